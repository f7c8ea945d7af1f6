#include "gi/methods/vpl/point_cloud.h"

#include "gi/core/rqmc.h"
#include "gi/scene/shading/shading_point.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {

PointCloud make_point_cloud(World const& world, std::uint64_t seed)
{
    PointCloud cloud;
    std::vector<double> area_up_to;
    area_up_to.reserve(world.surfaces.size());
    for (Surface const& s : world.surfaces) {
        double const area = 0.5 * double(glm::length(glm::cross(s.edge1, s.edge2)));
        cloud.area_m2 += std::isfinite(area) ? area : 0;
        area_up_to.push_back(cloud.area_m2);
    }
    if (!(cloud.area_m2 > 0)) return cloud;
    cloud.position.resize(PointCloud::kCount);
    cloud.normal.resize(PointCloud::kCount);
    WorldView const w = view(world);
    auto const stream = std::uint32_t(mix_bits(seed ^ 0x9012));
    tbb::parallel_for(0u, PointCloud::kCount, [&](std::uint32_t i) {
        vec4 const u = RqmcStream(stream, i).sample_together(0);
        double const wanted = double(u.x) * cloud.area_m2;
        auto const at = std::upper_bound(area_up_to.begin(), area_up_to.end(), wanted) - area_up_to.begin();
        auto const triangle = std::uint32_t(std::min<std::ptrdiff_t>(at, std::ptrdiff_t(area_up_to.size()) - 1));
        vec2 const weights = square_to_triangle({u.y, u.z});
        Surface const& s = world.surfaces[triangle];
        cloud.position[i] = s.corner + weights.x * s.edge1 + weights.y * s.edge2;
        bool const there = u.w < coverage(w, triangle, weights);
        cloud.normal[i] = there ? shading_detail::triangle_normal(s) : vec3{0};
    });
    return cloud;
}

} // namespace gi
