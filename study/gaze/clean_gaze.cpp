#include "study/gaze/clean_gaze.h"

#include "gi/core/quantile.h"

#include <algorithm>

namespace study {

GazeCounts& GazeCounts::operator+=(GazeCounts const& other)
{
    for (NamedCount const& c : kGazeCounts) this->*c.count += other.*c.count;
    return *this;
}

std::vector<GazeSample> clean_gaze(std::vector<GazeSample> const& samples, ScreenGeometry const& screen,
                                   GazeCounts& counts)
{
    std::vector<GazeSample> clean;
    clean.reserve(samples.size());
    for (GazeSample s : samples) {
        if (!std::isfinite(s.time_s)) {
            ++counts.no_time;
            continue;
        }
        if (!clean.empty() && s.time_s <= clean.back().time_s) {
            ++(s.time_s == clean.back().time_s ? counts.repeated : counts.backwards);
            continue;
        }
        if (s.is_valid && !(std::isfinite(s.x_px) && std::isfinite(s.y_px))) {
            s.is_valid = false;
            ++counts.not_finite;
        }
        if (s.is_valid &&
            (std::abs(s.x_px) > 1.5 * screen.width_px || std::abs(s.y_px) > 1.5 * screen.height_px)) {
            s.is_valid = false;
            ++counts.far_off;
        }
        clean.push_back(s);
    }
    return clean;
}

std::vector<GazeSample> mean_of_eyes(std::vector<GazeSample> const& left, std::vector<GazeSample> const& right,
                                     GazeCounts& counts)
{
    double const tolerance_s = 0.5 * std::min(median_step_s(left), median_step_s(right));
    std::vector<GazeSample> both;
    both.reserve(std::max(left.size(), right.size()));
    std::size_t l = 0, r = 0;
    while (l < left.size() || r < right.size()) {
        bool const has_both = l < left.size() && r < right.size();
        double const apart_s = has_both ? left[l].time_s - right[r].time_s : 0;
        if (!has_both || std::abs(apart_s) > tolerance_s) {
            bool const is_left = has_both ? apart_s < 0 : l < left.size();
            GazeSample alone = is_left ? left[l++] : right[r++];
            alone.is_valid = false;
            ++counts.unpaired;
            both.push_back(alone);
            continue;
        }
        GazeSample const &a = left[l++], &b = right[r++];
        counts.one_eyed += a.is_valid != b.is_valid;
        GazeSample mean{0.5 * (a.time_s + b.time_s), 0.5 * (a.x_px + b.x_px), 0.5 * (a.y_px + b.y_px),
                        0.5 * (a.pupil_mm + b.pupil_mm), a.is_valid && b.is_valid};
        both.push_back(mean);
    }
    return both;
}

double median_step_s(std::vector<GazeSample> const& samples)
{
    if (samples.size() < 2) return NAN;
    std::vector<double> steps;
    steps.reserve(samples.size() - 1);
    for (std::size_t i = 1; i < samples.size(); ++i) steps.push_back(samples[i].time_s - samples[i - 1].time_s);
    return gi::median(std::move(steps));
}

} // namespace study
