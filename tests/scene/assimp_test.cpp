// OBJ, PLY, STL, ... through Assimp: what becomes of their materials, textures, bones and units.

#include "gi/core/error.h"
#include "gi/scene/load/assimp_parts.h"
#include "gi/scene/load/assimp_trial.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/world.h"
#include "gi/scene/motion/animation.h"
#include "tests/scene/obj_assimp.h"
#include "tests/support/processor_time.h"

#include <assimp/material.h>
#include <fstream>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <sys/stat.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gi::test {
namespace {

namespace fs = std::filesystem;

class AssimpFolder : public testing::Test {
protected:
    AssimpFolder() : folder_(fs::temp_directory_path() / ("lightwell_assimp_" + std::to_string(getpid())))
    {
        fs::create_directories(folder_);
    }
    ~AssimpFolder() override { fs::remove_all(folder_); }

    std::string write(std::string const& name, std::string const& text) const
    {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return (folder_ / name).string();
    }
    Scene load(std::string const& name, std::string const& text) { return load_scene(write(name, text), report_); }
    /// A triangle of one material.
    Material load_material(std::string const& mtl)
    {
        write("m.mtl", "newmtl m\n" + mtl);
        Scene const scene = load(
            "m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nusemtl m\nf 1/1 2/2 3/3\n");
        textures_ = scene.textures;
        return scene.materials.at(std::size_t(scene.meshes.at(0).material));
    }
    std::string refusal(std::string const& file)
    {
        try {
            load_scene(file, report_);
        } catch (InputError const& e) {
            return e.what();
        }
        ADD_FAILURE() << file << " was read";
        return {};
    }
    std::uint64_t lost(std::string const& what) const
    {
        auto const losses = report_.losses();
        auto const it = losses.find(what);
        return it == losses.end() ? 0 : it->second.count;
    }

    fs::path folder_;
    Report report_;
    TexturePool textures_;
};

TEST_F(AssimpFolder, PolygonsBecomeTriangles)
{
    Scene const scene = load("square.OBJ", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n");
    ASSERT_EQ(scene.meshes.size(), 1u);
    EXPECT_EQ(scene.meshes[0].triangles.size(), 2u);
    EXPECT_EQ(scene.meshes[0].material, -1);
}

TEST_F(AssimpFolder, MtlBecomesPhongThatKeepsEnergy)
{
    Material const m = load_material("Kd 0.5 0.25 0\nKs 0.25 0.25 0.25\nNs 40\nKe 3 2 1\n");
    EXPECT_EQ(m.model, MaterialModel::phong);
    EXPECT_EQ(m.base_color, (vec3{0.5f, 0.25f, 0}));
    EXPECT_EQ(m.phong_specular, vec3{0.25f});
    EXPECT_EQ(m.phong_exponent, 40);
    EXPECT_EQ(m.emission, (vec3{3, 2, 1}));
    EXPECT_EQ(lost("materials that reflect more than they receive, scaled down"), 0u);
    Material const bright = load_material("Kd 0.75 0.75 0.75\nKs 0.75 0.75 0.75\nNs 40\n");
    EXPECT_FLOAT_EQ(bright.base_color.x, 0.5f);
    EXPECT_FLOAT_EQ(bright.phong_specular.x, 0.5f);
    EXPECT_EQ(lost("materials that reflect more than they receive, scaled down"), 1u);
}

/// What u, v of the file becomes in the texture: v upwards.
vec2 placed(TextureRef const& ref, vec2 uv)
{
    vec2 const ours{uv.x, 1 - uv.y};
    return {glm::dot(ref.row_u, ours) + ref.offset.x, 1 - (glm::dot(ref.row_v, ours) + ref.offset.y)};
}

TEST_F(AssimpFolder, MapsOfMtlAreScaledMovedAndClamped)
{
    for (char const* const name : {"t.png", "two words.png"})
        cv::imwrite((folder_ / name).string(), cv::Mat(2, 2, CV_8UC3, cv::Scalar(10, 20, 30)));
    struct Case {
        char const* options;
        vec2 scale, offset;
        bool clamped;
    };
    for (auto const& [options, scale, offset, clamped] :
         {Case{"t.png", {1, 1}, {0, 0}, false}, Case{"-s 2 2 1 t.png", {2, 2}, {0, 0}, false},
          Case{"-s 2 3 t.png", {2, 3}, {0, 0}, false}, Case{"-s 2 t.png", {2, 1}, {0, 0}, false},
          Case{"-o 0.25 .5 0 t.png", {1, 1}, {0.25f, 0.5f}, false},
          Case{"-o 0.25 -s 4 0.5 1 -clamp on t.png", {4, 0.5f}, {0.25f, 0}, true},
          Case{"-clamp off t.png", {1, 1}, {0, 0}, false},
          Case{"t.png -s 2 2 -o -0.5 +1", {2, 2}, {-0.5f, 1}, false}, Case{"two words.png", {1, 1}, {0, 0}, false},
          Case{"-s -1 1 1 two words.png -clamp on", {-1, 1}, {0, 0}, true},
          Case{"\"two words.png\"", {1, 1}, {0, 0}, false}}) {
        Material const m = load_material(std::string("Kd 1 1 1\nmap_Kd ") + options + "\n");
        ASSERT_GE(m.base_color_map.texture, 0) << options;
        Texture const& t = textures_.textures.at(std::size_t(m.base_color_map.texture));
        EXPECT_EQ(t.wrap_u, clamped ? Wrap::clamp : Wrap::repeat) << options;
        EXPECT_EQ(t.wrap_v, clamped ? Wrap::clamp : Wrap::repeat) << options;
        for (vec2 const uv : {vec2{0, 0}, vec2{1, 0}, vec2{0, 1}, vec2{0.3f, 0.7f}})
            EXPECT_LT(glm::length(placed(m.base_color_map, uv) - (scale * uv + offset)), 1e-6f) << options;
    }
    EXPECT_TRUE(report_.losses().empty()) << report_.losses().begin()->first;
}

TEST_F(AssimpFolder, MapsAreScaledThenTurnedAboutTheirCentreThenMoved)
{
    cv::imwrite((folder_ / "t.png").string(), cv::Mat(2, 2, CV_8UC3, cv::Scalar(10, 20, 30)));
    aiScene source;
    source.mNumMaterials = 1;
    source.mMaterials = new aiMaterial* [1] { new aiMaterial };
    aiString const file("t.png");
    source.mMaterials[0]->AddProperty(&file, AI_MATKEY_TEXTURE(aiTextureType_DIFFUSE, 0));
    aiUVTransform t;
    t.mScaling = {2, 4};
    t.mRotation = kPi / 2; // (x, y) about the centre: (1 - y, x)
    t.mTranslation = {0.25f, 0.5f};
    source.mMaterials[0]->AddProperty(&t, 1, AI_MATKEY_UVTRANSFORM(aiTextureType_DIFFUSE, 0));
    Scene scene;
    convert_materials(source, folder_, scene, report_);
    for (vec2 const uv : {vec2{0, 0}, vec2{1, 0}, vec2{0, 1}, vec2{0.3f, 0.7f}}) {
        vec2 const expected{1 - 4 * uv.y + 0.25f, 2 * uv.x + 0.5f};
        EXPECT_LT(glm::length(placed(scene.materials.at(0).base_color_map, uv) - expected), 1e-5f) << uv.x << uv.y;
    }
}

TEST_F(AssimpFolder, APictureThatRepeatsInTwoWaysIsDecodedOnce)
{
    cv::imwrite((folder_ / "t.png").string(), cv::Mat(2, 2, CV_8UC3, cv::Scalar(10, 20, 30)));
    Material const m = load_material("Kd 1 1 1\nKe 1 1 1\nmap_Kd -clamp on t.png\nmap_Ke t.png\n");
    Texture const& kd = textures_.textures.at(std::size_t(m.base_color_map.texture));
    Texture const& ke = textures_.textures.at(std::size_t(m.emissive_map.texture));
    EXPECT_EQ(kd.first, ke.first);
    EXPECT_EQ(kd.wrap_u, Wrap::clamp);
    EXPECT_EQ(ke.wrap_u, Wrap::repeat);
}

TEST_F(AssimpFolder, OptionsOfMapsWithoutAnEquivalentAreNamed)
{
    cv::imwrite((folder_ / "t.png").string(), cv::Mat(2, 2, CV_8UC3, cv::Scalar(10, 20, 30)));
    std::string const what = "options of texture maps without an equivalent, dropped";
    std::uint64_t before = 0;
    for (char const* const option :
         {"-t 0.1 0.1", "-mm 0 2", "-mm 0.5", "-bm 2", "-boost 3", "-texres 512", "-blendu off", "-blendv off",
          "-cc on", "-imfchan r", "-type sphere", "-turn 3", "-colorspace linear", "-clamp"}) {
        EXPECT_GE(load_material(std::string("Kd 1 1 1\nmap_Kd ") + option + " t.png\n").base_color_map.texture, 0)
            << option;
        EXPECT_EQ(lost(what), ++before) << option;
    }
    EXPECT_EQ(report_.losses().at(what).first, (folder_ / "m.mtl").string() + ":3: map_Kd -t 0.1 0.1");
    for (char const* const option : {"-t 0 0 0", "-mm 0 1", "-bm 1.0", "-boost 0", "-blendu on", "-cc off"})
        EXPECT_GE(load_material(std::string("Kd 1 1 1\nmap_Kd ") + option + " t.png\n").base_color_map.texture, 0)
            << option;
    EXPECT_EQ(lost(what), before) << "options that change nothing";
    EXPECT_EQ(load_material("Kd 1 1 1\nnorm -bm 0.5 t.png\n").normal_scale, 0.5f);
    EXPECT_EQ(lost(what), before);
}

TEST_F(AssimpFolder, MapsOfMtlWithoutAFileAreNamed)
{
    load_material("Kd 1 1 1\nmap_Kd -x.png\nmap_Ke -clamp on\n");
    std::string const what = "texture maps without a file, skipped";
    EXPECT_EQ(lost(what), 2u) << "the first one looks like an option";
    EXPECT_EQ(report_.losses().at(what).first, (folder_ / "m.mtl").string() + ":3: map_Kd");
}

TEST_F(AssimpFolder, StatementsOfMtlWithoutAnEquivalentAreNamed)
{
    load_material("Ka 1 1 1\nKd 0.5 0.5 0.5\nPs 0.0\nPc 0\nsharpness 60\n# a comment\n");
    EXPECT_TRUE(report_.losses().empty()) << report_.losses().begin()->first;
    EXPECT_EQ(load_material("Kd spectral a.rfl\nPs 0.5\ndecal t.png\nmap_Tr t.png\n").base_color, vec3{0.6f});
    EXPECT_EQ(lost("colours of MTL that are not three numbers, skipped"), 1u);
    EXPECT_EQ(lost("statements of MTL without an equivalent, skipped"), 3u);
    vec3 const white = load_material("Kd xyz 0.4752 0.5 0.5445\n").base_color; // D65
    EXPECT_LT(glm::length(white - vec3{0.5f}), 0.002f);
}

TEST_F(AssimpFolder, MtlWithoutShineIsDiffuse)
{
    Material const m = load_material("Kd 0.5 0.5 0.5\nKs 0 0 0\nNs 10\n");
    EXPECT_EQ(m.model, MaterialModel::metal_rough);
    EXPECT_EQ(m.specular, 0);
    EXPECT_EQ(m.metallic, 0);
}

TEST_F(AssimpFolder, MtlMirrorsGlassAndVeils)
{
    Material const mirror = load_material("Kd 0 0 0\nKs 0.9 0.8 0.7\nNs 1000\nillum 5\n");
    EXPECT_EQ(mirror.model, MaterialModel::metal_rough);
    EXPECT_EQ(mirror.metallic, 1);
    EXPECT_EQ(mirror.roughness, 0);
    EXPECT_EQ(mirror.base_color, (vec3{0.9f, 0.8f, 0.7f}));
    Material const glass = load_material("Kd 0 0 0\nKs 1 1 1\nNs 1000\nNi 1.6\nd 0.1\nTf 1 0.9 0.8\nillum 7\n");
    EXPECT_EQ(glass.transmission, 1);
    EXPECT_FALSE(glass.thin);
    EXPECT_FLOAT_EQ(glass.ior, 1.6f);
    EXPECT_EQ(glass.alpha_mode, AlphaMode::opaque);
    EXPECT_EQ(glass.base_color, (vec3{1, 0.9f, 0.8f}));
    Material const veil = load_material("Kd 1 1 1\nd 0.25\n");
    EXPECT_EQ(veil.alpha_mode, AlphaMode::blend);
    EXPECT_FLOAT_EQ(veil.alpha, 0.25f);
}

TEST_F(AssimpFolder, MapsAreReadAndMasksBecomeAlpha)
{
    cv::imwrite((folder_ / "color.png").string(), cv::Mat(2, 2, CV_8UC3, cv::Scalar(10, 20, 30)));
    cv::Mat mask(2, 2, CV_8UC1, cv::Scalar(0));
    mask.at<unsigned char>(0, 1) = 255;
    cv::imwrite((folder_ / "mask.png").string(), mask);
    Material const m = load_material("Kd 1 1 1\nmap_Kd color.png\nmap_d mask.png\n");
    EXPECT_EQ(m.alpha_mode, AlphaMode::mask);
    Texture const& t = textures_.textures.at(std::size_t(m.base_color_map.texture));
    EXPECT_TRUE(t.srgb);
    Rgba8 const left = textures_.texels[t.first], right = textures_.texels[t.first + 1];
    EXPECT_EQ(std::vector<int>({left.r, left.g, left.b, left.a}), std::vector<int>({30, 20, 10, 0}));
    EXPECT_EQ(std::vector<int>({right.r, right.g, right.b, right.a}), std::vector<int>({30, 20, 10, 255}));
}

/// A picture of 2 x 2 texels whose channels are known.
TEST_F(AssimpFolder, ChannelsOfOpacityMaps)
{
    cv::imwrite((folder_ / "rgba.png").string(), cv::Mat(2, 2, CV_8UC4, cv::Scalar(30, 20, 10, 40))); // BGRA
    struct Case {
        char const* map;
        int alpha;
    };
    for (auto const& [map, alpha] : {Case{"map_d -imfchan r rgba.png", 10}, Case{"map_d -imfchan g rgba.png", 20},
                                     Case{"map_d -imfchan b rgba.png", 30}, Case{"map_d -imfchan m rgba.png", 40},
                                     Case{"map_d -imfchan l rgba.png", 19}, Case{"map_d rgba.png", 19},
                                     Case{"map_Kd rgba.png\nmap_d rgba.png", 40}}) {
        Material const m = load_material(std::string("Kd 1 1 1\n") + map + "\n");
        EXPECT_EQ(textures_.texels[textures_.textures.at(std::size_t(m.base_color_map.texture)).first].a, alpha)
            << map;
        EXPECT_EQ(m.alpha_mode, AlphaMode::mask) << map;
    }
}

TEST_F(AssimpFolder, MissingTexturesAreCounted)
{
    EXPECT_EQ(load_material("Kd 1 1 1\nmap_Kd nowhere.png\n").base_color_map.texture, -1);
    EXPECT_EQ(lost("textures that could not be read"), 1u);
}

TEST_F(AssimpFolder, MissingMaterialLibrariesAreCounted)
{
    std::string const triangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n",
                      what = "material libraries that could not be read";
    load("a.obj", "mtllib none.mtl\n" + triangle);
    EXPECT_EQ(lost(what), 1u);
    EXPECT_EQ(report_.losses().at(what).first, (folder_ / "none.mtl").string());
    load("a.obj", "mtllib a.mtl\n" + triangle);
    EXPECT_EQ(lost(what), 2u) << "of the file's own name";
    load("a.obj", triangle);
    write("a.mtl", "newmtl m\nKd 1 1 1\n");
    load("a.obj", "mtllib a.mtl\n" + triangle);
    EXPECT_EQ(lost(what), 2u);
}

/// The colour of a triangle of the material m.
vec3 color_of_m(Scene const& scene)
{
    return scene.materials.at(std::size_t(scene.meshes.at(0).material)).base_color;
}

TEST_F(AssimpFolder, WhichMaterialLibraryIsTaken)
{
    vec3 const one{1, 0, 0}, two{0, 1, 0}, own{0, 0, 1}, grey{0.6f};
    write("one.mtl", "newmtl m\nKd 1 0 0\nnewmtl x\nKd 1 1 1\n");
    write("two.mtl", "newmtl m\nKd 0 1 0\n");
    write("none.mtl", "newmtl x\nKd 1 1 1\n");
    write("two words.mtl", "newmtl m\nKd 0 1 0\n");
    struct Case {
        char const* statements;
        vec3 color;
        std::uint64_t other, unread, again, unknown; ///< see below
    };
    auto const check = [&](Case const& c, std::string const& obj) {
        Report fresh;
        Scene const scene = load_scene(
            write(obj, std::string(c.statements) + "\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n"), fresh);
        EXPECT_EQ(color_of_m(scene), c.color) << c.statements;
        auto const losses = fresh.losses();
        auto const count = [&](char const* what) { return losses.contains(what) ? losses.at(what).count : 0; };
        EXPECT_EQ(count("material libraries not found, another one taken"), c.other) << c.statements;
        EXPECT_EQ(count("material libraries that could not be read"), c.unread) << c.statements;
        EXPECT_EQ(count("materials of a library that an earlier one has: the first is taken"), c.again)
            << c.statements;
        EXPECT_EQ(count("materials that no library has, taken as grey"), c.unknown) << c.statements;
    };
    for (Case const& c :
         {Case{"mtllib one.mtl", one, 0, 0, 0, 0}, Case{"mtllib one.mtl two.mtl", one, 0, 0, 1, 0},
          Case{"mtllib two.mtl one.mtl", two, 0, 0, 1, 0}, Case{"mtllib none.mtl two.mtl", two, 0, 0, 0, 0},
          Case{"mtllib none.mtl\nmtllib two.mtl", two, 0, 0, 0, 0},
          Case{"mtllib two.mtl\nmtllib two.mtl two.mtl", two, 0, 0, 0, 0},
          Case{"mtllib two words.mtl", two, 0, 0, 0, 0}, Case{"mtllib none.mtl two words.mtl", two, 0, 0, 0, 0},
          Case{"mtllib \"two words.mtl\" one.mtl", two, 0, 0, 1, 0},
          Case{"mtllib gone.mtl two.mtl", two, 0, 1, 0, 0}, Case{"mtllib C:\\my\\two.mtl", two, 1, 0, 0, 0},
          Case{"mtllib gone.mtl", grey, 0, 1, 0, 1}, Case{"mtllib none.mtl", grey, 0, 0, 0, 1},
          Case{"", grey, 0, 0, 0, 1}})
        check(c, "thing.obj");
    write("thing.mtl", "newmtl m\nKd 0 0 1\n");
    for (Case const& c : {Case{"mtllib gone.mtl", own, 1, 0, 0, 0}, Case{"mtllib none.mtl", grey, 0, 0, 0, 1},
                          Case{"", grey, 0, 0, 0, 1}})
        check(c, "thing.obj");
}

/// A pipe that nobody writes to would be waited for without end.
TEST_F(AssimpFolder, PipesAndDevicesAreNotOpened)
{
    ASSERT_EQ(mkfifo((folder_ / "pipe.mtl").c_str(), 0600), 0);
    ASSERT_EQ(mkfifo((folder_ / "pipe.obj").c_str(), 0600), 0);
    EXPECT_EQ(load("a.obj", "mtllib pipe.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n").meshes.size(), 1u);
    EXPECT_EQ(lost("material libraries that could not be read"), 1u);
    EXPECT_NE(refusal((folder_ / "pipe.obj").string()).find("it is a pipe"), std::string::npos);
    EXPECT_NE(refusal("/dev/zero").find("it is a device"), std::string::npos);
}

TEST_F(AssimpFolder, HeadersWithoutAnEndAreRefusedAtOnce)
{
    double const begun_s = processor_s();
    for (std::string const header :
         {"ply\nformat ascii 1.0\ncomment x\n", "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x",
          "ply\nformat ascii 1.0\nelement verteroperty float x\ncomment end_headerx",
          "ply\nformat ascii 1.0\nelement vertexces\n0 1 0end_header\n0 0\n",
          "ply\nformat ascii 1.0\nelement vertexces\nendend_header_header\n0 0\n"})
        EXPECT_NE(refusal(write("a.ply", header)).find("no line end_header"), std::string::npos);
    EXPECT_LT(processor_s() - begun_s, 2);
}

/// For each of its bones, the reader of SMD looks through all of them.
TEST_F(AssimpFolder, AReaderThatTakesTooLongIsEnded)
{
    constexpr int kBones = 90000;
    std::string text = "version 1\nnodes\n", poses;
    for (int b = 0; b < kBones; ++b) {
        text += std::to_string(b) + " \"b\" -1\n";
        poses += std::to_string(b) + " 0 0 0 0 0 0\n";
    }
    text += "end\nskeleton\ntime 0\n" + poses +
            "end\ntriangles\nm\n0 0 0 0 0 0 1 0 0\n0 1 0 0 0 0 1 0 0\n0 0 1 0 0 0 1 0 0\nend\n";
    std::string const why = refusal(write("a.smd", text));
    EXPECT_NE(why.find("did not finish in"), std::string::npos) << why;
}

constexpr char const* kTriangle = "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n";
constexpr char const* kCrash = "1 1 1 1 0 0 0 0\np v\nfrom 0 0 0\na"; ///< crashes Assimp 5.2 as .nff

TEST_F(AssimpFolder, OneProcessTriesManyFiles)
{
    std::vector<fs::path> files;
    for (int k = 0; k < 40; ++k)
        files.emplace_back(k == 20 ? write("20.nff", kCrash)
                                   : write(std::to_string(k) + ".obj", k % 10 == 3 ? "nonsense" : kTriangle));
    AssimpTrials trials(files, AssimpFaces::merged);
    for (int k = 0; k < 40; ++k) {
        auto const outcome = trials.outcome(files[std::size_t(k)], AssimpFaces::merged);
        ASSERT_TRUE(outcome) << k;
        EXPECT_EQ(outcome->empty(), (k != 20 || !is_assimp_before(4)) && k % 10 != 3) << k << *outcome;
        EXPECT_EQ(outcome->find("crashed") != std::string::npos, k == 20 && is_assimp_before(4)) << *outcome;
    }
    EXPECT_FALSE(trials.outcome(folder_ / "other.obj", AssimpFaces::merged));
    EXPECT_FALSE(trials.outcome(files[0], AssimpFaces::polygons));
}

TEST_F(AssimpFolder, AModelThatCrashesAmongOthersIsNamed)
{
    std::string yaml = "models:\n";
    for (int k = 0; k < 30; ++k) {
        write(std::to_string(k) + ".obj", kTriangle);
        yaml += "  - file: " + std::to_string(k) + ".obj\n";
    }
    EXPECT_EQ(load("many.yaml", yaml).meshes.size(), 30u);
    write("bad.nff", kCrash);
    std::string const why = refusal(write("many.yaml", yaml + "  - file: bad.nff\n  - file: 3.obj\n"));
    EXPECT_NE(why.find("bad.nff"), std::string::npos) << why;
    EXPECT_NE(why.find(is_assimp_before(4) ? "crashed" : "no triangles"), std::string::npos) << why;
}

TEST_F(AssimpFolder, NumbersMayBeginWithAPoint)
{
    Scene const scene = load("a.obj", "v .5 0 0\nv 1 .25 -.5\nv\t0 1 .125\nvt .5 .5\nusemtl .3x\nf 1 2 3\n");
    ASSERT_EQ(scene.meshes.at(0).positions.size(), 3u);
    EXPECT_EQ(scene.meshes[0].positions[0], (vec3{0.5f, 0, 0}));
    EXPECT_EQ(scene.meshes[0].positions[1], (vec3{1, 0.25f, -0.5f}));
    EXPECT_EQ(scene.meshes[0].positions[2], (vec3{0, 1, 0.125f}));
}

/// A child that was forked while another thread held a lock may sleep for ever.
TEST(ChildProcess, OneThatStallsIsEnded)
{
    ChildProcess child([](int) { pause(); });
    std::string told;
    EXPECT_FALSE(child.read(told));
    EXPECT_FALSE(child.status());
}

TEST(ChildProcess, TellsAndEnds)
{
    ChildProcess child([](int pipe) { _exit(write(pipe, "abc", 3) == 3 ? 7 : 1); });
    std::string told;
    while (child.read(told)) {
    }
    EXPECT_EQ(told, "abc");
    EXPECT_EQ(WEXITSTATUS(child.status().value()), 7);
}

TEST_F(AssimpFolder, FilesThatWereReadAreNoted)
{
    cv::imwrite((folder_ / "color.png").string(), cv::Mat(2, 2, CV_8UC3, cv::Scalar(10, 20, 30)));
    write("m.mtl", "newmtl m\nKd 1 1 1\nmap_Kd color.png\n");
    Scene const scene = load("m.obj", "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl m\nf 1 2 3\n");
    std::set<std::string> expected;
    for (char const* name : {"m.obj", "m.mtl", "color.png"}) expected.insert((folder_ / name).string());
    EXPECT_EQ(std::set(scene.files.begin(), scene.files.end()), expected);
}

TEST_F(AssimpFolder, TextureCoordinatesStartAtTheTop)
{
    Scene const scene = load("uv.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\nf 1/1 2/2 3/3\n");
    Mesh const& mesh = scene.meshes.at(0);
    for (std::size_t i = 0; i < 3; ++i)
        EXPECT_EQ(mesh.uv0.at(i), (vec2{mesh.positions[i].x, 1 - mesh.positions[i].y}));
}

TEST_F(AssimpFolder, PlyStlAndOffAreRead)
{
    std::string const ply =
        "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 1\nproperty list uchar int vertex_indices\nend_header\n"
        "0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    std::string const stl = "solid s\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\nvertex 1 0 0\nvertex 0 1 0\n"
                            "endloop\nendfacet\nendsolid s\n";
    std::string const off = "OFF\n3 1 0\n0 0 0\n1 0 0\n0 1 0\n3 0 1 2\n";
    for (auto const& [name, text] :
         {std::pair{"a.ply", ply}, std::pair{"a.stl", stl}, std::pair{"a.off", off}, std::pair{"A.PLY", ply}}) {
        Scene const scene = load(name, text);
        ASSERT_EQ(scene.meshes.size(), 1u) << name;
        EXPECT_EQ(scene.meshes[0].triangles.size(), 1u) << name;
        EXPECT_EQ(scene.meshes[0].material, -1) << name;
    }
}

TEST_F(AssimpFolder, ColladaKeepsNodesCamerasLightsAndClips)
{
    Scene const scene = load("a.dae", R"(<?xml version="1.0"?>
<COLLADA xmlns="http://www.collada.org/2005/11/COLLADASchema" version="1.4.1">
<asset><unit meter="1"/><up_axis>Y_UP</up_axis></asset>
<library_cameras><camera id="cam" name="cam"><optics><technique_common><perspective><yfov>40</yfov>
<aspect_ratio>2</aspect_ratio><znear>0.1</znear><zfar>9</zfar></perspective></technique_common></optics></camera></library_cameras>
<library_lights><light id="lamp" name="lamp"><technique_common><point><color>3 2 1</color></point></technique_common></light></library_lights>
<library_geometries><geometry id="g"><mesh>
<source id="p"><float_array id="pa" count="9">0 0 0 1 0 0 0 1 0</float_array><technique_common>
<accessor source="#pa" count="3" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<vertices id="v"><input semantic="POSITION" source="#p"/></vertices>
<triangles count="1"><input semantic="VERTEX" source="#v" offset="0"/><p>0 1 2</p></triangles></mesh></geometry></library_geometries>
<library_animations><animation id="a">
<source id="ti"><float_array id="tia" count="2">0 2</float_array><technique_common><accessor source="#tia" count="2" stride="1"><param name="TIME" type="float"/></accessor></technique_common></source>
<source id="to"><float_array id="toa" count="6">0 0 0 4 0 0</float_array><technique_common><accessor source="#toa" count="2" stride="3"><param name="X" type="float"/><param name="Y" type="float"/><param name="Z" type="float"/></accessor></technique_common></source>
<sampler id="s"><input semantic="INPUT" source="#ti"/><input semantic="OUTPUT" source="#to"/></sampler>
<channel source="#s" target="n/place"/></animation></library_animations>
<library_visual_scenes><visual_scene id="vs"><node id="n" name="n"><translate sid="place">0 0 0</translate><instance_geometry url="#g"/></node>
<node id="m" name="m"><translate>7 0 0</translate><instance_geometry url="#g"/></node>
<node id="eye" name="eye"><translate>0 0 5</translate><instance_camera url="#cam"/></node>
<node id="bulb" name="bulb"><translate>0 3 0</translate><instance_light url="#lamp"/></node></visual_scene></library_visual_scenes>
<scene><instance_visual_scene url="#vs"/></scene></COLLADA>)");
    std::vector<double> places;
    ASSERT_EQ(scene.playbacks.size(), 1u);
    Pose const pose = evaluate_pose(scene, 1.0);
    for (std::size_t n = 0; n < scene.nodes.size(); ++n)
        if (!scene.nodes[n].meshes.empty()) places.push_back(pose.world_from_node[n][3].x);
    EXPECT_EQ(places, (std::vector<double>{2, 7}));
    ASSERT_EQ(scene.cameras.size(), 1u);
    EXPECT_NEAR(scene.cameras[0].yfov_rad, 40 * kPi / 180, 1e-4);
    ASSERT_EQ(scene.lights.size(), 1u);
    EXPECT_EQ(scene.lights[0].intensity, (vec3{3, 2, 1}));
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        if (scene.nodes[n].camera >= 0) {
            EXPECT_NEAR(pose.world_from_node[n][3].z, 5, 1e-6);
        }
        if (scene.nodes[n].light >= 0) {
            EXPECT_NEAR(pose.world_from_node[n][3].y, 3, 1e-6);
        }
    }
}

/// One triangle that hangs on five bones with the weights 0.1 ... 0.3 per vertex.
std::string skinned_collada()
{
    std::string joints, matrices, nodes, pairs;
    for (int b = 0; b < 5; ++b) {
        std::string const name = "bone" + std::to_string(b);
        joints += name + " ";
        matrices += "1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1 ";
        nodes += "<node id='" + name + "' sid='" + name + "' name='" + name + "' type='JOINT'><translate>0 " +
                 std::to_string(b) + " 0</translate></node>";
    }
    for (int v = 0; v < 3; ++v)
        for (int b = 0; b < 5; ++b) pairs += std::to_string(b) + " " + std::to_string(b) + " ";
    return "<?xml version='1.0'?><COLLADA xmlns='http://www.collada.org/2005/11/COLLADASchema' version='1.4.1'>"
           "<library_geometries><geometry id='g'><mesh>"
           "<source id='p'><float_array id='pa' count='9'>0 0 0 1 0 0 0 1 0</float_array><technique_common>"
           "<accessor source='#pa' count='3' stride='3'><param name='X' type='float'/><param name='Y' "
           "type='float'/>"
           "<param name='Z' type='float'/></accessor></technique_common></source>"
           "<vertices id='v'><input semantic='POSITION' source='#p'/></vertices>"
           "<triangles count='1'><input semantic='VERTEX' source='#v' offset='0'/><p>0 1 2</p></triangles>"
           "</mesh></geometry></library_geometries><library_controllers><controller id='c'><skin source='#g'>"
           "<bind_shape_matrix>1 0 0 0 0 1 0 0 0 0 1 0 0 0 0 1</bind_shape_matrix>"
           "<source id='j'><Name_array id='ja' count='5'>" +
           joints +
           "</Name_array><technique_common><accessor source='#ja' count='5' stride='1'>"
           "<param name='JOINT' type='name'/></accessor></technique_common></source>"
           "<source id='b'><float_array id='ba' count='80'>" +
           matrices +
           "</float_array><technique_common><accessor source='#ba' count='5' stride='16'>"
           "<param name='TRANSFORM' type='float4x4'/></accessor></technique_common></source>"
           "<source id='w'><float_array id='wa' count='5'>0.15 0.3 0.1 0.25 0.2</float_array><technique_common>"
           "<accessor source='#wa' count='5' stride='1'><param name='WEIGHT' type='float'/></accessor>"
           "</technique_common></source>"
           "<joints><input semantic='JOINT' source='#j'/><input semantic='INV_BIND_MATRIX' source='#b'/></joints>"
           "<vertex_weights count='3'><input semantic='JOINT' source='#j' offset='0'/>"
           "<input semantic='WEIGHT' source='#w' offset='1'/><vcount>5 5 5</vcount><v>" +
           pairs +
           "</v></vertex_weights></skin></controller></library_controllers>"
           "<library_visual_scenes><visual_scene id='s'><node id='rig'>" +
           nodes +
           "</node><node id='body'><instance_controller url='#c'><skeleton>#bone0</skeleton></instance_controller>"
           "</node></visual_scene></library_visual_scenes><scene><instance_visual_scene "
           "url='#s'/></scene></COLLADA>";
}

TEST_F(AssimpFolder, BonesBecomeASkinOfTheFourLargestWeights)
{
    Scene const scene = load("skinned.dae", skinned_collada());
    ASSERT_EQ(scene.skins.size(), 1u);
    EXPECT_EQ(scene.skins[0].joints.size(), 5u);
    Mesh const& mesh = scene.meshes.at(0);
    ASSERT_EQ(mesh.weights.size(), mesh.positions.size());
    double height = 0, all = 0;
    for (int k = 0; k < 4; ++k) {
        std::string const& bone =
            scene.nodes[std::size_t(scene.skins[0].joints[mesh.joints[0][std::size_t(k)]])].name;
        EXPECT_NE(bone, "bone2") << "the smallest";
        height += double(mesh.weights[0][k]) * (bone.back() - '0');
        all += double(mesh.weights[0][k]);
    }
    EXPECT_NEAR(all, 0.9, 1e-6);
    EXPECT_NEAR(height, 0.3 * 1 + 0.25 * 3 + 0.2 * 4, 1e-6);
    EXPECT_EQ(lost("bone weights beyond the largest four of a vertex, dropped"), mesh.positions.size());

    Report report;
    World const world = build_world(std::make_shared<Scene const>(scene), std::nullopt, report);
    EXPECT_NEAR(double(world.positions[0].y) + world.origin.y, height / all, 1e-5)
        << "each bone is lifted by its number";
}

TEST_F(AssimpFolder, FbxCentimetresBecomeMetres)
{
    Scene const scene = load("a.fbx", R"(; FBX 7.4.0 project file
FBXHeaderExtension:  {
	FBXHeaderVersion: 1003
	FBXVersion: 7400
}
GlobalSettings:  {
	Version: 1000
	Properties70:  {
		P: "UnitScaleFactor", "double", "Number", "",1
	}
}
Objects:  {
	Geometry: 10, "Geometry::", "Mesh" {
		Vertices: *9 {
			a: 0,0,0,100,0,0,0,100,0
		}
		PolygonVertexIndex: *3 {
			a: 0,1,-3
		}
		GeometryVersion: 124
	}
	Model: 20, "Model::tri", "Mesh" {
		Version: 232
	}
}
Connections:  {
	C: "OO",20,0
	C: "OO",10,20
}
)");
    Pose const pose = evaluate_pose(scene, std::nullopt);
    std::size_t found = 0;
    for (std::size_t n = 0; n < scene.nodes.size(); ++n)
        for (std::int32_t const m : scene.nodes[n].meshes)
            for (vec3 const p : scene.meshes[std::size_t(m)].positions) {
                double const x = (pose.world_from_node[n] * glm::dvec4(dvec3(p), 1)).x;
                EXPECT_TRUE(std::abs(x) < 1e-6 || std::abs(x - 1) < 1e-6) << x;
                ++found;
            }
    EXPECT_EQ(found, 3u);
}

TEST_F(AssimpFolder, WhatCannotBeASceneIsRefusedWithAReason)
{
    auto const refusal = [&](std::string const& file) -> std::string {
        try {
            load_scene(file, report_);
        } catch (InputError const& e) {
            return e.what();
        }
        return "accepted";
    };
    EXPECT_NE(refusal(write("empty.obj", "")).find("is empty"), std::string::npos);
    EXPECT_NE(refusal(write("points.obj", "v 0 0 0\nv 1 0 0\n")).find("points.obj"), std::string::npos);
    EXPECT_NE(refusal(write("what.xyzzy", "nothing known")).find("cannot be read"), std::string::npos);
    for (char const* name : {"a.blend", "a.USDA", "a.usdz", "a.pbrt", "a.xml"})
        EXPECT_NE(refusal(write(name, "<scene/>")).find("save it as glTF"), std::string::npos) << name;
    EXPECT_NE(refusal((folder_ / "what.xyzzy").string()).find("another format"), std::string::npos);
    EXPECT_NE(refusal(folder_.string()).find("empty.obj"), std::string::npos)
        << "a folder is a sequence of frames";
    fs::create_directories(folder_ / "bare");
    EXPECT_NE(refusal((folder_ / "bare").string()).find("folder"), std::string::npos);
    EXPECT_NE(refusal("no_such_scene").find("atrium, cornell"), std::string::npos);
    std::string const large = refusal(write("loop.off", "OFF\n99999999 99999999 0\n"));
    EXPECT_NE(large, "accepted");
    EXPECT_EQ(large.find("bad_alloc"), std::string::npos) << large;
    std::string const bad_index = refusal(write("index.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n"));
    EXPECT_NE(bad_index.find("export glTF"), std::string::npos) << bad_index;
    EXPECT_EQ(bad_index.find("another format"), std::string::npos) << bad_index;
}

} // namespace
} // namespace gi::test
