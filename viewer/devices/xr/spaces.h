#pragma once
// Relation of the runtime's space to the room: its stage, or its local space raised by the eye height; plus
// recentring by this program (a rotation and translation) and by the runtime (which moves its space).

#include "viewer/devices/xr/openxr.h"
#include "viewer/devices/xr/session.h"

namespace viewer {

class Spaces {
public:
    /// Throws CallError.
    Spaces(XrSession session, HmdOptions const& options);

    XrSpace base() const { return base_; }
    XrSpace head_space() const { return head_; }
    std::string const& description() const { return description_; }
    RoomPose const& room_from_space() const { return room_from_space_; }
    std::optional<RoomPose> head(XrTime time) const;
    bool recentre(XrTime time);

    /// Stores the head pose at `time` as requested at `asked`. Runtimes may recentre without reporting how their
    /// space moved; requesting the head pose for the same time again reveals it.
    void remember_head(XrTime asked, XrTime time);
    /// Stores a pending change of the runtime until it takes effect; false if it concerns another space.
    bool take(XrEventDataReferenceSpaceChangePending const& change);
    /// Applies changes up to this time. They reset this program's own recentring,
    /// because the user recentred in the runtime.
    void apply_until(XrTime time);
    /// Number of changes applied so far.
    std::uint64_t moves() const { return moves_.size(); }
    /// Converts a pose in the space after `space` changes to the current space; unchanged if neither the runtime
    /// nor the head poses reveal the motion.
    XrPosef moved_on(HmdRawView const& view, std::uint64_t space) const;

private:
    struct Change {
        XrTime time;
        std::optional<RoomPose> old_from_new;
    };

    struct SeenHead {
        XrTime asked, time;
        RoomPose space_from_head;
    };
    std::optional<RoomPose> found_by_head(XrTime change) const;

    XrReferenceSpaceType type_ = XR_REFERENCE_SPACE_TYPE_LOCAL;
    XrSpace base_ = XR_NULL_HANDLE, head_ = XR_NULL_HANDLE; // destroyed with the session
    std::string description_;
    double floor_m_ = 0; ///< added to heights: 0 for a stage, whose origin is on the floor
    RoomPose room_from_space_;
    std::vector<SeenHead> heads_; ///< the most recent ones
    std::vector<Change> pending_;
    std::vector<std::optional<RoomPose>> moves_; ///< old from new, in order
};

} // namespace viewer
