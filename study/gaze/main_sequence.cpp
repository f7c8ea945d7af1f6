#include "study/gaze/main_sequence.h"

namespace study {
namespace {

struct FittedLine {
    double at_zero = NAN, slope = NAN, slope_se = NAN;
};

FittedLine line_through(std::vector<double> const& x, std::vector<double> const& y)
{
    double const n = double(x.size());
    if (x.size() < 3) return {};
    double mean_x = 0, mean_y = 0, xx = 0, xy = 0;
    for (std::size_t i = 0; i < x.size(); ++i) {
        mean_x += x[i] / n;
        mean_y += y[i] / n;
    }
    for (std::size_t i = 0; i < x.size(); ++i) {
        xx += (x[i] - mean_x) * (x[i] - mean_x);
        xy += (x[i] - mean_x) * (y[i] - mean_y);
    }
    if (!(xx > 0)) return {};
    FittedLine line{0, xy / xx, 0};
    line.at_zero = mean_y - line.slope * mean_x;
    double rest = 0;
    for (std::size_t i = 0; i < x.size(); ++i) rest += std::pow(y[i] - line.at_zero - line.slope * x[i], 2);
    line.slope_se = std::sqrt(rest / (n - 2) / xx);
    return line;
}

} // namespace

MainSequence main_sequence(std::vector<Saccade> const& saccades)
{
    std::vector<double> log_deg, log_peak, deg, ms;
    for (Saccade const& s : saccades) {
        if (s.is_cut || s.amplitude_deg < kMainSequenceFrom_deg || !(s.peak_deg_s > 0)) continue;
        log_deg.push_back(std::log(s.amplitude_deg));
        log_peak.push_back(std::log(s.peak_deg_s));
        deg.push_back(s.amplitude_deg);
        ms.push_back(1e3 * (s.end_s - s.start_s));
    }
    FittedLine const peak = line_through(log_deg, log_peak), duration = line_through(deg, ms);
    return {int(deg.size()), peak.slope,        peak.slope_se,   std::exp(peak.at_zero),
            duration.slope,  duration.slope_se, duration.at_zero};
}

} // namespace study
