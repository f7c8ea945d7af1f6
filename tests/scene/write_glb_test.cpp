// What is written comes back: through a GLB every part of a scene survives.

#include "gi/core/file.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/generate/write_glb.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/world.h"
#include "tests/scene/scene_checks.h"
#include "tests/support/scenes.h"

#include <cstring>
#include <nlohmann/json.hpp>
#include <set>
#include <unistd.h>

namespace gi::test {
namespace {

using json = nlohmann::json;

class WriteGlb : public ::testing::Test {
protected:
    WriteGlb()
    {
        auto const* const info = ::testing::UnitTest::GetInstance()->current_test_info();
        folder_ = std::filesystem::temp_directory_path() /
                  (std::string("lightwell_glb_") + info->name() + "_" + std::to_string(::getpid()));
        std::filesystem::create_directories(folder_);
    }
    ~WriteGlb() override { std::filesystem::remove_all(folder_); }

    Scene round_trip(Scene const& scene)
    {
        Report report;
        write_glb(folder_ / "scene.glb", scene, report);
        return load_gltf(folder_ / "scene.glb", report);
    }
    std::filesystem::path folder_;
};

void expect_close(vec3 a, vec3 b, char const* what)
{
    EXPECT_NEAR(glm::distance(a, b), 0, 1e-6 * double(1 + glm::length(b))) << what;
}

/// Same texels, sampled in the same way.
void expect_same(TexturePool const& a, TextureRef const& ra, TexturePool const& b, TextureRef const& rb,
                 char const* what)
{
    ASSERT_EQ(ra.texture >= 0, rb.texture >= 0) << what;
    if (ra.texture < 0) return;
    EXPECT_EQ(ra.uv_set, rb.uv_set) << what;
    EXPECT_NEAR(glm::distance(ra.row_u, rb.row_u), 0, 1e-5) << what;
    EXPECT_NEAR(glm::distance(ra.row_v, rb.row_v), 0, 1e-5) << what;
    EXPECT_NEAR(glm::distance(ra.offset, rb.offset), 0, 1e-6) << what;
    Texture const &ta = a.textures.at(std::size_t(ra.texture)), &tb = b.textures.at(std::size_t(rb.texture));
    ASSERT_TRUE(ta.width == tb.width && ta.height == tb.height) << what;
    EXPECT_TRUE(ta.wrap_u == tb.wrap_u && ta.wrap_v == tb.wrap_v && ta.nearest == tb.nearest) << what;
    EXPECT_EQ(ta.srgb, tb.srgb) << what;
    EXPECT_EQ(std::memcmp(&a.texels[ta.first], &b.texels[tb.first], std::size_t(4) * ta.width * ta.height), 0)
        << what;
}

void expect_same(Scene const& sa, Material const& a, Scene const& sb, Material const& b)
{
    EXPECT_EQ(a.model, b.model);
    EXPECT_EQ(a.alpha_mode, b.alpha_mode);
    EXPECT_EQ(a.double_sided, b.double_sided);
    EXPECT_EQ(a.unlit, b.unlit);
    EXPECT_EQ(a.thin, b.thin);
    expect_close(a.base_color, b.base_color, "base_color");
    EXPECT_FLOAT_EQ(a.alpha, b.alpha);
    if (a.alpha_mode == AlphaMode::mask) {
        EXPECT_FLOAT_EQ(a.alpha_cutoff, b.alpha_cutoff);
    }
    EXPECT_FLOAT_EQ(a.metallic, b.metallic);
    if (a.model == MaterialModel::metal_rough) {
        EXPECT_FLOAT_EQ(a.roughness, b.roughness);
    }
    EXPECT_FLOAT_EQ(a.specular, b.specular);
    expect_close(a.specular_color, b.specular_color, "specular_color");
    EXPECT_FLOAT_EQ(a.ior, b.ior);
    EXPECT_FLOAT_EQ(a.transmission, b.transmission);
    expect_close(a.phong_specular, b.phong_specular, "phong_specular");
    EXPECT_FLOAT_EQ(a.phong_exponent, b.phong_exponent);
    expect_close(a.emission, b.emission, "emission");
    if (a.normal_map.texture >= 0) {
        EXPECT_FLOAT_EQ(a.normal_scale, b.normal_scale);
    }
    auto const map = [&](TextureRef Material::*ref, char const* what) {
        expect_same(sa.textures, a.*ref, sb.textures, b.*ref, what);
    };
    map(&Material::base_color_map, "base_color_map");
    map(&Material::metallic_roughness_map, "metallic_roughness_map");
    map(&Material::normal_map, "normal_map");
    map(&Material::emissive_map, "emissive_map");
    map(&Material::specular_map, "specular_map");
    map(&Material::specular_color_map, "specular_color_map");
    map(&Material::transmission_map, "transmission_map");
}

void expect_same(Light const& a, Light const& b)
{
    EXPECT_EQ(a.type, b.type);
    expect_close(a.intensity, b.intensity, "intensity");
    expect_close(a.position, b.position, "light position");
    if (a.type != LightType::point) expect_close(a.direction, b.direction, "light direction");
    if (a.type != LightType::directional) {
        EXPECT_FLOAT_EQ(a.range, b.range);
    }
    if (a.type == LightType::spot) {
        EXPECT_NEAR(a.cos_inner, b.cos_inner, 1e-6);
        EXPECT_NEAR(a.cos_outer, b.cos_outer, 1e-6);
    }
}

void expect_same(Camera const& a, Camera const& b)
{
    EXPECT_EQ(a.name, b.name);
    EXPECT_EQ(a.orthographic, b.orthographic);
    if (a.orthographic) {
        EXPECT_DOUBLE_EQ(a.ymag_m, b.ymag_m);
    } else {
        EXPECT_DOUBLE_EQ(a.yfov_rad, b.yfov_rad);
    }
    if (a.aspect > 0) {
        EXPECT_NEAR(a.aspect, b.aspect, 1e-12);
    }
    for (int c = 0; c < 4; ++c)
        EXPECT_NEAR(glm::distance(a.world_from_camera[c], b.world_from_camera[c]), 0, 1e-12) << a.name;
}

/// Both scenes evaluate to the same triangles, cameras and lights.
void expect_same_world(Scene const& a, Scene const& b, SceneTime time_s)
{
    Report report;
    World const wa = build_world(std::make_shared<Scene>(a), time_s, report);
    World const wb = build_world(std::make_shared<Scene>(b), time_s, report);
    EXPECT_TRUE(report.losses().empty());
    EXPECT_EQ(wa.triangles, wb.triangles);
    EXPECT_EQ(wa.triangle_material, wb.triangle_material);
    EXPECT_EQ(wa.uv0, wb.uv0);
    EXPECT_EQ(wa.uv1, wb.uv1);
    auto const largest = [](auto const& x, auto const& y) {
        float worst = 0;
        for (std::size_t i = 0; i < x.size(); ++i) worst = std::max(worst, glm::distance(x[i], y[i]));
        return worst;
    };
    ASSERT_EQ(wa.positions.size(), wb.positions.size());
    EXPECT_LE(largest(wa.positions, wb.positions), 1e-6f * (1 + wa.bounds.radius()));
    ASSERT_EQ(wa.normals.size(), wb.normals.size());
    EXPECT_LE(largest(wa.normals, wb.normals), 1e-5f);
    ASSERT_EQ(wa.tangents.size(), wb.tangents.size());
    EXPECT_LE(largest(wa.tangents, wb.tangents), 1e-5f);
    ASSERT_EQ(wa.colors.size(), wb.colors.size());
    EXPECT_LE(largest(wa.colors, wb.colors), 1e-6f);
    EXPECT_EQ(wa.alphas, wb.alphas);
    ASSERT_EQ(wa.cameras.size(), wb.cameras.size());
    for (std::size_t i = 0; i < wa.cameras.size(); ++i) expect_same(wa.cameras[i], wb.cameras[i]);
    ASSERT_EQ(wa.lights.size(), wb.lights.size());
    for (std::size_t i = 0; i < wa.lights.size(); ++i) expect_same(wa.lights[i], wb.lights[i]);
}

void expect_same(Scene const& a, Scene const& b)
{
    EXPECT_EQ(a.material_names, b.material_names);
    ASSERT_EQ(a.materials.size(), b.materials.size());
    for (std::size_t i = 0; i < a.materials.size(); ++i) {
        SCOPED_TRACE(a.material_names[i]);
        expect_same(a, a.materials[i], b, b.materials[i]);
    }
    ASSERT_EQ(a.animations.size(), b.animations.size());
    for (std::size_t i = 0; i < a.animations.size(); ++i) {
        EXPECT_EQ(a.animations[i].name, b.animations[i].name);
        EXPECT_NEAR(a.animations[i].duration_s, b.animations[i].duration_s, 1e-6);
        ASSERT_EQ(a.animations[i].channels.size(), b.animations[i].channels.size());
        for (std::size_t c = 0; c < a.animations[i].channels.size(); ++c) {
            AnimationChannel const &x = a.animations[i].channels[c], &y = b.animations[i].channels[c];
            EXPECT_EQ(a.nodes[std::size_t(x.node)].name, b.nodes[std::size_t(y.node)].name);
            EXPECT_EQ(x.path, y.path);
            EXPECT_EQ(x.interpolation, y.interpolation);
            EXPECT_EQ(x.times_s, y.times_s);
            EXPECT_EQ(x.values, y.values);
        }
    }
    expect_same_world(a, b, std::nullopt);
    for (double const time_s : {0.0, 0.31, 0.77}) expect_same_world(a, b, time_s);
}

/// The structure and the bytes of a GLB.
struct Glb {
    json root;
    std::vector<unsigned char> binary;
};

Glb open_glb(std::filesystem::path const& file)
{
    std::vector<unsigned char> const bytes = read_bytes(file);
    auto const word = [&](std::size_t at) {
        std::uint32_t v = 0;
        std::memcpy(&v, bytes.data() + at, 4);
        return v;
    };
    EXPECT_EQ(word(0), 0x46546c67u);
    EXPECT_EQ(word(4), 2u);
    EXPECT_EQ(word(8), bytes.size());
    std::uint32_t const text = word(12);
    EXPECT_EQ(text % 4, 0u);
    EXPECT_EQ(word(16), 0x4e4f534au);
    auto const begin = bytes.begin() + 20;
    Glb out{json::parse(begin, begin + text), {}};
    EXPECT_EQ(word(20 + text) % 4, 0u);
    EXPECT_EQ(word(24 + text), 0x004e4942u);
    out.binary.assign(begin + text + 8, bytes.end());
    return out;
}

/// One of everything that the generated scenes do not have.
Scene everything()
{
    Scene s;
    s.name = "everything";
    s.textures.texels = {{255, 0, 0, 255}, {0, 255, 0, 128}, {0, 0, 255, 64}, {9, 8, 7, 0}};
    s.textures.textures = {Texture{0, 2, 2, Wrap::clamp, Wrap::mirror, true, true},
                           Texture{0, 2, 2, Wrap::repeat, Wrap::repeat, false, false}};
    Material m;
    m.base_color = {0.1f, 0.2f, 0.3f};
    m.alpha = 0.5f;
    m.alpha_mode = AlphaMode::blend;
    m.metallic = 0.25f;
    m.roughness = 0.75f;
    m.specular = 0.4f;
    m.specular_color = {0.9f, 0.8f, 1.7f};
    m.ior = 1.33f;
    m.transmission = 0.6f;
    m.thin = false;
    m.absorption = {2, 0, 0};
    m.emission = {0.5f, 7, 0.25f};
    m.normal_scale = 0.7f;
    float const c = std::cos(0.4f), sn = std::sin(0.4f);
    m.base_color_map = {0, 1, {2 * c, -3 * sn}, {-2 * sn, -3 * c}, {0.1f, 0.2f}};
    m.metallic_roughness_map = m.normal_map = m.specular_map = m.transmission_map = {1};
    m.emissive_map = m.specular_color_map = {0};
    int const first = add_material(s, m);
    Material faint;
    faint.emission = {0.1f, 0.2f, 0.3f};
    faint.double_sided = true;
    faint.model = MaterialModel::phong;
    faint.phong_specular = {0.1f, 0.2f, 0.3f};
    faint.phong_exponent = 37;
    int const second = add_material(s, faint);
    Material unlit = lambert({0.3f, 0.2f, 0.1f});
    unlit.unlit = true;
    add_material(s, unlit);

    add_quad(s, {0, 0, 0}, {1, 0, 0}, {0, 1, 0}, first);
    Mesh& mesh = s.meshes.front();
    std::size_t const n = mesh.positions.size();
    mesh.normals.assign(n, {0, 0, 1});
    mesh.tangents.assign(n, {1, 0, 0, -1});
    for (std::size_t i = 0; i < n; ++i) {
        mesh.uv0.push_back({0.1f * float(i), 0.5f});
        mesh.uv1.push_back({-3, float(i)});
        mesh.colors.push_back({0.2f * float(i), 1, 0.5f});
        mesh.alphas.push_back(0.3f * float(i));
    }
    MorphTarget up;
    up.positions.assign(n, {0, 0.5f, 0});
    up.normals.assign(n, {0.1f, 0, 0});
    up.tangents.assign(n, {0, 0, 0.1f});
    MorphTarget side;
    side.positions.assign(n, {0.5f, 0, 0.25f});
    mesh.morph_targets = {up, side};
    s.nodes.front().name = "first";
    s.nodes.front().morph_weights = {0.25f, 0.5f};
    Node moved; // the same mesh again, below another node
    moved.name = "turned";
    moved.parent = 0;
    moved.translation = {1, 2, 3};
    moved.rotation = glm::normalize(dquat(0.8, 0.1, 0.5, -0.2));
    moved.scale = {1, 2, 0.5};
    moved.meshes = {s.nodes.front().meshes};
    moved.morph_weights = {0, 0};
    s.nodes.push_back(moved);
    auto const turned = std::int32_t(s.nodes.size()) - 1;

    add_quad(s, {5, 0, 0}, {1, 0, 0}, {0, 0, 2}, second);
    s.nodes.back().name = "second";

    Light point, spot;
    point.intensity = {1, 20, 3};
    point.range = 12;
    spot.type = LightType::spot;
    spot.cos_inner = 0.9f;
    spot.cos_outer = 0.8f;
    for (Light const& light : {point, spot}) {
        Node node;
        node.name = "light";
        node.translation = {0, 4, double(s.lights.size())};
        node.light = std::int32_t(s.lights.size());
        s.lights.push_back(light);
        s.nodes.push_back(node);
    }
    Camera camera;
    camera.name = "above";
    camera.orthographic = true;
    camera.ymag_m = 2.5;
    camera.aspect = 1.5;
    Node eye;
    eye.name = camera.name;
    eye.camera = 0;
    eye.translation = {0, 0, 9};
    s.cameras.push_back(camera);
    s.nodes.push_back(eye);

    AnimationChannel weights{0, ChannelPath::morph_weights, Interpolation::linear, {0, 1}, {0, 1, 1, 0}};
    AnimationChannel spline{turned, ChannelPath::translation, Interpolation::cubic_spline, {0, 1}, {}};
    for (int i = 0; i < 18; ++i) spline.values.push_back(0.1f * float(i * i % 7));
    AnimationChannel step{turned, ChannelPath::scale, Interpolation::step, {0.25f, 1}, {1, 1, 1, 2, 2, 2}};
    Animation clip;
    clip.name = "all paths";
    clip.channels = {weights, spline, step};
    clip.duration_s = 1;
    s.animations = {clip};
    s.playbacks = {{0, 0, 1, true}};
    return s;
}

TEST_F(WriteGlb, KeepsTheAtrium)
{
    Scene const scene = generate_atrium({});
    expect_same(scene, round_trip(scene));
}

TEST_F(WriteGlb, KeepsTheCornellBox)
{
    Scene const scene = generate_cornell();
    expect_same(scene, round_trip(scene));
}

TEST_F(WriteGlb, KeepsTheMirrorRoomAndTheAvatar)
{
    for (Scene const& scene : {generate_mirror(), generate_avatar()}) expect_same(scene, round_trip(scene));
}

TEST_F(WriteGlb, KeepsEverythingElse)
{
    Scene const scene = everything();
    expect_same(scene, round_trip(scene));
}

TEST_F(WriteGlb, KeepsAMillionBoxes)
{
    Scene const scene = generate_boxes(1'000'000, 2);
    Scene const back = round_trip(scene);
    ASSERT_EQ(back.meshes.size(), scene.meshes.size());
    for (std::size_t i = 0; i < scene.meshes.size(); ++i) {
        EXPECT_EQ(back.meshes[i].positions, scene.meshes[i].positions);
        EXPECT_EQ(back.meshes[i].triangles, scene.meshes[i].triangles);
        EXPECT_EQ(back.meshes[i].uv0, scene.meshes[i].uv0);
        EXPECT_EQ(back.meshes[i].material, scene.meshes[i].material);
    }
}

TEST_F(WriteGlb, FileFollowsTheSpecification)
{
    Report report;
    write_glb(folder_ / "atrium.glb", generate_atrium({}), report);
    Glb const glb = open_glb(folder_ / "atrium.glb");
    EXPECT_EQ(glb.root["asset"]["version"], "2.0");
    EXPECT_LE(glb.root["buffers"][0]["byteLength"].get<std::size_t>(), glb.binary.size());
    for (json const& view : glb.root["bufferViews"]) {
        EXPECT_EQ(view["byteOffset"].get<std::size_t>() % 4, 0u);
        EXPECT_LE(view["byteOffset"].get<std::size_t>() + view["byteLength"].get<std::size_t>(),
                  glb.binary.size());
    }
    std::set<std::string> const used = glb.root["extensionsUsed"];
    for (json const& material : glb.root["materials"]) {
        json const extensions = material.value("extensions", json::object());
        for (auto const& [name, value] : extensions.items()) EXPECT_TRUE(used.contains(name)) << name;
        for (json const& channel : material.value("emissiveFactor", json::array())) EXPECT_LE(channel, 1);
    }
    for (json const& mesh : glb.root["meshes"])
        for (json const& primitive : mesh["primitives"]) {
            json const& positions = glb.root["accessors"][primitive["attributes"]["POSITION"].get<int>()];
            EXPECT_EQ(positions["min"].size(), 3u);
            EXPECT_EQ(positions["max"].size(), 3u);
        }
    for (json const& image : glb.root["images"]) EXPECT_EQ(image["mimeType"], "image/png");
}

TEST_F(WriteGlb, CountsWhatGlbCannotHold)
{
    Report report;
    Scene scene = everything();
    set_environment(scene, vec3{1});
    scene.materials[0].base_color_map.row_v = scene.materials[0].base_color_map.row_u;
    Mesh empty;
    empty.name = "empty";
    scene.nodes.back().meshes.push_back(std::int32_t(scene.meshes.size()));
    scene.meshes.push_back(empty);
    write_glb(folder_ / "scene.glb", scene, report);
    auto const losses = report.losses();
    EXPECT_EQ(losses.size(), 3u);
    EXPECT_EQ(losses.at("environment maps that GLB cannot hold").count, 1u);
    EXPECT_EQ(losses.at("shears of texture transforms that GLB cannot hold").count, 1u);
    EXPECT_EQ(losses.at("meshes without triangles not written").count, 1u);
}

TEST_F(WriteGlb, BundleBringsTheSky)
{
    Report report;
    Scene scene = generate_atrium({});
    scene.environment->rotation_rad = 0.5f;
    scene.environment->scale = {1, 2, 3};
    auto const files = write_scene_bundle(folder_ / "a scene.glb", scene, report);
    EXPECT_EQ(files.size(), 3u);
    for (auto const& file : files) EXPECT_TRUE(std::filesystem::exists(file)) << file;
    EXPECT_TRUE(report.losses().empty());
    Scene const back = load_scene((folder_ / "a scene.yaml").string(), report);
    ASSERT_TRUE(back.environment);
    EXPECT_EQ(back.environment->radiance, scene.environment->radiance);
    EXPECT_NEAR(back.environment->rotation_rad, 0.5, 1e-6);
    EXPECT_EQ(back.environment->scale, vec3(1, 2, 3));
    EXPECT_EQ(count_triangles(back), count_triangles(scene));
    EXPECT_EQ(write_scene_bundle(folder_ / "box.glb", generate_cornell(), report).size(), 1u);
}

} // namespace
} // namespace gi::test
