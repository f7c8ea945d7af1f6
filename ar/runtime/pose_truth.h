#pragma once
// Errors of camera poses against true ones: how far off, how they jump, and what their confidence is worth.

#include "ar/camera/pose.h"
#include "ar/pose/trust.h"

#include <optional>
#include <string>
#include <vector>

namespace ar {

struct PoseError {
    double confidence = 0, position_mm = 0, rotation_deg = 0;
};

/// Estimates whose confidence lies in [low, high), in the last one up to 1.
struct ConfidenceBin {
    double low = 0, high = 0;
    std::size_t frames = 0;
    double median_mm = 0, p95_mm = 0, median_deg = 0, p95_deg = 0; ///< zeros without frames
};
/// Bins at 0, 0.1, 0.3, 0.5 (what is trusted by default), 0.7, 0.9, 0.97.
std::vector<ConfidenceBin> confidence_curve(std::vector<PoseError> const& errors);
/// CSV with a header line.
std::string to_csv(std::vector<ConfidenceBin> const& curve);

/// A jump: the error of the used pose changes by more than this from a frame to the next.
inline constexpr double kJump_mm = 20;

/// Adds up frames in order.
class PoseTruth {
public:
    /// @param estimated  the frame's own pose, trusted or not  @param used  the pose that it is shown with
    void add(std::uint64_t sequence, gi::RigidPose const& truth, std::optional<gi::RigidPose> const& estimated,
             double confidence, PoseState state, std::optional<gi::RigidPose> const& used);

    std::vector<PoseError> const& estimates() const { return estimates_; }
    std::size_t jumps() const { return jumps_; }
    std::size_t steps() const { return steps_; } ///< pairs of successive frames that are both shown
    double largest_jump_mm() const { return largest_jump_mm_; }
    std::size_t tracked_jumps() const { return tracked_jumps_; } ///< jumps between two tracked frames

private:
    std::vector<PoseError> estimates_;
    std::optional<glm::dvec3> last_; ///< error of the last frame's used pose, m
    PoseState last_state_ = PoseState::lost;
    std::uint64_t last_sequence_ = 0;
    std::size_t jumps_ = 0, tracked_jumps_ = 0, steps_ = 0;
    double largest_jump_mm_ = 0;
};

/// Lines of text: jumps, and the curve of confidence; empty without estimates.
std::string describe(PoseTruth const& truth);

} // namespace ar
