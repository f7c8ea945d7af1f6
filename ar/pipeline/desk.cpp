#include "ar/pipeline/synthetic.h"
#include "gi/core/rng.h"
#include "gi/scene/generate/builder.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/generate/procedural_texture.h"

#include <glm/gtc/matrix_transform.hpp>

namespace ar {
namespace {

using gi::vec2, gi::vec3, gi::vec4;

constexpr float kFloor = -0.75f, kCeiling = 1.85f, kLeft = -2, kRight = 2.2f, kBack = -1.7f, kFront = 2.3f;
constexpr float kTableLeft = -0.75f, kTableRight = 0.75f, kTableBack = -0.55f, kTableFront = 0.5f;

gi::Material matt(vec3 albedo)
{
    gi::Material m;
    m.base_color = albedo;
    m.specular = 0;
    return m;
}

/// Noise between two albedos.
gi::Material mottled(gi::TexturePool& pool, vec3 dark, vec3 light, int cells_u, std::uint32_t seed, bool grain)
{
    gi::Material m = matt(vec3{1});
    m.base_color_map.texture = gi::add_procedural_texture(pool, 256, true, [=](vec2 uv) {
        vec2 const at = grain ? vec2{uv.x, 0.1f * uv.y} : uv; // wood: long along v
        float const t = gi::tileable_noise(grain ? vec2{at.x, uv.y} : at, cells_u, seed);
        float const rings = grain ? 0.5f + 0.5f * std::sin(60 * (at.x + 0.15f * t)) : t;
        return vec4(glm::mix(dark, light, 0.6f * rings + 0.4f * t), 1);
    });
    return m;
}

void add_room(gi::SceneBuilder& b)
{
    gi::TexturePool& pool = b.scene().textures;
    int const floor =
        b.add_material("floor", mottled(pool, {0.2f, 0.16f, 0.13f}, {0.42f, 0.36f, 0.3f}, 6, 3, false));
    int const white =
        b.add_material("plaster", mottled(pool, {0.62f, 0.6f, 0.55f}, {0.76f, 0.74f, 0.7f}, 9, 5, false));
    int const red = b.add_material("red wall", matt({0.5f, 0.19f, 0.14f}));
    int const green =
        b.add_material("curtain", mottled(pool, {0.12f, 0.25f, 0.12f}, {0.3f, 0.42f, 0.22f}, 14, 8, true));
    vec3 const low{kLeft, kFloor, kBack}, size{kRight - kLeft, kCeiling - kFloor, kFront - kBack};
    b.quad(floor, low, {0, 0, size.z}, {size.x, 0, 0});
    b.quad(white, low + vec3{0, size.y, 0}, {size.x, 0, 0}, {0, 0, size.z});
    b.quad(white, low, {size.x, 0, 0}, {0, size.y, 0});
    b.quad(white, low + vec3{size.x, 0, size.z}, {-size.x, 0, 0}, {0, size.y, 0});
    b.quad(green, low + vec3{0, 0, size.z}, {0, 0, -size.z}, {0, size.y, 0});
    b.quad(red, low + vec3{size.x, 0, 0}, {0, 0, size.z}, {0, size.y, 0});

    gi::Material window = matt(vec3{0.3f});
    window.emission = vec3{5.5f, 6.2f, 7.2f};
    b.quad(b.add_material("window", window), {kLeft + 0.01f, 0.2f, 0.9f}, {0, 0, -1.5f}, {0, 1.2f, 0});
    gi::Material lamp = matt(vec3{0.8f});
    lamp.emission = vec3{9, 7.6f, 5.8f};
    b.quad(b.add_material("lamp", lamp), {0.3f, kCeiling - 0.02f, -0.5f}, {0.5f, 0, 0}, {0, 0, 0.5f});

    int const frame = b.add_material("picture frame", matt({0.12f, 0.1f, 0.09f}));
    b.box(frame, {-0.8f, 0.4f, kBack}, {0.1f, 1.1f, kBack + 0.03f});
    int const canvas =
        b.add_material("picture", mottled(pool, {0.1f, 0.2f, 0.5f}, {0.8f, 0.6f, 0.2f}, 3, 21, false));
    b.quad(canvas, {-0.74f, 0.46f, kBack + 0.035f}, {0.78f, 0, 0}, {0, 0.58f, 0});
    int const shelf = b.add_material("shelf", matt({0.35f, 0.23f, 0.13f}));
    b.box(shelf, {1.0f, kFloor, kBack}, {1.9f, 0.9f, kBack + 0.35f});
}

void add_table(gi::SceneBuilder& b)
{
    int const wood = b.add_material(
        "table", mottled(b.scene().textures, {0.34f, 0.22f, 0.13f}, {0.55f, 0.38f, 0.24f}, 7, 11, true));
    b.box(wood, {kTableLeft, -0.04f, kTableBack}, {kTableRight, 0, kTableFront}, 1.3f);
    for (float const x : {kTableLeft + 0.05f, kTableRight - 0.1f})
        for (float const z : {kTableBack + 0.05f, kTableFront - 0.1f})
            b.box(wood, {x, kFloor, z}, {x + 0.05f, -0.04f, z + 0.05f});
}

/// A value in [0, 1) for each cell of a grid.
float cell_value(vec2 uv, int cells, std::uint64_t seed)
{
    auto const x = std::uint64_t(uv.x * float(cells)), y = std::uint64_t(uv.y * float(cells));
    return float(gi::mix_bits(seed + gi::mix_bits(x + 100003 * y)) >> 40) / float(1 << 24);
}

void add_cloth(gi::SceneBuilder& b)
{
    gi::Material m = matt(vec3{1});
    float const width = kTableRight - kTableLeft, depth = kTableFront - kTableBack;
    m.base_color_map.texture = gi::add_procedural_texture(b.scene().textures, 1536, true, [](vec2 uv) {
        // Squares of 9, 4 and 2 cm, and spots of 6 mm on some of them.
        float const large = cell_value(uv, 17, 1), middle = cell_value(uv, 37, 2), small = cell_value(uv, 79, 3);
        float const spots = cell_value(uv, 241, 4) > 0.85f ? 0.35f : 0;
        float const t = 0.1f + 0.3f * large + 0.25f * middle + 0.2f * small;
        float const light = glm::clamp(t > 0.5f ? t - spots : t + spots, 0.04f, 0.9f);
        vec3 const hue = glm::mix(vec3{1, 0.85f, 0.7f}, vec3{0.7f, 0.85f, 1}, cell_value(uv, 17, 5));
        return vec4(light * hue, 1);
    });
    m.base_color_map.row_u = {1 / width, 0};
    m.base_color_map.row_v = {0, 1 / depth};
    b.quad(b.add_material("cloth", m), {kTableLeft, 0.0002f, kTableFront}, {width, 0, 0}, {0, 0, -depth});
}

void add_things(gi::SceneBuilder& b)
{
    b.box(b.add_material("book", matt({0.12f, 0.2f, 0.45f})), {-0.42f, 0, -0.3f}, {-0.2f, 0.035f, -0.02f});
    b.box(b.add_material("box", matt({0.7f, 0.62f, 0.3f})), {0.26f, 0, -0.34f}, {0.42f, 0.17f, -0.2f});
    b.lathe(b.add_material("mug", matt({0.75f, 0.74f, 0.7f})), {-0.3f, 0.035f, -0.18f},
            {{0, 0}, {0.036f, 0}, {0.038f, 0.02f}, {0.04f, 0.09f}, {0.037f, 0.09f}, {0.034f, 0.012f}, {0, 0.012f}},
            40);
}

void add_paper(gi::SceneBuilder& b, PaperOnTable const& paper)
{
    if (paper.print.empty()) return;
    gi::TexturePool& pool = b.scene().textures;
    gi::Texture texture;
    texture.first = pool.texels.size();
    texture.width = std::uint32_t(paper.print.cols);
    texture.height = std::uint32_t(paper.print.rows);
    texture.wrap_u = texture.wrap_v = gi::Wrap::clamp;
    // What is printed is grey by its share of ink; ink of 0.04, paper of 0.85.
    for (int y = 0; y < paper.print.rows; ++y)
        for (int x = 0; x < paper.print.cols; ++x) {
            double const albedo = 0.04 + 0.81 * paper.print.at<std::uint8_t>(y, x) / 255.0;
            auto const v = std::uint8_t(std::lround(255 * albedo));
            pool.texels.push_back({v, v, v, 255});
        }
    gi::Material m = matt(vec3{1});
    m.base_color_map.texture = std::int32_t(pool.textures.size());
    m.base_color_map.row_u = {1 / float(paper.width_m), 0};
    m.base_color_map.row_v = {0, 1 / float(paper.depth_m)};
    pool.textures.push_back(texture);
    b.quad(b.add_material("paper", m), {float(paper.near_left_m.x), 0.0005f, float(paper.near_left_m.y)},
           {float(paper.width_m), 0, 0}, {0, 0, -float(paper.depth_m)});
}

} // namespace

gi::Scene generate_desk(DeskPart part, PaperOnTable const& paper, TableCloth cloth)
{
    gi::SceneBuilder b;
    if (part == DeskPart::whole) add_room(b);
    add_table(b);
    if (cloth == TableCloth::printed) add_cloth(b);
    add_things(b);
    add_paper(b, paper);
    return b.finish(part == DeskPart::whole ? "desk" : "desk, near part");
}

gi::Scene generate_statue()
{
    gi::SceneBuilder b;
    gi::Material ball = matt({0.75f, 0.08f, 0.06f});
    b.sphere(b.add_material("red ball", ball), {0.13f, 0.045f, 0.06f}, 0.045f, 48);
    gi::Scene scene = b.finish("statue");
    gi::append(scene, gi::generate_avatar(), "figure", glm::scale(gi::dmat4(1), gi::dvec3(0.2)));
    return scene;
}

} // namespace ar
