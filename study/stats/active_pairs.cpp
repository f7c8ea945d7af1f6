#include "study/stats/active_pairs.h"

#include "study/stats/error.h"
#include "study/stats/grid_posterior.h"
#include "study/stats/special.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <numbers>
#include <numeric>

namespace study {
namespace {

constexpr double kTie = 1e-9;

/// Mean of H(Phi(d)) over d ~ N(m, v) by the trapezoidal rule, which converges fast for smooth functions.
double mean_entropy(double m, double v)
{
    constexpr int kSteps = 32;
    constexpr double kWidest = 6;
    double sum = 0, weights = 0;
    for (int i = -kSteps; i <= kSteps; ++i) {
        double const z = kWidest * i / kSteps, weight = std::exp(-z * z / 2);
        sum += weight * entropy_of_event(normal_cdf(m + std::sqrt(v) * z));
        weights += weight;
    }
    return sum / weights;
}

/// Finds the part of an item (union-find).
int part_of(std::vector<int>& parent, int item)
{
    while (parent[std::size_t(item)] != item)
        item = parent[std::size_t(item)] = parent[std::size_t(parent[std::size_t(item)])];
    return item;
}

} // namespace

/// Newton's method; the posterior is log-concave.
PairPosterior pair_posterior(int items, std::span<PairAnswer const> answers, double prior_sd,
                             std::vector<double> const& start)
{
    Eigen::Index const n = items;
    Eigen::VectorXd s = Eigen::VectorXd::Zero(n);
    for (Eigen::Index i = 0; i < n && !start.empty(); ++i) s[i] = start[std::size_t(i)];
    double const prior = 1 / (prior_sd * prior_sd);
    Eigen::MatrixXd information;
    for (int iteration = 0; iteration < 50; ++iteration) {
        Eigen::VectorXd gradient = -prior * s;
        information = Eigen::MatrixXd::Identity(n, n) * prior;
        for (PairAnswer const& answer : answers) {
            auto const [a, b] = answer.pair;
            double const d = s[a] - s[b];
            // A tie is half a win of each.
            for (auto const& [sign, share] : {std::pair{1.0, answer.first_wins}, {-1.0, 1 - answer.first_wins}}) {
                if (share <= 0) continue;
                double const z = sign * d,
                             ratio = std::exp(-z * z / 2 - log_normal_cdf(z)) / std::sqrt(2 * std::numbers::pi);
                double const pull = share * sign * ratio, weight = share * ratio * (z + ratio);
                gradient[a] += pull;
                gradient[b] -= pull;
                information(a, a) += weight;
                information(b, b) += weight;
                information(a, b) -= weight;
                information(b, a) -= weight;
            }
        }
        Eigen::VectorXd const step = information.llt().solve(gradient);
        double const longest = step.cwiseAbs().maxCoeff();
        s += step * std::min(1.0, 2 / std::max(longest, 1e-300));
        if (longest < 1e-10) break;
    }
    Eigen::MatrixXd const inverse = information.llt().solve(Eigen::MatrixXd::Identity(n, n));
    PairPosterior out{{s.data(), s.data() + n}, Matrix(std::size_t(n), std::size_t(n))};
    for (Eigen::Index i = 0; i < n; ++i)
        for (Eigen::Index j = 0; j < n; ++j) out.covariance(std::size_t(i), std::size_t(j)) = inverse(i, j);
    return out;
}

ActivePairs::ActivePairs(int items, std::vector<Pair> allowed, ActiveSettings const& settings)
    : items_(items), allowed_(std::move(allowed)), settings_(settings), random_(settings.seed)
{
    if (allowed_.empty()) refuse("active sampling of no pair", "there is nothing to show", "name pairs");
    for (auto const& [a, b] : allowed_)
        if (a < 0 || b < 0 || a >= items || b >= items || a == b)
            refuse("a pair of items " + std::to_string(a) + " and " + std::to_string(b),
                   "there are " + std::to_string(items) + ", counted from 0", "name two of them");
    posterior_ = pair_posterior(items_, answers_, settings_.prior_sd);
    choose();
}

double ActivePairs::gain(Pair pair) const
{
    auto const [a, b] = std::pair{std::size_t(pair.first), std::size_t(pair.second)};
    double const m = scores()[a] - scores()[b];
    double const v = std::max(0.0, covariance()(a, a) + covariance()(b, b) - 2 * covariance()(a, b));
    return entropy_of_event(normal_cdf(m / std::sqrt(1 + v))) - mean_entropy(m, v);
}

void ActivePairs::choose()
{
    if (is_outdated_) posterior_ = pair_posterior(items_, answers_, settings_.prior_sd, posterior_.mode);
    is_outdated_ = false;
    std::vector<std::size_t> order(allowed_.size());
    std::iota(order.begin(), order.end(), std::size_t(0));
    random_.shuffle(order); // the order of ties
    std::vector<double> gains;
    for (Pair const& p : allowed_) gains.push_back(std::round(gain(p) / kTie) * kTie);
    std::stable_sort(order.begin(), order.end(),
                     [&](std::size_t a, std::size_t b) { return gains[a] > gains[b]; });
    if (!settings_.is_batch) {
        queue_.push_back(allowed_[order[0]]);
        return;
    }
    std::vector<int> parent(static_cast<std::size_t>(items_));
    std::iota(parent.begin(), parent.end(), 0);
    std::vector<Pair> tree; // Kruskal's algorithm (1956)
    for (std::size_t const i : order) {
        int const a = part_of(parent, allowed_[i].first), b = part_of(parent, allowed_[i].second);
        if (a == b) continue;
        parent[std::size_t(a)] = b;
        tree.push_back(allowed_[i]);
    }
    random_.shuffle(tree);
    queue_.assign(tree.begin(), tree.end());
}

void ActivePairs::shown(Pair pair, std::optional<double> first_wins)
{
    if (first_wins) answers_.push_back({pair, *first_wins});
    is_outdated_ |= first_wins.has_value();
    if (auto const found = std::find(queue_.begin(), queue_.end(), pair); found != queue_.end())
        queue_.erase(found);
    if (!settings_.is_batch) queue_.clear();
    if (queue_.empty()) choose();
}

} // namespace study
