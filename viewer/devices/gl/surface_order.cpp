#include "viewer/devices/gl/surface_order.h"

#include <algorithm>
#include <span>

namespace viewer {
namespace {

constexpr std::uint32_t kClusterTriangles = 512, kMostClusters = 4096; // of a mesh

/// Sorts triangles so that `size` consecutive ones are near each other.
void sort_by_place(gi::World const& w, std::span<std::uint32_t> triangles, std::uint32_t size,
                   std::stop_token const& stop)
{
    if (stop.stop_requested()) return;
    if (triangles.size() <= size) {
        std::ranges::sort(triangles); // near ones share vertices
        return;
    }
    auto const middle_of = [&](std::uint32_t t) {
        gi::uvec3 const c = w.triangles[t];
        return w.positions[c.x] + w.positions[c.y] + w.positions[c.z];
    };
    gi::Bounds box;
    for (std::uint32_t const t : triangles) box = gi::joined(box, {middle_of(t), middle_of(t)});
    gi::vec3 const extent = box.high - box.low;
    int const axis = extent.x >= extent.y && extent.x >= extent.z ? 0 : extent.y >= extent.z ? 1 : 2;
    std::size_t const half = (triangles.size() / size + 1) / 2 * size;
    std::ranges::nth_element(triangles, triangles.begin() + std::ptrdiff_t(half),
                             [&](std::uint32_t a, std::uint32_t b) {
                                 return std::pair(middle_of(a)[axis], a) < std::pair(middle_of(b)[axis], b);
                             });
    sort_by_place(w, triangles.first(half), size, stop);
    sort_by_place(w, triangles.subspan(half), size, stop);
}

} // namespace

SurfaceOrder order_surfaces(gi::ShownScene const& scene, bool moves, std::stop_token const& stop)
{
    gi::World const& w = *scene.world;
    auto const begin = moves ? w.static_triangles : 0u,
               end = moves ? std::uint32_t(w.triangles.size()) : w.static_triangles;
    std::vector<std::vector<std::uint32_t>> of_material(scene.materials->size());
    for (std::uint32_t t = begin; t < end; ++t) of_material[w.triangle_material[t]].push_back(t);
    SurfaceOrder order;
    order.triangles.reserve(end - begin);
    std::uint32_t const size = std::max(kClusterTriangles, (end - begin) / kMostClusters);
    for (std::uint32_t material = 0; material < of_material.size() && !stop.stop_requested(); ++material) {
        std::vector<std::uint32_t>& triangles = of_material[material];
        if (triangles.empty()) continue;
        if (!moves) sort_by_place(w, triangles, size, stop);
        auto const first = std::uint32_t(order.triangles.size()), count = std::uint32_t(triangles.size());
        for (std::uint32_t const t : triangles)
            order.triangles.push_back(moves ? scene.moving->triangles[t - begin] : w.triangles[t]);
        SurfacePart& part = order.parts.emplace_back(SurfacePart{material, {first, count}, {}});
        if (moves) {
            part.clusters.push_back({part.triangles, {gi::vec3(-gi::kInf), gi::vec3(gi::kInf)}});
            continue;
        }
        for (std::uint32_t done = 0; done < count; done += size) {
            SurfaceCluster c{{first + done, std::min(size, count - done)}, {}};
            for (std::uint32_t t = c.triangles.first; t < c.triangles.first + c.triangles.count; ++t)
                for (int k = 0; k < 3; ++k) {
                    gi::vec3 const p = w.positions[order.triangles[t][k]];
                    c.bounds = gi::joined(c.bounds, {p, p});
                }
            part.clusters.push_back(c);
        }
    }
    return order;
}

} // namespace viewer
