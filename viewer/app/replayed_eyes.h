#pragma once
// Which pictures of a recorded walk a replay writes, and of what size: those that the window showed, with its stereo
// mode, or those of one eye or of both.

#include "viewer/displays/stereo_mode.h"
#include "viewer/protocol/frame_command.h"

#include <glm/vec2.hpp>
#include <string_view>

namespace viewer {

enum class ReplayedEyes {
    window, ///< as the window showed them; of walls and headsets the first view
    left,   ///< the left eye alone
    right,  ///< the right eye alone
    both    ///< side by side, as they were rendered
};
/// Throws InputError if it is none of window, left, right, both.
ReplayedEyes parse_replayed_eyes(std::string const& name);

/// The views of a frame's first window or wall.
struct RecordedViews {
    int left = -1, right = -1; ///< -1 = none; a frame with one view has it as `left`
    glm::ivec2 eye_px{0};      ///< of each
    double pixel_aspect =
        1;                 ///< width over height of what a pixel shows: 2 where the window is shared side by side
    bool is_fixed = false; ///< has edges of its own, so that pictures of another aspect are stretched
    bool is_wall = false;  ///< of a display file, whose stereo modes recordings do not have
};
RecordedViews recorded_views(FrameCommand const& command);

/// A picture put together from those of the eyes, as compose.h does.
struct Arrangement {
    StereoMode mode = StereoMode::off; ///< in a window of this size; off = `left` alone
    int left = -1, right = -1;
    glm::ivec2 size_px{0};
};
/// The picture that is written of a frame. @param mode  of the window
Arrangement arrange(RecordedViews const& views, ReplayedEyes eyes, StereoMode mode);

/// True if a size that people give has the aspect of what an eye sees, where eyes that shared a window are written apart
/// from it: then their pictures have square pixels. Else they keep the aspect that they were rendered with.
/// @param whole  the arrangement of the largest views
bool shows_square_pixels(RecordedViews const& views, ReplayedEyes eyes, Arrangement const& whole,
                         glm::ivec2 size_px);

/// The largest size within `room_px` of this aspect, width over height; all of it where that differs by rounding alone.
glm::ivec2 fitted(double aspect, glm::ivec2 room_px);

} // namespace viewer
