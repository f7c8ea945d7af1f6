#pragma once
// Settings of a session for real objects in front of virtual ones: pictures of depths and mattes, one per frame.

#include "ar/camera/pose.h"
#include "ar/composite/occluders.h"
#include "gi/core/yaml.h"

#include <filesystem>
#include <optional>

namespace ar {

/// Numbered pictures that belong to the frames: number = first + the frame's number, or, with a rate,
/// first + the nearest to time * rate_hz.
struct FramePictures {
    std::filesystem::path source; ///< folder (numbers: the last digits of the names) or name with %04d
    std::int64_t first = 0;
    double rate_hz = 0;
};

struct OcclusionPictures {
    std::optional<FramePictures> depth, matte;
    std::filesystem::path camera; ///< calibration of the depth pictures; empty = registered to the frames
    gi::RigidPose camera_from_depth; ///< of the depth camera in the camera's frame
    double metres_per_unit = 0;   ///< as read_depth_map
    DepthOcclusion settings;
};

/// Reads the key `occlusion`. @throws gi::InputError with file:line:column
OcclusionPictures read_occlusion(gi::Yaml const& map, std::filesystem::path const& folder);

} // namespace ar
