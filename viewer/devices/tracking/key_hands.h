#pragma once
// Hands of a user who has only a keyboard: they hang in front of the hips,
// and rise beside the head while a key is held.

#include "viewer/protocol/frame_command.h"

namespace viewer {

class KeyHands {
public:
    /// @param seconds  since the last step; a hand takes 0.6 s from hip to head
    void step(bool left_rises, bool right_rises, double seconds);
    /// @param head  in the room; hands follow its yaw but not its pitch
    Tracked with_head(RoomPose const& head) const;

private:
    double left_ = 0, right_ = 0; ///< 0 = down, 1 = up
};

} // namespace viewer
