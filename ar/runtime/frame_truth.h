#pragma once
// Errors per frame against the ground truth: a folder of pictures with the objects really there,
// and the camera's true poses.

#include "ar/pose/pose_file.h"
#include "ar/runtime/pose_truth.h"
#include "ar/runtime/runner.h"

namespace ar {

/// One value per frame with known truth.
struct FrameErrors {
    std::vector<double> position_mm, rotation_deg; ///< of the poses that were used
    PoseTruth poses;
    std::vector<double> flip_affected, flip_elsewhere;     ///< of composites, see TruthErrors
    std::vector<double> camera_affected, camera_elsewhere; ///< of the unchanged camera frame
    std::vector<double> affected_percent;                  ///< of the picture
    int missing = 0;                                       ///< frames without a truth picture of that size
};

/// Lines of text; empty without any values.
std::string describe(FrameErrors const& errors);

class FrameTruth {
public:
    /// @param pictures  folder, empty = none   @param poses  empty = none. @throws gi::InputError no such folder
    FrameTruth(std::filesystem::path pictures, std::vector<TimedPose> poses);
    void add(RunFrame const& record, FrameResult const& result);
    FrameErrors const& errors() const { return errors_; }

private:
    std::filesystem::path pictures_;
    std::vector<TimedPose> poses_;
    FrameErrors errors_;
};

} // namespace ar
