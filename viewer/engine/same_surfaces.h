#pragma once
// Where the two eyes' pictures of one moment show the same surfaces.

#include "gi/image_io/picture.h"
#include "gi/scene/model/camera.h"

#include <cstdint>
#include <vector>

namespace viewer {

/// Per pixel of `here`: the pixel of `there` that shows the same point, within 2 % of its distance; gi::kOwnLight
/// if there is none. Both need the layer position. @param rays  camera of `there`
std::vector<std::uint32_t> same_surfaces(gi::Picture const& here, gi::Picture const& there,
                                         gi::CameraRays const& rays, gi::dvec3 origin);

} // namespace viewer
