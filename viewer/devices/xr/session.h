#pragma once
// A head-mounted display through OpenXR (Khronos: The OpenXR Specification, 1.0).
//
//     HmdSession hmd(context, {});
//     while (!hmd.ended()) {
//         hmd.poll();
//         std::optional<HmdFrame> frame = hmd.begin_frame();
//         if (!frame) continue;                       // nothing is shown now; has waited briefly
//         if (!frame->should_render) hmd.end_frame();
//         else if (new_picture) hmd.end_frame(*new_picture);
//         else hmd.repeat_frame();                    // the runtime reprojects the last picture
//     }
//     if (hmd.phase() == HmdPhase::lost) ...           // report hmd.why(), destroy it, create another
//
// After a loss (service ended, headset disconnected) nothing throws: the phase is `lost`, frames are empty, and
// why() names the failed call and its result. HmdKeeper (keeper.h) creates new sessions. Only one session at a
// time; all calls must come from the thread of the GL context.

#include "viewer/devices/xr/frame.h"
#include "viewer/devices/xr/info.h"
#include "viewer/protocol/hidden_mask.h"

#include <memory>
#include <optional>

namespace viewer {

class GlContext;

enum class HmdSpace {
    stage, ///< standing: the runtime's floor; if it has none, as `local`
    local, ///< seated: eyes start eye_height_m above the floor, for any user
};

enum class HmdEyeTracking {
    off,
    on, ///< XR_EXT_eye_gaze_interaction, which may ask the user for permission
};

enum class HmdDepths {
    off,
    on, ///< depths are submitted with pictures that have them (XR_KHR_composition_layer_depth), if the runtime takes them
};

enum class HmdInsets {
    off,
    on, ///< finer pictures of the middle of each eye (XR_VARJO_quad_views), if the runtime shows them
};

struct HmdOptions {
    HmdSpace space = HmdSpace::stage;
    double eye_height_m = 1.6; ///< 0.2 to 3
    HmdEyeTracking eye_tracking = HmdEyeTracking::off;
    HmdDepths depths = HmdDepths::off;
    HmdInsets insets = HmdInsets::off;
};

/// Session states of OpenXR, and two final ones.
enum class HmdPhase { idle, ready, synchronized, visible, focused, stopping, lost, ended };
char const* name(HmdPhase phase);

/// Counts of frames, including all that were not shown.
struct HmdCounts {
    std::uint64_t frames = 0;      ///< begun
    std::uint64_t pictures = 0;    ///< new ones shown
    std::uint64_t with_depth = 0;  ///< of these, with depths
    std::uint64_t repeated = 0;    ///< the last picture shown again
    std::uint64_t empty = 0;       ///< ended without a picture, on request or because there was none
    std::uint64_t late_images = 0; ///< new pictures not shown, because the runtime was still reading the images
    std::uint64_t discarded = 0;   ///< by the runtime (XR_FRAME_DISCARDED)
    std::uint64_t without_pose = 0;
    std::uint64_t moved_spaces = 0; ///< the runtime was recentred
    std::uint64_t lost_events = 0;  ///< lost from the runtime's queue
};

class HmdSession {
public:
    /// Session with pictures for two eyes. The context must be current, from EGL or GLX, and outlive the session.
    /// Throws InputError if there is no runtime or headset, the runtime lacks a required feature (eye tracking, if
    /// it is on), or an option is out of range.
    HmdSession(GlContext const& context, HmdOptions const& options);
    /// Session for poses only: a tracker of head and hands without pictures and GL (XR_MND_headless).
    explicit HmdSession(HmdOptions const& options);
    ~HmdSession();
    HmdSession(HmdSession const&) = delete;
    HmdSession& operator=(HmdSession const&) = delete;

    /// Processes the runtime's events, and begins and ends the session accordingly. Does not wait.
    HmdPhase poll();
    HmdPhase phase() const;
    /// True if lost or ended; it should then be destroyed.
    bool ended() const;
    /// Reason of the loss or end, for messages; empty before.
    std::string const& why() const;
    /// Requests the end of the session; continue with poll and frames until ended().
    void request_exit();

    /// Waits for the runtime's next frame and gets the predicted poses of head, eyes and hands at its display
    /// time. If the runtime wants no frames, waits 10 ms and returns none. Trackers use poses() instead.
    std::optional<HmdFrame> begin_frame();
    /// The views of the begun frame, predicted again: later and more accurate. First waits until the runtime has
    /// finished reading the images that the next picture is drawn into.
    std::optional<std::vector<HmdView>> latest_views(HmdFrame const& frame);
    /// Ends the frame with a new picture, which is copied, so the textures can be reused.
    void end_frame(HmdPicture const& picture);
    /// Ends the frame with the last picture and the pose that it was drawn for;
    /// without a picture if there was none.
    void repeat_frame();
    /// Ends the frame without a picture.
    void end_frame();

    /// For trackers, instead of begin_frame: head and hands at a time of steady_clock, with actions. The views are
    /// empty, should_render is false. Does not wait.
    std::optional<HmdFrame> poses(double steady_s);

    /// Moves the room so that the head is at x = z = 0 and faces -Z (height and tilt are kept). Returns false if
    /// the head is not tracked.
    bool recentre();
    /// Room from the runtime's space; until recentred the identity, except for the eye height.
    RoomPose room_from_space() const;

    /// True if pictures are submitted with their depths.
    bool takes_depths() const;
    /// From when the views of the last new picture were requested until it was handed over (xrEndFrame), s.
    double pose_age_s() const;
    /// Of this time, what the calling thread worked, drivers included; the rest it waited, or others had its core.
    double pose_cpu_s() const;
    /// Hidden area of an eye; empty if the runtime provides none. May change when the runtime reports it.
    HiddenMask const& hidden(HmdEye eye) const;
    HmdInfo const& info() const;
    HmdCounts const& counts() const;

private:
    struct Parts;
    void start(GlContext const* context, HmdOptions const& options);
    std::unique_ptr<Parts> parts_;
};

} // namespace viewer
