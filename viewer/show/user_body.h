#pragma once
// The body of the first user, as an avatar has it: what is tracked, and what stands in for what is not.

#include "viewer/display/display.h"
#include "viewer/show/controls.h"
#include "viewer/tracking/key_hands.h"

namespace viewer {

class UserBody {
public:
    /// Keys raise the hands of who has no others. @param seconds  since the last step
    void step(Controls const& controls, double seconds)
    {
        hands_.step(controls.raises_left(), controls.raises_right(), seconds);
    }
    /// Before a desktop: the camera is the head. @param room_from_head  rigid
    Tracked before_desktop(gi::dmat4 const& room_from_head) const;
    /// In a display, with the head that its walls are drawn for: the middle between the eyes of the tracked head,
    /// or of the one that rests. Keys raise the hands of a user whose tracker is keyboard and mouse.
    Tracked in_room(Display const& display, Tracked const& tracked) const;

private:
    KeyHands hands_;
};

} // namespace viewer
