// Folders of frames: what moves, when, and what is refused.

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/summary.h"
#include "gi/scene/motion/animation.h"
#include "gi/scene/motion/vertex_normals.h"
#include "tests/support/scenes.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <unistd.h>

namespace gi::test {
namespace {

namespace fs = std::filesystem;

class MeshSequence : public testing::Test {
protected:
    MeshSequence()
        : folder_(fs::temp_directory_path() / ("lightwell_sequence_" + std::to_string(getpid())) / "cloth")
    {
        fs::create_directories(folder_);
    }
    ~MeshSequence() override { fs::remove_all(folder_.parent_path()); }

    /// A roof of two squares over y = 0, whose ridge lies at this height.
    static std::string obj(double ridge)
    {
        return fmt::format("v 0 0 0\nv 0 0 1\nv 1 {0} 1\nv 1 {0} 0\nv 2 0 1\nv 2 0 0\nf 1 2 3 4\nf 4 3 5 6\n",
                           ridge);
    }
    static std::string ply(double ridge, std::string const& faces = "3 0 1 2\n3 0 2 3\n3 3 2 4\n3 3 4 5\n")
    {
        auto const count = std::count(faces.begin(), faces.end(), '\n');
        return fmt::format("ply\nformat ascii 1.0\nelement vertex 6\nproperty float x\nproperty float y\nproperty "
                           "float z\nelement face {1}\nproperty list uchar int vertex_indices\nend_header\n"
                           "0 0 0\n0 0 1\n1 {0} 1\n1 {0} 0\n2 0 1\n2 0 0\n{2}",
                           ridge, count, faces);
    }
    void write(std::string const& name, std::string const& text) const { write_text(folder_ / name, text); }
    void write_plys(std::vector<double> const& ridges) const
    {
        for (std::size_t i = 0; i < ridges.size(); ++i) write(fmt::format("f{}.ply", i), ply(ridges[i]));
    }
    Scene load() { return load_scene(folder_.string(), report_); }
    World world_at(std::optional<double> time_s)
    {
        return build_world(std::make_shared<Scene const>(load()), time_s, report_);
    }
    double ridge_at(double time_s) { return double(world_at(time_s).bounds.high.y); }
    std::string refusal()
    {
        try {
            load();
        } catch (InputError const& e) {
            return e.what();
        }
        return "was accepted";
    }

    fs::path folder_;
    Report report_;
};

TEST_F(MeshSequence, FramesFollowEachOtherAndLoop)
{
    write_plys({1, 2, 4});
    write("sequence.json", R"({"fps": 10})");
    EXPECT_NEAR(ridge_at(0), 1, 1e-6);
    EXPECT_NEAR(ridge_at(0.05), 1.5, 1e-6);
    EXPECT_NEAR(ridge_at(0.1), 2, 1e-6);
    EXPECT_NEAR(ridge_at(0.2), 4, 1e-6);
    EXPECT_NEAR(ridge_at(0.25), 2.5, 1e-6) << "back to the first";
    EXPECT_NEAR(ridge_at(0.3), 1, 1e-5);
    EXPECT_NEAR(ridge_at(3.05), 1.5, 1e-5);
    EXPECT_NEAR(ridge_at(-0.1), 4, 1e-5);
    EXPECT_NEAR(double(world_at(std::nullopt).bounds.high.y), 1, 1e-6) << "rest is the first frame";
    EXPECT_TRUE(report_.losses().empty());
}

TEST_F(MeshSequence, FilesThatWereReadAreNoted)
{
    write_plys({1, 2});
    write("sequence.json", R"({"fps": 10})");
    std::vector<std::string> expected;
    for (char const* name : {"f0.ply", "f1.ply", "sequence.json"}) expected.push_back((folder_ / name).string());
    EXPECT_EQ(load().files, expected);
}

TEST_F(MeshSequence, WithoutAFileOfTimes24FramesASecond)
{
    write_plys({1, 2});
    EXPECT_NEAR(ridge_at(1.0 / 24), 2, 1e-5);
    EXPECT_NEAR(load().animations.at(0).duration_s, 2.0 / 24, 1e-12);
    EXPECT_EQ(load().animations.at(0).name, "cloth");
}

TEST_F(MeshSequence, OwnTimesAndNoLoop)
{
    write_plys({1, 2, 4});
    write("sequence.json", R"({"times_s": [5, 6, 8], "t0_s": 5, "duration_s": 10, "loop": false, "note": "x"})");
    EXPECT_NEAR(ridge_at(2), 3, 1e-6);
    EXPECT_NEAR(ridge_at(3), 4, 1e-6);
    EXPECT_NEAR(ridge_at(9), 4, 1e-6) << "held at the last frame";
    EXPECT_NEAR(ridge_at(1000), 4, 1e-6);
    EXPECT_NEAR(ridge_at(-1), 1, 1e-6);
}

TEST_F(MeshSequence, NumbersInNamesCountByTheirValue)
{
    write("f2.ply", ply(2));
    write("f10.ply", ply(3));
    write("f1.ply", ply(1));
    EXPECT_NEAR(ridge_at(0), 1, 1e-6);
    EXPECT_NEAR(ridge_at(2.0 / 24), 3, 1e-5);
}

TEST_F(MeshSequence, VerticesOfPlyKeepTheirPlaces)
{
    write_plys({1, 2});
    Scene const scene = load();
    ASSERT_EQ(scene.meshes.at(0).positions.size(), 6u);
    EXPECT_EQ(scene.meshes[0].positions[2], (vec3{1, 1, 1}));
    EXPECT_EQ(scene.meshes[0].triangles.size(), 4u);
    EXPECT_EQ(scene.meshes[0].morph_targets.size(), 1u);
}

/// The ridge's two vertices are made from four corners each; only those that are equal in all frames are joined.
TEST_F(MeshSequence, CornersOfObjAreJoinedWhereAllFramesAgree)
{
    write("a.obj", obj(1));
    write("b.obj", obj(2));
    EXPECT_EQ(load().meshes.at(0).positions.size(), 6u);
    EXPECT_NEAR(ridge_at(0.5 / 24), 1.5, 1e-5);
    write("b.obj",
          "v 0 0 0\nv 0 0 1\nv 1 2 1\nv 1 2 0\nv 2 0 1\nv 2 0 0\nv 1 3 1\nv 1 3 0\nf 1 2 3 4\nf 8 7 5 6\n");
    EXPECT_EQ(load().meshes.at(0).positions.size(), 8u) << "it tears along the ridge";
}

TEST_F(MeshSequence, NormalsAreMadeAndFollow)
{
    write_plys({0, 1});
    for (double const t : {0.0, 1.0 / 24}) {
        World const w = world_at(t);
        ASSERT_EQ(w.normals.size(), 6u);
        EXPECT_LT(glm::distance(w.normals[2], vec3{0, 1, 0}), 1e-5f) << "the ridge is symmetric";
        vec3 const slope = t > 0 ? glm::normalize(vec3{-1, 1, 0}) : vec3{0, 1, 0};
        EXPECT_LT(glm::distance(w.normals[0], slope), 1e-4f) << t;
    }
}

TEST_F(MeshSequence, NormalsOfTheFilesAreKept)
{
    auto const with_normal = [](std::string const& n) {
        return "v 0 0 0\nv 0 0 1\nv 1 0 0\nvn " + n + "\nf 1//1 2//1 3//1\n";
    };
    write("a.obj", with_normal("0 0 1"));
    write("b.obj", with_normal("1 0 0"));
    EXPECT_LT(glm::distance(world_at(0).normals.at(0), vec3{0, 0, 1}), 1e-6f);
    EXPECT_LT(glm::distance(world_at(0.5 / 24).normals.at(0), glm::normalize(vec3{1, 0, 1})), 1e-4f);
    write("b.obj", "v 0 0 0\nv 0 0 1\nv 1 0 0\nf 1 2 3\n");
    EXPECT_LT(glm::distance(world_at(0).normals.at(0), vec3{0, 1, 0}), 1e-6f) << "all are made anew";
    EXPECT_EQ(report_.losses().size(), 1u);
}

/// Where a polygon is cut depends on its shape: it is the polygons that have to be equal.
TEST_F(MeshSequence, PolygonsMayChangeTheirShape)
{
    write("a.obj", "v 0 0 0\nv 2 0 0\nv 2 2 0\nv 0 2 0\nf 1 2 3 4\n");
    write("b.obj", "v 0 0 0\nv 2 0 0\nv 0.5 0.5 0\nv 0 2 0\nf 1 2 3 4\n");
    EXPECT_EQ(world_at(1.0 / 24).triangles.size(), 2u);
}

TEST_F(MeshSequence, OneFrameIsAStill)
{
    write("a.obj", obj(1));
    EXPECT_NEAR(ridge_at(5), 1, 1e-6);
    EXPECT_TRUE(load().playbacks.empty());
}

TEST_F(MeshSequence, OtherFormsOfItsName)
{
    write_plys({1, 2});
    write("sequence.json", "{}");
    EXPECT_EQ(load_scene((folder_ / "sequence.json").string(), report_).animations.size(), 1u);
    EXPECT_EQ(load_scene(folder_.string() + "/", report_).animations.at(0).name, "cloth");
    write_text(folder_.parent_path() / "scene.yaml",
               "models: [{file: cloth, translate: [0, 10, 0], animation: {speed: 2, loop: false}}]");
    Scene const scene = load_scene((folder_.parent_path() / "scene.yaml").string(), report_);
    World const w = build_world(std::make_shared<Scene const>(scene), 0.25 / 24, report_);
    EXPECT_NEAR(w.bounds.high.y, 11.5, 1e-5);
    SceneSummary const s = summarise(w);
    ASSERT_EQ(s.mesh_sequences.size(), 1u);
    EXPECT_EQ(s.mesh_sequences[0].name, "cloth");
    EXPECT_EQ(s.mesh_sequences[0].frames, 2u);
}

TEST_F(MeshSequence, FramesThatDifferAreRefusedByName)
{
    auto const expect_refusal = [&](std::vector<std::string> const& parts) {
        std::string const message = refusal();
        for (std::string const& part : parts) EXPECT_NE(message.find(part), std::string::npos) << message;
    };
    expect_refusal({"cloth", "no OBJ or PLY"});
    write_plys({1, 2, 3});
    write("f2.ply", ply(3, "3 0 1 2\n3 0 2 3\n3 3 2 4\n"));
    expect_refusal({"f2.ply", "faces are not those of 'f0.ply'"});
    write("f2.ply", ply(3, "3 0 1 2\n3 0 2 3\n3 3 4 2\n3 3 4 5\n"));
    expect_refusal({"f2.ply", "faces"});
    write("f2.ply",
          "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
          "element face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n");
    expect_refusal({"f2.ply", "3 vertices, 'f0.ply' has 6"});
    write("f2.ply", "nonsense");
    expect_refusal({"f2.ply"});
    write("f2.ply", "");
    expect_refusal({"f2.ply", "empty"});
    fs::remove(folder_ / "f2.ply");
    write("other.obj", obj(1));
    expect_refusal({"OBJ and PLY"});
}

TEST_F(MeshSequence, TimesThatContradictAreRefused)
{
    write_plys({1, 2, 3});
    auto const expect_refusal = [&](std::string const& text, std::vector<std::string> const& parts) {
        write("sequence.json", text);
        std::string const message = refusal();
        for (std::string const& part : parts) EXPECT_NE(message.find(part), std::string::npos) << message << text;
    };
    expect_refusal("{\n \"fps\": ]", {"sequence.json:2:9", "not JSON"});
    expect_refusal("[]", {"no keys"});
    expect_refusal(R"({"times_s": [0, 1]})", {"list of 3 numbers"});
    expect_refusal(R"({"times_s": [0, 1, 1]})", {"frame 2"});
    expect_refusal(R"({"times_s": [0, 1, "x"]})", {"time 2"});
    expect_refusal(R"({"times_s": [0, 1, 2], "t0_s": 1})", {"time 0"});
    expect_refusal(R"({"times_s": [0, 1, 2], "duration_s": 1.5})", {"duration_s"});
    expect_refusal(R"({"times_s": [0, 1, 2], "fps": 3})", {"both"});
    expect_refusal(R"({"fps": 0})", {"fps"});
    expect_refusal(R"({"fps": "fast"})", {"fps"});
    expect_refusal(R"({"loop": 1})", {"loop"});
    write("sequence.json", R"({"fsp": 3})");
    load();
    EXPECT_EQ(report_.losses().size(), 1u) << "unknown keys are told";
}

TEST(VertexNormals, AnglesNotAreasOrCutsCount)
{
    // A corner of a cube: one face is cut in two there.
    std::vector<vec3> const p{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 3}};
    std::vector<uvec3> const t{{0, 2, 1}, {0, 3, 2}, {0, 1, 4}, {0, 4, 3}};
    EXPECT_LT(glm::distance(vertex_normals(p, t)[0], -glm::normalize(vec3{1, 1, 1})), 1e-6f);
    EXPECT_EQ(vertex_normals({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}})[0], vec3{0});
    EXPECT_EQ(vertex_normals({{0, 0, 0}}, {})[0], vec3{0});
}

} // namespace
} // namespace gi::test
