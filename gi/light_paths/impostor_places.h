#pragma once
// Chooses places of distance impostors, so that together they see all surfaces that light can reach.
//
// Random walks of exact rays from the lights and the cameras (from all surfaces, where there are neither) meet
// surfaces with the density of diffuse light: uniform over the area of a closed room, and denser where the cameras
// are than in the far parts of a large world. With a focus, half of the light from afar goes there, and flights
// into the open are as long as it is: a place high above a room's roof would show its walls in a few texels.
// Places between two surfaces of a walk are candidates. They are chosen one by one: each time the one that adds
// most to sum over surface points of max over chosen places of
//     visible * cos(normal, place) / (1 + distance / mean free path) * clearance
//         / (clearance + mean free path / 8),
// so that points which no place sees count most, then those that are seen badly. Clearance is the distance of the
// place to the nearest surface, as a few rays tell. This greedy choice reaches at least 1 - 1/e of what is
// possible (Nemhauser et al. 1978).

#include "gi/light_paths/settings.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/render_settings.h"

#include <vector>

namespace gi {

struct ImpostorPlacement {
    std::uint32_t count = 32;  ///< most places
    float least_gain = 0.002f; ///< of the sum; a place that adds less is not taken, nor are later ones
    std::uint32_t candidates = 256, points = 1024;
    Bounds focus{}; ///< what cameras show, if the world is much larger: places are near to it; else empty
};

/// @return  centres in the world's coordinates, m; the same for the same world. Empty if the world is, or if rays
/// meet nothing. Throws Interrupted.
std::vector<vec3> place_impostors(World const& world, ExactVisibility const& visibility,
                                  ImpostorPlacement const& settings = {},
                                  BuildStop const& stop = BuildStop(nullptr));

inline constexpr std::size_t kMostImpostors = 256;

/// Places that a user gives, "x,y,z;x,y,z", m in the scene's coordinates. Throws InputError unless they are 1 to
/// kMostImpostors places of three finite numbers.
std::vector<dvec3> read_impostor_places(std::string const& text);

/// How many there are, at most.
int impostor_count(PhotonSettings const& settings);

} // namespace gi
