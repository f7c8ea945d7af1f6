#pragma once
// Pictures of a stimulus from an AR session. They are made one after the other,
// starting at the stimulus's first frame (or `warmup_frames` before it), ahead of presentation,
// so that the stimulus does not depend on the machine's speed.

#include "ar/camera/pose.h"
#include "gi/core/progress.h"
#include "gi/core/report.h"
#include "viewer/experiment/stimuli/ar_stimulus.h"
#include "viewer/experiment/stimuli/stimulus_source.h"

namespace viewer {

struct ArPicture {
    double time_s = 0; ///< start of its presentation, since the onset
    cv::Mat rgb;       ///< CV_8UC3, of the place's size: the frame scaled to fit, grey around it
    std::optional<gi::RigidPose> world_from_camera;
};

/// Makes one picture, those for `view.duration_s`, or all there are if fewer. @throws gi::InputError,
/// gi::InputError if the frame or time does not exist, the camera is not found in a single frame, or a file of the
/// session cannot be read
std::vector<ArPicture> make_ar_pictures(ArStimulus const& stimulus, StimulusView const& view,
                                        gi::StopRequest const& stop, gi::Report& report);

/// Does everything except making pictures: reads all files of the session and seeks the first frame.
/// @throws as make_ar_pictures, and ArSettingError if a setting is the cause
void check_ar_pictures(ArStimulus const& stimulus);

/// The frame scaled to fit and centred in this size, the rest grey as the screen.
cv::Mat fitted(cv::Mat const& rgb, glm::ivec2 size_px);

} // namespace viewer
