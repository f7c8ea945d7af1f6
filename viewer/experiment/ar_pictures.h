#pragma once
// The pictures of a stimulus from an AR session. They are made one after the other from the stimulus's first frame
// (or `warmup_frames` before it) on, whenever that is: what people see does not depend on the machine's speed.

#include "ar/camera/pose.h"
#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "viewer/experiment/ar_stimulus.h"
#include "viewer/experiment/stimulus_source.h"

namespace viewer {

struct ArPicture {
    double time_s = 0; ///< when it is seen first, since the onset
    cv::Mat rgb;       ///< CV_8UC3, of the place's size: the frame as large as it fits, grey around it
    std::optional<ar::Pose> world_from_camera;
};

/// One picture, or those of `view.duration_s`, or as many as there are. @throws gi::InputError
/// there is no such frame or moment, the camera is not found in the only frame, what the session names cannot be
/// read
std::vector<ArPicture> make_ar_pictures(ArStimulus const& stimulus, StimulusView const& view,
                                        gi::StopRequest const& stop, gi::Report& report);

/// Everything but the pictures: reads all that the session names, goes to the frame that is seen first.
/// @throws as make_ar_pictures, and ArSettingError where a setting is to blame
void check_ar_pictures(ArStimulus const& stimulus);

/// The frame as large as it fits into this size, in the middle, the rest grey as the screen.
cv::Mat fitted(cv::Mat const& rgb, glm::ivec2 size_px);

} // namespace viewer
