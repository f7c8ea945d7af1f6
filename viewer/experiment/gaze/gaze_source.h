#pragma once
// Where gaze comes from: a recorded table, a Lab Streaming Layer stream, a headset. Samples are in pixels from the
// centre of the participant's window, x to the right, y down, with times of the steady clock.

#include "gi/core/report.h"
#include "study/signals/gaze.h"

#include <glm/vec2.hpp>
#include <memory>

namespace viewer {

/// The window on its monitor, to convert from one to the other.
struct GazePlace {
    glm::ivec2 window_px{}, window_corner_px{};   ///< size; top left corner on the desktop
    glm::ivec2 monitor_px{}, monitor_corner_px{}; ///< of the monitor under it; size 0 = unknown
};

class GazeSource {
public:
    virtual ~GazeSource() = default;
    /// The samples that have come since the last call, in order. Never blocks.
    virtual std::vector<study::GazeSample> take(GazePlace const& place, double now_s) = 0;
    /// Facts for the records: gaze_source, gaze_rate_hz, ...
    virtual std::vector<std::pair<std::string, std::string>> about() const = 0;
};

/// Not "openxr", which is the screen's (screen_gaze.h).
/// @param what  "lsl", "lsl:NAME", or the file of a table (study::read_gaze_csv: px from the window's
///     top left corner), which is replayed from the start of the session at its own pace, again and again
/// Throws InputError: no such stream within 5 s, liblsl is missing, channels without known names, a bad file.
std::unique_ptr<GazeSource> open_gaze(std::string const& what, double now_s);

} // namespace viewer
