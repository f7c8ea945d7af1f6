#pragma once
// Cameras that are fixed to a headset: key `hmd` of a session.

#include "ar/camera/pose.h"
#include "gi/core/yaml.h"

#include <filesystem>
#include <optional>

namespace viewer {

struct ArRightCamera {
    std::string source; ///< as ar::open_source takes it
    std::filesystem::path calibration;
    ar::Pose left_from_right; ///< where it is, in the frame of the other one
};

struct ArHmd {
    /// The head's axes are x right, y up, z back; the camera's x right, y down, z ahead. As it looks by default.
    ar::Pose head_from_camera{glm::dquat(0, 1, 0, 0), glm::dvec3(0)};
    double plane_m = 1; ///< ahead of the camera: what is there is where it seems to be for eyes beside the camera
    std::optional<ArRightCamera> right; ///< of the right eye; none: both see what the one camera sees
};

/// @throws gi::InputError with file:line:column
ArHmd read_hmd(gi::Yaml const& hmd, std::filesystem::path const& folder);

} // namespace viewer
