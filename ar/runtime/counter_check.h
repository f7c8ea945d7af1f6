#pragma once
// Whether what is shown is what it is said to be: a run of frames that show their own number, in which a ball is
// put where a camera that moves would see it. Number and ball are read from the picture that was shown, nothing
// else; both have to be those of the record, and the ball has to be where the camera of *that number's* frame sees
// it: else virtual things would swim.

#include "ar/camera/camera_model.h"
#include "ar/runtime/runner.h"

namespace viewer {

struct CounterSession {
    ArSession session;
    ar::Pose camera_at(double since_frame_0_s) const; ///< of any length
    ar::CameraModel camera;
    double rate_hz = 30;
};

/// The ball goes to and fro by 2 % of the picture's width per frame. Writes its files into a folder that is there.
/// @param size_px  at least 208 x 160
CounterSession make_counter_session(std::filesystem::path const& folder, glm::ivec2 size_px, double rate_hz,
                                    gi::Report& report);

/// The middle of what is white below the number; nothing = there is nothing white.
std::optional<glm::dvec2> ball_in(cv::Mat const& rgb);
/// Where a camera at that place sees the ball.
glm::dvec2 ball_from(ar::CameraModel const& camera, ar::Pose const& world_from_camera);

struct CounterVerdict {
    int frames = 0;
    int unread = 0;    ///< shown without a number that can be read
    int other = 0;     ///< that show another number than the record has
    int misplaced = 0; ///< whose ball is elsewhere, by more than a quarter of its way per frame
    int mistimed = 0;  ///< whose times do not add up, or are not those of the clocks around
    double most_off_px = 0;

    bool good() const { return frames > 0 && unread + other + misplaced + mistimed == 0; }
};

class CounterCheck {
public:
    explicit CounterCheck(CounterSession const& session) : session_(session) {}
    /// @param shown           CV_8UC3 RGB of any size
    /// @param before_s,after_s steady clock around the showing; the record's swap (without a window: its
    /// composite) has to be between them (before both)
    void add(ArFrameRecord const& record, cv::Mat const& shown, bool in_window, double before_s, double after_s);
    CounterVerdict const& verdict() const { return verdict_; }

private:
    CounterSession const& session_;
    CounterVerdict verdict_;
    std::optional<double> start_s_; ///< when frame 0 was captured
};

} // namespace viewer
