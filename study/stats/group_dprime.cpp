#include "study/stats/group_dprime.h"

#include "study/numeric/error.h"
#include "study/numeric/special.h"
#include "study/stats/gauss_hermite.h"
#include "study/stats/maximum_within.h"
#include "study/stats/profile.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

constexpr double kLargestMean = 8;     ///< means beyond it are called infinite
constexpr double kVisibleLogSd = -2.3; ///< log 0.1: where the likelihood has a gradient

/// Means and standard deviations of d' and criterion; a standard deviation is kLeastDPrimeSd + exp(parameter).
using Population = std::array<double, 4>; ///< mean d', log sd, mean criterion, log sd
double deviation(double parameter) { return kLeastDPrimeSd + std::exp(parameter); }

struct Observer {
    DetectionCounts counts;
    DetectionPoint mode;                 ///< of the last population: where the next search starts
    double dprime = 0;                   ///< mean under the last population
    std::array<double, 3> information{}; ///< of d', of both, of criterion, at the mode
    std::array<double, 2> score{};       ///< of the means of d' and criterion
};

class Marginal {
public:
    Marginal(DetectionTask task, std::span<DetectionCounts const> counts) : task_(task)
    {
        for (DetectionCounts const& c : counts)
            if (c.signals + c.noises > 0) observers_.push_back({c, detection_point(task, c), 0, {}, {}});
    }

    std::vector<Observer> const& observers() const { return observers_; }

    /// Log-likelihood and its gradient.
    double operator()(Population const& at, Population& gradient)
    {
        gradient.fill(0);
        double sum = 0;
        for (Observer& o : observers_) sum += integrate(o, at, gradient);
        return sum;
    }

private:
    struct Prior {
        double mean, sd;
        double precision() const { return 1 / (sd * sd); }
        double log_density(double x) const
        {
            double const z = (x - mean) / sd;
            return -0.5 * z * z - std::log(sd) - kLogRootTwoPi;
        }
    };

    double log_joint(Observer const& o, Prior const& d, Prior const& c, double x, double y) const
    {
        double const own = has_criterion(task_) ? c.log_density(y) : 0;
        return detection_likelihood(task_, o.counts, x, y).value + d.log_density(x) + own;
    }

    /// Moves o.mode to the maximum of the joint density; returns minus its second derivatives there (expected).
    std::array<double, 3> find_mode(Observer& o, Prior const& d, Prior const& c) const
    {
        double& x = o.mode.dprime;
        double& y = o.mode.criterion;
        bool const two = has_criterion(task_);
        double here = log_joint(o, d, c, x, y);
        std::array<double, 3> h{};
        for (int i = 0; i < 30; ++i) {
            DetectionLikelihood const l = detection_likelihood(task_, o.counts, x, y);
            double const gx = l.by_dprime - (x - d.mean) * d.precision();
            double const gy = two ? l.by_criterion - (y - c.mean) * c.precision() : 0;
            h = {l.information[0] + d.precision(), two ? l.information[1] : 0,
                 two ? l.information[2] + c.precision() : 1};
            double const determinant = h[0] * h[2] - h[1] * h[1];
            double const dx = (h[2] * gx - h[1] * gy) / determinant, dy = (h[0] * gy - h[1] * gx) / determinant;
            o.information = {l.information[0], l.information[1], l.information[2]};
            if (gx * dx + gy * dy < 1e-8) break;
            double step = 1;
            for (; step > 1e-6; step /= 2) {
                double const there = log_joint(o, d, c, x + step * dx, y + step * dy);
                if (there > here) {
                    here = there;
                    break;
                }
            }
            if (!(step > 1e-6)) break;
            x += step * dx;
            y += step * dy;
        }
        return h;
    }

    double integrate(Observer& o, Population const& at, Population& gradient)
    {
        static auto const wide = gauss_hermite(9), narrow = gauss_hermite(5), none = gauss_hermite(1);
        Prior const d{at[0], deviation(at[1])}, c{at[2], deviation(at[3])};
        auto const h = find_mode(o, d, c);
        // h = R^T R; points are mode + sqrt 2 R^-1 z.
        double const r00 = std::sqrt(h[0]), r01 = h[1] / r00, r11 = std::sqrt(h[2] - r01 * r01);
        bool const two = has_criterion(task_);
        double most = -kInfinity;
        terms_.clear();
        for (QuadratureNode const& i : two ? narrow : none) {
            double const y = std::sqrt(2.0) * i.x / r11;
            for (QuadratureNode const& k : wide) {
                double const x = (std::sqrt(2.0) * k.x - r01 * y) / r00;
                Term t{o.mode.dprime + x, o.mode.criterion + y, 0};
                t.log_value = log_joint(o, d, c, t.dprime, t.criterion) + k.log_weight + (two ? i.log_weight : 0);
                most = std::max(most, t.log_value);
                terms_.push_back(t);
            }
        }
        double sum = 0, dprime = 0, d1 = 0, d2 = 0, c1 = 0, c2 = 0;
        for (Term const& t : terms_) {
            double const w = std::exp(t.log_value - most), zd = (t.dprime - d.mean) / d.sd,
                         zc = (t.criterion - c.mean) / c.sd;
            sum += w;
            dprime += w * t.dprime;
            d1 += w * zd;
            d2 += w * (zd * zd - 1);
            c1 += w * zc;
            c2 += w * (zc * zc - 1);
        }
        o.dprime = dprime / sum;
        o.score = {d1 / sum / d.sd, two ? c1 / sum / c.sd : 0};
        // Fisher's identity: the score is the mean, given the answers, of that of the complete data.
        gradient[0] += o.score[0];
        gradient[1] += d2 / sum * (1 - kLeastDPrimeSd / d.sd);
        if (two) {
            gradient[2] += o.score[1];
            gradient[3] += c2 / sum * (1 - kLeastDPrimeSd / c.sd);
        }
        return most + std::log(sum) - std::log(r00) - (two ? std::log(r11) - 0.5 * std::log(2.0) : 0) +
               0.5 * std::log(2.0);
    }

    struct Term {
        double dprime, criterion, log_value;
    };
    DetectionTask task_;
    std::vector<Observer> observers_;
    std::vector<Term> terms_;
};

class Fit {
public:
    Fit(DetectionTask task, std::span<DetectionCounts const> counts) : marginal_(task, counts)
    {
        auto const& all = marginal_.observers();
        if (all.empty()) return;
        double d = 0, c = 0;
        for (Observer const& o : all) {
            d += o.mode.dprime / double(all.size());
            c += o.mode.criterion / double(all.size());
        }
        best_ = {d, std::log(0.3), c, std::log(0.3)};
        if (has_criterion(task)) free_ = {2};
        if (all.size() > 1) { // one observer has no differences to others
            free_.push_back(1);
            if (has_criterion(task)) free_.push_back(3);
        } else {
            best_[1] = best_[3] = -20;
        }
        std::vector<int> every = free_;
        every.push_back(0);
        most_ = maximise(best_, every);
        Population unused;
        marginal_(best_, unused); // scores are those of the best
    }

    Population const& best() const { return best_; }
    Marginal& marginal() { return marginal_; }

    /// Twice the loss of log-likelihood if the mean d' is this. Not negative.
    double loss(double mean)
    {
        last_[0] = mean;
        // Where the best deviation is 0 its logarithm has no gradient, but farther
        // off observers may seem to differ.
        for (int const i : free_)
            if (i % 2 == 1) last_[std::size_t(i)] = std::max(last_[std::size_t(i)], kVisibleLogSd);
        return std::max(0.0, 2 * (most_ - maximise(last_, free_)));
    }
    void start_over() { last_ = best_; }
    /// Twice the loss of log-likelihood if the parameter of the deviation of d' is this.
    double loss_of_deviation(double parameter)
    {
        last_[1] = parameter;
        std::vector<int> free{0};
        for (int const i : free_)
            if (i != 1) free.push_back(i);
        return std::max(0.0, 2 * (most_ - maximise(last_, free)));
    }

private:
    double maximise(Population& at, std::vector<int> const& free)
    {
        // Means and logarithms of deviations within which the functions are accurate.
        static constexpr Bounds<4> kBounds{{-kLargestMean - 1, -12, -kLargestMean - 1, -12},
                                           {kLargestMean + 1, 2.5, kLargestMean + 1, 2.5}};
        return maximise_within(kBounds, at, free, 60, 1 / double(marginal_.observers().size()),
                               [&](Population const& p, Population& gradient) { return marginal_(p, gradient); });
    }

    Marginal marginal_;
    std::vector<int> free_;
    Population best_{}, last_{};
    double most_ = 0;
};

/// The variance of the mean by how observers' scores differ (the sandwich estimator:
/// Huber 1967), by that of the likelihood.
double variance_ratio(DetectionTask task, Fit& fit)
{
    Population const& best = fit.best();
    double const d_variance = std::pow(deviation(best[1]), 2), c_variance = std::pow(deviation(best[3]), 2);
    bool const two = has_criterion(task);
    double dd = 0, dc = 0, cc = 0, surprises = 0, trials = 0;
    auto const& observers = fit.marginal().observers();
    for (Observer const& o : observers) {
        // (J^-1 + variances)^-1 = (1 + J variances)^-1 J
        auto const& j = o.information;
        double const a = 1 + j[0] * d_variance, b = j[1] * c_variance, c = j[1] * d_variance,
                     e = 1 + j[2] * c_variance, determinant = a * e - b * c;
        dd += (e * j[0] - b * j[1]) / determinant;
        dc += (e * j[1] - b * j[2]) / determinant;
        cc += (a * j[2] - c * j[1]) / determinant;
        DetectionRates const r = detection_rates(task, o.mode.dprime, o.mode.criterion);
        surprises +=
            o.counts.signals * r.hit.yes * r.hit.no + o.counts.noises * r.false_alarm.yes * r.false_alarm.no;
        trials += o.counts.signals + o.counts.noises;
    }
    double const slope = two ? dc / cc : 0; // the criterion's mean is estimated too
    double sum = 0;
    for (Observer const& o : observers) sum += std::pow(o.score[0] - slope * o.score[1], 2);
    auto const n = double(observers.size());
    // More than the likelihood's is taken up by its variances between observers, except around d' = 0, where the
    // information of three tasks vanishes.
    return moderated(std::min(1.0, sum / (dd - slope * dc)), n, surprises / n, trials / n);
}

Interval deviation_interval(Fit& fit, double n, double confidence)
{
    constexpr double kNone = -6, kMost = 2; // logarithms of deviations: below 0.0025, beyond 7
    double const tail = (1 - confidence) / 2, best = fit.best()[1];
    auto const end = [&](double direction, double from, double farthest) {
        fit.start_over();
        double const limit = deviation_limit(n, direction > 0 ? tail : 1 - tail);
        double const x = profile_end({from, limit, direction, farthest, 0.3, 0.02},
                                     [&](double parameter) { return fit.loss_of_deviation(parameter); });
        return std::isinf(x) ? x : deviation(x);
    };
    double const low = best > kNone ? end(-1, best, kNone) : 0;
    return {std::isinf(low) ? 0 : low, end(1, std::max(best, kVisibleLogSd), kMost)};
}

void check(std::span<DetectionCounts const> observers)
{
    double trials = 0;
    for (DetectionCounts const& c : observers) {
        bool const good = c.hits >= 0 && c.hits <= c.signals && c.false_alarms >= 0 &&
                          c.false_alarms <= c.noises && std::isfinite(c.signals + c.noises);
        if (!good)
            refuse("more hits than signals or more false alarms than noise trials",
                   "they are counts of these trials", "count them again");
        trials += c.signals + c.noises;
    }
    if (!(trials > 0)) refuse("d' of observers without trials", "nothing was answered", "leave the condition out");
}

} // namespace

GroupDPrime group_dprime(DetectionTask task, std::span<DetectionCounts const> observers, double confidence,
                         bool has_deviation)
{
    check(observers);
    double signals = 0, noises = 0;
    for (DetectionCounts const& c : observers) {
        signals += c.signals;
        noises += c.noises;
    }
    if (has_criterion(task) && !(signals > 0 && noises > 0))
        refuse("d' without signal trials or without noise trials", "both rates are needed",
               "run both kinds of trial");
    Fit fit(task, observers);
    GroupDPrime g;
    Population const& best = fit.best();
    g.mean = best[0];
    g.deviation = deviation(best[1]);
    g.criterion = best[2];
    for (Observer const& o : fit.marginal().observers()) g.observer.push_back(o.dprime);
    auto const n = double(g.observer.size());
    double const ratio = variance_ratio(task, fit), limit = profile_limit(confidence, n, ratio);
    auto const are_all = [&](auto const& is_so) { return std::all_of(observers.begin(), observers.end(), is_so); };
    bool const has_noise = noises > 0;
    bool const is_up = are_all([](DetectionCounts const& c) { return c.hits == c.signals; }) ||
                       (has_noise && are_all([](DetectionCounts const& c) { return c.false_alarms == 0; }));
    bool const is_down =
        are_all([](DetectionCounts const& c) { return c.hits == 0; }) ||
        (has_noise && are_all([](DetectionCounts const& c) { return c.false_alarms == c.noises; }));
    if (is_up != is_down || std::abs(g.mean) > kLargestMean) {
        bool const is_high = is_up != is_down ? is_up : g.mean > 0;
        g.mean = is_high ? kInfinity : -kInfinity;
        g.note = fmt::format("all answers to {} are {}: d' has no {} limit",
                             has_noise ? "one kind of trial, or both," : "these trials",
                             is_high ? "right" : "wrong", is_high ? "upper" : "lower");
    }
    fit.start_over();
    g.p = profile_p(fit.loss(0), n, ratio);
    auto const end = [&](double direction) {
        fit.start_over();
        return profile_end({best[0], limit, direction, direction * kLargestMean},
                           [&](double mean) { return fit.loss(mean); });
    };
    g.interval = {end(-1), end(1)};
    if (has_deviation && n > 1 && std::isfinite(g.mean))
        g.deviation_interval = deviation_interval(fit, n, confidence);
    return g;
}

} // namespace study
