#pragma once
// Where the runtime's poses are in the room: its stage, or its local space raised by the height of the eyes; what
// was recentred here (a turn and a step of our own) and there (the runtime moves its space under us).

#include "viewer/devices/xr/openxr.h"
#include "viewer/devices/xr/session.h"

namespace viewer {

class Spaces {
public:
    /// Throws CallError.
    Spaces(XrSession session, HmdOptions const& options);

    XrSpace base() const { return base_; }
    std::string const& description() const { return description_; }
    RoomPose const& room_from_space() const { return room_from_space_; }
    std::optional<RoomPose> head(XrTime time) const;
    bool recentre(XrTime time);

    /// Keeps where the head is seen at `time` by who asks at `asked`: runtimes may recentre without saying how
    /// their space moved, and the head, sought again at the same time, tells.
    void remember_head(XrTime asked, XrTime time);
    /// Keeps a change of the runtime for when it comes to pass; false where it is of another space.
    bool take(XrEventDataReferenceSpaceChangePending const& change);
    /// Changes up to this time are made: our own turn and step are undone, for the runtime's user has chosen anew.
    void apply_until(XrTime time);
    /// Changes made so far.
    std::uint64_t moves() const { return moves_.size(); }
    /// A pose of the space as it was after `space` changes, in the space as it is now; the same numbers where
    /// neither the runtime nor the head tells how it moved.
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
    XrSpace base_ = XR_NULL_HANDLE, head_ = XR_NULL_HANDLE; // they go with the session
    std::string description_;
    double floor_m_ = 0; ///< added to heights: 0 for a stage, which has its origin on the floor
    RoomPose room_from_space_;
    std::vector<SeenHead> heads_; ///< the last few
    std::vector<Change> pending_;
    std::vector<std::optional<RoomPose>> moves_; ///< old from new, in order
};

} // namespace viewer
