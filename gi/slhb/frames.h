#pragma once
// Frames by the method slhb. Static hit buffers are built once; what moves is appended to them, or drawn with the
// rest where the schedule builds fresh axes for every frame anyway.

#include "gi/transport/frame_renderer.h"

namespace gi {

/// See StartFrames. Throws InputError on settings that cannot work with what moves.
std::unique_ptr<FrameRenderer> start_slhb_frames(MovingWorld const& world, Camera const& camera,
                                                 RenderSettings const& settings, Report& report);

} // namespace gi
