#pragma once
// Camera models that are possible, and that no usual camera has: focal lengths in millimetres, swapped numbers.

#include "ar/camera/camera_model.h"

#include <string>
#include <vector>

namespace ar {

/// A sentence for each: a view of a lens other than a fisheye wider than 150 degrees or narrower than 1, pixels that
/// are not nearly square, a principal point more than 12 % of the picture off its middle.
std::vector<std::string> doubts_about(CameraModel const& camera);

} // namespace ar
