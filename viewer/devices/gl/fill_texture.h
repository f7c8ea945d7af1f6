#pragma once
// Uploads OpenCV pictures to textures.

#include "viewer/devices/gl/gl_object.h"

#include <opencv2/core.hpp>

namespace viewer {

/// Fills a texture of the picture's size. Rows may have gaps between them.
/// @param format, type  of the picture in OpenGL terms: GL_RGB and GL_UNSIGNED_BYTE, ...
void fill_texture(GlObject const& texture, cv::Mat const& picture, unsigned format, unsigned type);

} // namespace viewer
