// The avatars of the test data move: every clip of every file, blended clips, mesh sequences against the clips
// that they were baked from, and synthetic files with what is hard about skins.

#include "gi/scene/load/load.h"
#include "gi/scene/motion/skinning.h"
#include "tests/scene/gltf_builder.h"
#include "tests/support/data.h"
#include "tests/support/scenes.h"

#include <fstream>
#include <gtest/gtest.h>

namespace gi::test {
namespace {

std::vector<dvec3> points_at(std::shared_ptr<Scene const> const& scene, SceneTime time_s)
{
    Report report;
    World const w = build_world(scene, time_s, report);
    std::vector<dvec3> p;
    for (vec3 const v : w.positions) p.push_back(dvec3(v) + w.origin);
    return p;
}

double size_of(std::vector<dvec3> const& p)
{
    dvec3 low = p.at(0), high = low;
    for (dvec3 const& v : p) low = glm::min(low, v), high = glm::max(high, v);
    return glm::distance(low, high);
}

double largest_distance(std::vector<dvec3> const& a, std::vector<dvec3> const& b)
{
    EXPECT_EQ(a.size(), b.size());
    double worst = 0;
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i)
        worst = std::max(worst, glm::distance(a[i], b[i]));
    return worst;
}

void expect_finite(std::vector<dvec3> const& p)
{
    for (dvec3 const& v : p) ASSERT_TRUE(std::isfinite(glm::length(v)));
}

/// Every clip gives finite vertices, equal ones a period later, and moves something.
void expect_plays(std::filesystem::path const& file, std::size_t clips)
{
    Report report;
    Scene scene = load_scene(file.string(), report);
    ASSERT_EQ(scene.animations.size(), clips) << file;
    for (std::size_t clip = 0; clip < clips; ++clip) {
        SCOPED_TRACE(file.filename().string() + ", " + scene.animations[clip].name);
        scene.playbacks = {{std::int32_t(clip), 0, 1, true}};
        auto const shared = std::make_shared<Scene const>(scene);
        double const duration = scene.animations[clip].duration_s;
        ASSERT_GT(duration, 0);
        std::vector<dvec3> const start = points_at(shared, 0);
        double moved = 0, size = size_of(start);
        for (double const t : {0.0, 0.21, 0.5, 0.83}) {
            std::vector<dvec3> const p = points_at(shared, t * duration);
            expect_finite(p);
            moved = std::max(moved, largest_distance(p, start));
            EXPECT_LT(size_of(p), 5 * size) << "it stays together";
            if (t > 0) {
                EXPECT_LT(largest_distance(p, points_at(shared, (t + 3) * duration)), 1e-4 * size);
            }
        }
        EXPECT_GT(moved, 1e-3 * size) << "it moves";
    }
}

TEST(AvatarsPlay, EveryClipOfEveryFile)
{
    LIGHTWELL_NEED_DATA("avatars/robot_expressive.glb");
    std::filesystem::path const folder = shared_data() / "avatars";
    expect_plays(folder / "cesium_man.glb", 1);
    expect_plays(folder / "fox.glb", 3);
    expect_plays(folder / "quaternius_horse.glb", 13);
    expect_plays(folder / "quaternius_human.glb", 8);
    expect_plays(folder / "robot_expressive.glb", 14);
    expect_plays(folder / "morph_stress_test.glb", 3);
    expect_plays(folder / "horse_gallop_seq", 1);
    expect_plays(folder / "cesium_man_walk_expected", 1);
    expect_plays(folder / "fox_run_expected", 1);
}

TEST(AvatarsPlay, AStillHeadStaysStill)
{
    LIGHTWELL_NEED_DATA("avatars/lee_perry_smith_head.glb");
    Report report;
    auto const scene = std::make_shared<Scene const>(
        load_scene((shared_data() / "avatars/lee_perry_smith_head.glb").string(), report));
    EXPECT_EQ(points_at(scene, 0.7), points_at(scene, std::nullopt));
}

/// Half walk, half run is between both, and either alone at its end of the mix.
TEST(AvatarsPlay, FoxBetweenWalkAndRun)
{
    LIGHTWELL_NEED_DATA("avatars/fox.glb");
    Report report;
    Scene scene = load_scene((shared_data() / "avatars/fox.glb").string(), report);
    auto const mixed = [&](double walk, double run) {
        scene.playbacks = {{1, 0, 1, true, walk}, {2, 0, 1, true, run}};
        return points_at(std::make_shared<Scene const>(scene), 0.3);
    };
    std::vector<dvec3> const walk = mixed(1, 0), run = mixed(0, 1), half = mixed(3, 3),
                             near_walk = mixed(0.9, 1e-4);
    expect_finite(half);
    double const apart = largest_distance(walk, run);
    EXPECT_GT(apart, 0.05 * size_of(walk));
    EXPECT_LT(largest_distance(half, walk), 0.8 * apart);
    EXPECT_LT(largest_distance(half, run), 0.8 * apart);
    EXPECT_LT(largest_distance(near_walk, walk), 1e-3 * apart);
}

/// A sequence against the file and clip that its sequence.json names: at its frames to rounding; between them
/// within what a chord leaves of an arc.
void expect_sequence_is_clip(std::string const& name, double between_frames)
{
    Report report;
    std::filesystem::path const folder = shared_data() / "avatars" / name;
    std::ifstream in(folder / "sequence.json");
    nlohmann::json const json = nlohmann::json::parse(in);
    auto const sequence = std::make_shared<Scene const>(load_scene(folder.string(), report));
    EXPECT_TRUE(report.losses().empty());
    Scene source = load_scene((folder.parent_path() / json.at("source").get<std::string>()).string(), report);
    source.playbacks = {{0, 0, 1, true}};
    for (std::size_t i = 0; i < source.animations.size(); ++i)
        if (json.at("animation") == source.animations[i].name) source.playbacks[0].animation = std::int32_t(i);
    auto const clip = std::make_shared<Scene const>(std::move(source));
    auto const times = json.at("times_s").get<std::vector<double>>();
    double const size = size_of(points_at(clip, 0));
    double worst_between = 0;
    for (std::size_t i = 0; i < times.size(); ++i) {
        std::vector<dvec3> const frame = points_at(sequence, times[i]);
        EXPECT_LT(largest_distance(frame, points_at(clip, times[i])), 1e-3 * size) << "frame " << i;
        // The file itself, alone.
        std::string const number = std::to_string(i);
        std::filesystem::path const file =
            folder / ("frame_" + std::string(3 - number.size(), '0') + number + ".ply");
        std::ifstream bytes(file, std::ios::binary);
        for (std::string line; std::getline(bytes, line) && line != "end_header";) {
        }
        std::vector<vec3> own(frame.size());
        bytes.read(reinterpret_cast<char*>(own.data()), std::streamsize(own.size() * sizeof(vec3)));
        ASSERT_TRUE(bytes.good());
        EXPECT_LT(largest_distance(frame, {own.begin(), own.end()}), 1e-5 * size) << "frame " << i;
        if (i + 1 == times.size()) continue; // the sequence leads back to its start, a clip may jump
        double const middle = 0.5 * (times[i] + times[i + 1]);
        worst_between =
            std::max(worst_between, largest_distance(points_at(sequence, middle), points_at(clip, middle)));
    }
    testing::Test::RecordProperty("between_frames_of_size", std::to_string(worst_between / size));
    EXPECT_LT(worst_between, between_frames * size);
}

TEST(AvatarsPlay, HorseSequenceIsItsClip)
{
    LIGHTWELL_NEED_DATA("avatars/horse_gallop_seq/sequence.json");
    expect_sequence_is_clip("horse_gallop_seq", 0.015);
}

TEST(AvatarsPlay, CesiumManSequenceIsItsClip)
{
    LIGHTWELL_NEED_DATA("avatars/cesium_man_walk_expected/sequence.json");
    expect_sequence_is_clip("cesium_man_walk_expected", 0.1);
}

TEST(AvatarsPlay, FoxSequenceIsItsClip)
{
    LIGHTWELL_NEED_DATA("avatars/fox_run_expected/sequence.json");
    expect_sequence_is_clip("fox_run_expected", 0.2);
}

/// A triangle on one joint that moves by (2, 0, 0) in a second, with weights as given; a second, rigid triangle
/// hangs below the joint.
Scene skinned_triangle(std::vector<float> const& weights, Report& report)
{
    GltfBuilder b;
    int const positions = b.add_floats({0, 0, 0, 1, 0, 0, 0, 1, 0}, "VEC3", 3);
    int const joints = b.add_accessor(b.add_view(std::vector<unsigned char>(12, 0)), kUbyte, 3, "VEC4");
    int const weight = b.add_floats(weights, "VEC4", 4);
    int const bind = b.add_floats({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1}, "MAT4", 16);
    b.add_primitive({{"POSITION", positions}, {"JOINTS_0", joints}, {"WEIGHTS_0", weight}});
    int const hat = b.append("meshes", {{"primitives", {{{"attributes", {{"POSITION", positions}}}}}}});
    b.append("nodes", {{"name", "hat"}, {"mesh", hat}, {"translation", {0, 5, 0}}});
    b.append("nodes", {{"name", "joint"}, {"children", {1}}});
    b.root["nodes"][0]["skin"] = b.append("skins", {{"joints", {2}}, {"inverseBindMatrices", bind}});
    b.root["scenes"][0]["nodes"] = {0, 2};
    int const times = b.add_floats({0, 1}, "SCALAR", 1), places = b.add_floats({0, 0, 0, 2, 0, 0}, "VEC3", 3);
    b.append("animations", {{"name", "slide"},
                            {"samplers", {{{"input", times}, {"output", places}}}},
                            {"channels", {{{"sampler", 0}, {"target", {{"node", 2}, {"path", "translation"}}}}}}});
    return b.parse(report);
}

TEST(AvatarsPlay, WeightsThatDoNotSumToOneAreMadeTo)
{
    for (std::vector<float> const& w : {std::vector<float>{1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0},
                                        {0.5f, 0, 0, 0, 0.25f, 0.25f, 0, 0, 3, 0, 0, 0},
                                        {1e-3f, 0, 0, 0, 0.9f, 0.3f, 0.2f, 0.1f, 1, 1, 1, 1}}) {
        Report report;
        Scene const scene = skinned_triangle(w, report);
        std::vector<dvec3> const p = points_at(std::make_shared<Scene const>(scene), 0.75);
        ASSERT_EQ(p.size(), 6u);
        EXPECT_LT(glm::distance(p[0], dvec3{1.5, 0, 0}), 1e-6);
        EXPECT_LT(glm::distance(p[1], dvec3{2.5, 0, 0}), 1e-6);
        EXPECT_LT(glm::distance(p[2], dvec3{1.5, 1, 0}), 1e-6);
    }
}

TEST(AvatarsPlay, NodesBelowJointsFollowThem)
{
    Report report;
    Scene const scene = skinned_triangle({1, 0, 0, 0, 1, 0, 0, 0, 1, 0, 0, 0}, report);
    std::vector<dvec3> const p = points_at(std::make_shared<Scene const>(scene), 0.5);
    ASSERT_EQ(p.size(), 6u);
    EXPECT_LT(glm::distance(p[3], dvec3{1, 5, 0}), 1e-6);
}

} // namespace
} // namespace gi::test
