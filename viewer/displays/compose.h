#pragma once
// Composes the pictures of two eyes into one, on bytes: for screenshots, and as the reference for the GPU version.
//
// Interlaced modes alternate by rows and columns of the SCREEN, because the optical filter does not move with the
// window: the parity is that of the window's position plus the pixel's.

#include "viewer/displays/stereo_mode.h"

#include <glm/vec2.hpp>
#include <glm/vec3.hpp>
#include <span>
#include <vector>

namespace viewer {

/// Size of each eye's picture in a window: half of it for side-by-side and top-bottom (an odd last column or row
/// stays black; at least one pixel if the window has any), otherwise all of it.
glm::ivec2 eye_size(StereoMode mode, glm::ivec2 window_px);
/// Size of the picture from compose_stereo: the window's; for quad-buffer and two-windows, which have two
/// pictures, side by side at twice the width.
glm::ivec2 composed_size(StereoMode mode, glm::ivec2 window_px);

/// Bytes are R, G, B, display-encoded (sRGB), rows from the top.
/// @param left, right  pictures of eye_size(); right is not read in mode off
/// @param on_screen_px position of the window's top left corner on the screen: parity of interlaced modes
/// Throws InputError if the pictures have the wrong size.
std::vector<unsigned char> compose_stereo(StereoMode mode, std::span<unsigned char const> left,
                                          std::span<unsigned char const> right, glm::ivec2 window_px,
                                          glm::ivec2 on_screen_px = {0, 0});

/// Matrices for red/cyan glasses, on linear light; row = channel of the result,
/// column = channel of the eye's picture.
/// E. Dubois, "Conversion of a Stereo Pair to Anaglyph with the Least-Squares Projection Method", 2009; the
/// method: "A projection method to generate anaglyph stereo images", ICASSP 2001. The left eye
/// looks through red. Results beyond 0..1 are clipped.
struct DuboisMatrices {
    float left[3][3] = {{0.437f, 0.449f, 0.164f}, {-0.062f, -0.062f, -0.024f}, {-0.048f, -0.050f, -0.017f}};
    float right[3][3] = {{-0.011f, -0.032f, -0.007f}, {0.377f, 0.761f, 0.009f}, {-0.026f, -0.093f, 1.234f}};
};

/// IEC 61966-2-1 back to linear light, v in [0, 1].
float decode_srgb(float v);

} // namespace viewer
