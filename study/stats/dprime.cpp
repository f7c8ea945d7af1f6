#include "study/stats/dprime.h"

#include "study/numeric/error.h"
#include "study/numeric/special.h"

#include <cmath>
#include <numbers>

namespace study {

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

double two_interval_dprime(double p)
{
    if (!(p >= 0 && p <= 1))
        refuse("proportion correct " + std::to_string(p), "it is a proportion of trials, from 0 to 1",
               "divide a count by its number of trials, which must not be 0");
    return std::numbers::sqrt2 * normal_quantile(p);
}

double oddity_miss(double dprime)
{
    if (std::isinf(dprime)) return 0;
    return 4 * owens_t(dprime / std::sqrt(6.0), std::sqrt(3.0));
}

double oddity_proportion(double dprime) { return 1 - oddity_miss(dprime); }

} // namespace study
