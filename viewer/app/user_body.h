#pragma once
// A user's body for an avatar: tracked parts, and substitutes for those that are not tracked.

#include "viewer/app/controls.h"
#include "viewer/devices/tracking/footsteps.h"
#include "viewer/devices/tracking/key_hands.h"
#include "viewer/displays/display.h"
#include "viewer/engine/live/live_renderer.h"

#include <functional>
#include <map>

namespace viewer {

class UserBody {
public:
    /// @param stance  where the avatar's feet stand; none (an avatar without legs) = feet
    /// that are not tracked are not made up
    explicit UserBody(std::optional<Stance> const& stance)
    {
        if (stance) feet_.emplace(*stance);
    }
    /// Keys raise hands that are not tracked. @param seconds  since the last step
    void step(Controls const& controls, double seconds)
    {
        hands_.step(controls.raises_left(), controls.raises_right(), seconds);
    }
    /// Body at a desktop, where the camera is the head. @param room_from_head  rigid
    Tracked before_desktop(gi::dmat4 const& room_from_head) const;
    /// Body in a display. Its head is the one that the walls are drawn for: the midpoint between the eyes of the
    /// tracked head, or of the resting head. Keys raise the hands of a user tracked by keyboard and mouse.
    Tracked in_room(Display const& display, std::size_t user, Tracked const& tracked) const;

    /// Adds feet that are not tracked (footsteps.h). @param seconds  since the last call
    void stand(Tracked& body, gi::dmat4 const& world_from_room, double seconds)
    {
        if (feet_) feet_->step(body, world_from_room, seconds);
    }

private:
    KeyHands hands_;
    std::optional<Footsteps> feet_;
};

/// Bodies of all users with avatars.
class UserBodies {
public:
    explicit UserBodies(std::vector<AvatarOfUser> const& avatars)
    {
        for (AvatarOfUser const& a : avatars) bodies_.emplace(a.user, a.stance);
    }
    /// The first user's body; null without an avatar.
    UserBody* first() { return bodies_.contains(0) ? &bodies_.at(0) : nullptr; }
    void step(Controls const& controls, double seconds)
    {
        for (auto& [user, body] : bodies_) body.step(controls, seconds);
    }
    /// Writes the bodies of a display's users into the viewpoint. @param tracked  of a user
    /// @param seconds  since the last call
    void put(Display const& display, std::function<Tracked(std::size_t user)> const& tracked, double seconds,
             Viewpoint& at);

private:
    std::map<std::size_t, UserBody> bodies_;
};

} // namespace viewer
