#include "study/gaze/gaze_runs.h"

#include <algorithm>
#include <numbers>

namespace study {

GazeSample const& GazeRun::sample(std::size_t i) const { return gaze->samples_[i]; }
double GazeRun::speed(std::size_t i) const { return gaze->speeds_[i]; }
double GazeRun::start_s(std::size_t i) const
{
    return i == first ? sample(i).time_s - 0.5 * gaze->step_s_ : 0.5 * (sample(i - 1).time_s + sample(i).time_s);
}
double GazeRun::end_s(std::size_t i) const
{
    return i == last ? sample(i).time_s + 0.5 * gaze->step_s_ : 0.5 * (sample(i).time_s + sample(i + 1).time_s);
}
double GazeRun::deg_from(std::size_t i, std::pair<double, double> place_px) const
{
    return deg_between_places({sample(i).x_px, sample(i).y_px}, place_px);
}
double GazeRun::deg_between_places(std::pair<double, double> a, std::pair<double, double> b) const
{
    return deg_between(gaze->screen_, a, b);
}

ValidGaze::ValidGaze(std::vector<GazeSample> const& samples, ScreenGeometry const& screen, double step_s,
                     GazeEventSettings const& settings)
    : screen_(screen), step_s_(step_s)
{
    bool is_lost = true; // since the last valid sample
    for (GazeSample const& s : samples) {
        if (!s.is_valid) {
            is_lost = true;
            continue;
        }
        if (samples_.empty()) {
            begins_.push_back(0);
        } else {
            GazeSample const& last = samples_.back();
            double const gap_s = s.time_s - last.time_s;
            if (is_lost || gap_s > 1.5 * step_s) {
                double const moved_deg = deg_between(screen, {last.x_px, last.y_px}, {s.x_px, s.y_px});
                bool const is_short = gap_s <= std::max(1e-3 * settings.window_ms + kGazeTick_s, 2.5 * step_s);
                bool const is_bridged =
                    gap_s <= 1e-3 * settings.bridge_ms + kGazeTick_s && (is_short || moved_deg <= settings.merge_deg);
                bridged += is_bridged;
                if (!is_bridged) {
                    losses.push_back({last.time_s + 0.5 * step_s, s.time_s - 0.5 * step_s});
                    begins_.push_back(samples_.size());
                }
            }
        }
        samples_.push_back(s);
        is_lost = false;
    }
    speeds_.assign(samples_.size(), 0);
    for (GazeRun const& run : runs()) measure_speeds(run, 1e-3 * settings.window_ms);
}

std::vector<GazeRun> ValidGaze::runs() const
{
    std::vector<GazeRun> all;
    for (std::size_t r = 0; r < begins_.size(); ++r)
        all.push_back({this, begins_[r], (r + 1 < begins_.size() ? begins_[r + 1] : samples_.size()) - 1});
    return all;
}

void ValidGaze::measure_speeds(GazeRun const& run, double window_s)
{
    std::vector<std::array<double, 3>> directions;
    for (std::size_t i = run.first; i <= run.last; ++i)
        directions.push_back(direction_of_place(screen_, {samples_[i].x_px, samples_[i].y_px}));
    std::size_t low = run.first, high = run.first;
    for (std::size_t i = run.first; i <= run.last && run.last > run.first; ++i) {
        while (samples_[i].time_s - samples_[low].time_s > 0.5 * window_s + kGazeTick_s) ++low;
        while (high < run.last && samples_[high + 1].time_s - samples_[i].time_s <= 0.5 * window_s + kGazeTick_s)
            ++high;
        std::size_t const from = std::min(low, i > run.first ? i - 1 : i);
        std::size_t const to = std::max(high, i < run.last ? i + 1 : i);
        double mean_s = 0, squares = 0;
        for (std::size_t k = from; k <= to; ++k) mean_s += (samples_[k].time_s - samples_[i].time_s);
        mean_s = samples_[i].time_s + mean_s / double(to - from + 1);
        std::array<double, 3> slope{};
        for (std::size_t k = from; k <= to; ++k) {
            double const t = samples_[k].time_s - mean_s;
            squares += t * t;
            for (int a = 0; a < 3; ++a) slope[std::size_t(a)] += t * directions[k - run.first][std::size_t(a)];
        }
        // The slope is of chords: the angle over the window's span is that of the chord.
        double const span_s = samples_[to].time_s - samples_[from].time_s;
        double const chord = std::hypot(slope[0], slope[1], slope[2]) / squares * span_s;
        speeds_[i] = 2 * std::asin(std::min(1.0, 0.5 * chord)) * 180 / std::numbers::pi / span_s;
    }
}

} // namespace study
