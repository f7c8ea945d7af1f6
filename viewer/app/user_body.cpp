#include "viewer/app/user_body.h"

#include "viewer/displays/views.h"

namespace viewer {

Tracked UserBody::before_desktop(gi::dmat4 const& room_from_head) const
{
    return hands_.with_head(
        {gi::dvec3(room_from_head[3]), glm::normalize(glm::quat_cast(glm::dmat3(room_from_head)))});
}

Tracked UserBody::in_room(Display const& display, std::size_t of_user, Tracked const& tracked) const
{
    if (of_user >= display.users.size()) return tracked;
    User const& user = display.users[of_user];
    RoomPose head = tracked.head.value_or(resting_head(user));
    head.position = eyes_of(user, head).middle;
    bool const by_keys =
        user.tracker >= 0 && display.trackers[std::size_t(user.tracker)].type == DisplayTrackerType::fake;
    if (by_keys) return hands_.with_head(head);
    Tracked body = tracked;
    body.head = head;
    return body;
}

void UserBodies::put(Display const& display, std::function<Tracked(std::size_t user)> const& tracked,
                     double seconds, Viewpoint& at)
{
    for (auto& [user, body] : bodies_) {
        Tracked now = body.in_room(display, user, tracked(user));
        body.stand(now, at.world_from_room, seconds);
        if (user > at.others.size()) at.others.resize(user);
        (user == 0 ? at.tracked : at.others[user - 1]) = now;
    }
}

} // namespace viewer
