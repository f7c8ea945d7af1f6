#pragma once
// Gaze with known fixations and saccades. Saccades have the minimum-jerk profile (Flash and Hogan 1985, J. Neurosci.
// 5:1688) and last 21 ms + 2.2 ms per degree (Carpenter 1988, Movements of the Eyes).

#include "study/signals/gaze.h"

#include <algorithm>
#include <random>

namespace study::test {

inline ScreenGeometry const kGazeScreen{1920, 1080, 53.1, 29.87, 57.3, "typed"};

struct SimulatedGazeSettings {
    double rate_hz = 500, jitter = 0; ///< of times, share of a step to either side
    double noise_deg = 0.05;          ///< rms, of directions
    double drift_deg_s = 0.2;
    double length_s = 60;
    double blinks_per_s = 0.1, blink_s = 0.15; ///< in the middle of fixations
    double dropped = 0;                        ///< share of samples that are missing
    unsigned seed = 1;
};

struct SimulatedGaze {
    struct Fixation {
        double start_s, end_s, x_deg, y_deg;
    };
    struct Saccade {
        double start_s, end_s, amplitude_deg, peak_deg_s;
    };
    std::vector<GazeSample> samples;
    std::vector<Fixation> fixations; ///< those with a blink are two
    std::vector<Saccade> saccades;
    int blinks = 0;
};

inline std::pair<double, double> px_of_direction(double x_deg, double y_deg)
{
    return {px_of_place(kGazeScreen, x_deg, false), px_of_place(kGazeScreen, y_deg, true)};
}

inline SimulatedGaze simulated_gaze(SimulatedGazeSettings const& set)
{
    std::mt19937 random(set.seed);
    std::uniform_real_distribution<double> share(0, 1);
    std::normal_distribution<double> normal;
    SimulatedGaze gaze;
    struct Part {
        double start_s, end_s, x0, y0, x1, y1;
        bool is_saccade;
    };
    std::vector<Part> parts;
    std::vector<std::pair<double, double>> blinks;
    double x = 0, y = 0;
    for (double t = 0; t < set.length_s;) {
        double const length_s = 0.18 + 0.15 * -std::log(1 - share(random));
        double const angle = 6.2831853 * share(random), way = set.drift_deg_s * length_s;
        Part const fixation{t, t + length_s, x, y, x + way * std::cos(angle), y + way * std::sin(angle), false};
        double const middle_s = t + 0.5 * length_s;
        if (length_s > set.blink_s + 0.3 && share(random) < set.blinks_per_s / 1.5) {
            blinks.emplace_back(middle_s - 0.5 * set.blink_s, middle_s + 0.5 * set.blink_s);
            gaze.fixations.push_back({t, blinks.back().first, x, y});
            gaze.fixations.push_back({blinks.back().second, t + length_s, x, y});
        } else {
            gaze.fixations.push_back({t, t + length_s, x, y});
        }
        parts.push_back(fixation);
        t += length_s;
        x = fixation.x1;
        y = fixation.y1;
        double to_x = 0, to_y = 0, amplitude = 0;
        do {
            to_x = 20 * share(random) - 10;
            to_y = 12 * share(random) - 6;
            amplitude = deg_between(kGazeScreen, px_of_direction(x, y), px_of_direction(to_x, to_y));
        } while (amplitude < 1);
        double const takes_s = 0.021 + 0.0022 * amplitude;
        parts.push_back({t, t + takes_s, x, y, to_x, to_y, true});
        gaze.saccades.push_back({t, t + takes_s, amplitude, 1.875 * amplitude / takes_s});
        t += takes_s;
        x = to_x;
        y = to_y;
    }
    double const end_s = parts.back().end_s;
    std::size_t p = 0;
    for (int i = 0; i / set.rate_hz < end_s; ++i) {
        double const t = (i + set.jitter * (2 * share(random) - 1)) / set.rate_hz;
        bool const is_dropped = share(random) < set.dropped;
        while (p + 1 < parts.size() && parts[p].end_s <= t) ++p;
        Part const& part = parts[p];
        double u = std::clamp((t - part.start_s) / (part.end_s - part.start_s), 0.0, 1.0);
        if (part.is_saccade) u = u * u * u * (10 + u * (6 * u - 15));
        double const noise = set.noise_deg / std::sqrt(2);
        auto const [x_px, y_px] = px_of_direction(part.x0 + u * (part.x1 - part.x0) + noise * normal(random),
                                                  part.y0 + u * (part.y1 - part.y0) + noise * normal(random));
        bool const is_blink =
            std::any_of(blinks.begin(), blinks.end(), [t](auto const& b) { return t >= b.first && t < b.second; });
        if (!is_dropped) gaze.samples.push_back({t, x_px, y_px, 3, !is_blink});
    }
    gaze.blinks = int(blinks.size());
    return gaze;
}

} // namespace study::test
