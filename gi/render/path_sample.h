#pragma once
// Contribution of one path to its pixel.

#include "gi/core/math.h"

#include <array>
#include <cstdint>

namespace gi {

/// Maximum number of surfaces along a path, delta lobes included. Paths cut there are counted.
inline constexpr int kLongestPath = 1024;

/// With interleaving, whether this pixel computed indirect light; see gi/render/interleaving.h.
enum class IndirectTurn : std::uint8_t {
    each,  ///< no interleaving: computed its own
    taken, ///< computed it for itself and its neighbours
    waits  ///< computed none; waits for a neighbour's
};

struct PathSample {
    std::array<vec3, 3> radiance{vec3{0}, vec3{0}, vec3{0}}; ///< L0, L1, L2
    vec3 albedo{0}, normal{0}, position{0};                  ///< at the first surface
    float depth = 0;                                         ///< m, along the camera's axis
    bool hit = false;
    /// True if the path could differ without dynamic geometry; set only if the tracer is asked for it.
    bool near_moving = false;
    IndirectTurn turn = IndirectTurn::each; ///< for its broad lobes
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
