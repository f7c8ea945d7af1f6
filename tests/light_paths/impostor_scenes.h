#pragma once
// Scenes of the tests of distance impostors.

#include "gi/core/rng.h"
#include "gi/scene/shading/warp.h"
#include "tests/light_paths/impostor_accuracy.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {

inline World box_room(vec3 low, vec3 high)
{
    Scene scene;
    add_box(scene, low, high, add_material(scene, lambert(vec3{0.5f})), true);
    return world_of(scene);
}

inline vec3 random_direction(Pcg32& rng)
{
    float const z = 1 - 2 * rng.uniform(), r = std::sqrt(std::max(0.0f, 1 - z * z)),
                turn = 2 * kPi * rng.uniform();
    return {r * std::cos(turn), r * std::sin(turn), z};
}

/// Cosine-distributed rays that leave random surface points, of the sides that their normals show.
inline std::vector<PathQuery> rays_from_surfaces(World const& world, std::size_t n, std::uint64_t seed)
{
    std::vector<double> area;
    double sum = 0;
    for (Surface const& s : world.surfaces)
        area.push_back(sum += double(glm::length(glm::cross(s.edge1, s.edge2))));
    Pcg32 rng(seed, 1);
    std::vector<PathQuery> rays;
    for (std::size_t i = 0; i < n; ++i) {
        auto const at = std::ranges::upper_bound(area, rng.uniform_double() * sum);
        Surface const& s = world.surfaces[std::min(std::size_t(at - area.begin()), area.size() - 1)];
        vec2 const w = square_to_triangle(rng.uniform2());
        vec3 const normal = shading_detail::triangle_normal(s);
        vec3 const d = Frame::about(normal).to_world(square_to_cosine_hemisphere(rng.uniform2()));
        rays.push_back({{.ray = {s.corner + w.x * s.edge1 + w.y * s.edge2 + s.clearance * normal, d},
                         .seed = std::uint32_t(i)},
                        std::uint32_t(&s - world.surfaces.data())});
    }
    return rays;
}

} // namespace gi::test
