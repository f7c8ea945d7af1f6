#pragma once
// What `lightwell ar run` keeps while it runs: composites as pictures and as a video, and the camera's frames as a
// recorded session. Whoever renders and shows waits for none of them, but where frames are read as fast as
// possible.

#include "ar/capture/session_writer.h"
#include "ar/runtime/picture_folder.h"
#include "ar/runtime/picture_thread.h"
#include "ar/runtime/runner.h"
#include "viewer/offline/video_writer.h"

#include <memory>
#include <optional>

namespace viewer {

struct ArRecordingSettings {
    std::string pictures, video, input; ///< folder, file, folder; empty = none
    std::string calibration;            ///< noted with the input
    PictureThread::WhenFull when_full = PictureThread::WhenFull::lose;
};

class ArRecording {
public:
    /// Makes the folder of pictures; nothing else before `begin`. @throws gi::InputError
    explicit ArRecording(ArRecordingSettings settings);

    /// @throws gi::InputError the video or the session cannot be made
    void begin(ar::SourceDescription const& source);
    /// By the thread that takes frames.
    void add_input(ar::Frame const& frame);
    /// @throws what went wrong with an earlier one
    void add(ArFrameRecord const& record, cv::Mat const& rgb);
    /// Waits until all is kept, whatever goes wrong with one of them; the video gets its name. @throws the first
    /// that went wrong
    void finish();
    /// What was kept and what was lost, a line each; after `finish`.
    std::string text() const;
    /// Why the input is not whole; empty = it is.
    std::string failure() const { return input_ ? input_->failure() : std::string(); }

private:
    void add_to_video(NumberedPicture const& picture);

    ArRecordingSettings settings_;
    std::optional<PictureFolder> folder_;
    std::unique_ptr<VideoWriter> video_;
    std::unique_ptr<ar::SessionWriter> input_;
    double video_hz_ = 30;
    cv::Mat held_;     ///< the video's last picture
    double cut_s_ = 0; ///< of time that passed while nothing came, not in the video
    int left_out_ = 0; ///< pictures that came before they were due
    bool is_video_done_ = false, is_video_lost_ = false;
    int repeated_ = 0; ///< pictures of the video that stand for frames that did not come
    std::unique_ptr<PictureThread> to_folder_, to_video_; // end before what they fill
};

} // namespace viewer
