#pragma once
// Hand input as OpenXR actions, which the runtime binds to its controllers' buttons and the user may rebind.

#include "viewer/devices/xr/frame.h"
#include "viewer/devices/xr/openxr.h"
#include "viewer/devices/xr/session.h"

namespace viewer {

class Actions {
public:
    /// Suggests bindings for the simple controller and those of Oculus Touch, Valve Index, HTC Vive and Windows
    /// Mixed Reality, and attaches them to the session. Throws CallError.
    /// @param eye_tracking  on: also an action for gaze
    Actions(XrInstance instance, XrSession session, HmdEyeTracking eye_tracking);
    ~Actions();
    Actions(Actions const&) = delete;
    Actions& operator=(Actions const&) = delete;

    /// Queries the current controllers; call after XR_TYPE_EVENT_DATA_INTERACTION_PROFILE_CHANGED.
    void read_profiles();
    /// Current button states; released while the session has no focus.
    void read_buttons();
    struct Hand {
        HmdHand state;
        std::optional<RoomPose> grip;
    };
    /// Gaze at a time, from the head. None without eye tracking, or while the session has no focus.
    struct Gaze {
        HmdGaze state;       ///< without its time
        XrTime measured = 0; ///< 0 = the runtime does not say
    };
    std::optional<Gaze> gaze(XrSpace head, XrTime time) const;
    /// Poses of the hands at a time, in the room.
    std::array<Hand, 2> hands(XrSpace space, RoomPose const& room_from_space, XrTime time) const;

private:
    /// @param hands  it has a value for each; else one for all
    XrAction make_action(char const* name, char const* shown_name, XrActionType type, bool hands = true) const;
    void suggest(char const* profile, std::vector<XrActionSuggestedBinding> const& bindings) const;
    void suggest() const;
    XrPath path(std::string const& text) const;
    XrActionStateGetInfo of_hand(XrAction action, std::size_t hand) const;
    bool is_pressed(XrAction action, std::size_t hand) const;

    XrInstance instance_;
    XrSession session_;
    XrActionSet set_ = XR_NULL_HANDLE;
    XrAction aim_{}, grip_{}, move_{}, select_{}, trigger_{}, menu_{}, gaze_{};
    XrSpace gaze_space_ = XR_NULL_HANDLE;
    std::array<XrPath, 2> hand_path_{};
    std::array<XrSpace, 2> aim_space_{}, grip_space_{};
    std::array<HmdHand, 2> hands_;
};

/// Pose of a space, converted to the room; empty if unknown.
std::optional<RoomPose> locate(XrSpace what, XrSpace space, RoomPose const& room_from_space, XrTime time);

} // namespace viewer
