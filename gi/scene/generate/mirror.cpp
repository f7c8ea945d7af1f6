// A room with a mirror on the wall in front of the camera, in which users see their avatar: see
// `lightwell view --avatar`.

#include "gi/scene/generate/builder.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/generate/procedural_texture.h"

namespace gi {
namespace {

constexpr float kHalfWidth = 2.5f, kFront = -1.6f, kBackWall = 3,
                kHeight = 2.7f; // m; the camera stands at x = z = 0

Material tiles(TexturePool& pool)
{
    Material m = matt(vec3{1});
    m.base_color_map.texture = add_procedural_texture(pool, 128, true, [](vec2 uv) {
        vec2 const in = glm::fract(2.0f * uv); // tiles of half a metre
        bool const joint = std::min({in.x, in.y, 1 - in.x, 1 - in.y}) < 0.03f;
        bool const dark = (uv.x < 0.5f) != (uv.y < 0.5f);
        return joint  ? vec4{0.18f, 0.17f, 0.16f, 1}
               : dark ? vec4{0.34f, 0.26f, 0.19f, 1}
                      : vec4{0.6f, 0.53f, 0.43f, 1};
    });
    return m;
}

void add_walls(SceneBuilder& b)
{
    int const white = b.add_material("white wall", matt({0.74f, 0.72f, 0.68f}));
    int const red = b.add_material("red wall", matt({0.55f, 0.16f, 0.12f}));
    int const blue = b.add_material("blue wall", matt({0.13f, 0.3f, 0.5f}));
    float const width = 2 * kHalfWidth, depth = kBackWall - kFront;
    vec3 const low{-kHalfWidth, 0, kFront};
    b.quad(b.add_material("floor", tiles(b.scene().textures)), low, {0, 0, depth}, {width, 0, 0});
    b.quad(white, low + vec3{0, kHeight, 0}, {width, 0, 0}, {0, 0, depth});
    b.quad(white, low, {width, 0, 0}, {0, kHeight, 0});
    b.quad(white, low + vec3{width, 0, depth}, {-width, 0, 0}, {0, kHeight, 0});
    b.quad(red, low + vec3{0, 0, depth}, {0, 0, -depth}, {0, kHeight, 0});
    b.quad(blue, low + vec3{width, 0, 0}, {0, 0, depth}, {0, kHeight, 0});
}

void add_mirror(SceneBuilder& b)
{
    Material silver = matt(vec3{0.94f});
    silver.metallic = 1;
    silver.roughness = 0;
    constexpr float half = 0.8f, low = 0.2f, high = 2.1f, rim = 0.06f, z = kFront + 0.02f;
    b.quad(b.add_material("mirror", silver), {-half, low, z}, {2 * half, 0, 0}, {0, high - low, 0});
    int const frame = b.add_material("mirror frame", matt({0.3f, 0.2f, 0.1f}));
    b.box(frame, {-half - rim, low - rim, kFront}, {half + rim, low, z + 0.02f});
    b.box(frame, {-half - rim, high, kFront}, {half + rim, high + rim, z + 0.02f});
    b.box(frame, {-half - rim, low, kFront}, {-half, high, z + 0.02f});
    b.box(frame, {half, low, kFront}, {half + rim, high, z + 0.02f});
}

/// Adds two steps and a ball.
void add_furniture(SceneBuilder& b)
{
    int const wood = b.add_material("wood", matt({0.45f, 0.3f, 0.16f}));
    b.box(wood, {1.2f, 0, 1.2f}, {kHalfWidth, 0.18f, kBackWall});
    b.box(wood, {1.6f, 0.18f, 1.6f}, {kHalfWidth, 0.36f, kBackWall});
    Material glossy = matt({0.75f, 0.55f, 0.1f});
    glossy.specular = 1;
    glossy.roughness = 0.25f;
    b.sphere(b.add_material("ball", glossy), {-1.5f, 0.3f, -0.9f}, 0.3f, 32);
}

/// Adds an area light, large and dim because paths via the mirror hit it only by chance.
void add_lamp(SceneBuilder& b)
{
    Material lamp = matt(vec3{0.8f});
    lamp.emission = vec3{3, 2.9f, 2.7f};
    b.quad(b.add_material("lamp", lamp), {-1.6f, kHeight - 0.02f, -1.2f}, {3.2f, 0, 0}, {0, 0, 3.2f});
}

} // namespace

Scene generate_mirror()
{
    SceneBuilder b;
    add_walls(b);
    add_mirror(b);
    add_furniture(b);
    add_lamp(b);
    b.add_camera("camera", {0, 1.6, 0}, {0, 1.25, -1.6}, 50);
    return b.finish("mirror");
}

} // namespace gi
