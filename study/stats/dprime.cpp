#include "study/stats/dprime.h"

#include "study/stats/error.h"
#include "study/stats/root.h"
#include "study/stats/special.h"

#include <cmath>
#include <limits>
#include <numbers>

namespace study {
namespace {

constexpr double kLargest = 40; ///< above it, proportions are 1 within rounding
constexpr double kSqrt2 = std::numbers::sqrt2;

void check_rate(double rate, char const* name)
{
    if (!(rate >= 0 && rate <= 1))
        refuse(std::string(name) + " " + std::to_string(rate), "it is a proportion of trials, from 0 to 1",
               "divide a count by its number of trials, which must not be 0");
}

double unbiased_proportion(double hit_rate, double false_alarm_rate)
{
    check_rate(hit_rate, "hit rate");
    check_rate(false_alarm_rate, "false alarm rate");
    if (hit_rate <= false_alarm_rate) return 0.5;
    return normal_cdf((normal_quantile(hit_rate) - normal_quantile(false_alarm_rate)) / 2);
}

} // namespace

YesNo yes_no(double hits, double signals, double false_alarms, double noises, Correction correction)
{
    if (!(signals > 0 && noises > 0))
        refuse("d' without signal trials or without noise trials", "both rates are needed",
               "run both kinds of trial");
    if (!(hits >= 0 && hits <= signals && false_alarms >= 0 && false_alarms <= noises))
        refuse("more hits than signals or more false alarms than noise trials", "they are counts of these trials",
               "count them again");
    double const add = correction == Correction::log_linear ? 0.5 : 0;
    YesNo r{};
    r.hit_rate = (hits + add) / (signals + 2 * add);
    r.false_alarm_rate = (false_alarms + add) / (noises + 2 * add);
    double const zh = normal_quantile(r.hit_rate), zf = normal_quantile(r.false_alarm_rate);
    r.dprime = zh - zf;
    r.criterion = -(zh + zf) / 2;
    r.beta = std::exp((zf * zf - zh * zh) / 2);
    auto const variance = [](double rate, double z, double n) {
        if (std::isinf(z)) return kInfinity;
        return rate * (1 - rate) / (n * normal_pdf(z) * normal_pdf(z));
    };
    r.standard_error = std::sqrt(variance(r.hit_rate, zh, signals) + variance(r.false_alarm_rate, zf, noises));
    return r;
}

double mafc_proportion(double dprime, int m)
{
    if (m < 2)
        refuse(std::to_string(m) + " alternatives", "a choice has two or more", "use yes_no for one interval");
    if (std::isinf(dprime)) return dprime > 0 ? 1 : 0;
    constexpr double kStep = 0.05, kEnd = 9; // the trapezium rule: see normal_range_cdf
    double sum = 0;
    for (double x = -kEnd; x < kEnd + kStep / 2; x += kStep)
        sum += normal_pdf(x) * std::pow(normal_cdf(x + dprime), m - 1);
    return sum * kStep;
}

double mafc_dprime(double p, int m)
{
    check_rate(p, "proportion correct");
    if (m < 2)
        refuse(std::to_string(m) + " alternatives", "a choice has two or more", "use yes_no for one interval");
    if (p == 0 || p == 1) return p == 0 ? -kInfinity : kInfinity;
    if (m == 2) return kSqrt2 * normal_quantile(p);
    return bisect([&](double d) { return mafc_proportion(d, m) - p; }, -kLargest, kLargest);
}

double same_different_dprime(double hit_rate, double false_alarm_rate, Strategy strategy)
{
    double const p = unbiased_proportion(hit_rate, false_alarm_rate);
    if (p <= 0.5) return 0;
    if (strategy == Strategy::independent) return 2 * normal_quantile((1 + std::sqrt(2 * p - 1)) / 2);
    if (hit_rate == 1 || false_alarm_rate == 0) return kInfinity;
    double const k = -kSqrt2 * normal_quantile(false_alarm_rate / 2);
    return bisect(
        [&](double d) { return normal_cdf((d - k) / kSqrt2) + normal_cdf((-d - k) / kSqrt2) - hit_rate; }, 0,
        kLargest);
}

double abx_dprime(double hit_rate, double false_alarm_rate, Strategy strategy)
{
    double const p = unbiased_proportion(hit_rate, false_alarm_rate);
    if (p <= 0.5) return 0;
    if (p == 1) return kInfinity;
    double const s = strategy == Strategy::independent ? 2 : std::sqrt(6.0);
    return bisect(
        [&](double d) {
            return normal_cdf(d / kSqrt2) * normal_cdf(d / s) + normal_cdf(-d / kSqrt2) * normal_cdf(-d / s) - p;
        },
        0, kLargest);
}

double oddity_miss(double dprime)
{
    if (std::isinf(dprime)) return 0;
    return 4 * owens_t(dprime / std::sqrt(6.0), std::sqrt(3.0));
}

double oddity_proportion(double dprime) { return 1 - oddity_miss(dprime); }

double oddity_dprime(double p)
{
    check_rate(p, "proportion correct");
    if (p <= 1.0 / 3) return 0;
    if (p == 1) return kInfinity;
    return bisect([&](double d) { return oddity_proportion(d) - p; }, 0, kLargest);
}

} // namespace study
