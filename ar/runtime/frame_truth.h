#pragma once
// Errors per frame against the ground truth: a folder of pictures with the objects really there,
// and the camera's true poses.

#include "ar/pose/pose_file.h"
#include "ar/runtime/pose_truth.h"
#include "ar/runtime/runner.h"

#include <map>

namespace ar {

/// One value per frame with known truth.
struct FrameErrors {
    std::vector<double> position_mm, rotation_deg; ///< of the poses that were used
    PoseTruth poses;
    std::vector<double> flip_affected,
        flip_elsewhere; ///< of composites, see TruthErrors; of frames that have such pixels
    std::vector<double> camera_affected, camera_elsewhere; ///< of the unchanged camera frame
    std::vector<double> affected_percent;                  ///< of the picture
    bool has_pictures = false, has_poses = false;          ///< a truth was given
    std::uint64_t without_pose = 0;                        ///< frames at whose time there is no true pose
    std::uint64_t without_picture = 0,
                  unusable = 0;   ///< frames without a truth picture; with one that cannot be compared
    std::uint64_t unaffected = 0; ///< compared frames whose truth differs from the camera's frame in no pixel
    std::uint64_t equal = 0;      ///< of these, byte for byte
    std::string first_without_picture, first_unusable; ///< "frame 3", and why
    std::uint64_t compared() const { return affected_percent.size(); }
};

/// Lines of text: a mean over nothing is "-"; empty without a truth.
std::string describe(FrameErrors const& errors);
/// Counts frames without a truth, and those that it does not change.
void report_losses(FrameErrors const& errors, gi::Report& report);

class FrameTruth {
public:
    /// @param pictures  folder, numbered as the frames are; empty = none   @param poses  empty = none
    /// @throws gi::InputError no such folder, no pictures in it, or pictures without numbers
    FrameTruth(std::filesystem::path const& pictures, std::vector<TimedPose> poses);
    void add(RunFrame const& record, FrameResult const& result);
    FrameErrors const& errors() const { return errors_; }

private:
    void add_picture(std::filesystem::path const& file, FrameResult const& result);

    std::map<std::uint64_t, std::filesystem::path> pictures_;
    std::vector<TimedPose> poses_;
    FrameErrors errors_;
};

} // namespace ar
