#pragma once
// What is off, frame by frame, against a folder of pictures with the things really there and the camera's true
// path.

#include "ar/pose/pose_file.h"
#include "ar/runtime/runner.h"

namespace viewer {

/// A value per frame of which the truth is known.
struct FrameErrors {
    std::vector<double> position_mm, rotation_deg;
    std::vector<double> flip_affected, flip_elsewhere;     ///< of composites, see TruthErrors
    std::vector<double> camera_affected, camera_elsewhere; ///< of adding nothing
    std::vector<double> affected_percent;                  ///< of the picture
    int missing = 0;                                       ///< frames of which there is no picture of that size
};

/// Lines of text; empty where nothing is known.
std::string describe(FrameErrors const& errors);

class FrameTruth {
public:
    /// @param pictures  folder, empty = none   @param poses  file, empty = none. @throws gi::InputError
    FrameTruth(std::filesystem::path pictures, std::filesystem::path const& poses);
    void add(ArFrameRecord const& record, ArResult const& result);
    FrameErrors const& errors() const { return errors_; }

private:
    std::filesystem::path pictures_;
    std::vector<ar::TimedPose> poses_;
    FrameErrors errors_;
};

} // namespace viewer
