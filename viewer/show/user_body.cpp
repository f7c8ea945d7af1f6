#include "viewer/show/user_body.h"

#include "viewer/display/views.h"

namespace viewer {

Tracked UserBody::before_desktop(gi::dmat4 const& room_from_head) const
{
    return hands_.with_head(
        {gi::dvec3(room_from_head[3]), glm::normalize(glm::quat_cast(glm::dmat3(room_from_head)))});
}

Tracked UserBody::in_room(Display const& display, Tracked const& tracked) const
{
    if (display.users.empty()) return tracked;
    User const& user = display.users[0];
    RoomPose head = tracked.head.value_or(resting_head(user));
    head.position = eyes_of(user, head).middle;
    bool const by_keys =
        user.tracker >= 0 && display.trackers[std::size_t(user.tracker)].type == DisplayTrackerType::fake;
    return by_keys ? hands_.with_head(head) : Tracked{head, tracked.left_hand, tracked.right_hand};
}

} // namespace viewer
