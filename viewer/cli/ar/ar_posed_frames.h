#pragma once
// Reads some frames of a session whose camera pose is trusted, for commands that estimate what they show.

#include "ar/pipeline/pipeline.h"
#include "ar/pipeline/posed_frame.h"
#include "viewer/cli/ar/pose_arguments.h"

#include <vector>

namespace viewer {

struct PosedFrameChoice {
    PoseArguments poses;    ///< without a file: from markers, features or the session's tracker
    int views = 8;          ///< frames to keep, spread evenly
    int frames = 0;         ///< read at most this many; 0 = all, of files only
    std::int64_t only = -1; ///< number of the only frame to keep; -1 = any
};

struct PosedFrames {
    std::vector<ar::PosedFrame> kept{};
    int found = 0, without_pose = 0, refused = 0; ///< frames read: with a pose, without one, unusable
};

/// @throws gi::InputError the source cannot be opened, or never ends and `frames` is 0
PosedFrames read_posed_frames(PosedFrameChoice const& choice, ar::Session const& session,
                              ar::CalibratedCamera const& camera, gi::StopRequest const& stop, gi::Report& report);

} // namespace viewer
