// OBJ and MTL: equal to what Assimp's importer reads, and right where that is wrong.

#include "gi/core/error.h"
#include "gi/core/report.h"
#include "gi/scene/load/load.h"
#include "gi/scene/load/obj/mtl_map.h"
#include "gi/scene/load/obj/obj_libraries.h"
#include "gi/scene/load/obj/obj_model.h"
#include "gi/scene/load/obj/obj_text.h"
#include "gi/scene/model/world.h"
#include "tests/scene/obj_assimp.h"

#include <array>
#include <fstream>
#include <unistd.h>

namespace gi::test {
namespace {

constexpr char const* kLibrary = R"(# two materials
newmtl brick wall
  Ka 0.1 0.1 0.1
  Kd 0.731 0.42 1e-2
  Ks .2 .3 .4
  Ns 96.078431
  Ni 1.45
  d 0.75
  illum 2
  map_Kd -s 1 1 1 -o 0 0 0 -clamp on wall picture.png
  map_Bump -bm 0.5 bumps.png
  map_d mask.png
  Pr 0.35
  Pm 1

newmtl lamp
Ke 5 4 3
Tr 0.25
norm normals.png
disp heights.png
)";

constexpr char const* kModel = R"(mtllib m.mtl
o house
v 0 0 0
v 1.00001 0 0 # a comment
v 1 1.5e-3 0
v 0 1 -2.25
v 0.5 1.333333333333 .0 1
vt 0 0
vt 1 0.123456789
vt 1 1
vt 0 1
vn 0 0 1
vn 0.57735 0.57735 0.57735
s 1
usemtl brick wall
f 1/1/1 2/2/1 3/3/1 4/4/2
f 1/1/1 \
  3/3/1 4/4/1
usemtl lamp
f -5//-1 -4//-1 -3//-2
l 1 2 3
g roof left
s off
f 1 2 5
g roof left
f 3 4 5
usemtl unknown
f 1/1 2/2 3/3 4/4 5/1
p 1 2
o other
usemtl lamp
f 4 3 2
)";

class ObjFolder : public testing::Test {
protected:
    ObjFolder() : folder_(std::filesystem::temp_directory_path() / ("lightwell_obj_" + std::to_string(getpid())))
    {
        std::filesystem::create_directories(folder_);
    }
    ~ObjFolder() override { std::filesystem::remove_all(folder_); }

    std::string write(std::string const& name, std::string const& text) const
    {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return (folder_ / name).string();
    }
    Scene load(std::string const& text) { return load_scene(write("m.obj", text), report_); }
    std::string refusal(std::string const& text)
    {
        try {
            load(text);
        } catch (InputError const& e) {
            return e.what();
        }
        ADD_FAILURE() << text << " was read";
        return {};
    }

    std::filesystem::path folder_;
    Report report_;
};

constexpr char const* kThreeVertices = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";

TEST_F(ObjFolder, EqualsAssimp)
{
    write("m.mtl", kLibrary);
    ObjAgainstAssimp(write("m.obj", kModel)).expect_equal(AssimpFaces::triangles);
    std::string text = kModel;
    text.erase(text.find("l 1 2 3\n"), 8); // Assimp orders the vertices of lines otherwise
    ObjAgainstAssimp(write("m.obj", text)).expect_equal(AssimpFaces::polygons);
}
TEST_F(ObjFolder, LineEndsOfWindowsAndNoEndAtAll)
{
    std::string text;
    for (char const* c = kModel; *c != 0; ++c) text += *c == '\n' ? "\r\n" : std::string(1, *c);
    text.resize(text.size() - 2);
    write("m.mtl", kLibrary);
    ObjAgainstAssimp(write("m.obj", text)).expect_equal(AssimpFaces::triangles);
}

TEST_F(ObjFolder, FacesBeforeTheFirstMaterialHaveNone)
{
    write("m.mtl", "newmtl red\nKd 1 0 0\n");
    Scene const scene = load(std::string("mtllib m.mtl\n") + kThreeVertices + "f 1 2 3\nusemtl red\nf 3 2 1\n");
    ASSERT_EQ(scene.meshes.size(), 2u);
    EXPECT_EQ(scene.meshes[0].material, -1);
    EXPECT_EQ(scene.materials.at(std::size_t(scene.meshes[1].material)).base_color, (vec3{1, 0, 0}));
}
TEST_F(ObjFolder, OneNumberOfAColorIsAllThree)
{
    write("m.mtl", "newmtl grey\nKd 0.25\nKs spectral file.rfl\nd -halo 0.5\n");
    Scene const scene = load(std::string("mtllib m.mtl\n") + kThreeVertices + "usemtl grey\nf 1 2 3\n");
    Material const& m = scene.materials.at(std::size_t(scene.meshes.at(0).material));
    EXPECT_EQ(m.base_color, vec3{0.25f});
    EXPECT_EQ(m.alpha, 0.5f);
}
TEST_F(ObjFolder, VerticesWithoutAColorAreWhite)
{
    Scene const scene = load("v 0 0 0\nv 1 0 0 1 0.5 0\nv 0 1 0\nf 1 2 3\n");
    // as monitors show them: 0.5 is 0.2140 of the light
    std::vector<vec3> const expected{vec3{1}, vec3{1, 0.21404114f, 0}, vec3{1}};
    for (std::size_t v = 0; v < 3; ++v)
        EXPECT_LT(glm::length(scene.meshes.at(0).colors.at(v) - expected[v]), 1e-6f) << v;
    Material const& m = scene.materials.at(std::size_t(scene.meshes[0].material));
    EXPECT_EQ(m.base_color, vec3{1}) << "the colours are the albedo";
    EXPECT_EQ(m.specular, 0);
}
TEST_F(ObjFolder, ColorsWithAlphaAndBehindAFourthCoordinate)
{
    for (char const* text : {"v 0 0 0 1 0 0 1\nv 1 0 0 0 1 0 .5\nv 0 1 0 0 0 1 1\nf 1 2 3\n",
                             "v 0 0 0 2 1 0 0 1\nv 2 0 0 2 0 1 0 .5\nv 0 1 0 1 0 0 1 1\nf 1 2 3\n"}) {
        Report report;
        Scene const scene = load_scene(write("m.obj", text), report);
        EXPECT_EQ(scene.meshes.at(0).positions.at(1), (vec3{1, 0, 0})) << text;
        EXPECT_EQ(scene.meshes[0].colors, (std::vector{vec3{1, 0, 0}, vec3{0, 1, 0}, vec3{0, 0, 1}})) << text;
        ASSERT_EQ(report.losses().size(), 1u) << text;
        EXPECT_EQ(report.losses().at("vertices with an alpha of their own, taken as opaque").count, 1u) << text;
    }
    Scene const scene = load("v 0 0 0 2\nv 2 0 0 2\nv 0 1 0 1\nf 1 2 3\n");
    EXPECT_EQ(scene.meshes.at(0).positions.at(1), (vec3{1, 0, 0}));
}
TEST(MtlMap, OptionsAtTheEndAndWhatOnlyLooksLikeThem)
{
    struct Case {
        char const *values, *file;
        float scale_u;
    };
    for (auto const& [values, file, scale] :
         {Case{"t.png -s 2 -clamp on", "t.png", 2}, Case{"t -s 2.png -s 3", "t -s 2.png", 3},
          Case{"t -type -s 3", "t -type", 3}, Case{"t -s 2 -s 4 x", "t -s 2 -s 4 x", 1},
          Case{"t\t-s 2 -s 4", "t\t-s 2", 4}, Case{"t -s", "t -s", 1}}) {
        MtlMap const map = read_mtl_map(values);
        EXPECT_EQ(map.file, file);
        EXPECT_EQ(map.scale_u, scale) << values;
    }
}
TEST(ObjNames, HostileLinesTakeTimeInProportionToTheirLength)
{
    std::string options = "t", names;
    for (int i = 0; i < 200'000; ++i) {
        options += " -s 1";
        names += "ab ";
    }
    EXPECT_EQ(read_mtl_map(options + " x").file, options + " x");
    EXPECT_EQ(library_names(names).size(), 200'000u);
}
TEST_F(ObjFolder, WhatIsNotReadIsNamed)
{
    std::string const v = kThreeVertices;
    load(v + "# vp 1\ng a\ns off\nf 1 2 3\ns 1\nf 1 2 3\nvn 0 0 1\nf 1//1 2//1 3//1\ns 0\nf 1 2 3\nvp 0 0\nvp 1 "
             "0\ncstype bezier\nl 1 2\n"
             "p 1\n");
    std::map<std::string, std::uint64_t> counts;
    for (auto const& [what, loss] : report_.losses()) counts[what] = loss.count;
    EXPECT_EQ(counts, (std::map<std::string, std::uint64_t>{
                          {"statements of OBJ that are not read (curves, surfaces, ...)", 3},
                          {"faces of smoothing groups without normals, flat", 1},
                          {"points and lines skipped", 2}}));
}
TEST_F(ObjFolder, MoreCornersThanAByteCounts)
{
    std::string text, face = "f";
    for (int i = 0; i < 300; ++i) {
        text += "v " + std::to_string(std::cos(i * 0.02)) + " " + std::to_string(std::sin(i * 0.02)) + " 0\n";
        face += " " + std::to_string(i + 1);
    }
    EXPECT_EQ(load(text + face + "\n").meshes.at(0).triangles.size(), 298u);
}
TEST_F(ObjFolder, MistakesAreToldWithTheirLine)
{
    std::string const v = kThreeVertices;
    EXPECT_NE(refusal("nonsense").find("it has no faces"), std::string::npos);
    EXPECT_NE(refusal(v + "f 1 2 x\n").find("line 4: 'x' is no index"), std::string::npos);
    EXPECT_NE(refusal(v + "f 1 2 0\n").find("line 4"), std::string::npos);
    EXPECT_NE(refusal(v + "f 1 2 3/1/1/1\n").find("follows the corner"), std::string::npos);
    EXPECT_NE(refusal(v + "f 1 2 99999999999999999999\n").find("line 4"), std::string::npos);
    EXPECT_NE(refusal("v 0 0\nf 1 1 1\n").find("line 1: a vertex has three numbers"), std::string::npos);
    EXPECT_NE(refusal("# \\\nv 0 0 0 0\n").find("line 2: the vertex lies at infinity"), std::string::npos);
    for (char const* const bad : {"4", "-4", "-9223372036854775808", "9223372036854775807"})
        EXPECT_NE(refusal(v + "f 1 2 " + bad + "\n").find("a vertex that the file has not"), std::string::npos)
            << bad;
}
TEST_F(ObjFolder, WrongIndicesOfNormalsAndTextureCoordinatesDropThese)
{
    Scene const scene = load(std::string(kThreeVertices) + "vt 0 0\nvn 0 0 1\nf 1/1/1 2/7/1 3/1/-3\n");
    EXPECT_TRUE(scene.meshes.at(0).uv0.empty());
    EXPECT_TRUE(scene.meshes[0].normals.empty());
}

TEST_F(ObjFolder, DecimalCommasAreRefused)
{
    char const* const comma = "has a comma; write a decimal point";
    for (char const* const line :
         {"v 0,5 0,5 0\n", "v 0 0 0,25\n", "v 0 0 0 0,5 0,5 0,5\n", "vt 0,5 0,5\n", "vn 0 0,7 0,7\n"}) {
        std::string const why = refusal(std::string(kThreeVertices) + line + "f 1 2 3\n");
        EXPECT_NE(why.find("line 4"), std::string::npos) << why;
        EXPECT_NE(why.find(comma), std::string::npos) << why;
    }
    EXPECT_EQ(load("v 0, 0, 0,\nv 1, 0, 0\nv 0, 1, 0\nf 1 2 3\n").meshes.at(0).positions.size(), 3u) << "lists";
    write("m.mtl", "newmtl a\nKd 0,8 0,8 0,8\n");
    load(std::string("mtllib m.mtl\nusemtl a\n") + kThreeVertices + "f 1 2 3\n");
    EXPECT_FALSE(report_.losses().empty()) << "a colour that cannot be read is told";
}

TEST_F(ObjFolder, FarFromTheOriginNothingIsRounded)
{
    // As surveys write it: metres of UTM, where a float has steps of half a metre.
    Scene const scene =
        load("v 650000.37 12.125 5300000.37\nv 650001.0 12.125 5300000.37\nv 650000.37 12.75 5300000.37\n"
             "f 1 2 3\n");
    World const world = build_world(std::make_shared<Scene const>(scene), {}, report_);
    auto const at = [&](int corner) { return world.origin + dvec3(world.positions[std::size_t(corner)]); };
    EXPECT_NEAR(at(0).x, 650000.37, 1e-6);
    EXPECT_NEAR(at(0).z, 5300000.37, 1e-6);
    EXPECT_NEAR(at(1).x - at(0).x, 0.63, 1e-6);
    EXPECT_NEAR(at(2).y - at(0).y, 0.625, 1e-6);
    EXPECT_EQ(
        read_obj("v nan 1e30 1e6\nf 1 1 1\n", {[](std::string const&) { return 0u; }, [](std::string const&) {}})
            .origin_m,
        dvec3(0));
}

float rounded(std::string_view text)
{
    std::array<float, 1> number{};
    EXPECT_EQ(leading_numbers(text, std::span<float>(number)), 1u) << text;
    return number[0];
}

TEST(ObjText, NumbersAreRoundedToNearest)
{
    EXPECT_EQ(rounded("0.1"), 0.1f);
    EXPECT_EQ(rounded("+16777217.0000001"), 16777218.0f);
    EXPECT_EQ(rounded("-.5,"), -0.5f);
    EXPECT_EQ(rounded("3.1+e2"), 3.1f);
    EXPECT_EQ(rounded("1e300"), kInf);
    EXPECT_EQ(rounded("-1e300"), -kInf);
    EXPECT_EQ(rounded("1e-300"), 0.0f);
    EXPECT_FALSE(leading_number("e5"));
    EXPECT_FALSE(leading_number("0,5"));
    EXPECT_FALSE(leading_number(""));
}

} // namespace
} // namespace gi::test
