#pragma once
// What one path brings to its pixel.

#include "gi/core/math.h"

#include <array>
#include <cstdint>

namespace gi {

/// Longest chain of surfaces a path may visit, delta lobes included. Reaching it is counted.
inline constexpr int kLongestPath = 1024;

/// Where one pixel of some takes indirect light, see gi/render/interleaving.h.
enum class IndirectTurn : std::uint8_t {
    each,  ///< it took what it takes
    taken, ///< it took that of its neighbours, too
    waits  ///< it took none
};

struct PathSample {
    std::array<vec3, 3> radiance{vec3{0}, vec3{0}, vec3{0}}; ///< L0, L1, L2
    vec3 albedo{0}, normal{0}, position{0};                  ///< at the first surface
    float depth = 0;                                         ///< m along the camera's axis
    bool hit = false;
    bool near_moving = false; ///< without what moves it might be another; only where the tracer was asked to say
    IndirectTurn turn = IndirectTurn::each; ///< of its broad lobes
};

struct PathCounts {
    std::uint64_t nearest_rays = 0, shadow_rays = 0, cut_paths = 0, invalid_paths = 0;

    PathCounts& operator+=(PathCounts const& o)
    {
        nearest_rays += o.nearest_rays;
        shadow_rays += o.shadow_rays;
        cut_paths += o.cut_paths;
        invalid_paths += o.invalid_paths;
        return *this;
    }
};

} // namespace gi
