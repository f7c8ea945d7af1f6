#include "study/gaze/gaze_events.h"

#include "study/gaze/clean_gaze.h"
#include "study/gaze/gaze_runs.h"

#include <algorithm>
#include <numbers>

namespace study {
namespace {

/// Samples first..last of a run, both included.
struct Stretch {
    std::size_t first, last;
    bool is_fast = false;
};

/// Alternately slow and fast stretches. Slow ones between fast ones, shorter than the window, are overshoots of the
/// saccade and belong to it.
std::vector<Stretch> stretches_of(GazeRun const& run, GazeEventSettings const& settings)
{
    std::vector<Stretch> all;
    for (std::size_t i = run.first; i <= run.last; ++i) {
        bool const is_fast = run.speed(i) > settings.velocity_deg_s;
        if (!all.empty() && all.back().is_fast == is_fast)
            all.back().last = i;
        else
            all.push_back({i, i, is_fast});
    }
    std::vector<Stretch> joined;
    for (std::size_t i = 0; i < all.size(); ++i) {
        bool const is_between = !all[i].is_fast && !joined.empty() && i + 1 < all.size();
        if (is_between &&
            run.end_s(all[i].last) - run.start_s(all[i].first) < 1e-3 * settings.window_ms - kGazeTick_s) {
            joined.back().last = all[++i].last;
            continue;
        }
        joined.push_back(all[i]);
    }
    return joined;
}

Fixation fixation_of(GazeRun const& run, Stretch const& part, std::vector<Stretch> const& without)
{
    Fixation f;
    f.start_s = run.start_s(part.first);
    f.end_s = run.end_s(part.last);
    f.is_cut = part.first == run.first || part.last == run.last;
    auto const is_in = [&](std::size_t i) {
        return std::none_of(without.begin(), without.end(),
                            [i](Stretch const& s) { return i >= s.first && i <= s.last; });
    };
    double pupil = 0;
    int pupils = 0;
    for (std::size_t i = part.first; i <= part.last; ++i) {
        if (!is_in(i)) continue;
        GazeSample const& s = run.sample(i);
        ++f.samples;
        f.x_px += s.x_px;
        f.y_px += s.y_px;
        if (std::isfinite(s.pupil_mm)) {
            pupil += s.pupil_mm;
            ++pupils;
        }
    }
    f.x_px /= f.samples;
    f.y_px /= f.samples;
    if (pupils > 0) f.pupil_mm = pupil / pupils;
    for (std::size_t i = part.first; i <= part.last; ++i)
        if (is_in(i)) f.rms_deg += std::pow(run.deg_from(i, {f.x_px, f.y_px}), 2);
    f.rms_deg = std::sqrt(f.rms_deg / f.samples);
    return f;
}

/// Mean place of the samples from i on, forwards or back, within the window and `bounds`.
std::pair<double, double> place_beside(GazeRun const& run, std::size_t i, bool is_forwards, Stretch const& bounds,
                                       double window_s)
{
    double x = 0, y = 0;
    int n = 0;
    for (std::size_t k = i; std::abs(run.sample(k).time_s - run.sample(i).time_s) <= window_s + kGazeTick_s;
         is_forwards ? ++k : --k) {
        x += run.sample(k).x_px;
        y += run.sample(k).y_px;
        ++n;
        if (k == (is_forwards ? bounds.last : bounds.first)) break;
    }
    return {x / n, y / n};
}

/// @param before, after  slow stretches beside it; null = the run begins or ends with it
Saccade saccade_of(GazeRun const& run, Stretch const& fast, Stretch const* before, Stretch const* after,
                   GazeEventSettings const& settings)
{
    double const window_s = 1e-3 * settings.window_ms;
    Saccade s;
    s.start_s = run.start_s(fast.first);
    s.end_s = run.end_s(fast.last);
    s.is_cut = before == nullptr || after == nullptr;
    auto const at = [&](std::size_t i) { return std::pair{run.sample(i).x_px, run.sample(i).y_px}; };
    auto const from = before ? place_beside(run, before->last, false, *before, window_s) : at(fast.first);
    auto const to = after ? place_beside(run, after->first, true, *after, window_s) : at(fast.last);
    s.from_x_px = from.first;
    s.from_y_px = from.second;
    s.to_x_px = to.first;
    s.to_y_px = to.second;
    s.amplitude_deg = run.deg_between_places(from, to);
    for (std::size_t i = fast.first; i <= fast.last; ++i) s.peak_deg_s = std::max(s.peak_deg_s, run.speed(i));
    return s;
}

void find_by_velocity(GazeRun const& run, GazeEventSettings const& settings, GazeEvents& events)
{
    std::vector<Stretch> const parts = stretches_of(run, settings);
    double const window_s = 1e-3 * settings.window_ms;
    struct Merged {
        Stretch whole, last; ///< last: the slow stretch at its end
        std::vector<Stretch> without;
    };
    std::vector<Merged> slow;
    std::vector<std::size_t> fast;
    for (std::size_t p = 0; p < parts.size(); ++p) {
        if (parts[p].is_fast) {
            fast.push_back(p);
            continue;
        }
        if (!slow.empty()) {
            Merged& one = slow.back();
            auto const from = place_beside(run, one.last.last, false, one.last, window_s);
            auto const to = place_beside(run, parts[p].first, true, parts[p], window_s);
            if (run.start_s(parts[p].first) - run.end_s(one.last.last) <= 1e-3 * settings.merge_ms + kGazeTick_s &&
                run.deg_between_places(from, to) <= settings.merge_deg) {
                one.without.push_back(parts[p - 1]);
                one.whole.last = parts[p].last;
                one.last = parts[p];
                std::erase(fast, p - 1);
                ++events.merged;
                continue;
            }
        }
        slow.push_back({parts[p], parts[p], {}});
    }
    for (Merged const& m : slow) {
        if (run.end_s(m.whole.last) - run.start_s(m.whole.first) < 1e-3 * settings.shortest_ms() - kGazeTick_s)
            ++events.short_fixations;
        else
            events.fixations.push_back(fixation_of(run, m.whole, m.without));
    }
    for (std::size_t const p : fast)
        events.saccades.push_back(saccade_of(run, parts[p], p > 0 ? &parts[p - 1] : nullptr,
                                             p + 1 < parts.size() ? &parts[p + 1] : nullptr, settings));
}

/// Extent of places; its width plus height in degrees, each between rays at the middle of the other.
struct Extent {
    double left = INFINITY, right = -INFINITY, top = INFINITY, bottom = -INFINITY;
    void add(GazeSample const& s)
    {
        left = std::min(left, s.x_px);
        right = std::max(right, s.x_px);
        top = std::min(top, s.y_px);
        bottom = std::max(bottom, s.y_px);
    }
    double dispersion_deg(GazeRun const& run) const
    {
        double const x = 0.5 * (left + right), y = 0.5 * (top + bottom);
        return run.deg_between_places({left, y}, {right, y}) + run.deg_between_places({x, top}, {x, bottom});
    }
};

void find_by_dispersion(GazeRun const& run, GazeEventSettings const& settings, GazeEvents& events)
{
    double const shortest_s = 1e-3 * settings.shortest_ms() - kGazeTick_s;
    std::vector<Stretch> found;
    for (std::size_t first = run.first; first <= run.last;) {
        std::size_t last = first;
        Extent extent;
        extent.add(run.sample(first));
        while (last < run.last && run.end_s(last) - run.start_s(first) < shortest_s)
            extent.add(run.sample(++last));
        if (run.end_s(last) - run.start_s(first) < shortest_s) break;
        if (extent.dispersion_deg(run) > settings.dispersion_deg) {
            ++first;
            continue;
        }
        while (last < run.last) {
            Extent wider = extent;
            wider.add(run.sample(last + 1));
            if (wider.dispersion_deg(run) > settings.dispersion_deg) break;
            extent = wider;
            ++last;
        }
        found.push_back({first, last});
        first = last + 1;
    }
    for (Stretch const& f : found) events.fixations.push_back(fixation_of(run, f, {}));
    for (std::size_t f = 1; f < found.size(); ++f) {
        // Fixations may touch, as where a saccade is shorter than a step: it is seen at their ends.
        bool const touch = found[f - 1].last + 1 == found[f].first;
        Stretch const between = touch ? Stretch{found[f - 1].last, found[f].first}
                                      : Stretch{found[f - 1].last + 1, found[f].first - 1};
        Saccade s = saccade_of(run, between, &found[f - 1], &found[f], settings);
        if (touch) {
            s.start_s = s.end_s = run.end_s(found[f - 1].last);
            s.is_cut = true; // its duration is unknown
        }
        if (s.peak_deg_s > settings.velocity_deg_s) events.saccades.push_back(s);
    }
}

} // namespace

GazeEvents find_gaze_events(std::vector<GazeSample> const& samples, ScreenGeometry const& screen,
                            GazeEventSettings const& settings)
{
    GazeEvents events;
    events.step_s = median_step_s(samples);
    if (!(events.step_s > 0)) return events;
    ValidGaze const valid(samples, screen, events.step_s, settings);
    events.bridged = valid.bridged;
    events.losses = valid.losses;
    for (GazeRun const& run : valid.runs()) {
        if (run.first == run.last)
            ++events.alone;
        else if (settings.method == GazeMethod::ivt)
            find_by_velocity(run, settings, events);
        else
            find_by_dispersion(run, settings, events);
    }
    return events;
}

double valid_share(std::vector<GazeSample> const& samples, double step_s, double start_s, double end_s)
{
    if (!(end_s > start_s) || !(step_s > 0)) return 0;
    auto const earlier = [](GazeSample const& s, double t) { return s.time_s < t; };
    auto const from = std::lower_bound(samples.begin(), samples.end(), start_s - step_s, earlier);
    double covered_s = 0;
    for (auto it = from; it != samples.end() && it->time_s < end_s + step_s; ++it) {
        if (!it->is_valid) continue;
        double const most_s = 0.75 * step_s;
        double const before = it == samples.begin() ? most_s : 0.5 * (it->time_s - std::prev(it)->time_s);
        double const after = std::next(it) == samples.end() ? most_s : 0.5 * (std::next(it)->time_s - it->time_s);
        double const low = std::max(start_s, it->time_s - std::min(before, most_s));
        double const high = std::min(end_s, it->time_s + std::min(after, most_s));
        covered_s += std::max(0.0, high - low);
    }
    return std::min(1.0, covered_s / (end_s - start_s));
}

} // namespace study
