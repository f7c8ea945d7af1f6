#pragma once
// Margins of pictures: what a picture shows beyond the edges of its view, so that nothing is missing there when
// the head has turned on before the next picture comes.

#include "gi/image_io/picture.h"
#include "viewer/protocol/frame_command.h"

#include <glm/glm.hpp>

namespace viewer {

/// The camera of a picture with a margin. @param size_px  of the view, without it
gi::Camera with_margin(gi::Camera const& camera, glm::ivec2 size_px, glm::ivec2 margin_px);

/// The margin that shows what the view's camera sees after it has turned to that of `later`: as if all were far
/// away, a multiple of 4 pixels, and at most a twelfth of the view.
glm::ivec2 margin_for(ViewCommand const& view, gi::Camera const& later);

/// The picture without its margin.
gi::Picture without_margin(gi::Picture const& picture, glm::ivec2 margin_px);

} // namespace viewer
