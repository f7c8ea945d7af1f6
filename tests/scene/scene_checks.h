#pragma once
// What must hold for every scene that the project makes itself.

#include "gi/core/rng.h"
#include "gi/scene/model/scene.h"

#include <bit>
#include <gtest/gtest.h>

namespace gi::test {

inline std::size_t count_triangles(Scene const& scene)
{
    std::size_t n = 0;
    for (Node const& node : scene.nodes)
        for (std::int32_t const m : node.meshes) n += scene.meshes[std::size_t(m)].triangles.size();
    return n;
}

inline Material const& material_of(Scene const& scene, Mesh const& mesh)
{
    return scene.materials.at(std::size_t(mesh.material));
}

inline Mesh const& find_mesh(Scene const& scene, std::string const& name)
{
    for (Mesh const& m : scene.meshes)
        if (m.name == name) return m;
    throw std::runtime_error("no mesh '" + name + "'");
}

/// Geometry and texels; the same for the same scene.
inline std::uint64_t hash(Scene const& scene)
{
    std::uint64_t h = 0;
    auto const add = [&](std::uint64_t v) { h = mix_bits(h ^ v); };
    for (Mesh const& m : scene.meshes) {
        for (vec3 const p : m.positions)
            for (int c = 0; c < 3; ++c) add(std::bit_cast<std::uint32_t>(p[c]));
        for (vec3 const n : m.normals)
            for (int c = 0; c < 3; ++c) add(std::bit_cast<std::uint32_t>(n[c]));
        for (uvec3 const t : m.triangles)
            for (int c = 0; c < 3; ++c) add(t[c]);
    }
    for (Rgba8 const t : scene.textures.texels) add(std::bit_cast<std::uint32_t>(t));
    return h;
}

/// Indices in range, attributes as long as the positions, everything finite, normals unit and on the side of the
/// triangle's front, no triangle without area.
inline void expect_sound(Scene const& scene)
{
    ASSERT_EQ(scene.materials.size(), scene.material_names.size());
    for (Mesh const& m : scene.meshes) {
        SCOPED_TRACE(m.name);
        ASSERT_GE(m.material, 0);
        ASSERT_LT(std::size_t(m.material), scene.materials.size());
        std::size_t const n = m.positions.size();
        ASSERT_TRUE(m.normals.empty() || m.normals.size() == n);
        ASSERT_TRUE(m.uv0.empty() || m.uv0.size() == n);
        ASSERT_TRUE(m.joints.empty() || (m.joints.size() == n && m.weights.size() == n));
        std::size_t bad_positions = 0, bad_normals = 0, bad_uv = 0, bad_weights = 0, bad_triangles = 0, turned = 0;
        for (vec3 const p : m.positions) bad_positions += !all_finite(p);
        for (vec3 const v : m.normals) bad_normals += !(std::abs(glm::length(v) - 1) < 1e-4f);
        for (vec2 const v : m.uv0) bad_uv += !std::isfinite(v.x) || !std::isfinite(v.y);
        for (vec4 const w : m.weights) bad_weights += !(std::abs(w.x + w.y + w.z + w.w - 1) < 1e-5f);
        for (uvec3 const t : m.triangles) {
            ASSERT_LT(std::max({t.x, t.y, t.z}), n);
            vec3 const g = glm::cross(m.positions[t.y] - m.positions[t.x], m.positions[t.z] - m.positions[t.x]);
            bad_triangles += !(glm::length(g) > 0);
            if (!m.normals.empty()) turned += !(glm::dot(g, m.normals[t.x] + m.normals[t.y] + m.normals[t.z]) > 0);
        }
        EXPECT_EQ(bad_positions, 0u);
        EXPECT_EQ(bad_normals, 0u);
        EXPECT_EQ(bad_uv, 0u);
        EXPECT_EQ(bad_weights, 0u);
        EXPECT_EQ(bad_triangles, 0u);
        EXPECT_EQ(turned, 0u) << "of " << m.triangles.size() << " triangles";
    }
    for (std::size_t i = 0; i < scene.nodes.size(); ++i) {
        Node const& node = scene.nodes[i];
        ASSERT_LT(node.parent, std::int32_t(i));
        for (std::int32_t const m : node.meshes) ASSERT_LT(std::size_t(m), scene.meshes.size());
    }
}

} // namespace gi::test
