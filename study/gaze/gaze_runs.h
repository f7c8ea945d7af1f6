#pragma once
// Valid samples of gaze in runs without losses, and how fast gaze moves in them.

#include "study/gaze/gaze_events.h"

namespace study {

inline constexpr double kGazeTick_s = 1e-9; ///< times that differ by less are equal

class ValidGaze;

/// Valid samples first..last (both included) with no loss between them that is not bridged.
struct GazeRun {
    ValidGaze const* gaze;
    std::size_t first, last;

    GazeSample const& sample(std::size_t i) const;
    double speed(std::size_t i) const; ///< deg/s; 0 in runs of one sample
    /// For which a sample stands: midway to its neighbours in the run; half a step beyond its ends.
    double start_s(std::size_t i) const;
    double end_s(std::size_t i) const;
    double deg_from(std::size_t i, std::pair<double, double> place_px) const;
    double deg_between_places(std::pair<double, double> a, std::pair<double, double> b) const;
};

class ValidGaze {
public:
    /// @param samples  cleaned   @param step_s  median
    ValidGaze(std::vector<GazeSample> const& samples, ScreenGeometry const& screen, double step_s,
              GazeEventSettings const& settings);

    std::vector<GazeRun> runs() const;
    std::vector<GazeLoss> losses;
    int bridged = 0;

private:
    friend struct GazeRun;
    void measure_speeds(GazeRun const& run, double window_s);

    ScreenGeometry screen_;
    double step_s_;
    std::vector<GazeSample> samples_; ///< valid ones
    std::vector<double> speeds_;
    std::vector<std::size_t> begins_; ///< of runs
};

} // namespace study
