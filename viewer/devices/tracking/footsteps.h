#pragma once
// Simulated feet of a user whose feet are not tracked: they stand on the floor until the user has moved away,
// and then step to follow, one at a time. They are generated together with frame commands,
// which hold them like tracked bodies.
//
// A foot's target is below its hip and, while the user walks, ahead of it by half a step's time. The foot stands
// fixed in the world until it is farther from its target than kStray_m or kStray_rad. Then it swings to the target
// in kSwing_s (less above 1.3 m/s), along a sine arc with smooth start and end, unless the other foot is swinging.
// After standing still for kStill_s, the user brings the feet together. Above kGlide_m_s, and after a jump, feet
// are placed below the hips.

#include "viewer/protocol/frame_command.h"

namespace viewer {

/// Positions of a standing user's feet relative to the head, m. For an avatar, see OwnAvatar::stance.
struct Stance {
    gi::dvec3 head_joint_in_head{0, -0.08, 0.09}; ///< from the midpoint between the eyes
    /// Soles, from the point below the head joint; -Z = forward.
    gi::dvec3 left_foot{-0.1, 0, 0}, right_foot{0.1, 0, 0};

    bool operator==(Stance const&) const = default;
};

/// A user with an avatar: the data that frame commands depend on.
struct AvatarOfUser {
    std::size_t user = 0;         ///< index in the display
    std::optional<Stance> stance; ///< none for an avatar without legs
};

class Footsteps {
public:
    static constexpr double kStray_m = 0.1, kStray_rad = 0.45, kSwing_s = 0.3, kStill_s = 0.5, kGlide_m_s = 4,
                            kJump_m = 0.6;

    explicit Footsteps(Stance const& stance) : stance_(stance) {}

    /// Adds the missing feet to a body: on the floor of the room (y = 0), or above it while swinging.
    /// Without a head there are none, and the simulation restarts. Standing feet stay fixed in the world,
    /// up to rounding if the room moves.
    /// @param body  in the room, finite  @param world_from_room  upright, with any scale
    /// @param seconds  since the last step
    void step(Tracked& body, gi::dmat4 const& world_from_room, double seconds);

private:
    /// A foot's pose on the floor: position at height 0, and yaw.
    struct Print {
        gi::dvec3 at{0}; ///< m
        double yaw_rad = 0;
    };
    struct Foot {
        Print stands; ///< in the world; of a swinging foot, where it stood before
        bool swings = false;
        double phase = 0; ///< of the swing, 0 to 1
    };

    static Print moved(Print const& p, gi::dmat4 const& m);
    static double stray(Print const& from, Print const& to, bool is_still);
    static RoomPose swinging(Print const& from, Print const& to, double phase);
    void stand_at(Foot& foot, Print const& in_room, gi::dmat4 const& world_from_room) const;

    Stance stance_;
    std::array<Foot, 2> feet_;
    gi::dvec3 last_{0};     ///< below the head joint, in the world
    gi::dvec3 velocity_{0}; ///< in the room, smoothed, m/s
    double still_s_ = 0;
    bool begun_ = false;
};

} // namespace viewer
