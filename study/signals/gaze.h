#pragma once
// Gaze: samples of where somebody looks, and what depends on it: fixations before an onset, gaze that leaves.
// Places are in pixels from the centre of the screen, x to the right, y down.

#include "study/display/geometry.h"

#include <cmath>
#include <optional>
#include <string>
#include <vector>

namespace study {

struct GazeSample {
    double time_s = 0;         ///< steady clock
    double x_px = 0, y_px = 0; ///< meaningless if not valid
    double pupil_mm = NAN;     ///< diameter; NaN = not measured
    bool is_valid = false;     ///< false: a blink, or the eye was not found
};

/// A fixation that comes before the first stimulus.
struct GazeFixation {
    double within_deg = 2, for_ms = 300;
    double timeout_ms = 10000; ///< without a fixation the trial is invalid
};
/// Gaze that stays.
struct GazeHold {
    double within_deg = 3, grace_ms = 100; ///< shorter absences and blinks do not count as leaving
};
enum class GazeFollow { window, mask };
/// A circle that follows gaze.
struct GazeCircleRule {
    GazeFollow kind = GazeFollow::window; ///< window: only around the gaze; mask: hidden around it
    double radius_deg = 2.5, edge_deg = 0.5;
};
/// What a block demands of gaze; degrees of visual angle.
struct GazeRules {
    std::optional<GazeFixation> start;
    std::optional<GazeHold> hold;
    std::optional<GazeCircleRule> moving;
    bool any() const { return start || hold || moving; }
};

/// Tells when gaze has been near a place for long enough, and for how long it has been away.
class GazeWatch {
public:
    /// @param place_px from the centre   @param within_deg of it
    GazeWatch(ScreenGeometry const& screen, std::pair<double, double> place_px, double within_deg)
        : screen_(screen), place_px_(place_px), within_deg_(within_deg)
    {
    }
    void take(GazeSample const& sample);
    /// How long all valid samples have been inside, ms; invalid ones end it.
    double inside_ms() const { return since_inside_s_ ? 1e3 * (last_s_ - *since_inside_s_) : 0; }
    /// How long no valid sample has been inside, ms.
    double away_ms() const { return since_away_s_ ? 1e3 * (last_s_ - *since_away_s_) : 0; }
    int samples() const { return samples_; }
    int valid() const { return valid_; }
    int inside() const { return inside_; }

private:
    ScreenGeometry screen_;
    std::pair<double, double> place_px_;
    double within_deg_;
    std::optional<double> since_inside_s_, since_away_s_;
    double last_s_ = 0;
    int samples_ = 0, valid_ = 0, inside_ = 0;
};

/// Samples of one recording, counted.
struct GazeSummary {
    int samples = 0, valid = 0;
    int dropped = 0;    ///< missing between samples that are too far apart
    double rate_hz = 0; ///< by the median step
};
/// @param samples  in the order of their times
GazeSummary summarise(std::vector<GazeSample> const& samples);

/// Reads a table of gaze: t_s, x_px, y_px (from the top left corner of the screen or window), and optionally
/// pupil_mm and valid (0, 1); empty cells and nan are invalid. @throws gi::InputError with file:line:column
std::vector<GazeSample> read_gaze_csv(std::string const& text, std::string const& file);

} // namespace study
