// The summary says what is in the scene.

#include "gi/scene/model/summary.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

std::string line(SceneSummary const& summary, std::string const& what)
{
    for (SummaryLine const& l : text_lines(summary))
        if (l.what == what) return l.value;
    ADD_FAILURE() << "no line '" << what << "'";
    return {};
}

TEST(Summary, CountsEverything)
{
    Scene scene;
    add_quad(scene, {0, 0, 0}, {2, 0, 0}, {0, 0, 3}, add_material(scene, emitter(vec3{1})));
    add_quad(scene, {0, 1, 0}, {2, 0, 0}, {0, 0, 3}, add_material(scene, glass(1.5f, false)));
    add_material(scene, mirror(vec3{1}));
    add_light(scene, Light{});
    set_environment(scene, vec3{1});
    scene.textures.texels.resize(std::size_t(1) << 18);
    scene.textures.textures = {Texture{0, 512, 512}};
    scene.cameras.resize(1);
    scene.cameras[0].name = "front";
    Node eye;
    eye.camera = 0;
    scene.nodes.push_back(eye);
    scene.skins.resize(1);
    scene.skins[0].joints = {0, 1};
    scene.skins[0].inverse_bind.resize(2);
    scene.meshes[0].morph_targets.resize(3);
    Animation clip;
    clip.name = "Walk";
    clip.duration_s = 1.5;
    scene.animations = {clip, clip};
    scene.animations[1].name = "Run";
    scene.playbacks = {{1, 0, 1, true}};

    SceneSummary const s = summarise(world_of(scene));
    EXPECT_EQ(line(s, "nodes"), "4");
    EXPECT_EQ(line(s, "meshes"), "2 (2 placed)");
    EXPECT_EQ(line(s, "triangles"), "4");
    EXPECT_EQ(line(s, "vertices"), "8");
    EXPECT_EQ(line(s, "bounds"), "0, 0, 0 to 2, 1, 3 m");
    EXPECT_EQ(line(s, "materials"), "3 (1 matt, 0 coated, 0 Phong, 0 metal, 1 mirror, 1 glass; 1 emit)");
    EXPECT_EQ(line(s, "their names"), "0 'm1', 1 'm2', 2 'm3'");
    EXPECT_EQ(line(s, "textures"), "1 (1.0 MiB)");
    EXPECT_EQ(line(s, "punctual lights"), "1: 0 point at 0, 0, 0 m");
    EXPECT_EQ(line(s, "emissive triangles"), "2 (6 m2; materials 0 'm1')");
    EXPECT_EQ(line(s, "environment map"), "16 x 8");
    EXPECT_EQ(line(s, "light on upward faces"), "3.142, 3.142, 3.142 W/m2");
    EXPECT_EQ(line(s, "on downward faces"), "3.142, 3.142, 3.142 W/m2");
    EXPECT_EQ(line(s, "on the brightest").substr(0, 24), "3.142, 3.142, 3.142 W/m2");
    EXPECT_EQ(line(s, "smooth part of the map"),
              "100 % of its squared radiance (spherical harmonics to degree 2)");
    EXPECT_EQ(line(s, "cameras"), "front");
    EXPECT_EQ(line(s, "skins"), "2 joints");
    EXPECT_EQ(line(s, "morph targets"), "3");
    EXPECT_EQ(line(s, "clips"), "Walk (1.5 s), Run (1.5 s)");
    EXPECT_EQ(line(s, "playing"), "Run");
    EXPECT_EQ(s.triangles, 4u);
    ASSERT_TRUE(s.bounds_m && s.environment);
    EXPECT_EQ(s.bounds_m->second, (dvec3{2, 1, 3}));
    EXPECT_EQ(s.materials.all, s.materials.matt + s.materials.mirror + s.materials.glass);
    EXPECT_EQ(s.texture_bytes, std::size_t(1) << 20);
    EXPECT_DOUBLE_EQ(s.emissive_area_m2, 6);
    EXPECT_NEAR(s.environment->up.x, 3.14159, 1e-4);
    EXPECT_NEAR(s.environment->smooth_share, 1, 1e-6);
    EXPECT_EQ(s.clips.at(1).name, "Run");
    EXPECT_EQ(s.playing.at(0).weight, 1);
}

TEST(Summary, EmptyScenesHaveOneToo)
{
    SceneSummary const s = summarise(world_of({}));
    EXPECT_EQ(line(s, "triangles"), "0");
    EXPECT_EQ(line(s, "cameras"), "none");
    EXPECT_EQ(line(s, "environment map"), "none");
}

} // namespace
} // namespace gi::test
