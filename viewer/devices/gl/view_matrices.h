#pragma once
// Matrices between the world, a camera's picture in pixels from the top left, and OpenGL's clip space. Not for
// orthographic cameras; a lens is a pinhole.

#include "gi/scene/model/camera.h"
#include "gi/scene/model/world.h"

#include <array>

namespace viewer {

/// (right, up, forward) of a point at a depth of 1 from its pixel (x, y, 1).
glm::dmat3 frame_from_pixel(gi::Camera const& camera, glm::ivec2 size_px);
/// Axes right, up, forward in the world.
glm::dmat3 axes_of(gi::Camera const& camera);
/// Pixel times depth, and depth, m, of a point relative to the camera's position.
glm::dmat3 pixel_from_world(gi::Camera const& camera, glm::ivec2 size_px);

std::array<glm::vec3, 8> corners_of(gi::Bounds const& box);

} // namespace viewer
