#include "viewer/engine/same_surfaces.h"

#include "gi/filter/reused_light.h"
#include "gi/scene/model/projection.h"

#include <cmath>
#include <tbb/parallel_for.h>

namespace viewer {

std::vector<std::uint32_t> same_surfaces(gi::Picture const& here, gi::Picture const& there,
                                         gi::CameraRays const& rays, gi::dvec3 origin)
{
    constexpr float kNear = 0.02f; // of the distance
    std::vector<std::uint32_t> same(here.pixels(), gi::kOwnLight);
    gi::Layer const* const from = here.find("position");
    gi::Layer const* const to = there.find("position");
    gi::Layer const* const normal = here.find("normal");
    if (from == nullptr || to == nullptr || normal == nullptr) return same;
    gi::Projection const project(rays);
    tbb::parallel_for(0, here.height, [&](int y) {
        for (int x = 0; x < here.width; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(here.width) + std::size_t(x);
            if (gi::rgb(*normal, i) == gi::vec3{0}) continue;
            gi::vec3 const point = gi::rgb(*from, i), at = project(gi::vec3(gi::dvec3(point) - origin));
            if (!(at.z > 0) ||
                !(at.x >= 0 && at.x < float(there.width) && at.y >= 0 && at.y < float(there.height)))
                continue;
            std::size_t const j = std::size_t(at.y) * std::size_t(there.width) + std::size_t(at.x);
            if (glm::distance(gi::rgb(*to, j), point) <= kNear * at.z) same[i] = std::uint32_t(j);
        }
    });
    return same;
}

} // namespace viewer
