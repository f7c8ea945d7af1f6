#include "study/stats/detection_model.h"

#include "study/numeric/root.h"
#include "study/numeric/special.h"
#include "study/stats/dprime.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace study {
namespace {

constexpr double kRoot2 = std::numbers::sqrt2;
constexpr double kFarthestStart = 8;

/// Phi of z, a function of d' and c with these derivatives.
DetectionRate of_score(double z, double by_dprime, double by_criterion)
{
    double const density = normal_pdf(z);
    return {normal_cdf(z), normal_cdf(-z), density * by_dprime, density * by_criterion};
}

/// z of a probability given with its complement.
double score(double p, double complement) { return p < 0.5 ? normal_quantile(p) : -normal_quantile(complement); }

DetectionRate odd_one_out(double d)
{
    double const size = std::abs(d), right = oddity_proportion(size), wrong = oddity_miss(size);
    double const rise =
        std::sqrt(2.0 / 3) * normal_pdf(size / std::sqrt(6.0)) * (2 * normal_cdf(size / kRoot2) - 1);
    if (d >= 0) return {right, wrong, rise, 0};
    double const z = score(right, wrong), chance = normal_quantile(1.0 / 3);
    return of_score(2 * chance - z, rise / normal_pdf(z), 0);
}

/// z of the proportion correct in ABX, and its derivative.
std::pair<double, double> abx_score(double d)
{
    double const size = std::abs(d), a = size / kRoot2, b = size / std::sqrt(6.0);
    double const wrong = normal_cdf(a) * normal_cdf(-b) + normal_cdf(-a) * normal_cdf(b);
    double const rise = normal_pdf(a) * (2 * normal_cdf(b) - 1) / kRoot2 +
                        normal_pdf(b) * (2 * normal_cdf(a) - 1) / std::sqrt(6.0);
    double const z = -normal_quantile(wrong);
    return {d < 0 ? -z : z, rise / normal_pdf(z)};
}

DetectionRates same_different(double d, double c)
{
    // F = 2 Phi(-k / sqrt 2); for a small 1 - F its first term.
    double const size = std::abs(d), same = normal_cdf(c);
    double const k =
        same < 1e-6 ? std::sqrt(std::numbers::pi) * same : -kRoot2 * normal_quantile(normal_cdf(-c) / 2);
    double const near = (size - k) / kRoot2, far = (-size - k) / kRoot2;
    DetectionRate const false_alarm = of_score(-c, 0, -1);
    DetectionRate hit;
    hit.yes = normal_cdf(near) + normal_cdf(far);
    hit.no =
        k < 1e-5 ? kRoot2 * k * normal_pdf(size / kRoot2) : std::max(0.0, normal_cdf(-near) - normal_cdf(far));
    hit.by_dprime = (normal_pdf(near) - normal_pdf(far)) / kRoot2;
    // dF/dk = -sqrt 2 phi(k / sqrt 2) and dF/dc = -phi(c).
    double const k_by_c = normal_pdf(c) / (kRoot2 * normal_pdf(k / kRoot2));
    hit.by_criterion = -(normal_pdf(near) + normal_pdf(far)) / kRoot2 * k_by_c;
    if (d >= 0) return {hit, false_alarm};
    double const z = score(hit.yes, hit.no), slope = normal_pdf(z);
    // z = 2 z(F) - z(H at |d'|)
    return {of_score(-2 * c - z, hit.by_dprime / slope, -2 - hit.by_criterion / slope), false_alarm};
}

/// Beyond these rates are 0 or 1 within rounding, and the derivatives of their z lose all digits.
constexpr double kFarthestDPrime = 25, kFarthestCriterion = 15;

DetectionRates rates_within(DetectionTask task, double d, double c)
{
    switch (task) {
    case DetectionTask::yes_no:
        return {of_score(d / 2 - c, 0.5, -1), of_score(-d / 2 - c, -0.5, -1)};
    case DetectionTask::two_interval:
        return {of_score(d / kRoot2 - c, 1 / kRoot2, -1), of_score(-d / kRoot2 - c, -1 / kRoot2, -1)};
    case DetectionTask::abx: {
        auto const [z, rise] = abx_score(d);
        return {of_score(z - c, rise, -1), of_score(-z - c, -rise, -1)};
    }
    case DetectionTask::same_different:
        return same_different(d, c);
    case DetectionTask::oddity:
        break;
    }
    return {odd_one_out(d), {}};
}

} // namespace

DetectionRates detection_rates(DetectionTask task, double d, double c)
{
    double const near_d = std::clamp(d, -kFarthestDPrime, kFarthestDPrime);
    double const near_c = std::clamp(c, -kFarthestCriterion, kFarthestCriterion);
    DetectionRates r = rates_within(task, near_d, near_c);
    if (near_d != d) r.hit.by_dprime = r.false_alarm.by_dprime = 0;
    if (near_c != c) r.hit.by_criterion = r.false_alarm.by_criterion = 0;
    return r;
}

DetectionLikelihood detection_likelihood(DetectionTask task, DetectionCounts const& counts, double d, double c)
{
    DetectionLikelihood l;
    DetectionRates const rates = detection_rates(task, d, c);
    auto const add = [&](DetectionRate const& rate, double yes, double trials) {
        if (!(trials > 0)) return;
        double const no = trials - yes, p = std::max(rate.yes, 1e-300), q = std::max(rate.no, 1e-300);
        l.value += (yes > 0 ? yes * std::log(p) : 0) + (no > 0 ? no * std::log(q) : 0);
        double const pull = yes / p - no / q, weight = trials / (p * q);
        l.by_dprime += pull * rate.by_dprime;
        l.by_criterion += pull * rate.by_criterion;
        l.information[0] += weight * rate.by_dprime * rate.by_dprime;
        l.information[1] += weight * rate.by_dprime * rate.by_criterion;
        l.information[2] += weight * rate.by_criterion * rate.by_criterion;
    };
    add(rates.hit, counts.hits, counts.signals);
    if (has_criterion(task)) add(rates.false_alarm, counts.false_alarms, counts.noises);
    return l;
}

DetectionPoint detection_point(DetectionTask task, DetectionCounts const& counts)
{
    double const zh = normal_quantile((counts.hits + 0.5) / (counts.signals + 1));
    double const zf = normal_quantile((counts.false_alarms + 0.5) / (counts.noises + 1));
    DetectionPoint p;
    // With a criterion of its own at each d', the wanted difference of z (or z itself) rises with d'.
    bool const is_symmetric = task != DetectionTask::same_different && has_criterion(task);
    if (has_criterion(task)) p.criterion = is_symmetric ? -(zh + zf) / 2 : -zf;
    double const wanted = is_symmetric ? (zh - zf) / 2 : zh;
    auto const reached = [&](double d) {
        DetectionRate const hit = detection_rates(task, d, is_symmetric ? 0 : p.criterion).hit;
        return score(hit.yes, hit.no) - wanted;
    };
    p.dprime = bisect(reached, -kFarthestStart, kFarthestStart);
    return p;
}

} // namespace study
