#include "study/stats/psychometric_posterior.h"

#include "study/adaptive/sigmoid.h"
#include "study/numeric/descent.h"
#include "study/numeric/error.h"
#include "study/numeric/special.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace study {
namespace {

using Eigen::Index, Eigen::MatrixXd, Eigen::VectorXd;

constexpr int kFirstPoints = 600, kPoints = 2000;
constexpr double kTailDegrees = 5;

struct CountedLevel {
    double u, correct, trials; ///< u in ranges from the centre
};

/// log of the density of x if inverse_logit(x) follows Beta(a, b), up to a constant.
double log_beta_prior(double x, double a, double b)
{
    return -a * std::log1p(std::exp(-x)) - b * std::log1p(std::exp(x));
}

/// Parameters x: threshold in ranges from the centre, log of the scale in ranges, logits of lapse, guess, eta.
struct PosteriorModel {
    PosteriorSettings s;
    std::vector<CountedLevel> levels;
    double centre = 0, range = 1;

    Index count() const { return 3 + (s.fits_guess ? 1 : 0) + (s.is_overdispersed ? 1 : 0); }

    PossibleFunction at(VectorXd const& x) const
    {
        PossibleFunction f;
        f.parameters.threshold = centre + range * x[0];
        f.parameters.scale = range * std::exp(x[1]);
        f.parameters.lapse = s.lapse.value_or(inverse_logit(x[2]));
        f.parameters.guess = s.fits_guess ? inverse_logit(x[3]) : s.guess;
        if (s.is_overdispersed) f.eta = inverse_logit(x[count() - 1]);
        return f;
    }

    double log_density(VectorXd const& x) const
    {
        double const outside = std::max(0.0, std::abs(x[0]) - 0.5) / 0.25, spread = x[1] - std::log(0.125);
        double sum = -0.5 * outside * outside - 0.5 * spread * spread + log_beta_prior(x[2], 1, 10);
        double const lapse = s.lapse.value_or(inverse_logit(x[2])); // if it is fixed, x[2] has only its prior
        double guess = s.guess;
        if (s.fits_guess) {
            guess = inverse_logit(x[3]);
            sum += log_beta_prior(x[3], 1 + s.false_alarms, 1 + s.noises - s.false_alarms);
        }
        double const span = 1 - guess - lapse, scale = std::exp(x[1]);
        if (!(span > 0)) return -kInfinity;
        double nu = kInfinity;
        if (s.is_overdispersed) {
            sum += log_beta_prior(x[count() - 1], 1, 10);
            double const eta = std::max(1e-4, inverse_logit(x[count() - 1]));
            nu = 1 / (eta * eta) - 1;
        }
        for (CountedLevel const& l : levels) {
            SigmoidValue const f = sigmoid(s.shape.sigmoid, (l.u - x[0]) / scale);
            double const p = std::max(1e-12, guess + span * f.below), q = std::max(1e-12, lapse + span * f.above);
            sum += l.trials < 2 || std::isinf(nu) ? l.correct * std::log(p) + (l.trials - l.correct) * std::log(q)
                                                  : log_beta_binomial(l, nu * p, nu * q, nu);
        }
        return sum;
    }

    /// Gamma functions of whole numbers of trials as products.
    static double log_beta_binomial(CountedLevel const& l, double a, double b, double nu)
    {
        double product = 1, sum = 0;
        auto const right = int(l.correct), all = int(l.trials);
        for (int i = 0; i < all; ++i) {
            product *= (i < right ? a + i : b + (i - right)) / (nu + i);
            if (product < 1e-200) {
                sum += std::log(product);
                product = 1;
            }
        }
        return sum + std::log(product);
    }
};

PosteriorModel make_posterior_model(std::span<LevelCount const> counts, PosteriorSettings const& s)
{
    PosteriorModel m;
    m.s = s;
    double const a = transformed(s.shape, s.low), b = transformed(s.shape, s.high);
    m.range = std::abs(b - a);
    m.centre = (a + b) / 2;
    if (s.low == s.high)
        refuse(fmt::format("trials at one level, {:.9g}", s.low), "a threshold is searched between two levels",
               "show more levels, or report the proportion");
    if (!(m.range > 0 && std::isfinite(m.range)))
        refuse(fmt::format("a psychometric function for levels from {:.9g} to {:.9g}", s.low, s.high),
               "its threshold is expected between two levels", "give two different ones, above 0 on a log scale");
    if (!(s.guess >= 0 && s.guess < 1 && s.false_alarms >= 0 && s.false_alarms <= s.noises))
        refuse("a guess rate of " + std::to_string(s.guess) + ", or more false alarms than trials",
               "both are proportions", "give rates from 0 to below 1");
    if (s.guess + s.lapse.value_or(0) >= 1)
        refuse("a guess rate of " + std::to_string(s.guess) + " and a lapse rate of " + std::to_string(*s.lapse),
               "together they leave no room for a curve", "use rates whose sum is below 1");
    std::vector<LevelCount> sorted(counts.begin(), counts.end());
    std::sort(sorted.begin(), sorted.end(), [](auto const& x, auto const& y) { return x.level < y.level; });
    bool is_whole = true, is_repeated = false;
    for (LevelCount const& c : sorted) {
        double const u = transformed(s.shape, c.level);
        if (!(c.correct >= 0 && c.correct <= c.trials && std::isfinite(c.trials)) || !std::isfinite(u))
            refuse(std::to_string(c.correct) + " of " + std::to_string(c.trials) + " trials at level " +
                       std::to_string(c.level),
                   "counts are numbers, with no more correct responses than trials, at levels on the axis",
                   "check the table");
        if (c.trials == 0) continue;
        double const place = (u - m.centre) / m.range;
        if (!m.levels.empty() && m.levels.back().u == place) {
            m.levels.back().correct += c.correct;
            m.levels.back().trials += c.trials;
        } else
            m.levels.push_back({place, c.correct, c.trials});
    }
    for (CountedLevel const& l : m.levels) {
        is_whole = is_whole && l.correct == std::floor(l.correct) && l.trials == std::floor(l.trials);
        is_repeated = is_repeated || l.trials >= 2;
    }
    if (m.levels.empty()) refuse("a psychometric function without trials", "nothing was answered", "leave it out");
    m.s.is_overdispersed = s.is_overdispersed && is_whole && is_repeated;
    return m;
}

/// Mode, starting from the best of some points.
VectorXd mode_of(PosteriorModel const& m)
{
    VectorXd best = VectorXd::Zero(m.count());
    double most = -kInfinity;
    for (double const threshold : {-0.4, -0.2, 0.0, 0.2, 0.4})
        for (double const scale : {0.04, 0.12, 0.35}) {
            VectorXd x(m.count());
            x[0] = threshold;
            x[1] = std::log(scale);
            x[2] = -3.5;
            if (m.s.fits_guess)
                x[3] = std::log((m.s.false_alarms + 0.5) / (m.s.noises - m.s.false_alarms + 0.5 + 1));
            if (m.s.is_overdispersed) x[m.count() - 1] = -2.5;
            if (double const v = m.log_density(x); v > most) {
                most = v;
                best = x;
            }
        }
    auto const loss = [&](std::span<double const> x) {
        double const v = -m.log_density(VectorXd::Map(x.data(), Index(x.size())));
        return std::isfinite(v) ? v : 1e300;
    };
    auto const slope = [&](std::span<double const> x, std::span<double> g) {
        std::vector<double> at(x.begin(), x.end());
        for (std::size_t i = 0; i < at.size(); ++i) {
            double const here = at[i];
            at[i] = here + 1e-4;
            double const above = loss(at);
            at[i] = here - 1e-4;
            g[i] = (above - loss(at)) / 2e-4;
            at[i] = here;
        }
    };
    auto const found = minimise(loss, slope, {best.begin(), best.end()}, 40, 1e-5, 0.1).at;
    return VectorXd::Map(found.data(), Index(found.size()));
}

/// Square root of the covariance by the curvature at the mode; directions that the data
/// leave open get a deviation of up to 2.
MatrixXd spread_at(PosteriorModel const& m, VectorXd const& mode)
{
    Index const n = mode.size();
    double const h = 0.02, here = m.log_density(mode);
    MatrixXd curvature(n, n);
    auto const shifted = [&](Index i, double a, Index k, double b) {
        VectorXd x = mode;
        x[i] += a;
        x[k] += b;
        return m.log_density(x);
    };
    for (Index i = 0; i < n; ++i) {
        curvature(i, i) = -(shifted(i, h, i, 0) + shifted(i, -h, i, 0) - 2 * here) / (h * h);
        for (Index k = 0; k < i; ++k)
            curvature(i, k) = curvature(k, i) =
                -(shifted(i, h, k, h) + shifted(i, -h, k, -h) - shifted(i, h, k, -h) - shifted(i, -h, k, h)) /
                (4 * h * h);
    }
    Eigen::SelfAdjointEigenSolver<MatrixXd> const solver(curvature);
    VectorXd const deviation =
        solver.eigenvalues().unaryExpr([](double v) { return 1 / std::sqrt(std::max(v, 0.25)); });
    return solver.eigenvectors() * deviation.asDiagonal();
}

/// Points that follow Student's distribution with kTailDegrees in each number
/// of dimensions, the same for all fits.
MatrixXd const& student_points(Index dimensions)
{
    static std::array<MatrixXd, 6> const all = [] {
        constexpr int kBases[] = {2, 3, 5, 7, 11, 13};
        std::array<MatrixXd, 6> sets;
        for (Index d = 1; d < 6; ++d) {
            MatrixXd points(d, kPoints);
            for (int i = 0; i < kPoints; ++i) {
                auto const halton = [&](int base) {
                    double value = 0, digit = 1;
                    for (int k = i + 37; k > 0; k /= base) value += (digit /= base) * (k % base);
                    return value;
                };
                double const chi = chi_square_quantile(halton(kBases[d]), kTailDegrees);
                for (Index k = 0; k < d; ++k)
                    points(k, i) = normal_quantile(halton(kBases[k])) * std::sqrt(kTailDegrees / chi);
            }
            sets[std::size_t(d)] = points;
        }
        return sets;
    }();
    return all[std::size_t(dimensions)];
}

struct WeightedPoints {
    MatrixXd x;
    VectorXd weight; ///< sums to 1
    double effective = 0;
};

WeightedPoints weighted_points(PosteriorModel const& m, VectorXd const& centre, MatrixXd const& spread, int count)
{
    Index const n = centre.size();
    MatrixXd const& standard = student_points(n);
    WeightedPoints w{MatrixXd(n, count), VectorXd(count), 0};
    for (int i = 0; i < count; ++i) {
        w.x.col(i) = centre + spread * standard.col(i);
        double const q =
            -0.5 * (kTailDegrees + double(n)) * std::log1p(standard.col(i).squaredNorm() / kTailDegrees);
        w.weight[i] = m.log_density(w.x.col(i)) - q;
    }
    double const most = w.weight.maxCoeff();
    w.weight = w.weight.unaryExpr([&](double v) { return std::isfinite(v) ? std::exp(v - most) : 0; });
    w.weight /= w.weight.sum();
    w.effective = 1 / w.weight.squaredNorm();
    return w;
}

} // namespace

PsychometricPosterior psychometric_posterior(std::span<LevelCount const> counts, PosteriorSettings const& settings)
{
    PosteriorModel const m = make_posterior_model(counts, settings);
    VectorXd const mode = mode_of(m);
    WeightedPoints w = weighted_points(m, mode, spread_at(m, mode), kFirstPoints);
    VectorXd const centre = w.x * w.weight;
    MatrixXd const away = w.x.colwise() - centre;
    MatrixXd covariance = away * w.weight.asDiagonal() * away.transpose();
    covariance.diagonal().array() += 1e-8;
    Eigen::LLT<MatrixXd> const root(covariance);
    if (root.info() == Eigen::Success) w = weighted_points(m, centre, root.matrixL(), kPoints);

    PsychometricPosterior p;
    p.shape = settings.shape;
    p.effective = w.effective;
    p.mean = {0, 0, 0, 0};
    for (Index i = 0; i < w.x.cols(); ++i) {
        if (!(w.weight[i] > 0)) continue;
        PossibleFunction f = m.at(w.x.col(i));
        f.weight = w.weight[i];
        p.mean.threshold += f.weight * f.parameters.threshold;
        p.mean.scale += f.weight * std::log(f.parameters.scale);
        p.mean.guess += f.weight * f.parameters.guess;
        p.mean.lapse += f.weight * f.parameters.lapse;
        p.eta += f.weight * f.eta;
        p.functions.push_back(f);
    }
    if (p.functions.empty()) // as with guess rates near 1
        refuse("a guess rate of " + std::to_string(settings.guess), "no psychometric function fits these answers",
               "leave the observer out");
    p.mean.scale = std::exp(p.mean.scale);
    return p;
}

PosteriorLevel posterior_level(PsychometricPosterior const& posterior, double proportion, double confidence)
{
    std::vector<std::pair<double, double>> values; // level, weight
    PosteriorLevel l;
    double sum = 0, squares = 0;
    for (PossibleFunction const& f : posterior.functions) {
        PsychometricParameters const& p = f.parameters;
        double const share = (proportion - p.guess) / (1 - p.guess - p.lapse);
        if (!(share > 0 && share < 1)) {
            l.never += f.weight;
            values.emplace_back(share > 0 ? kInfinity : -kInfinity, f.weight);
            continue;
        }
        double const u = p.threshold + p.scale * sigmoid_quantile(posterior.shape.sigmoid, share);
        values.emplace_back(u, f.weight);
        sum += f.weight * u;
        squares += f.weight * u * u;
    }
    double const reached = 1 - l.never;
    if (!(reached > 0.5)) {
        l.centre = l.deviation = l.low = l.high = std::nan("");
        return l;
    }
    double const mean = sum / reached;
    l.deviation = std::sqrt(std::max(0.0, squares / reached - mean * mean));
    std::sort(values.begin(), values.end());
    auto const quantile = [&](double p) {
        double below = 0;
        for (auto const& [value, weight] : values)
            if ((below += weight) >= p) return value;
        return values.back().first;
    };
    l.centre = quantile(0.5);
    l.low = quantile((1 - confidence) / 2);
    l.high = quantile((1 + confidence) / 2);
    return l;
}

} // namespace study
