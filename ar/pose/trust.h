#pragma once
// Decides for each frame whether a camera pose is trusted, and what is shown while none is:
// the last trusted pose is kept for a while (held), then virtual objects fade out at it (fading).
// All times are seconds on the clock of the frames.
//
//   a trusted pose            tracked, and objects fade in if they were not fully shown
//   else a predicted pose     predicted
//   else until hold_s         held: the last pose
//   else until shown is 0     fading: the last pose
//   else                      uncertain, if the frame has an estimate; lost, if it has none

#include "ar/camera/pose.h"

#include <array>
#include <optional>
#include <string>

namespace ar {

enum class PoseState { tracked, predicted, held, fading, uncertain, lost };
inline constexpr std::size_t kPoseStates = 6;
std::string name_of(PoseState state);

struct TrustSettings {
    /// Estimates below this confidence (PoseEstimate::confidence) are not used.
    double least_confidence = 0.5;
    double hold_s = 0.1; ///< keep the last pose for this long after the last trusted one
    double fade_s = 0.2; ///< time from fully shown to not at all, and back; 0 = at once
};

/// What is known about a frame's pose.
struct OfferedPose {
    std::optional<gi::RigidPose> trusted;   ///< of this frame
    std::optional<gi::RigidPose> predicted; ///< from earlier frames
    bool is_estimated = false;     ///< this frame has an estimate, trusted or not
};

struct UsedPose {
    PoseState state = PoseState::lost;
    std::optional<gi::RigidPose> world_from_camera; ///< if anything is shown
    double shown = 0; ///< 0 to 1: share of the change by virtual objects that is shown; 0 without a pose
    double age_s = 0; ///< since the last trusted pose
};

class PoseTrust {
public:
    explicit PoseTrust(TrustSettings const& settings = {}) : settings_(settings) {}

    /// Call for every frame, in order. Times that do not increase count as the same time.
    UsedPose next(double time_s, OfferedPose const& offered);
    /// Number of frames in each state.
    std::array<std::uint64_t, kPoseStates> const& counts() const { return counts_; }

private:
    UsedPose decided(double time_s, double passed_s, OfferedPose const& offered);

    TrustSettings settings_;
    std::optional<double> last_s_;    ///< time of the last frame
    std::optional<double> trusted_s_; ///< time of the last trusted pose
    gi::RigidPose pose_;              ///< the last one shown
    double shown_ = 0;
    std::array<std::uint64_t, kPoseStates> counts_{};
};

} // namespace ar
