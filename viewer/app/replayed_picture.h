#pragma once
// The pictures of a replay: those of the eyes put together, and brought to the size of a file. Two forms: display-encoded
// bytes (R, G, B, rows from the top) for PNG and video, and linear layers for EXR.

#include "gi/filter/tone_map.h"
#include "viewer/app/replayed_eyes.h"
#include "viewer/engine/render_session.h"

namespace viewer {

/// All layers, in this size: colour bilinear, others by the nearest pixel.
gi::Picture resized(gi::Picture const& picture, glm::ivec2 size_px);

/// What the window showed of a view's pictures, encoded: compared with those of the second method as `view` says.
/// @param time_s  of the display, for flicker
std::vector<unsigned char> shown_bytes(ViewPicture const& view, glm::ivec2 size_px, Settings const& settings,
                                       double time_s);
/// True if flicker shows the second method at this time.
bool flickers_to_second(double time_s);

/// Puts linear pictures of eye_size() together, all layers of the first. Not for anaglyphs, which mix encoded colours.
gi::Picture composed(Arrangement const& a, gi::Picture const& left, gi::Picture const& right);

/// In the middle of a black picture of size `to`, as large as its aspect allows.
std::vector<unsigned char> on_canvas(std::vector<unsigned char> bytes, glm::ivec2 from, glm::ivec2 to);
gi::Picture on_canvas(gi::Picture picture, glm::ivec2 to);

} // namespace viewer
