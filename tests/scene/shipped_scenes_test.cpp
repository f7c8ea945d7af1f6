// Real scenes and avatars: what is in the files arrives, nothing is lost on the way.

#include "gi/scene/load/load.h"
#include "tests/support/data.h"

#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace gi::test {
namespace {

struct Contents {
    std::string file;
    std::size_t triangles, materials, textures, cameras, skins, animations;
};

/// Counted in the files themselves by another program; textures: those that the materials use, occlusion apart.
std::vector<Contents> const kFiles{
    {"scenes/cornell_box/cornell_box.glb", 36, 8, 0, 1, 0, 0},
    {"scenes/cornell_box/cornell_box_closed.glb", 38, 8, 0, 1, 0, 0},
    {"scenes/veach_bidir/veach_bidir.glb", 11544, 6, 0, 1, 0, 0},
    {"scenes/living_room/living_room.glb", 143163, 19, 4, 1, 0, 0},
    {"scenes/staircase2/staircase2.glb", 31247, 21, 3, 1, 0, 0},
    {"scenes/classroom/classroom.glb", 103832, 44, 3, 1, 0, 0},
    {"scenes/crytek_sponza/crytek_sponza.glb", 262267, 25, 24, 0, 0, 0},
    {"scenes/misc/standard_shader_ball.glb", 63856, 3, 2, 0, 0, 0}, // one is the default
    {"scenes/misc/glass-table.glb", 592, 3, 0, 0, 0, 0},
    {"avatars/quaternius_horse.glb", 2182, 8, 0, 0, 1, 13},
    {"avatars/quaternius_human.glb", 1578, 1, 0, 0, 1, 8},
    {"avatars/robot_expressive.glb", 3237, 3, 0, 0, 2, 14},
    {"avatars/cesium_man.glb", 4672, 1, 1, 0, 1, 1},
    {"avatars/fox.glb", 576, 1, 1, 0, 1, 3},
    {"avatars/morph_stress_test.glb", 2412, 2, 2, 0, 0, 3},
    {"avatars/lee_perry_smith_head.glb", 17684, 1, 0, 0, 0, 0},
};

/// As placed by the nodes.
std::size_t count_triangles(Scene const& scene)
{
    std::size_t n = 0;
    for (Node const& node : scene.nodes)
        for (std::int32_t const m : node.meshes) n += scene.meshes[std::size_t(m)].triangles.size();
    return n;
}

class ShippedScene : public testing::TestWithParam<Contents> {};

TEST_P(ShippedScene, ArrivesWhole)
{
    Contents const& expected = GetParam();
    std::filesystem::path const file = shared_data() / expected.file;
    LIGHTWELL_NEED_DATA(file);
    Report report;
    Scene const scene = load_scene(file.string(), report);
    EXPECT_EQ(count_triangles(scene), expected.triangles);
    EXPECT_EQ(scene.materials.size(), expected.materials);
    EXPECT_EQ(scene.textures.textures.size(), expected.textures);
    EXPECT_EQ(scene.cameras.size(), expected.cameras);
    EXPECT_EQ(scene.skins.size(), expected.skins);
    EXPECT_EQ(scene.animations.size(), expected.animations);
    for (auto const& [what, loss] : report.losses())
        EXPECT_TRUE(what == "vertex weights that do not sum to one, normalised" ||
                    what == "animation channels ignored" ||
                    what == "normals that are not unit, normalised or left flat")
            << what << ": " << loss.count << " " << loss.first;

    std::filesystem::path description = file;
    description.replace_extension(".json");
    if (std::filesystem::exists(description)) {
        nlohmann::json const j = nlohmann::json::parse(std::ifstream(description));
        EXPECT_EQ(j.at("triangles"), expected.triangles);
    }
}

std::string file_stem(testing::TestParamInfo<Contents> const& info)
{
    std::string stem = std::filesystem::path(info.param.file).stem();
    std::replace(stem.begin(), stem.end(), '-', '_');
    return stem;
}

INSTANTIATE_TEST_SUITE_P(Files, ShippedScene, testing::ValuesIn(kFiles), file_stem);

TEST(ShippedScenes, GlassIsSolidAndLampsShineAsTheFilesSay)
{
    std::filesystem::path const folder = shared_data() / "scenes";
    LIGHTWELL_NEED_DATA(folder);
    Report report;
    Scene const veach = load_scene((folder / "veach_bidir/veach_bidir.glb").string(), report);
    std::size_t glass = 0;
    for (Material const& m : veach.materials) {
        glass += m.transmission > 0;
        EXPECT_FALSE(m.transmission > 0 && m.thin);
    }
    EXPECT_GE(glass, 1u);
    Scene const cornell = load_scene((folder / "cornell_box/cornell_box.glb").string(), report);
    vec3 brightest{0};
    for (Material const& m : cornell.materials) {
        brightest = glm::max(brightest, m.emission);
        EXPECT_EQ(m.specular, 0); // pure diffuse
    }
    EXPECT_LT(glm::distance(brightest, vec3(17, 12, 4)), 1e-4f);
}

} // namespace
} // namespace gi::test
