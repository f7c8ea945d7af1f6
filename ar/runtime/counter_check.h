#pragma once
// End-to-end check of the displayed pictures: the frames show their own number, and a virtual ball is
// rendered where a moving camera would see it. Number and ball are read only from the displayed picture;
// both must match the record, and the ball must be where the camera of *that number's* frame sees
// it: otherwise virtual objects would swim.

#include "ar/camera/camera_model.h"
#include "ar/runtime/runner.h"

namespace ar {

struct CounterSession {
    Session session;
    gi::RigidPose camera_at(double since_frame_0_s) const; ///< for any time
    CameraModel camera;
    double rate_hz = 30;
};

/// The ball moves back and forth by 2 % of the picture's width per frame.
/// Writes its files into an existing folder.
/// @param size_px  at least 208 x 160
CounterSession make_counter_session(std::filesystem::path const& folder, glm::ivec2 size_px, double rate_hz,
                                    gi::Report& report);

/// Centre of the white pixels below the number; nothing if there are none.
std::optional<glm::dvec2> ball_in(cv::Mat const& rgb);
/// Pixel position of the ball for a camera pose.
glm::dvec2 ball_from(CameraModel const& camera, gi::RigidPose const& world_from_camera);

struct CounterVerdict {
    int frames = 0;
    int unread = 0;    ///< frames shown without a readable number
    int other = 0;     ///< frames that show another number than the record
    int misplaced = 0; ///< frames whose ball is off by more than a quarter of its motion per frame
    int mistimed = 0;  ///< frames whose times do not add up, or contradict the surrounding clock readings
    double most_off_px = 0;

    bool good() const { return frames > 0 && unread + other + misplaced + mistimed == 0; }
};

class CounterCheck {
public:
    explicit CounterCheck(CounterSession const& session) : session_(session) {}
    /// @param shown           CV_8UC3 RGB of any size
    /// @param before_s,after_s steady clock before and after showing; the record's swap must be between them
    /// (without a window: its composite must be before both)
    void add(RunFrame const& record, cv::Mat const& shown, bool in_window, double before_s, double after_s);
    CounterVerdict const& verdict() const { return verdict_; }

private:
    CounterSession const& session_;
    CounterVerdict verdict_;
    std::optional<double> start_s_; ///< when frame 0 was captured
};

} // namespace ar
