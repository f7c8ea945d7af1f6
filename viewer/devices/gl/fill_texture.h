#pragma once
// Pictures in OpenCV's form as textures.

#include "viewer/devices/gl/gl_object.h"

#include <opencv2/core.hpp>

namespace viewer {

/// Fills a texture of the picture's size. Rows may have gaps between them.
/// @param format, type  as OpenGL calls those of the picture: GL_RGB and GL_UNSIGNED_BYTE, ...
void fill_texture(GlObject const& texture, cv::Mat const& picture, unsigned format, unsigned type);

} // namespace viewer
