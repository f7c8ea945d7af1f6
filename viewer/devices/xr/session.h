#pragma once
// A head-mounted display through OpenXR (Khronos: The OpenXR Specification, 1.0).
//
//     HmdSession hmd(context, {});
//     while (!hmd.ended()) {
//         hmd.poll();
//         std::optional<HmdFrame> frame = hmd.begin_frame();
//         if (!frame) continue;                       // nothing is shown now; has waited a little
//         if (!frame->should_render) hmd.end_frame();
//         else if (new_picture) hmd.end_frame(*new_picture);
//         else hmd.repeat_frame();                    // the runtime moves the last picture to the new pose
//     }
//     if (hmd.phase() == HmdPhase::lost) ...           // say hmd.why(), destroy it, build another
//
// After a loss (service gone, headset pulled out) nothing throws: the phase is `lost`, frames are empty, and why()
// names the call and its result. HmdKeeper (keeper.h) does the building again. One session at a time; all calls
// come from the thread of the GL context.

#include "viewer/devices/xr/frame.h"
#include "viewer/devices/xr/info.h"
#include "viewer/protocol/hidden_mask.h"

#include <memory>
#include <optional>

namespace viewer {

class GlContext;

enum class HmdSpace {
    stage, ///< standing: the floor of the runtime; where it knows none, as seated
    local, ///< seated: eyes are eye_height_m above the floor when the session starts, however tall the user
};

struct HmdOptions {
    HmdSpace space = HmdSpace::stage;
    double eye_height_m = 1.6; ///< 0.2 to 3
};

/// Those of OpenXR, and two ends.
enum class HmdPhase { idle, ready, synchronized, visible, focused, stopping, lost, ended };
char const* name(HmdPhase phase);

/// What became of the frames. Everything that was not shown is here.
struct HmdCounts {
    std::uint64_t frames = 0;      ///< begun
    std::uint64_t pictures = 0;    ///< new ones shown
    std::uint64_t repeated = 0;    ///< the last picture shown again
    std::uint64_t empty = 0;       ///< ended without a picture, as asked or as none was there
    std::uint64_t late_images = 0; ///< new pictures not shown, since the runtime was still reading the images
    std::uint64_t discarded = 0;   ///< by the runtime (XR_FRAME_DISCARDED)
    std::uint64_t without_pose = 0;
    std::uint64_t moved_spaces = 0; ///< the runtime was recentred
    std::uint64_t lost_events = 0;  ///< of the runtime's queue
};

class HmdSession {
public:
    /// Pictures for two eyes. The context is current, is EGL's or GLX's, and outlives the session.
    /// Throws InputError where there is no runtime, no headset, a runtime without what is needed, or an option out
    /// of its range.
    HmdSession(GlContext const& context, HmdOptions const& options);
    /// Poses only: a tracker for head and hands without pictures and without GL (XR_MND_headless).
    explicit HmdSession(HmdOptions const& options);
    ~HmdSession();
    HmdSession(HmdSession const&) = delete;
    HmdSession& operator=(HmdSession const&) = delete;

    /// Reads the runtime's events, begins and ends the session as they say. Does not wait.
    HmdPhase poll();
    HmdPhase phase() const;
    /// Lost or ended: destroy it.
    bool ended() const;
    /// Why it was lost or has ended, for people; empty before.
    std::string const& why() const;
    /// Asks the runtime to end the session; go on with poll and frames until ended().
    void request_exit();

    /// Waits for the runtime's next frame and asks where head, eyes and hands will be when it is seen. Empty where
    /// no frames are wanted, after a pause of 10 ms; a tracker has poses() instead.
    std::optional<HmdFrame> begin_frame();
    /// The views again, for the time of a frame that was begun: a later and better prediction, for a last
    /// reprojection.
    std::optional<std::array<HmdView, 2>> latest_views(HmdFrame const& frame);
    /// Ends the frame with a new picture, which is copied: the textures are free again.
    void end_frame(HmdPicture const& picture);
    /// Ends the frame with the last picture and the pose it was drawn for; empty where there was none.
    void repeat_frame();
    /// Ends the frame with nothing.
    void end_frame();

    /// A tracker's begin_frame: head and hands at a time of steady_clock, with actions. The views are empty,
    /// should_render is false. Does not wait.
    std::optional<HmdFrame> poses(double steady_s);

    /// From now on the head stands at the room's x = z = 0 and looks along -Z (height and tilt are kept).
    /// False where the head is not tracked.
    bool recentre();
    /// Room from the space of the runtime; identity until recentred, but for the eye height.
    RoomPose room_from_space() const;

    /// Pixels of an eye that nobody sees; none where the runtime does not tell. Changes where the runtime says so.
    HiddenMask const& hidden(HmdEye eye) const;
    HmdInfo const& info() const;
    HmdCounts const& counts() const;

private:
    struct Parts;
    void start(GlContext const* context, HmdOptions const& options);
    std::unique_ptr<Parts> parts_;
};

} // namespace viewer
