// Scene files: what they build, what they refuse and how they say so, and that the schema knows the same keys.

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/scene/load/load.h"
#include "gi/scene/load/scene_file_keys.h"
#include "gi/scene/model/sky.h"
#include "tests/support/processor_time.h"
#include "tests/support/scenes.h"

#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <set>
#include <unistd.h>

namespace gi::test {
namespace {

namespace fs = std::filesystem;

Scene parse(std::string const& text)
{
    Report report;
    return parse_scene_file(text, {}, "test.yaml", report);
}

/// The message with which a text is refused, or a file.
template <class Read>
std::string message_of(Read const& read)
{
    try {
        read();
    } catch (InputError const& e) {
        return e.what();
    }
    return "was accepted";
}

std::string refusal(std::string const& text)
{
    return message_of([&] { parse(text); });
}

void expect_parts(std::string const& message, std::vector<std::string> const& parts)
{
    for (std::string const& part : parts)
        EXPECT_NE(message.find(part), std::string::npos) << message << "\n" << part;
}

void expect_refusal(std::string const& text, std::vector<std::string> const& parts)
{
    SCOPED_TRACE(text);
    expect_parts(refusal(text), parts);
}

class SceneFileFolder : public testing::Test {
protected:
    SceneFileFolder() : folder_(fs::temp_directory_path() / ("lightwell_scene_file_" + std::to_string(getpid())))
    {
        fs::create_directories(folder_ / "sub");
    }
    ~SceneFileFolder() override { fs::remove_all(folder_); }

    void expect_file_refusal(std::string const& text, std::vector<std::string> const& parts)
    {
        fs::path const file = folder_ / "a.yaml";
        write_text(file, text);
        expect_parts(message_of([&] { load_scene_file(file, report_); }), parts);
    }

    fs::path folder_;
    Report report_;
};

/// A glTF file without a material, its points in triangle.bin beside it.
void write_triangle(fs::path const& folder, std::string const& name)
{
    write_text(folder / name, R"({"asset": {"version": "2.0"}, "scene": 0, "scenes": [{"nodes": [0]}],
"nodes": [{"mesh": 0}], "meshes": [{"primitives": [{"attributes": {"POSITION": 0}}]}],
"accessors": [{"bufferView": 0, "componentType": 5126, "count": 3, "type": "VEC3", "min": [0, 0, 0], "max": [1, 1, 0]}],
"bufferViews": [{"buffer": 0, "byteLength": 36}], "buffers": [{"byteLength": 36, "uri": "triangle.bin"}]})");
    float const points[9] = {0, 0, 0, 1, 0, 0, 0, 1, 0};
    write_text(folder / "triangle.bin", {reinterpret_cast<char const*>(points), sizeof points});
}

TEST(SceneFile, PlacesModelsByScaleRotationTranslation)
{
    Scene const scene = parse(R"(
models:
  - {generate: {kind: cornell}, translate: [10, 0, 0], rotate: [0, 90, 0], scale: [2, 1, 1]}
)");
    dmat4 const& m = scene.nodes.at(0).matrix.value();
    EXPECT_LT(glm::distance(dvec3(m * glm::dvec4(1, 0, 0, 1)), dvec3{10, 0, -2}), 1e-12);
    EXPECT_LT(glm::distance(dvec3(m * glm::dvec4(0, 3, 1, 1)), dvec3{11, 3, 0}), 1e-12);
}

TEST(SceneFile, EulerAnglesTurnAboutXThenYThenZ)
{
    Scene const scene = parse("models: [{generate: {kind: cornell}, rotate: [90, 90, 0]}]");
    dvec3 const y(scene.nodes.at(0).matrix.value()[1]); // y to z by x, then to x by y
    EXPECT_LT(glm::distance(y, dvec3{1, 0, 0}), 1e-12);
}

TEST(SceneFile, LightsShineWhereTheyAreTold)
{
    Scene const scene = parse(R"(
lights:
  - {type: point, position: [1, 2, 3], intensity: [1, 2, 3], range: 9}
  - {type: spot, position: [0, 5, 0], target: [0, 0, 5], intensity: 4, cone: [10, 60]}
  - {type: directional, direction: [2, 0, 0]}
)");
    World const w = world_of(scene);
    ASSERT_EQ(w.lights.size(), 3u);
    EXPECT_EQ(w.lights[0].position, (vec3{1, 2, 3}));
    EXPECT_EQ(w.lights[0].intensity, (vec3{1, 2, 3}));
    EXPECT_EQ(w.lights[0].range, 9);
    EXPECT_LT(glm::distance(w.lights[1].direction, glm::normalize(vec3{0, -1, 1})), 1e-6f);
    EXPECT_NEAR(w.lights[1].cos_outer, 0.5f, 1e-6f);
    EXPECT_EQ(w.lights[2].type, LightType::directional);
    EXPECT_LT(glm::distance(w.lights[2].direction, vec3{1, 0, 0}), 1e-6f);
}

TEST(SceneFile, BothKindsOfRectangleAreTheSameLamp)
{
    World const edges = world_of(
        parse("lights: [{type: rectangle, position: [-1, 3, -0.5], u: [2, 0, 0], v: [0, 0, 1], radiance: 5}]"));
    World const size = world_of(parse(
        "lights: [{type: rectangle, position: [0, 3, 0], size: [2, 1], direction: [0, -1, 0], radiance: 5}]"));
    for (World const* w : {&edges, &size}) {
        ASSERT_EQ(w->triangles.size(), 2u);
        EXPECT_EQ(w->emitters.size(), 2u);
        EXPECT_LT(glm::distance(w->bounds.low, vec3{-1, 3, -0.5f}), 1e-6f);
        EXPECT_LT(glm::distance(w->bounds.high, vec3{1, 3, 0.5f}), 1e-6f);
        uvec3 const t = w->triangles[0];
        vec3 const a = w->positions[t.x];
        EXPECT_LT(glm::cross(w->positions[t.y] - a, w->positions[t.z] - a).y, 0) << "it shines down";
        EXPECT_FALSE(w->materials[w->triangle_material[0]].double_sided);
    }
}

TEST(SceneFile, OwnCamerasComeFirst)
{
    World const w = world_of(parse(R"(
models: [{generate: {kind: cornell}}]
cameras:
  - {name: front, from: [0, 1, 5], at: [0, 1, 0], fov: 30}
  - {name: plan, from: [0, 5, 0], at: [0, 0, 0], height: 3}
)"));
    ASSERT_EQ(w.cameras.size(), 3u);
    EXPECT_EQ(w.cameras[0].name, "front");
    EXPECT_NEAR(w.cameras[0].yfov_rad, glm::radians(30.0), 1e-12);
    EXPECT_LT(glm::distance(dvec3(w.cameras[0].world_from_camera[3]), dvec3{0, 1, 5}), 1e-12);
    EXPECT_TRUE(w.cameras[1].orthographic);
    EXPECT_EQ(w.cameras[1].ymag_m, 1.5);
    EXPECT_LT(glm::distance(-dvec3(w.cameras[1].world_from_camera[2]), dvec3{0, -1, 0}), 1e-12);
}

TEST(SceneFile, CamerasHaveLenses)
{
    auto const camera = [](std::string const& keys) {
        return world_of(parse("models: [{generate: {kind: cornell}}]\n"
                              "cameras: [{name: front, from: [0, 1, 5], at: [0, 1, 1]" +
                              keys + "}]"))
            .cameras[0];
    };
    EXPECT_EQ(camera("").aperture_radius_m, 0);
    Camera const lens = camera(", aperture_radius: 0.02, focus_distance: 3");
    EXPECT_EQ(lens.aperture_radius_m, 0.02);
    EXPECT_EQ(lens.focus_distance_m, 3);
    EXPECT_DOUBLE_EQ(camera(", aperture_radius: 0.02").focus_distance_m, 4) << "on what it looks at";
    for (char const* bad : {", focus_distance: 3", ", aperture_radius: -1", ", aperture_radius: .nan",
                            ", aperture_radius: 0.1, focus_distance: 0",
                            ", aperture_radius: 0.1, focus_distance: .inf", ", aperture_radius: 0.1, height: 2"})
        EXPECT_THROW(camera(bad), InputError) << bad;
}

TEST(SceneFile, CamerasLeaveSkinsAndClipsWithTheirNodes)
{
    Scene const scene = parse(R"(
models: [{generate: {kind: atrium, bays: 1, detail: 0.2}, translate: [5, 0, 0], animation: walk}]
cameras: [{name: front, from: [0, 1, 5], at: [0, 1, 0]}]
)");
    Scene const bare = parse("models: [{generate: {kind: atrium, bays: 1, detail: 0.2}, translate: [5, 0, 0]}]");
    Report report;
    World const w = build_world(std::make_shared<Scene const>(scene), 0.4, report);
    World const b = build_world(std::make_shared<Scene const>(bare), 0.4, report);
    EXPECT_EQ(w.positions, b.positions);
}

TEST(SceneFile, ClipsAreChosen)
{
    std::string const model = "models: [{generate: {kind: atrium, bays: 1, detail: 0.2}, animation: ";
    EXPECT_TRUE(parse(model + "none}]").playbacks.empty());
    Playback const p = parse(model + "{clip: walk, offset: 0.5, speed: -2, loop: false}}]").playbacks.at(0);
    EXPECT_EQ(p.offset_s, 0.5);
    EXPECT_EQ(p.speed, -2);
    EXPECT_FALSE(p.loop);
    EXPECT_EQ(p.weight, 1);
    expect_refusal(model + "run}]", {"test.yaml:1:", "'run'", "walk"});
}

TEST(SceneFile, SkinningIsChosen)
{
    std::string const model = "models: [{generate: {kind: atrium, bays: 1, detail: 0.2}";
    EXPECT_EQ(parse(model + "}]").skins.at(0).method, SkinningMethod::linear);
    EXPECT_EQ(parse(model + ", skinning: dual_quaternion}]").skins.at(0).method, SkinningMethod::dual_quaternion);
    expect_refusal(model + ", skinning: cubic}]", {"test.yaml:1:", "'cubic'", "linear"});
}

TEST(SceneFile, SeveralClipsAreBlended)
{
    std::string const model = "models:\n  - generate: {kind: atrium, bays: 1, detail: 0.2}\n    animation:\n";
    Scene const scene = parse(model + "      - walk\n      - {weight: 0.25, speed: 2, offset: 1}\n");
    ASSERT_EQ(scene.playbacks.size(), 2u);
    EXPECT_EQ(scene.playbacks[0].weight, 1);
    EXPECT_EQ(scene.playbacks[1].animation, scene.playbacks[0].animation) << "the only clip needs no name";
    EXPECT_EQ(scene.playbacks[1].weight, 0.25);
    EXPECT_EQ(scene.playbacks[1].speed, 2);
    EXPECT_TRUE(parse(model + "      []\n").playbacks.empty());
    expect_refusal(model + "      - walk\n      - jump\n", {"test.yaml:5:9", "'jump'", "walk"});
    expect_refusal(model + "      - {clip: walk, weight: -1}\n", {"test.yaml:4:30", "between"});
    expect_refusal(model + "      - {clip: walk, wieght: 1}\n", {"test.yaml:4:22", "'wieght'", "weight"});
    expect_refusal(model + "      - {clip: [walk]}\n", {"test.yaml:4:", "not text"});
    expect_refusal("models: [{generate: {kind: cornell}, animation: {speed: 2}}]",
                   {"test.yaml:1:", "needs a clip"});
}

TEST(SceneFile, OverridesReachWhatTheyMatch)
{
    Scene const scene = parse(R"(
models:
  - {name: a, generate: {kind: cornell}}
  - {name: b, generate: {kind: cornell}}
materials:
  - {match: "w*te", base_color: [0.1, 0.2, 0.3], roughness: 0.4, metallic: 0.5, specular: 0.6, ior: 1.7}
  - {match: green, model: b, transmission: 0.8, emission: 9, thin: false, double_sided: true, alpha: 0.5}
  - {match: red, base_color: 0.5, phong: {specular: [0.1, 0.2, 0.5], exponent: 50}}
)");
    auto const named = [&](std::string const& name, int which) {
        for (std::size_t i = 0; i < scene.materials.size(); ++i)
            if (scene.material_names[i] == name && which-- == 0) return scene.materials[i];
        ADD_FAILURE() << name;
        return Material{};
    };
    for (int const which : {0, 1}) {
        Material const white = named("white", which);
        EXPECT_EQ(white.base_color, (vec3{0.1f, 0.2f, 0.3f}));
        EXPECT_EQ(white.roughness, 0.4f);
        EXPECT_EQ(white.metallic, 0.5f);
        EXPECT_EQ(white.specular, 0.6f);
        EXPECT_EQ(white.ior, 1.7f);
    }
    EXPECT_EQ(named("green", 0).transmission, 0);
    Material const green = named("green", 1);
    EXPECT_EQ(green.transmission, 0.8f);
    EXPECT_EQ(green.emission, vec3{9});
    EXPECT_FALSE(green.thin);
    EXPECT_TRUE(green.double_sided);
    EXPECT_EQ(green.alpha, 0.5f);
    EXPECT_EQ(green.alpha_mode, AlphaMode::blend);
    Material const red = named("red", 1);
    EXPECT_EQ(red.model, MaterialModel::phong);
    EXPECT_EQ(red.phong_specular, (vec3{0.1f, 0.2f, 0.5f}));
    EXPECT_EQ(red.phong_exponent, 50);
}

TEST(SceneFile, EnvironmentOfOneColour)
{
    Scene const scene = parse("environment: {color: [1, 2, 3], rotate: 90, scale: 2}");
    for (vec3 const v : scene.environment->radiance) EXPECT_EQ(v, (vec3{1, 2, 3}));
    EXPECT_NEAR(scene.environment->rotation_rad, 0.5f * kPi, 1e-6f);
    EXPECT_EQ(scene.environment->scale, vec3{2});
}

TEST(SceneFile, SkiesAndBackgrounds)
{
    Scene const scene = parse("environment: {sky: {turbidity: 4, sun_elevation: 20, sun_azimuth: 10, sun: false, "
                              "ground_albedo: [0.1, 0.2, 0.3], size: [32, 16]}, scale: 0.5}");
    SkyOptions options;
    options.turbidity = 4;
    options.sun_elevation_deg = 20;
    options.sun_azimuth_deg = 10;
    options.sun = false;
    options.ground_albedo = {0.1f, 0.2f, 0.3f};
    options.width = 32;
    options.height = 16;
    EXPECT_EQ(scene.environment->radiance, sky_map(options).radiance);
    EXPECT_EQ(scene.environment->scale, vec3{0.5f});
    EXPECT_EQ(parse("models: []").background.kind, BackgroundKind::map);
    EXPECT_EQ(parse("background: map").background.kind, BackgroundKind::map);
    EXPECT_EQ(parse("background: transparent").background.kind, BackgroundKind::transparent);
    EXPECT_EQ(parse("background: [1, 2, 3]").background.color, (vec3{1, 2, 3}));
    expect_refusal("background: blue", {"background", "transparent"});
    expect_refusal("background: [1, 2]", {"1:13"});
    expect_refusal("environment: {sky: {turbidity: 1}}", {"turbidity"});
    expect_refusal("environment: {sky: {size: [64]}}", {"two numbers"});
    expect_refusal("environment: {sky: {clouds: 1}}", {"clouds"});
    expect_refusal("environment: {sky: {}, color: 1}", {"either"});
}

TEST(SceneFile, MistakesAreNamedWithTheirPlace)
{
    expect_refusal("models:\n  - {generate: {kind: cornell}, tanslate: [0, 0, 0]}",
                   {"test.yaml:2:33", "'translate'"});
    expect_refusal("modles: []", {"test.yaml:1:1", "'models'"});
    expect_refusal("cameras: []\ncameras: []", {"test.yaml:2:1", "twice"});
    expect_refusal("models: [{generate: {kind: cornell}, scale: big}]", {"test.yaml:1:", "not a number"});
    expect_refusal("models: [{generate: {kind: cornell}, scale: .nan}]", {"not a number"});
    expect_refusal("models: [{generate: {kind: cornell}, scale: nan}]", {"test.yaml:1:"});
    expect_refusal("models: [{generate: {kind: cornell}, scale: inf}]", {"test.yaml:1:"});
    expect_refusal("models: [{generate: {kind: cornell}, scale: [1, 2]}]", {"three"});
    expect_refusal("models: [{generate: {kind: castle}}]", {"castle", "atrium"});
    expect_refusal("models: [{generate: {kind: boxes, triangles: 1e18}}]", {"between"});
    expect_refusal("models: [{generate: {kind: cornell, triangles: 100}}]",
                   {"test.yaml:1:48", "cornell has no key 'triangles'"});
    expect_refusal("models: [{generate: {kind: atrium, seed: 1}}]", {"'seed'"});
    expect_refusal("models: [{generate: {kind: sphere, bays: 1}}]", {"'bays'"});
    expect_refusal("models: [{}]", {"file or generate"});
    expect_refusal("lights: [{type: lava}]", {"lava", "rectangle"});
    expect_refusal("lights: [{type: point, cone: [1, 2]}]", {"cone"});
    expect_refusal("lights: [{type: point, intensity: -1}]", {"between"});
    expect_refusal("lights: [{type: spot, target: [0, 0, 0]}]", {"no direction"});
    expect_refusal("lights: [{type: spot, target: [0, 1, 0], direction: [0, 1, 0]}]", {"both"});
    expect_refusal("lights: [{type: spot, cone: [50, 40]}]", {"between"});
    expect_refusal("lights: [{type: rectangle, position: [0, 0, 0], radiance: 1}]", {"needs u"});
    expect_refusal("lights: [{type: rectangle, position: [0, 0, 0], u: [1, 0, 0], v: [2, 0, 0], radiance: 1}]",
                   {"no area"});
    expect_refusal("lights: [{type: rectangle, position: [0, 0, 0], u: [1, 0, 0], size: [1, 2], radiance: 1}]",
                   {"contradict"});
    expect_refusal("cameras: [{name: a, from: [0, 0, 0], at: [0, 0, 0]}]", {"test.yaml:1:11", "direction"});
    expect_refusal("cameras: [{name: a, from: [0, 0, 0], at: [0, 0, 1], fov: 180}]", {"between"});
    expect_refusal("environment: {color: 1, file: a.hdr}", {"either"});
    expect_refusal("models: [{generate: {kind: cornell}}]\nmaterials: [{match: gold}]",
                   {"test.yaml:2:", "'gold'", "white"});
    expect_refusal("models: [{generate: {kind: cornell}}]\nmaterials: [{match: red, model: hall}]", {"'hall'"});
    expect_refusal(
        "models: [{generate: {kind: cornell}}]\nmaterials: [{match: red, base_color: 0.9, phong: {specular: "
        "0.2}}]",
        {"more than 1"});
    expect_refusal(
        "models: [{generate: {kind: cornell}}]\nmaterials: [{match: red, base_color: 0.5, phong: {specular: "
        "0.4}}, {match: red, base_color: 0.9}]",
        {"more than 1"});
    expect_refusal("models: [\n  {a: 1", {"test.yaml:", "not YAML"});
    expect_refusal("", {"test.yaml"});
    expect_refusal("just words", {"test.yaml"});
}

TEST(SceneFile, TextFromMemoryOpensNoFiles)
{
    expect_refusal("models: [{file: /etc/passwd}]", {"no files"});
    expect_refusal("environment: {file: /etc/passwd}", {"no files"});
}

/// Short texts that ask for deep stacks or much memory are refused at once.
TEST(SceneFile, BombsAreRefused)
{
    std::string brackets = "models: ", dashes = "models:\n", nested, question;
    for (int i = 0; i < 100000; ++i) brackets += "[{a: ", dashes += "- ", question += "? ";
    for (int i = 0; i < 1000; ++i) nested += std::string(std::size_t(i), ' ') + "a:\n";
    std::string laughs = "a0: &a0 [1, 1]\n";
    for (int i = 1; i < 40; ++i) {
        std::string const n = std::to_string(i), below = "*a" + std::to_string(i - 1);
        laughs += "a" + n + ": &a" + n + " [" + below + ", " + below + "]\n";
    }
    laughs += "models: *a39";
    double const start_s = processor_s();
    for (std::string const& text : {brackets, dashes, nested, question, laughs, std::string("models: &a [*a]"),
                                    std::string(std::size_t(2) << 20, ' ')})
        EXPECT_NE(refusal(text), "was accepted") << text.substr(0, 40);
    EXPECT_LT(processor_s() - start_s, 5);
}

TEST_F(SceneFileFolder, ScenesIncludeScenesRelativeToThemselves)
{
    write_text(folder_ / "sub/inner.yaml",
               "models: [{generate: {kind: cornell}, scale: 2}]\nenvironment: {color: 1}");
    write_text(folder_ / "outer.yaml",
               "models: [{file: sub/inner.yaml, translate: [1, 0, 0], name: in}]\n"
               "environment: {color: 3}\nmaterials: [{match: red, model: in, roughness: 0}]");
    Scene const scene = load_scene_file(folder_ / "outer.yaml", report_);
    World const w = world_of(scene);
    EXPECT_NEAR(w.bounds.low.x, 1, 1e-5f);
    EXPECT_GT(w.bounds.high.x, 2);
    EXPECT_EQ(scene.environment->radiance[0], vec3{3});
    EXPECT_EQ(report_.losses().size(), 1u) << "the inner environment is counted as lost";
}

TEST_F(SceneFileFolder, FilesThatWereReadAreNoted)
{
    write_triangle(folder_ / "sub", "a.gltf");
    cv::imwrite((folder_ / "sky.hdr").string(), cv::Mat(2, 4, CV_32FC3, cv::Scalar(1, 1, 1)));
    write_text(folder_ / "sub/inner.yaml", "models: [{file: a.gltf}]\nenvironment: {color: 1}");
    write_text(folder_ / "outer.yaml", "models: [{file: sub/inner.yaml}]\nenvironment: {file: sky.hdr}");
    std::set<std::string> expected;
    for (char const* name : {"outer.yaml", "sky.hdr", "sub/inner.yaml", "sub/a.gltf", "sub/triangle.bin"})
        expected.insert((folder_ / name).string());
    std::vector<std::string> const files = load_scene_file(folder_ / "outer.yaml", report_).files;
    EXPECT_EQ(std::set(files.begin(), files.end()), expected);
    EXPECT_TRUE(parse("models: [{generate: {kind: cornell}}]").files.empty());
}

TEST_F(SceneFileFolder, LoopsOfScenesAreRefused)
{
    write_text(folder_ / "a.yaml", "models: [{file: sub/b.yaml}, {file: sub/b.yaml}]");
    write_text(folder_ / "sub/b.yaml", "models: [{file: ../a.yaml}, {file: ../a.yaml}]");
    EXPECT_THROW(load_scene_file(folder_ / "a.yaml", report_), InputError);
    expect_file_refusal("models: [{file: ./a.yaml}]", {"a.yaml:1:17", "include each other 8 deep"});
}

/// 20^7 models by eight small files.
TEST_F(SceneFileFolder, TreesOfScenesAreLimited)
{
    for (int i = 0; i < 8; ++i) {
        std::string text = "models:\n";
        for (int k = 0; k < 20; ++k) text += "  - {file: s" + std::to_string(i + 1) + ".yaml}\n";
        write_text(folder_ / ("s" + std::to_string(i) + ".yaml"), i < 7 ? text : "cameras: []");
    }
    EXPECT_THROW(load_scene_file(folder_ / "s0.yaml", report_), InputError);
    EXPECT_NO_THROW(load_scene_file(folder_ / "s5.yaml", report_)) << "the count begins anew";
}

TEST_F(SceneFileFolder, MissingFilesAreNamed)
{
    expect_file_refusal("models: [{file: house.glb}]", {"a.yaml:1:17", "house.glb", "check the path"});
    expect_file_refusal("models: [{file: cornell}]", {"a.yaml:1:17", "generate: {kind: cornell}"});
    expect_file_refusal("cameras: []\nenvironment: {file: sky.hdr}", {"a.yaml:2:21", "sky.hdr"});
    expect_file_refusal("environment: {file: cornell}", {"a.yaml:1:21", "check the path"});
    EXPECT_THROW(load_scene_file(folder_ / "none.yaml", report_), InputError);
    EXPECT_THROW(load_scene_file(folder_, report_), InputError);
}

TEST_F(SceneFileFolder, MeshesWithoutMaterialCanBeOverridden)
{
    write_triangle(folder_, "triangle.gltf");
    write_text(folder_ / "a.yaml",
               "models: [{file: triangle.gltf}]\nmaterials: [{match: default, roughness: 0.125}]");
    World const w = world_of(load_scene_file(folder_ / "a.yaml", report_));
    ASSERT_EQ(w.triangles.size(), 1u);
    EXPECT_EQ(w.materials[w.triangle_material[0]].roughness, 0.125f);
}

nlohmann::json schema()
{
    std::ifstream in(fs::path(LIGHTWELL_SOURCE_DIR) / "data/scene.schema.json");
    return nlohmann::json::parse(in);
}

TEST(SceneFile, SchemaAndReaderKnowTheSameKeys)
{
    std::map<std::string, std::set<std::string>> in_schema;
    nlohmann::json const document = schema(); // outlives the loop
    for (auto const& [name, definition] : document.at("$defs").items())
        for (auto const& [key, value] : definition.at("properties").items()) in_schema[name].insert(key);
    EXPECT_EQ(in_schema, scene_file_keys());
}

TEST(SceneFile, SchemaAndReaderKnowTheSameKindsOfGenerated)
{
    nlohmann::json const generate = schema().at("$defs").at("generate");
    std::set<std::string> kinds;
    for (auto const& [kind, keys] : keys_of_generated()) {
        kinds.insert(kind);
        for (std::string const& key : keys) EXPECT_TRUE(generate.at("properties").contains(key)) << key;
    }
    EXPECT_EQ(generate.at("properties").at("kind").at("enum").get<std::set<std::string>>(), kinds);
}

TEST(SceneFile, TheCrowdLoadsAndMoves)
{
    Report report;
    World const w = world_of(load_scene_file(fs::path(LIGHTWELL_SOURCE_DIR) / "data/crowd.yaml", report));
    EXPECT_TRUE(report.losses().empty());
    EXPECT_GT(double(w.triangles.size() - w.static_triangles), 0.9 * double(w.triangles.size()));
    EXPECT_EQ(w.cameras.size(), 1u);
}

TEST(SceneFile, TheExampleLoads)
{
    Report report;
    World const w = world_of(load_scene_file(fs::path(LIGHTWELL_SOURCE_DIR) / "data/example.yaml", report));
    EXPECT_TRUE(report.losses().empty());
    EXPECT_GT(w.triangles.size(), 1500u);
    ASSERT_GE(w.cameras.size(), 3u);
    EXPECT_EQ(w.cameras[0].name, "corner");
    EXPECT_EQ(w.lights.size(), 1u);
    EXPECT_GT(w.environment_pdf, 0);
}

} // namespace
} // namespace gi::test
