#pragma once
// Files that `lightwell ar run` writes while it runs: composites as pictures and as a video, and the camera's
// frames as a recorded session. Rendering and display wait for them only if frames are read as fast as possible.

#include "ar/capture/session_writer.h"
#include "ar/runtime/pass_folder.h"
#include "ar/runtime/picture_folder.h"
#include "ar/runtime/picture_thread.h"
#include "ar/runtime/runner.h"
#include "viewer/offline/video_writer.h"

#include <memory>
#include <optional>

namespace viewer {

struct ArRecordingSettings {
    std::string pictures, video, input; ///< folder, file, folder; empty = none
    std::string calibration;            ///< file name stored with the input
    ar::PictureThread::WhenFull when_full = ar::PictureThread::WhenFull::lose;
    ar::PassSettings passes = {};
};

class ArRecording {
public:
    /// Makes the folder of pictures; all else is created by `begin`. @throws gi::InputError
    explicit ArRecording(ArRecordingSettings settings);

    /// @throws gi::InputError, gi::InputError if the video or the session cannot be created
    /// @param report  for what is lost when passes are written
    void begin(ar::SourceDescription const& source, ar::CameraModel const& camera,
               ar::Compositor const& compositor, gi::Report& report);
    /// Called by the thread that captures frames.
    void add_input(ar::Frame const& frame);
    /// @throws the error of an earlier picture
    void add(ar::RunFrame const& record, ar::FrameResult const& result);
    /// Waits until all files are written, also if one of them fails, and renames the video to its final name.
    /// @throws the first error
    void finish();
    /// One line for each output: what was written and lost. Call after `finish`.
    std::string text() const;
    /// Why the recorded input is incomplete; empty if it is complete.
    std::string failure() const { return input_ ? input_->failure() : std::string(); }

private:
    void add_to_video(ar::KeptPicture const& picture);

    ArRecordingSettings settings_;
    std::optional<ar::PictureFolder> folder_;
    std::unique_ptr<VideoWriter> video_;
    std::unique_ptr<ar::SessionWriter> input_;
    std::unique_ptr<ar::PassFolder> passes_;
    double video_hz_ = 30;
    cv::Mat held_;     ///< last picture of the video
    double cut_s_ = 0; ///< seconds without frames that were cut from the video
    int left_out_ = 0; ///< pictures dropped because they came too early
    int reduced_ = 0;  ///< composites of the video that had more than 8 bits
    bool is_video_done_ = false, is_video_lost_ = false;
    int repeated_ = 0;                                    ///< pictures repeated in place of missing frames
    std::unique_ptr<ar::PictureThread> to_folder_, to_video_; // destroyed before the outputs they fill
};

} // namespace viewer
