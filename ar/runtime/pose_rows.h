#pragma once
// Whether a file of poses covers the frames of a run: more or fewer rows than frames hint at lost ones.

#include "ar/pose/pose_file.h"
#include "ar/runtime/runner.h"

namespace ar {

/// Times are seconds since the time 0 of the session (FrameClock).
struct PoseRows {
    std::size_t poses = 0, frames = 0;
    std::size_t before = 0, after = 0; ///< poses more than half a frame before the first frame, after the last one
    std::size_t uncovered = 0;         ///< frames before the first pose or after the last one
    double first_pose_s = 0, last_pose_s = 0, first_frame_s = 0, last_frame_s = 0;
};

/// @param poses, frames  not empty
PoseRows compare_rows(std::vector<TimedPose> const& poses, std::vector<RunFrame> const& frames);

/// A line of text; empty if poses and frames begin and end together. @param whose  "poses of 'poses.csv'"
std::string describe(PoseRows const& rows, std::string const& whose);

} // namespace ar
