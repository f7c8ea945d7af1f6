#include "study/stats/group_threshold.h"

#include "study/stats/curve_likelihood.h"
#include "study/stats/error.h"
#include "study/stats/gauss_hermite.h"
#include "study/stats/maximum_within.h"
#include "study/stats/profile.h"
#include "study/stats/special.h"

#include <Eigen/Cholesky>
#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cmath>
#include <optional>

namespace study {
namespace {

constexpr double kLeastThresholdSd = 0.002; ///< between observers, in ranges
constexpr double kFarThreshold = 2;         ///< in ranges from the centre: infinite beyond

/// All in units of the range from its centre: mean and log deviation of thresholds, log scale, logits of lapse,
/// eta, guess.
enum Part { kMean, kSpread, kScale, kLapse, kEta, kGuess, kParts };
using Thresholds = std::array<double, kParts>;

double spread_of(double parameter) { return kLeastThresholdSd + std::exp(parameter); }

/// Beta-binomial distributions are of whole numbers; counts from percentages are none.
bool has_whole_counts(std::span<ObserverLevels const> observers)
{
    return std::all_of(observers.begin(), observers.end(), [](ObserverLevels const& o) {
        return std::all_of(o.counts.begin(), o.counts.end(), [](LevelCount const& c) {
            return c.correct == std::floor(c.correct) && c.trials == std::floor(c.trials);
        });
    });
}

struct Person {
    std::vector<LevelAnswers> levels;
    double guess = 0.5, mode = 0; ///< where the last search for the mode ended
    double mean = 0;              ///< of the threshold under the last population
    double information = 0;
    double surprises = 0; ///< sum over trials of p (1 - p)
    Thresholds score{};   ///< derivatives of this observer's log-likelihood
};

class ThresholdMarginal {
public:
    ThresholdMarginal(std::span<ObserverLevels const> observers, GroupThresholdSettings const& s) : s_(s)
    {
        double const a = transformed(s.shape, s.low), b = transformed(s.shape, s.high);
        range_ = std::abs(b - a);
        centre_ = (a + b) / 2;
        if (!(range_ > 0 && std::isfinite(range_)))
            refuse("thresholds between " + std::to_string(s.low) + " and " + std::to_string(s.high),
                   "they are expected between two levels", "give two different ones, above 0 on a log scale");
        for (ObserverLevels const& o : observers) add(o);
        is_repeated_ = is_repeated_ && has_whole_counts(observers);
        if (people_.empty())
            refuse("thresholds of observers without trials", "nothing was answered", "leave the condition out");
    }

    std::vector<Person> const& people() const { return people_; }
    bool is_repeated() const { return is_repeated_; }
    double range() const { return range_; }
    double centre() const { return centre_; }
    bool is_all(bool right) const
    {
        return std::all_of(people_.begin(), people_.end(), [&](Person const& p) {
            return std::all_of(p.levels.begin(), p.levels.end(),
                               [&](LevelAnswers const& l) { return l.right == (right ? l.trials : 0); });
        });
    }

    /// Penalised log-likelihood and its gradient; -infinity where the curve cannot reach the proportion.
    double operator()(Thresholds const& at, Thresholds& gradient)
    {
        gradient.fill(0);
        double sum = 0;
        for (Person& p : people_) {
            p.score.fill(0);
            auto const curve = curve_of(at, s_.fits_guess ? inverse_logit(at[kGuess]) : p.guess);
            if (!curve) return -kInfinity;
            sum += integrate(p, at, *curve);
            for (std::size_t i = 0; i < kParts; ++i) gradient[i] += p.score[i];
        }
        double const lapse = lapse_of(at), eta = inverse_logit(at[kEta]),
                     from_usual = at[kScale] - std::log(0.125);
        sum -= 0.5 * from_usual * from_usual;
        if (!s_.lapse) {
            sum += std::log(lapse) + 20 * std::log1p(-lapse);
            gradient[kLapse] += 1 - 21 * lapse;
        }
        gradient[kScale] -= from_usual;
        if (is_repeated_) {
            sum += std::log(eta) + 2 * std::log1p(-eta); // weaker than for one observer: there are many levels
            gradient[kEta] += 1 - 3 * eta;
        }
        return sum;
    }

    double lapse_of(Thresholds const& at) const { return s_.lapse.value_or(inverse_logit(at[kLapse])); }

private:
    void add(ObserverLevels const& o)
    {
        Person p;
        p.guess = o.guess;
        if (!(o.guess >= 0 && o.guess < 1))
            refuse("a guess rate of " + std::to_string(o.guess), "it is a proportion below 1", "check it");
        for (LevelCount const& c : o.counts) {
            double const u = transformed(s_.shape, c.level);
            if (!(c.correct >= 0 && c.correct <= c.trials && std::isfinite(c.trials)) || !std::isfinite(u))
                refuse(std::to_string(c.correct) + " of " + std::to_string(c.trials) + " trials at level " +
                           std::to_string(c.level),
                       "counts are numbers, with no more correct responses than trials, at levels on the axis",
                       "check the table");
            if (c.trials > 0) p.levels.push_back({(u - centre_) / range_, c.correct, c.trials});
            is_repeated_ = is_repeated_ || c.trials >= 2;
        }
        if (!p.levels.empty()) people_.push_back(std::move(p));
    }

    std::optional<LevelCurve> curve_of(Thresholds const& at, double guess) const
    {
        return level_curve(s_.shape.sigmoid, s_.proportion, std::exp(at[kScale]), lapse_of(at), guess,
                           is_repeated_ ? inverse_logit(at[kEta]) : 0);
    }

    double integrate(Person& p, Thresholds const& at, LevelCurve const& c) const
    {
        static auto const nodes = gauss_hermite(9);
        double const mean = at[kMean], sd = spread_of(at[kSpread]), precision = 1 / (sd * sd);
        auto const joint = [&](double t, LevelLikelihood const& s) {
            return s.value - 0.5 * (t - mean) * (t - mean) * precision;
        };
        // The mode, by scoring from the last one.
        double t = p.mode;
        LevelLikelihood s = level_likelihood(p.levels, c, t, false);
        double here = joint(t, s);
        for (int i = 0; i < 30; ++i) {
            double const pull = s.by_threshold - (t - mean) * precision, curvature = s.information + precision;
            double step = pull / curvature;
            if (pull * step < 1e-9) break;
            bool gained = false;
            for (; std::abs(step) > 1e-7 && !gained; step /= 2) {
                LevelLikelihood const there = level_likelihood(p.levels, c, t + step, false);
                gained = joint(t + step, there) > here;
                if (!gained) continue;
                t += step;
                s = there;
                here = joint(t, s);
                break;
            }
            if (!gained) break;
        }
        p.mode = t;
        p.information = s.information;
        p.surprises = s.surprises;
        double const width = 1 / std::sqrt(s.information + precision);
        std::array<LevelLikelihood, 9> at_node;
        std::array<double, 9> place, log_value;
        double most = -kInfinity;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            place[i] = t + std::sqrt(2.0) * width * nodes[i].x;
            at_node[i] = level_likelihood(p.levels, c, place[i], true);
            log_value[i] = joint(place[i], at_node[i]) + nodes[i].log_weight;
            most = std::max(most, log_value[i]);
        }
        double sum = 0, m1 = 0, m2 = 0;
        LevelLikelihood average;
        for (std::size_t i = 0; i < nodes.size(); ++i) {
            double const w = std::exp(log_value[i] - most), away = place[i] - mean;
            sum += w;
            m1 += w * away;
            m2 += w * away * away;
            average.by_log_scale += w * at_node[i].by_log_scale;
            average.by_lapse += w * at_node[i].by_lapse;
            average.by_guess += w * at_node[i].by_guess;
            average.by_nu += w * at_node[i].by_nu;
        }
        m1 /= sum;
        m2 /= sum;
        p.mean = mean + m1;
        p.score[kMean] = m1 * precision;
        p.score[kSpread] = (m2 * precision - 1) * (1 - kLeastThresholdSd / sd);
        p.score[kScale] = average.by_log_scale / sum;
        p.score[kLapse] = average.by_lapse / sum * c.lapse * (1 - c.lapse);
        if (s_.fits_guess) p.score[kGuess] = average.by_guess / sum * c.guess * (1 - c.guess);
        if (is_repeated_) p.score[kEta] = average.by_nu / sum * nu_by_logit(inverse_logit(at[kEta]));
        return most + std::log(sum) + std::log(width / sd);
    }

    GroupThresholdSettings const& s_;
    double centre_ = 0, range_ = 1;
    std::vector<Person> people_;
    bool is_repeated_ = false;
};

class ThresholdFit {
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
        /// The variance of the mean by how observers' scores differ (the sandwich estimator: Huber 1967), by that
        /// of the likelihood.
        double variance_ratio = 1;
        double scale = 0; ///< standard error of the logarithm
    };
    /// The spread of thresholds is left out: its estimate and that of the mean are independent.
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
        for (Person const& p : marginal_.people()) {
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
    double loss(double mean)
    {
        last_[kMean] = mean;
        return std::max(0.0, 2 * (most_ - maximise(last_, shared_)));
    }

private:
    double maximise(Thresholds& at, std::vector<int> const& free)
    {
        static constexpr Bounds<kParts> kBounds{{-kFarThreshold - 0.5, -9, -6, -9, -7, -7},
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
    if (std::abs(fit.best()[kMean]) > 0.5) return "the mean threshold lies outside the range of levels";
    if (fit.best()[kScale] > 0) return "responses hardly change with level: the scale is wider than the range";
    return "";
}

GroupThreshold described(ThresholdFit const& fit, GroupThresholdSettings const& settings)
{
    ThresholdMarginal const& m = fit.marginal();
    Thresholds const& best = fit.best();
    GroupThreshold g;
    g.observers = int(m.people().size());
    g.mean = m.centre() + m.range() * best[kMean];
    g.deviation = g.observers > 1 ? m.range() * spread_of(best[kSpread]) : 0;
    double guess = 0;
    for (Person const& p : m.people()) guess += p.guess / g.observers;
    g.shared = {g.mean, m.range() * std::exp(best[kScale]),
                settings.fits_guess ? inverse_logit(best[kGuess]) : guess, m.lapse_of(best)};
    g.eta = m.is_repeated() ? inverse_logit(best[kEta]) : 0;
    g.note = note_of(fit);
    return g;
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
    for (Person const& p : m.people()) information += p.information / n;
    double const sd = spread_of(fit.best()[kSpread]);
    auto const errors = fit.errors();
    g.scale_error = errors.scale;
    double const limit = profile_limit(settings.confidence, n, errors.variance_ratio);
    auto const end = [&](double direction) {
        fit.start_over();
        double const step = 1.5 * std::sqrt((sd * sd + 1 / (information + 1)) / n);
        ProfileSearch const search{fit.best()[kMean],         limit, direction,
                                   direction * kFarThreshold, step,  0.01 * step};
        double const x = profile_end(search, [&](double mean) { return fit.loss(mean); });
        return std::isinf(x) ? x : m.centre() + m.range() * x;
    };
    g.interval = {end(-1), end(1)};
    return g;
}

PosteriorLevel own_threshold(ObserverLevels const& observer, GroupThreshold const& group,
                             GroupThresholdSettings const& settings)
{
    ThresholdMarginal const checked(std::span(&observer, 1), settings);
    double const range = checked.range(), guess = settings.fits_guess ? group.shared.guess : observer.guess;
    auto const curve = level_curve(settings.shape.sigmoid, settings.proportion, group.shared.scale / range,
                                   group.shared.lapse, guess, checked.is_repeated() ? group.eta : 0);
    if (!curve)
        refuse("a threshold at " + std::to_string(settings.proportion) + " right answers",
               "this observer's function starts above it or ends below it", "choose another proportion");
    constexpr int kSteps = 600; // over three ranges
    std::vector<double> place, density;
    double most = -kInfinity;
    for (int i = 0; i <= kSteps; ++i) {
        place.push_back(-1.5 + 3.0 * i / kSteps);
        density.push_back(level_likelihood(checked.people()[0].levels, *curve, place.back(), false).value);
        most = std::max(most, density.back());
    }
    double sum = 0, first = 0, second = 0;
    for (std::size_t i = 0; i < place.size(); ++i) {
        density[i] = std::exp(density[i] - most);
        sum += density[i];
        first += density[i] * place[i];
        second += density[i] * place[i] * place[i];
    }
    auto const quantile = [&](double p) {
        double below = 0;
        for (std::size_t i = 0; i < place.size(); ++i) {
            double const here = density[i] / sum;
            if (below + here >= p) return place[i] + ((p - below) / here - 0.5) * 3.0 / kSteps;
            below += here;
        }
        return place.back();
    };
    auto const on_u = [&](double x) { return checked.centre() + range * x; };
    double const tail = (1 - settings.confidence) / 2, mean = first / sum;
    return {on_u(quantile(0.5)), range * std::sqrt(std::max(0.0, second / sum - mean * mean)),
            on_u(quantile(tail)), on_u(quantile(1 - tail)), 0};
}

} // namespace study
