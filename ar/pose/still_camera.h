#pragma once
// A camera on a tripod: all estimates belong to one pose until the camera is moved.

#include "ar/pose/estimate.h"

#include <cstdint>
#include <deque>

namespace ar {

struct StillSettings {
    std::size_t keep = 600; ///< number of newest estimates to keep
    /// An estimate disagrees if it is off by more than this many of its own standard deviations and the floors.
    double limit_sigmas = 5;
    double least_m = 0.002, least_deg = 0.1;
    int moved_after = 5; ///< after this many consecutive disagreeing estimates the camera counts as moved
};

struct StillPose {
    gi::RigidPose world_from_camera;
    std::size_t averaged = 0;       ///< number of estimates in the mean
    std::size_t left_out = 0;       ///< kept, but in disagreement
    glm::dvec3 position_sigma_m{0}; ///< standard error of the mean, from the spread of the estimates
    double rotation_sigma_deg = 0;
};

/// The mean of the estimates that agree with their median, each weighted by 1 / sigma^2 of position and of
/// rotation; rotations as rotation vectors about the median's.
class StillCamera {
public:
    explicit StillCamera(StillSettings const& settings = {}) : settings_(settings) {}

    /// Adds an estimate, ignoring failed ones. Returns true if this shows that the camera was moved; then only the
    /// estimates since the move are kept.
    bool add(PoseEstimate const& estimate);
    std::optional<StillPose> const& pose() const { return mean_; }
    std::uint64_t moves() const { return moves_; }

private:
    StillSettings settings_;
    std::deque<PoseEstimate> kept_;
    std::optional<StillPose> mean_;
    int astray_ = 0; ///< number of newest estimates that disagree
    std::uint64_t moves_ = 0;
};

} // namespace ar
