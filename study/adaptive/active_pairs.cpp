#include "study/adaptive/active_pairs.h"

#include "study/numeric/error.h"
#include "study/numeric/special.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

namespace study {
namespace {

constexpr double kTie = 1e-9;

/// The variances that answers would leave.
class ExpectedVariances {
public:
    ExpectedVariances(std::vector<double> const& scores, Matrix covariance)
        : scores_(scores), covariance_(std::move(covariance))
    {
        look();
    }

    /// By how much an answer about the pair would lower the sum of the variances around the mean score.
    double gain(ActivePairs::Pair const& pair) const
    {
        return narrowing(pair) * difference_variance(squares_, pair);
    }
    void answer(ActivePairs::Pair const& pair)
    {
        shrink_along(covariance_, pair, narrowing(pair));
        look();
    }

private:
    /// w / (1 + w v): see active_pairs.h.
    double narrowing(ActivePairs::Pair const& pair) const
    {
        double const v = difference_variance(covariance_, pair);
        double const m = scores_[std::size_t(pair.first)] - scores_[std::size_t(pair.second)];
        double const d = std::max(0.0, std::abs(m) - std::sqrt(v));
        double const w =
            std::exp(-d * d - std::log(2 * std::numbers::pi) - log_normal_cdf(d) - log_normal_cdf(-d));
        return w / (1 + w * v);
    }

    /// squares_ = C C - n mean mean^T: the scalar products of the columns of C, each around its mean.
    void look()
    {
        std::size_t const n = covariance_.rows;
        squares_ = Matrix(n, n);
        std::vector<double> mean(n, 0);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = 0; j < n; ++j) mean[i] += covariance_(i, j) / double(n);
        for (std::size_t i = 0; i < n; ++i)
            for (std::size_t j = i; j < n; ++j) {
                double sum = -double(n) * mean[i] * mean[j];
                for (std::size_t k = 0; k < n; ++k) sum += covariance_(i, k) * covariance_(j, k);
                squares_(i, j) = squares_(j, i) = sum;
            }
    }

    std::vector<double> const& scores_;
    Matrix covariance_, squares_;
};

/// Items that are connected so far (union-find).
class Parts {
public:
    explicit Parts(int items) : parent_(std::size_t(items)) { std::iota(parent_.begin(), parent_.end(), 0); }

    bool are_connected(ActivePairs::Pair const& p) { return of(p.first) == of(p.second); }
    void connect(ActivePairs::Pair const& p) { parent_[std::size_t(of(p.first))] = of(p.second); }

private:
    int of(int item)
    {
        while (parent_[std::size_t(item)] != item)
            item = parent_[std::size_t(item)] = parent_[std::size_t(parent_[std::size_t(item)])];
        return item;
    }
    std::vector<int> parent_;
};

} // namespace

ActivePairs::ActivePairs(int items, std::vector<Pair> allowed, ActiveSettings const& settings)
    : items_(items),
      allowed_(std::move(allowed)),
      settings_(settings),
      random_(settings.seed),
      posterior_(items, settings.prior_sd)
{
    if (allowed_.empty()) refuse("active sampling of no pair", "there is nothing to show", "name pairs");
    for (auto const& [a, b] : allowed_)
        if (a < 0 || b < 0 || a >= items || b >= items || a == b)
            refuse("a pair of items " + std::to_string(a) + " and " + std::to_string(b),
                   "there are " + std::to_string(items) + ", counted from 0", "name two of them");
    choose();
}

double ActivePairs::gain(Pair pair) const { return ExpectedVariances(scores(), covariance()).gain(pair); }

void ActivePairs::choose()
{
    std::vector<std::size_t> order(allowed_.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    random_.shuffle(order); // the order of ties
    ExpectedVariances variances(scores(), covariance());
    Parts parts(items_);
    std::vector<Pair> chosen;
    for (;;) {
        Pair const* best = nullptr;
        double most = 0;
        for (std::size_t const i : order) {
            if (settings_.is_tree && parts.are_connected(allowed_[i])) continue;
            if (!settings_.is_tree && allowed_[i] == last_ && order.size() > 1) continue;
            double const gain = variances.gain(allowed_[i]);
            if (best && gain <= most * (1 + kTie)) continue;
            best = &allowed_[i];
            most = gain;
        }
        if (!best) break; // the tree is complete
        chosen.push_back(*best);
        if (!settings_.is_tree) break;
        parts.connect(*best);
        variances.answer(*best);
    }
    random_.shuffle(chosen);
    queue_.assign(chosen.begin(), chosen.end());
}

void ActivePairs::shown(Pair pair, std::optional<double> first_wins)
{
    last_ = pair;
    if (first_wins) {
        posterior_.add({pair, *first_wins});
        // Each answer changes all factors only a little: refine them once per n - 1 answers (the pairs of a tree).
        if (++answers_ % std::max(1, items_ - 1) == 0) posterior_.refine();
    }
    if (auto const found = std::find(queue_.begin(), queue_.end(), pair); found != queue_.end())
        queue_.erase(found);
    if (!settings_.is_tree) queue_.clear();
    if (queue_.empty()) choose();
}

} // namespace study
