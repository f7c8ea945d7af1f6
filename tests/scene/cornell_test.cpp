// The Cornell box against its published numbers.

#include "gi/scene/generate/generate.h"
#include "gi/scene/model/projection.h"
#include "gi/scene/model/spectrum.h"
#include "tests/scene/scene_checks.h"

#include <array>

namespace gi::test {
namespace {

vec3 front(Mesh const& m, uvec3 t)
{
    return glm::normalize(glm::cross(m.positions[t.y] - m.positions[t.x], m.positions[t.z] - m.positions[t.x]));
}

vec3 middle(Mesh const& m, uvec3 t) { return (m.positions[t.x] + m.positions[t.y] + m.positions[t.z]) / 3.0f; }

double area(Mesh const& m)
{
    double sum = 0;
    for (uvec3 const t : m.triangles)
        sum += 0.5 * double(glm::length(
                         glm::cross(m.positions[t.y] - m.positions[t.x], m.positions[t.z] - m.positions[t.x])));
    return sum;
}

TEST(Cornell, IsSound)
{
    Scene const scene = generate_cornell();
    expect_sound(scene);
    EXPECT_EQ(count_triangles(scene), 2u * (1 + 4 + 1 + 3 + 5 + 5));
    EXPECT_EQ(hash(scene), hash(generate_cornell()));
}

TEST(Cornell, HasThePublishedMeasures)
{
    Scene const scene = generate_cornell();
    EXPECT_NEAR(area(find_mesh(scene, "lamp")), 0.130 * 0.105, 1e-7);
    EXPECT_NEAR(area(find_mesh(scene, "ceiling")), 0.556 * 0.5592 - 0.130 * 0.105, 1e-6);
    EXPECT_NEAR(area(find_mesh(scene, "right wall")), 0.5488 * 0.5592, 1e-6);
    EXPECT_NEAR(area(find_mesh(scene, "floor")), 0.5592 * 0.5 * (0.5528 + 0.5496), 1e-6);
    for (vec3 const p : find_mesh(scene, "lamp").positions) EXPECT_FLOAT_EQ(p.y, 0.5488f);
    float short_top = 0, tall_top = 0;
    for (vec3 const p : find_mesh(scene, "short block").positions) short_top = std::max(short_top, p.y);
    for (vec3 const p : find_mesh(scene, "tall block").positions) tall_top = std::max(tall_top, p.y);
    EXPECT_FLOAT_EQ(short_top, 0.165f);
    EXPECT_FLOAT_EQ(tall_top, 0.330f);
}

TEST(Cornell, FrontsFaceTheLight)
{
    Scene const scene = generate_cornell();
    vec3 const inside{0.278f, 0.27f, 0.28f};
    for (char const* const name : {"floor", "ceiling", "lamp", "back wall", "right wall", "left wall"})
        for (uvec3 const t : find_mesh(scene, name).triangles) {
            Mesh const& m = find_mesh(scene, name);
            EXPECT_GT(glm::dot(front(m, t), inside - middle(m, t)), 0) << name;
        }
    for (uvec3 const t : find_mesh(scene, "lamp").triangles)
        EXPECT_NEAR(front(find_mesh(scene, "lamp"), t).y, -1, 1e-6);
    for (char const* const name : {"short block", "tall block"}) {
        Mesh const& m = find_mesh(scene, name);
        vec3 center{0};
        for (vec3 const p : m.positions) center += p / float(m.positions.size());
        center.y *= 0.5f;
        for (uvec3 const t : m.triangles) EXPECT_GT(glm::dot(front(m, t), middle(m, t) - center), 0) << name;
    }
}

TEST(Cornell, IsNotMirrored)
{
    Scene const scene = generate_cornell();
    ASSERT_EQ(scene.cameras.size(), 1u);
    CameraRays const camera = camera_rays(scene.cameras[0], 100, 100, dvec3{0});
    auto const column = [&](char const* name) {
        Mesh const& m = find_mesh(scene, name);
        vec3 center{0};
        for (vec3 const p : m.positions) center += p / float(m.positions.size());
        return Projection(camera)(center).x;
    };
    EXPECT_LT(column("left wall"), 20);
    EXPECT_GT(column("right wall"), 80);
    EXPECT_LT(column("tall block"), column("short block"));
    vec3 const red = material_of(scene, find_mesh(scene, "left wall")).base_color;
    vec3 const green = material_of(scene, find_mesh(scene, "right wall")).base_color;
    EXPECT_GT(red.x, 4 * red.y);
    EXPECT_GT(green.y, 2 * green.x);
}

TEST(Cornell, CameraIsThePublishedOne)
{
    Camera const camera = generate_cornell().cameras.at(0);
    EXPECT_EQ(camera.name, "camera");
    EXPECT_NEAR(camera.yfov_rad, 2 * std::atan(0.0125 / 0.035), 1e-12);
    dvec3 const eye(camera.world_from_camera[3]), forward = -dvec3(camera.world_from_camera[2]);
    EXPECT_NEAR(glm::distance(eye, dvec3(0.278, 0.273, -0.8)), 0, 1e-12);
    EXPECT_NEAR(glm::distance(forward, dvec3(0, 0, 1)), 0, 1e-12);
}

TEST(Spectrum, ConstantIsWhiteAndBandsHaveTheirHue)
{
    std::array const one{1.0, 1.0};
    std::array const half{0.5};
    EXPECT_NEAR(glm::distance(to_rgb({400, 300, one}), vec3{1}), 0, 1e-6);
    EXPECT_NEAR(glm::distance(to_rgb({550, 1, half}), vec3{0.5f}), 0, 1e-6);
    std::array const short_waves{1.0, 1.0, 0.0, 0.0};
    std::array const long_waves{0.0, 0.0, 1.0, 1.0};
    vec3 const blue = to_rgb({400, 100, short_waves}), red = to_rgb({400, 100, long_waves});
    EXPECT_GT(blue.z, 2 * blue.x);
    EXPECT_GT(red.x, 2 * red.z);
}

TEST(Spectrum, CornellAlbedosAreReflectances)
{
    Scene const scene = generate_cornell();
    for (Material const& m : scene.materials) {
        EXPECT_LE(max_component(m.base_color), 1);
        EXPECT_EQ(m.specular, 0);
    }
    // The white paint reflects 0.70 to 0.77 wherever the eye sees.
    vec3 const white = material_of(scene, find_mesh(scene, "floor")).base_color;
    EXPECT_NEAR(luminance(white), 0.74, 0.02);
    vec3 const lamp = material_of(scene, find_mesh(scene, "lamp")).emission;
    EXPECT_GT(lamp.x, lamp.y);
    EXPECT_GT(lamp.y, lamp.z);
    // The eye weighs the published 8 (500 nm) to 18.4 (700 nm) by its own sensitivity.
    EXPECT_NEAR(luminance(lamp), 12.5, 1);
}

} // namespace
} // namespace gi::test
