#pragma once
// A camera on a tripod: all its estimates are of one pose, until it is moved.

#include "ar/pose/estimate.h"

#include <cstdint>
#include <deque>

namespace ar {

struct StillSettings {
    std::size_t keep = 600; ///< estimates, the newest
    /// An estimate disagrees if it is beyond this many of its own standard deviations and beyond both floors.
    double limit_sigmas = 5;
    double least_m = 0.002, least_deg = 0.1;
    int moved_after = 5; ///< estimates in a row that disagree with the mean: the camera was moved
};

struct StillPose {
    Pose world_from_camera;
    std::size_t averaged = 0;       ///< estimates in it
    std::size_t left_out = 0;       ///< kept, but in disagreement
    glm::dvec3 position_sigma_m{0}; ///< standard error of the mean, from the spread of the estimates
    double rotation_sigma_deg = 0;
};

/// The mean of the estimates that agree with their median, each weighted by 1 / sigma^2 of position and of
/// rotation; rotations as rotation vectors about the median's.
class StillCamera {
public:
    explicit StillCamera(StillSettings const& settings = {}) : settings_(settings) {}

    /// What was not found is not taken. True if the camera was found to have been moved: only the estimates since
    /// are kept.
    bool add(PoseEstimate const& estimate);
    std::optional<StillPose> const& pose() const { return mean_; }
    std::uint64_t moves() const { return moves_; }

private:
    StillSettings settings_;
    std::deque<PoseEstimate> kept_;
    std::optional<StillPose> mean_;
    int astray_ = 0; ///< the newest so many disagree
    std::uint64_t moves_ = 0;
};

} // namespace ar
