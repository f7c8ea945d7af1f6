#pragma once
// Cameras that are fixed to a headset: key `hmd` of a session.

#include "ar/camera/pose.h"
#include "gi/core/yaml.h"

#include <filesystem>
#include <optional>

namespace ar {

struct RightCamera {
    std::string source; ///< name for open_source
    std::filesystem::path calibration;
    gi::RigidPose left_from_right; ///< its pose in the left camera's frame
};

struct HmdCameras {
    /// The head's axes are x right, y up, z back; the camera's x right, y down, z ahead. Default: same direction.
    gi::RigidPose head_from_camera{glm::dvec3(0), glm::dquat(0, 1, 0, 0)};
    double plane_m = 1; ///< distance of the picture plane; objects at this distance appear at their true position
    std::optional<RightCamera> right; ///< camera of the right eye; none: one camera for both eyes
};

/// @throws gi::InputError with file:line:column
HmdCameras read_hmd(gi::Yaml const& hmd, std::filesystem::path const& folder);

} // namespace ar
