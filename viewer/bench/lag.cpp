#include "viewer/bench/lag.h"

#include "gi/metrics/metrics.h"

#include <limits>

namespace viewer {

void LagError::add(std::size_t seed, std::size_t frame, gi::Picture const& reused, gi::Picture const& alone)
{
    Half& half = differences_[frame][seed % 2];
    std::vector<float> const &a = reused.find("color")->data, &b = alone.find("color")->data;
    half.sum.resize(a.size());
    for (std::size_t i = 0; i < a.size(); ++i) half.sum[i] += a[i] - b[i];
    ++half.seeds;
}

double LagError::relmse(std::size_t frame, gi::Picture const& truth) const
{
    auto const& [even, odd] = differences_[frame];
    if (odd.seeds == 0) return std::numeric_limits<double>::quiet_NaN();
    std::vector<float> const& t = truth.find("color")->data;
    double sum = 0;
    for (std::size_t i = 0; i < t.size(); ++i)
        sum += double(even.sum[i]) * double(odd.sum[i]) / (double(t[i]) * double(t[i]) + gi::kRelativeFloor);
    return sum / (double(even.seeds) * odd.seeds * double(t.size()));
}

} // namespace viewer
