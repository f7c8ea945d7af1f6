#include "study/stats/bootstrap.h"

#include "gi/core/quantile.h"
#include "study/numeric/error.h"
#include "study/numeric/random.h"
#include "study/numeric/special.h"
#include "study/stats/summary.h"

#include <algorithm>
#include <cmath>
#include <map>

namespace study {
namespace {

double tail(int observers, double confidence)
{
    double const n = observers;
    return normal_cdf(std::sqrt(n / (n - 1)) * student_quantile((1 - confidence) / 2, n - 1));
}

} // namespace

Bootstrap bootstrap(int observers, ObserverStatistic const& statistic, BootstrapSettings const& settings)
{
    if (observers < 2)
        refuse("a bootstrap of " + std::to_string(observers) + " observers",
               "their variation cannot be estimated from fewer than two", "report the standard error of the fit");
    if (settings.replicates < 2 || !(settings.confidence > 0 && settings.confidence < 1))
        refuse("a bootstrap with " + std::to_string(settings.replicates) + " replicates and confidence " +
                   std::to_string(settings.confidence),
               "it needs two replicates or more and a probability", "use 1000 and 0.95");

    Bootstrap result;
    Random random(settings.seed);
    std::vector<int> drawn(std::size_t(observers), 0);
    std::string reason;
    for (int i = 0; i < settings.replicates; ++i) {
        for (int& d : drawn) d = int(random.below(std::uint32_t(observers)));
        try {
            result.replicates.push_back(statistic(drawn));
        } catch (std::invalid_argument const& error) {
            reason = error.what();
            ++result.failed;
        }
    }
    if (2 * result.failed > settings.replicates)
        refuse("most replicates of the bootstrap failed, the last with: " + reason,
               "too few observers made the comparisons that connect the items",
               "collect more observers, or report the standard error of the fit");

    double const low = tail(observers, settings.confidence);
    for (std::size_t k = 0; k < result.replicates.front().size(); ++k) {
        std::vector<double> values;
        for (auto const& r : result.replicates) values.push_back(r[k]);
        result.standard_error.push_back(standard_deviation(values));
        // Replicates that are all the same say nothing of other observers.
        bool const varies = result.standard_error.back() > kSolverNoise * largest_of(values);
        result.interval.push_back(varies ? Interval{gi::quantile(values, low), gi::quantile(values, 1 - low)}
                                         : Interval{std::nan(""), std::nan("")});
    }
    return result;
}

std::vector<PairCount> pool(std::vector<std::vector<PairCount>> const& observers)
{
    std::map<std::pair<int, int>, PairCount> sums;
    for (auto const& observer : observers)
        for (PairCount const& p : observer) {
            PairCount& sum = sums[{p.first, p.second}];
            sum.first = p.first;
            sum.second = p.second;
            sum.first_wins += p.first_wins;
            sum.second_wins += p.second_wins;
            sum.ties += p.ties;
        }
    std::vector<PairCount> pooled;
    for (auto const& [unused, sum] : sums) pooled.push_back(sum);
    return pooled;
}

} // namespace study
