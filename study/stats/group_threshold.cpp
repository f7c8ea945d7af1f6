#include "study/stats/group_threshold.h"

#include "study/numeric/error.h"
#include "study/numeric/special.h"
#include "study/stats/maximum_within.h"
#include "study/stats/profile.h"
#include "study/stats/threshold_marginal.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>

namespace study {
namespace {

constexpr double kFarThreshold = 2;      ///< in ranges from the centre: infinite beyond
constexpr double kVisibleLogSpread = -3; ///< of 0.05 ranges: where the likelihood has a gradient

class ThresholdFit {
    using enum ThresholdPart::Index;

public:
    ThresholdFit(std::span<ObserverLevels const> observers, GroupThresholdSettings const& s)
        : marginal_(observers, s)
    {
        bool const several = marginal_.people().size() > 1; // one observer has no differences to others
        shared_ = {kScale};
        if (!s.lapse) shared_.push_back(kLapse);
        if (several) shared_.push_back(kSpread);
        if (marginal_.is_repeated()) shared_.push_back(kEta);
        if (s.fits_guess) shared_.push_back(kGuess);
        std::vector<int> all = shared_;
        all.push_back(kMean);
        double const spread = several ? std::log(0.1) : -20;
        double const guess = std::log(0.1 / 0.9);
        most_ = -kInfinity;
        for (double const mean : {-0.25, 0.0, 0.25}) {
            Thresholds at{mean, spread, std::log(0.12), -3.5, -2.5, guess};
            double const v = maximise(at, all);
            if (!(v > most_)) continue;
            most_ = v;
            best_ = at;
        }
        if (std::isinf(most_))
            refuse("a threshold at " + std::to_string(s.proportion) + " right answers",
                   "the function starts above it or ends below it", "choose a proportion between guessing and 1");
        start_over();
        Thresholds unused;
        marginal_(best_, unused);
    }

    Thresholds const& best() const { return best_; }
    ThresholdMarginal const& marginal() const { return marginal_; }

    struct Errors {
        /// The variance of the mean by how observers' scores differ (the sandwich estimator:
        /// Huber 1967), by that of the likelihood.
        double variance_ratio = 1;
        double scale = 0; ///< standard error of the logarithm
    };
    /// Omits the spread of thresholds, since its estimate and that of the mean are independent.
    Errors errors()
    {
        std::vector<std::size_t> parts{kMean}; // the scale is next
        for (int const i : shared_)
            if (i != kSpread) parts.push_back(std::size_t(i));
        auto const size = Eigen::Index(parts.size());
        Eigen::MatrixXd information(size, size), by_scores = Eigen::MatrixXd::Zero(size, size);
        constexpr double kStep = 1e-3;
        for (Eigen::Index i = 0; i < size; ++i) {
            Thresholds at = best_, above, below;
            at[parts[std::size_t(i)]] += kStep;
            marginal_(at, above);
            at[parts[std::size_t(i)]] -= 2 * kStep;
            marginal_(at, below);
            for (Eigen::Index k = 0; k < size; ++k) {
                auto const part = parts[std::size_t(k)];
                information(k, i) = (below[part] - above[part]) / (2 * kStep);
            }
        }
        Thresholds unused;
        marginal_(best_, unused);
        double surprises = 0, trials = 0;
        for (ThresholdPerson const& p : marginal_.people()) {
            Eigen::VectorXd score(size);
            for (Eigen::Index i = 0; i < size; ++i) score[i] = p.score[parts[std::size_t(i)]];
            by_scores += score * score.transpose();
            surprises += p.surprises;
            for (LevelAnswers const& l : p.levels) trials += l.trials;
        }
        auto const solved = ((information + information.transpose()) / 2).ldlt();
        Eigen::VectorXd const of_mean = solved.solve(Eigen::VectorXd::Unit(size, 0)); // its covariances
        double const ratio = of_mean.dot(by_scores * of_mean) / of_mean[0];
        double const scale = solved.solve(Eigen::VectorXd::Unit(size, 1))[1]; // its variance
        auto const n = double(marginal_.people().size());
        Errors e;
        if (n > 1 && std::isfinite(ratio) && of_mean[0] > 0)
            e.variance_ratio = moderated(ratio, n, surprises / n, trials / n);
        if (std::isfinite(scale) && scale > 0) e.scale = std::sqrt(scale);
        return e;
    }

    void start_over() { last_ = best_; }
    double loss_of_spread(double spread)
    {
        last_[kSpread] = spread;
        std::vector<int> free{kMean};
        for (int const i : shared_)
            if (i != kSpread) free.push_back(i);
        return std::max(0.0, 2 * (most_ - maximise(last_, free)));
    }
    double loss(double mean)
    {
        last_[kMean] = mean;
        // As in group_dprime: where the best spread is 0 its logarithm has no gradient.
        if (std::find(shared_.begin(), shared_.end(), kSpread) != shared_.end())
            last_[kSpread] = std::max(last_[kSpread], kVisibleLogSpread);
        return std::max(0.0, 2 * (most_ - maximise(last_, shared_)));
    }

private:
    double maximise(Thresholds& at, std::vector<int> const& free)
    {
        static constexpr Bounds<kCount> kBounds{{-kFarThreshold - 0.5, -9, -6, -9, -7, -7},
                                                {kFarThreshold + 0.5, 1, 2, -0.5, 0, 1}};
        return maximise_within(kBounds, at, free, 80, 0.05 / double(marginal_.people().size()),
                               [&](Thresholds const& p, Thresholds& gradient) { return marginal_(p, gradient); });
    }

    ThresholdMarginal marginal_;
    std::vector<int> shared_;
    Thresholds best_{}, last_{};
    double most_ = 0;
};

std::string note_of(ThresholdFit const& fit)
{
    ThresholdMarginal const& m = fit.marginal();
    if (m.is_all(true)) return "nothing but correct responses: there is no threshold among these levels";
    if (m.is_all(false)) return "no correct response at all: there is no threshold among these levels";
    Trend trend;
    for (ThresholdPerson const& p : m.people()) {
        for (LevelAnswers const& l : p.levels) trend.add(l.u, l.right, l.trials);
        trend.next_observer();
    }
    std::string note = trend.is_falling() ? kWrongDirection : "";
    auto const say = [&](char const* what) { note += (note.empty() ? "" : "; ") + std::string(what); };
    if (std::abs(fit.best()[ThresholdPart::kMean]) > 0.5)
        say("the mean threshold lies outside the range of levels");
    else if (fit.best()[ThresholdPart::kScale] > 0)
        say("responses hardly change with level: the scale is wider than the range");
    return note;
}

/// Levels do not follow the answers: all observers have the same ones, about as often (answers may be missing).
bool are_levels_fixed(std::vector<ThresholdPerson> const& people)
{
    auto const& first = people.front().levels;
    return std::all_of(people.begin(), people.end(), [&](ThresholdPerson const& p) {
        return std::equal(first.begin(), first.end(), p.levels.begin(), p.levels.end(),
                          [](LevelAnswers const& a, LevelAnswers const& b) {
                              return a.u == b.u && 2 * a.trials >= b.trials && a.trials <= 2 * b.trials;
                          });
    });
}

GroupThreshold described(ThresholdFit const& fit, GroupThresholdSettings const& settings)
{
    ThresholdMarginal const& m = fit.marginal();
    Thresholds const& best = fit.best();
    GroupThreshold g;
    g.observers = int(m.people().size());
    g.mean = m.centre() + m.range() * best[ThresholdPart::kMean];
    g.deviation = g.observers > 1 ? m.range() * spread_of(best[ThresholdPart::kSpread]) : 0;
    double guess = 0;
    for (ThresholdPerson const& p : m.people()) guess += p.guess / g.observers;
    g.shared = {g.mean, m.range() * std::exp(best[ThresholdPart::kScale]),
                settings.fits_guess ? inverse_logit(best[ThresholdPart::kGuess]) : guess, m.lapse_of(best)};
    g.eta = m.is_repeated() ? inverse_logit(best[ThresholdPart::kEta]) : 0;
    g.are_levels_fixed = are_levels_fixed(m.people());
    g.note = note_of(fit);
    return g;
}

/// Ends in ranges.
Interval deviation_interval(ThresholdFit& fit, double n, double confidence)
{
    constexpr double kNone = -8; // spreads below it are one: the logarithm of that part of a range
    double const best = fit.best()[ThresholdPart::kSpread], tail = (1 - confidence) / 2;
    auto const end = [&](double direction, double from, double farthest) {
        fit.start_over();
        ProfileSearch const search{
            from, deviation_limit(n, direction > 0 ? tail : 1 - tail), direction, farthest, 0.3, 0.02};
        double const x = profile_end(search, [&](double spread) { return fit.loss_of_spread(spread); });
        return std::isinf(x) ? x : spread_of(x);
    };
    double const low = best > kNone ? end(-1, best, kNone) : 0;
    // As in loss(): where the best spread is 0 its logarithm has no gradient.
    double const high = end(1, std::max(best, kVisibleLogSpread), std::log(kMostDeviation));
    return {std::isinf(low) ? 0 : low, high};
}

} // namespace

GroupThreshold group_threshold_mode(std::span<ObserverLevels const> observers,
                                    GroupThresholdSettings const& settings)
{
    return described(ThresholdFit(observers, settings), settings);
}

GroupThreshold group_threshold(std::span<ObserverLevels const> observers, GroupThresholdSettings const& settings)
{
    ThresholdFit fit(observers, settings);
    ThresholdMarginal const& m = fit.marginal();
    GroupThreshold g = described(fit, settings);
    auto const n = double(g.observers);
    double information = 0;
    for (ThresholdPerson const& p : m.people()) information += p.information / n;
    double const sd = spread_of(fit.best()[ThresholdPart::kSpread]);
    auto const errors = fit.errors();
    g.scale_error = errors.scale;
    double const limit = profile_limit(settings.confidence, n, errors.variance_ratio);
    auto const end = [&](double direction) {
        fit.start_over();
        double const step = 1.5 * std::sqrt((sd * sd + 1 / (information + 1)) / n);
        ProfileSearch const search{fit.best()[ThresholdPart::kMean], limit, direction,
                                   direction * kFarThreshold,        step,  0.01 * step};
        double const x = profile_end(search, [&](double mean) { return fit.loss(mean); });
        return std::isinf(x) ? x : m.centre() + m.range() * x;
    };
    g.interval = {end(-1), end(1)};
    if (g.observers > 1 && settings.has_deviation) {
        Interval const spread = deviation_interval(fit, n, settings.confidence);
        g.deviation_interval = {m.range() * spread.low, m.range() * spread.high};
    }
    return g;
}

} // namespace study
