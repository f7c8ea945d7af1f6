#pragma once
// Feet of a user whose feet nobody tracks: they stand on the floor until he has moved away from them, and then
// step after him, one at a time. Made where orders are made, so that orders have feet like any tracked body.
//
// A foot belongs below its hip, and while its user walks half a step's time ahead of that. It stands where it is,
// in the world, until it is farther from there than kStray_m or kStray_rad; then it swings there in kSwing_s (less
// at more than 1.3 m/s), on a sine's arc and with a smooth start and end, unless the other one does. Who stands
// still for kStill_s brings his feet together again. At more than kGlide_m_s, and after a jump, feet are below the
// hips.

#include "viewer/protocol/frame_command.h"

namespace viewer {

/// Where the feet of somebody who stands are against his head, m. Of an avatar, OwnAvatar::stance.
struct Stance {
    gi::dvec3 head_joint_in_head{0, -0.08, 0.09};           ///< from the middle between the eyes
    gi::dvec3 left_foot{-0.1, 0, 0}, right_foot{0.1, 0, 0}; ///< soles from below the head joint; -Z = as he faces

    bool operator==(Stance const&) const = default;
};

/// Somebody who has an avatar, as far as orders depend on it.
struct AvatarOfUser {
    std::size_t user = 0;         ///< of the display
    std::optional<Stance> stance; ///< none of an avatar without legs
};

class Footsteps {
public:
    static constexpr double kStray_m = 0.1, kStray_rad = 0.45, kSwing_s = 0.3, kStill_s = 0.5, kGlide_m_s = 4,
                            kJump_m = 0.6;

    explicit Footsteps(Stance const& stance) : stance_(stance) {}

    /// Adds the feet that the body has not: on the floor of the room (y = 0) or, of one that swings, above it.
    /// Without a head there are none, and it begins anew. Feet that stand stay where they are in the world,
    /// to rounding where the room moves.
    /// @param body  in the room, finite  @param world_from_room  upright, with any scale  @param seconds  since
    /// the last step
    void step(Tracked& body, gi::dmat4 const& world_from_room, double seconds);

private:
    /// On the floor: what is at height 0, turned about the vertical.
    struct Print {
        gi::dvec3 at{0}; ///< m
        double yaw_rad = 0;
    };
    struct Foot {
        Print stands; ///< in the world; of one that swings, where it stood
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
