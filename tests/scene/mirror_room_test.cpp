// The room with the mirror and the avatar that the project makes itself.

#include "gi/scene/generate/generate.h"
#include "gi/scene/load/load.h"
#include "gi/scene/motion/avatar_joints.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

/// Nearest triangle on a ray, by looking at all of them.
std::pair<double, std::uint32_t> nearest(World const& world, dvec3 from, dvec3 way)
{
    std::pair<double, std::uint32_t> best{1e9, ~0u};
    for (std::uint32_t t = 0; t < world.surfaces.size(); ++t) {
        dvec3 const corner(world.surfaces[t].corner), e1(world.surfaces[t].edge1), e2(world.surfaces[t].edge2);
        dvec3 const p = glm::cross(way, e2), q = glm::cross(from - corner, e1);
        double const det = glm::dot(e1, p), u = glm::dot(from - corner, p) / det, v = glm::dot(way, q) / det;
        double const far = glm::dot(e2, q) / det;
        if (det != 0 && u >= 0 && v >= 0 && u + v <= 1 && far > 0 && far < best.first) best = {far, t};
    }
    return best;
}

TEST(MirrorRoom, TheCameraStandsBeforeTheMirror)
{
    World const world = world_of(generate_mirror());
    Camera const& camera = world.cameras.at(0);
    dvec3 const from(camera.world_from_camera[3]);
    EXPECT_NEAR(from.y, 1.6, 1e-6) << "the eyes of who stands on the floor";
    auto const [far, triangle] = nearest(world, from, -dvec3(camera.world_from_camera[2]));
    EXPECT_LT(far, 1.7);
    Material const& seen = world.materials[world.triangle_material[triangle]];
    EXPECT_EQ(seen.metallic, 1);
    EXPECT_EQ(seen.roughness, 0);
    EXPECT_NEAR(nearest(world, from, {0, -1, 0}).first, 1.6, 1e-5);
}

TEST(MirrorRoom, IsClosedAndLit)
{
    World const world = world_of(generate_mirror());
    EXPECT_FALSE(world.emitters.empty());
    dvec3 const middle{0, 1.4, 0.5};
    for (int i = 0; i < 2000; ++i) { // directions on a spiral
        double const z = 1 - (2 * i + 1) / 2000.0, angle = 2.399963 * i, r = std::sqrt(1 - z * z);
        EXPECT_LT(nearest(world, middle, {r * std::cos(angle), z, r * std::sin(angle)}).first, 5) << i;
    }
}

TEST(GeneratedAvatar, HasTheJointsThatTrackersNeed)
{
    Scene const scene = generate_avatar();
    AvatarJoints const joints = find_avatar_joints(scene);
    EXPECT_EQ(scene.nodes[std::size_t(joints.head)].name, "head");
    for (Mesh const& mesh : scene.meshes) {
        ASSERT_EQ(mesh.weights.size(), mesh.positions.size()) << mesh.name;
        for (vec4 const w : mesh.weights) EXPECT_NEAR(w.x + w.y + w.z + w.w, 1, 1e-5);
    }
}

/// Its ring's sides face away from the metal, its spheres outwards.
TEST(GeneratedRing, FacesAndLights)
{
    World const world = world_of(generate_ring());
    EXPECT_EQ(world.emitters.size(), 2u);
    std::size_t ring = 0;
    for (Surface const& s : world.surfaces) {
        if (world.materials[s.material].metallic < 1) continue;
        ++ring;
        vec3 const normal = glm::normalize(glm::cross(s.edge1, s.edge2)),
                   at = s.corner + (s.edge1 + s.edge2) / 3.0f;
        vec3 out = at - vec3{0.34f, at.y, -0.42f};
        float const radius = glm::length(out);
        out /= radius;
        float const facing =
            std::abs(normal.y) > 0.5f ? normal.y : (radius > 0.1925f ? 1.0f : -1.0f) * glm::dot(normal, out);
        EXPECT_GT(facing, 0.99f);
    }
    EXPECT_EQ(ring, 768u);
}

TEST(GeneratedAvatar, AllAreBuiltIn)
{
    Report report;
    EXPECT_EQ(load_scene("ring", report).nodes.size(), generate_ring().nodes.size());
    EXPECT_EQ(parse_scene_file("models: [{generate: {kind: ring}}]", "", "test", report).cameras.size(), 1u);
    EXPECT_EQ(load_scene("mirror", report).nodes.size(), generate_mirror().nodes.size());
    EXPECT_EQ(load_scene("avatar", report).skins.size(), 1u);
    EXPECT_EQ(parse_scene_file("models: [{generate: {kind: mirror}}]", "", "test", report).cameras.size(), 1u);
    EXPECT_EQ(parse_scene_file("models: [{generate: {kind: avatar}}]", "", "test", report).skins.size(), 1u);
}

} // namespace
} // namespace gi::test
