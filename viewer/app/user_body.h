#pragma once
// The body of a user, as an avatar has it: what is tracked, and what stands in for what is not.

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
    /// @param stance  of his avatar; none = his feet are not asked for
    explicit UserBody(std::optional<Stance> const& stance)
    {
        if (stance) feet_.emplace(*stance);
    }
    /// Keys raise the hands of who has no others. @param seconds  since the last step
    void step(Controls const& controls, double seconds)
    {
        hands_.step(controls.raises_left(), controls.raises_right(), seconds);
    }
    /// Before a desktop: the camera is the head. @param room_from_head  rigid
    Tracked before_desktop(gi::dmat4 const& room_from_head) const;
    /// In a display, with the head that its walls are drawn for: the middle between the eyes of the tracked head,
    /// or of the one that rests. Keys raise the hands of a user whose tracker is keyboard and mouse.
    Tracked in_room(Display const& display, std::size_t user, Tracked const& tracked) const;

    /// Adds the feet that nobody tracks (footsteps.h). @param seconds  since the last call
    void stand(Tracked& body, gi::dmat4 const& world_from_room, double seconds)
    {
        if (feet_) feet_->step(body, world_from_room, seconds);
    }

private:
    KeyHands hands_;
    std::optional<Footsteps> feet_;
};

/// Of all users who have avatars.
class UserBodies {
public:
    explicit UserBodies(std::vector<AvatarOfUser> const& avatars)
    {
        for (AvatarOfUser const& a : avatars) bodies_.emplace(a.user, a.stance);
    }
    /// The first user's; null where he has no avatar.
    UserBody* first() { return bodies_.contains(0) ? &bodies_.at(0) : nullptr; }
    void step(Controls const& controls, double seconds)
    {
        for (auto& [user, body] : bodies_) body.step(controls, seconds);
    }
    /// In a display: what an order has of each. @param tracked  of a user  @param seconds  since the last call
    void put(Display const& display, std::function<Tracked(std::size_t user)> const& tracked, double seconds,
             Viewpoint& at);

private:
    std::map<std::size_t, UserBody> bodies_;
};

} // namespace viewer
