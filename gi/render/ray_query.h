#pragma once
// What exact rays ask and what they are answered, for CPU and CUDA, whichever tree they go through.

#include "gi/scene/model/camera.h"

#include <cstdint>

namespace gi {

inline constexpr std::uint32_t kNoTriangle = 0xffffffffu;

struct Hit {
    std::uint32_t triangle = kNoTriangle; ///< index into World::triangles, kNoTriangle = no hit
    vec2 barycentric{0};                  ///< weights of vertices 1 and 2
    float distance = kInf;
};

struct RayQuery {
    static constexpr float kFar = 1e30f;

    Ray ray;
    float reach = kFar;     ///< m; farther surfaces are ignored
    std::uint32_t seed = 0; ///< of the random decisions about partial coverage
    float start = 0;        ///< m; nearer surfaces are ignored
    /// 1: towards a lamp without extent; transmittance() lets it through panes.
    std::uint32_t to_lamp = 0;
};

/// Which geometry rays can hit.
enum class RayWorld : std::uint8_t {
    all,
    what_stays ///< static triangles only
};

} // namespace gi
