// The default demo scene: a vaulted gallery behind an arcade, beside a court under sun and sky. Most visible
// surfaces are lit indirectly.

#include "gi/core/error.h"
#include "gi/scene/generate/figure.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/generate/masonry.h"
#include "gi/scene/generate/procedural_texture.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace gi {
namespace {

constexpr float kBay = 3;                    ///< m, width of an arch with its column
constexpr float kBack = -4.2f, kCourt = 7;   ///< x of the gallery's back wall and of the court's far wall
constexpr float kFloor1 = 4.9f, kTop = 8.2f; ///< upper floor and roof
constexpr float kSpring = 2.75f;             ///< height at which the arches begin

struct Materials {
    int stone, plaster, tiles, paving, vase, gold, mirror, glass, lamp, iron, red, blue, lattice;
};

vec3 stone_color(vec2 uv)
{
    float const n = tileable_noise(uv, 4, 11), fine = tileable_noise(uv, 32, 12);
    // Four courses of ashlar per texture, every second one shifted.
    float const row = std::floor(uv.y * 4), x = uv.x * 2 + (int(row) % 2 == 0 ? 0.0f : 0.5f);
    vec2 const in_block{x - std::floor(x), uv.y * 4 - row};
    vec2 const edge = glm::min(in_block, 1.0f - in_block) * vec2{0.5f, 0.25f};
    float const joint = glm::smoothstep(0.003f, 0.007f, glm::min(edge.x, edge.y));
    return vec3{0.60f, 0.54f, 0.45f} * (0.8f + 0.25f * n + 0.08f * fine) * glm::mix(0.72f, 1.0f, joint);
}

vec3 tile_color(vec2 uv)
{
    vec2 const p = uv * 4.0f, cell = glm::floor(p), in_tile = p - cell;
    float const vein = std::abs(tileable_noise(uv, 3, 21) - 0.5f), fine = tileable_noise(uv, 16, 22);
    bool const dark = (int(cell.x) + int(cell.y)) % 2 == 0;
    vec3 const base = dark ? vec3{0.22f, 0.16f, 0.13f} : vec3{0.62f, 0.57f, 0.49f};
    vec2 const edge = glm::min(in_tile, 1.0f - in_tile);
    float const joint = glm::smoothstep(0.012f, 0.02f, glm::min(edge.x, edge.y));
    vec3 const marble =
        base * (0.85f + 0.2f * fine) + (dark ? 0.10f : -0.08f) * glm::smoothstep(0.05f, 0.0f, vein);
    return glm::mix(vec3{0.3f, 0.28f, 0.25f}, marble, joint);
}

/// Slabs of the court, every row shifted.
vec3 paving_color(vec2 uv)
{
    float const row = std::floor(uv.y * 3), x = uv.x * 2 + 0.37f * row;
    vec2 const in_slab{x - std::floor(x), uv.y * 3 - row};
    vec2 const edge = glm::min(in_slab, 1.0f - in_slab) * vec2{0.5f, 0.33f};
    float const joint = glm::smoothstep(0.004f, 0.010f, glm::min(edge.x, edge.y));
    float const worn = 0.8f + 0.3f * tileable_noise(uv, 6, 31) + 0.1f * tileable_noise(uv, 48, 32);
    return vec3{0.50f, 0.44f, 0.36f} * worn * glm::mix(0.6f, 1.0f, joint);
}

vec3 plaster_color(vec2 uv)
{
    return vec3{0.74f, 0.69f, 0.60f} *
           (0.88f + 0.2f * tileable_noise(uv, 3, 41) + 0.04f * tileable_noise(uv, 40, 42));
}

/// Grooves of the tiles' joints.
vec3 tile_normal(vec2 uv)
{
    vec2 const p = uv * 4.0f, in_tile = p - glm::floor(p);
    auto const slope = [](float t) {
        float const low = t < 0.5f ? t : 1 - t;
        return low < 0.02f ? (t < 0.5f ? 1.0f : -1.0f) * (0.02f - low) * 30 : 0.0f;
    };
    return glm::normalize(vec3{-slope(in_tile.x), slope(in_tile.y), 1}) * 0.5f + 0.5f;
}

/// Interlaced rings, cut out by alpha 0.
float lattice_alpha(vec2 uv)
{
    auto const ring = [&](vec2 center) {
        vec2 const d = uv - center;
        float const r = glm::length(d);
        return std::abs(r - 0.36f) < 0.045f;
    };
    bool solid = std::abs(uv.x - 0.5f) > 0.47f || std::abs(uv.y - 0.5f) > 0.47f;
    for (vec2 const c : {vec2{0.5f, 0.5f}, vec2{0, 0}, vec2{1, 0}, vec2{0, 1}, vec2{1, 1}})
        solid = solid || ring(c);
    return solid ? 1.0f : 0.0f;
}

Materials add_materials(SceneBuilder& b)
{
    TexturePool& pool = b.scene().textures;
    auto const opaque = [](auto const& color) { return [color](vec2 uv) { return vec4(color(uv), 1); }; };
    auto const ref = [](std::int32_t texture) {
        TextureRef r;
        r.texture = texture;
        return r;
    };
    auto const matt = [](vec3 albedo) {
        Material m;
        m.base_color = albedo;
        m.specular = 0;
        return m;
    };
    Materials out{};
    Material stone = matt(vec3{1});
    stone.base_color_map = ref(add_procedural_texture(pool, 256, true, opaque(stone_color)));
    out.stone = b.add_material("stone", stone);
    Material plaster = matt(vec3{1});
    plaster.base_color_map = ref(add_procedural_texture(pool, 256, true, opaque(plaster_color)));
    out.plaster = b.add_material("plaster", plaster);
    Material tiles;
    tiles.base_color = vec3{1};
    tiles.roughness = 0.22f;
    tiles.base_color_map = ref(add_procedural_texture(pool, 256, true, opaque(tile_color)));
    tiles.normal_map = ref(add_procedural_texture(pool, 256, false, opaque(tile_normal)));
    out.tiles = b.add_material("polished tiles", tiles);
    Material paving = matt(vec3{1});
    paving.base_color_map = ref(add_procedural_texture(pool, 256, true, opaque(paving_color)));
    out.paving = b.add_material("paving", paving);
    Material vase = matt({0.08f, 0.22f, 0.20f});
    vase.model = MaterialModel::phong;
    vase.phong_specular = vec3{0.35f};
    vase.phong_exponent = 80;
    out.vase = b.add_material("glazed vase", vase);
    Material gold;
    gold.base_color = {0.95f, 0.70f, 0.34f};
    gold.metallic = 1;
    gold.roughness = 0.3f;
    out.gold = b.add_material("gold", gold);
    Material mirror;
    mirror.base_color = vec3{0.93f};
    mirror.metallic = 1;
    mirror.roughness = 0;
    out.mirror = b.add_material("mirror", mirror);
    Material glass;
    glass.base_color = {0.97f, 0.99f, 0.98f};
    glass.transmission = 1;
    glass.roughness = 0;
    glass.thin = false;
    out.glass = b.add_material("glass", glass);
    Material lamp = matt(vec3{0});
    lamp.emission = {14, 9.5f, 5};
    out.lamp = b.add_material("lamp", lamp);
    Material iron;
    iron.base_color = vec3{0.1f};
    iron.roughness = 0.6f;
    out.iron = b.add_material("iron", iron);
    Material red = matt({0.62f, 0.06f, 0.05f}), blue = matt({0.06f, 0.12f, 0.5f});
    red.double_sided = blue.double_sided = true;
    out.red = b.add_material("red banner", red);
    out.blue = b.add_material("blue banner", blue);
    Material lattice = matt({0.30f, 0.22f, 0.15f});
    lattice.alpha_mode = AlphaMode::mask;
    lattice.base_color_map = ref(add_procedural_texture(pool, 128, true, [](vec2 uv) {
        return vec4{1, 1, 1, lattice_alpha(uv)};
    }));
    out.lattice = b.add_material("lattice", lattice);
    return out;
}

/// Adds the static structure. @param end z of the far end (negative)   @param n tessellation
void add_building(SceneBuilder& b, Materials const& m, int bays, float end, auto const& n)
{
    constexpr float kNear = 1.5f; // z of the wall behind the camera
    // Floors. Slabs have thickness, so that no light leaks through joints.
    b.quad(m.tiles, {kBack - 0.3f, 0, kNear}, {-kBack + 0.3f + 0.5f, 0, 0}, {0, 0, end - kNear}, 0.35f, n(4),
           n(16));
    b.quad(m.paving, {0.5f, -0.001f, kNear}, {kCourt - 0.5f, 0, 0}, {0, 0, end - kNear}, 0.5f);
    b.box(m.stone, {kBack - 0.5f, -0.4f, end - 0.5f}, {kCourt + 0.5f, -0.05f, kNear + 0.5f}, 0.5f);

    // Arcade below, smaller windows above.
    for (int i = 0; i < bays; ++i) {
        float const z1 = -kBay * float(i), z0 = z1 - kBay;
        add_arch_wall(b, m.stone, {-0.28f, 0.28f, z0, z1, kSpring, kFloor1, 2.3f, kSpring, kSpring, n(28)});
        add_arch_wall(b, m.stone,
                      {-0.28f, 0.28f, z0, z1, kFloor1, kTop, 1.2f, kFloor1 + 0.9f, kFloor1 + 2.0f, n(14)});
    }
    for (int i = 0; i <= bays; ++i) add_column(b, m.stone, {0, 0, -kBay * float(i)}, kSpring, 0.21f, n(40));
    // Cornice between the storeys.
    b.box(m.stone, {-0.28f, kFloor1 - 0.12f, end}, {0.42f, kFloor1 + 0.1f, 0}, 0.5f);
    // The wall from the last columns to both ends.
    b.box(m.stone, {-0.28f, kSpring, 0}, {0.28f, kTop, kNear}, 0.5f);
    b.box(m.stone, {-0.2f, 0, 0.5f}, {0.2f, kSpring, kNear}, 0.5f);

    // Back wall, ends, roof of the gallery.
    b.box(m.plaster, {kBack - 0.5f, -0.05f, end - 0.5f}, {kBack, kTop, kNear + 0.5f}, 0.5f);
    b.box(m.plaster, {kBack, -0.05f, kNear}, {0.28f, kTop, kNear + 0.5f}, 0.5f);
    b.box(m.stone, {kBack - 0.5f, kTop, end - 0.5f}, {0.5f, kTop + 0.3f, kNear + 0.5f}, 0.5f);
    add_vault(b, m.plaster, kBack, -0.28f, end, kNear, 3.3f, 1.35f, n(44), n(40));
    b.box(m.stone, {kBack, kFloor1 - 0.12f, end}, {-0.28f, kFloor1, kNear}, 0.5f);
    for (int i = 0; i <= bays; ++i) { // ribs
        float const z = -kBay * float(i);
        add_vault(b, m.stone, kBack + 0.05f, -0.30f, z - 0.16f, z + 0.16f, 3.25f, 1.33f, n(44), 1);
        b.box(m.stone, {kBack, 0, z - 0.2f}, {kBack + 0.1f, 3.3f, z + 0.2f}, 0.5f); // pilaster
    }
    // The far end: a door-sized opening with a lattice, towards the light.
    float const x = 0.5f * (kBack - 0.28f);
    b.box(m.plaster, {kBack, -0.05f, end - 0.5f}, {x - 0.8f, kTop, end}, 0.5f);
    b.box(m.plaster, {x + 0.8f, -0.05f, end - 0.5f}, {0.28f, kTop, end}, 0.5f);
    b.box(m.plaster, {x - 0.8f, 2.6f, end - 0.5f}, {x + 0.8f, kTop, end}, 0.5f);
    b.quad(m.lattice, {x - 0.8f, 0, end - 0.25f}, {1.6f, 0, 0}, {0, 2.6f, 0}, 1 / 0.4f);
    // Around the court, low enough to let the sun in.
    b.box(m.stone, {kCourt, -0.05f, end - 0.5f}, {kCourt + 0.5f, 2.2f, kNear + 0.5f}, 0.5f);
    for (float const z : {end - 0.5f, kNear}) {
        b.box(m.plaster, {0.28f, -0.05f, z}, {kCourt + 0.5f, kFloor1 - 0.12f, z + 0.5f}, 0.5f);
        b.box(m.stone, {0.28f, kFloor1 - 0.12f, z - 0.1f}, {kCourt + 0.6f, kFloor1 + 0.1f, z + 0.6f}, 0.5f);
    }
}

/// Adds a hanging cloth with folds. @param top_left its upper corner   @param width along z
void add_banner(SceneBuilder& b, int material, vec3 top_left, float width, float length, int nu, int nv)
{
    b.grid(material, nu, nv, [&](float u, float v) {
        float const drop = 1 - v, phase = 6 * kPi * u + 2 * drop;
        float const fold = (0.02f + 0.05f * drop) * std::sin(phase);
        vec3 const p =
            top_left + vec3{fold, -length * drop - 0.15f * (1 - std::abs(2 * u - 1)) * drop, -width * u};
        float const slope = (0.02f + 0.05f * drop) * std::cos(phase) * 6 * kPi / width;
        return GridVertex{p, glm::normalize(vec3{1, 0, slope}), {u, drop}};
    });
}

std::vector<vec2> vase_profile(float scale, int steps)
{
    std::vector<vec2> profile{{0, 0}};
    for (int i = 0; i <= steps; ++i) {
        float const t = float(i) / float(steps);
        float const r =
            0.11f + 0.17f * std::sin(kPi * std::pow(t, 0.75f)) * (1 - 0.3f * t) + 0.06f * std::pow(t, 6.0f);
        profile.push_back(scale * vec2{r, 0.75f * t});
    }
    profile.push_back(scale * vec2{0.10f, 0.72f});
    profile.push_back(scale * vec2{0, 0.5f});
    return profile;
}

void add_objects(SceneBuilder& b, Materials const& m, int bays, auto const& n)
{
    auto const plinth = [&](vec3 foot, float height) {
        b.box(m.stone, foot + vec3{-0.26f, 0, -0.26f}, foot + vec3{0.26f, height - 0.08f, 0.26f}, 0.5f);
        b.box(m.stone, foot + vec3{-0.32f, height - 0.08f, -0.32f}, foot + vec3{0.32f, height, 0.32f}, 0.5f);
        return foot + vec3{0, height, 0};
    };
    b.lathe(m.vase, plinth({-3.55f, 0, -2.4f}, 0.6f), vase_profile(1, n(36)), n(44));
    b.sphere(m.glass, plinth({-0.9f, 0, -3.9f}, 0.9f) + vec3{0, 0.3f, 0}, 0.3f, n(64));
    b.sphere(m.gold, plinth({-3.5f, 0, -6.2f}, 0.75f) + vec3{0, 0.32f, 0}, 0.32f, n(56));
    b.lathe(m.gold, {2.6f, 0, -4.6f}, vase_profile(1.7f, n(36)), n(40));

    // A framed mirror on the back wall.
    b.box(m.gold, {kBack, 0.85f, -5.35f}, {kBack + 0.06f, 2.75f, -3.65f});
    b.quad(m.mirror, {kBack + 0.065f, 0.95f, -3.75f}, {0, 0, -1.5f}, {0, 1.7f, 0});
    // Lanterns under the vault.
    for (int i = 0; i < bays; i += 2) {
        vec3 const c{0.5f * (kBack - 0.28f), 3.45f, -kBay * (float(i) + 0.5f)};
        b.box(m.lamp, c - vec3{0.1f, 0.16f, 0.1f}, c + vec3{0.1f, 0.16f, 0.1f});
        b.box(m.iron, c + vec3{-0.13f, 0.16f, -0.13f}, c + vec3{0.13f, 0.2f, 0.13f});
        b.box(m.iron, c - vec3{0.13f, 0.2f, 0.13f}, c + vec3{0.13f, -0.16f, 0.13f});
        b.box(m.iron, c + vec3{-0.012f, 0.2f, -0.012f}, c + vec3{0.012f, 1.2f, 0.012f});
    }
    // Banners in the arcade.
    for (int i = 1; i < bays; i += 2) {
        add_banner(b, i % 4 == 1 ? m.red : m.blue, {0.48f, kFloor1 - 0.2f, -kBay * float(i) + 0.55f}, 1.1f, 2.6f,
                   n(24), n(30));
        b.box(m.iron, {0.28f, kFloor1 - 0.22f, -kBay * float(i) - 0.6f},
              {0.5f, kFloor1 - 0.18f, -kBay * float(i) + 0.6f});
    }
}

/// A clear sky without the sun (which is a directional light): blue above, pale at the horizon, brighter towards
/// the sun, and sunlit ground below. @param to_sun unit
EnvironmentMap clear_sky(vec3 to_sun)
{
    EnvironmentMap map;
    map.width = 128;
    map.height = 64;
    constexpr vec3 kZenith{0.22f, 0.42f, 0.85f}, kHorizon{0.85f, 0.95f, 1.05f}, kGlow{1.6f, 1.35f, 1.0f},
        kGround{0.28f, 0.25f, 0.20f};
    for (std::uint32_t y = 0; y < map.height; ++y)
        for (std::uint32_t x = 0; x < map.width; ++x) {
            float const theta = kPi * (float(y) + 0.5f) / float(map.height);
            float const phi = 2 * kPi * ((float(x) + 0.5f) / float(map.width) - 0.5f);
            vec3 const d{std::sin(theta) * std::sin(phi), std::cos(theta), -std::sin(theta) * std::cos(phi)};
            vec3 radiance = kGround;
            if (d.y > 0) {
                float const toward = glm::max(0.0f, glm::dot(d, to_sun));
                radiance = glm::mix(kHorizon, kZenith, std::pow(d.y, 0.45f)) + kGlow * std::pow(toward, 24.0f);
            }
            map.radiance.push_back(radiance);
        }
    return map;
}

} // namespace

Scene generate_atrium(AtriumOptions const& o)
{
    if (o.bays < 1 || o.bays > 1000 || !(o.detail >= 0.1) || !(o.detail <= 100) || !(o.sun_elevation_deg >= 0) ||
        !(o.sun_elevation_deg <= 90) || !std::isfinite(o.sun_azimuth_deg))
        throw InputError(
            "the atrium cannot be built",
            fmt::format("{} bays, detail {}, sun at {} degrees", o.bays, o.detail, o.sun_elevation_deg),
            "1 to 1000 bays, detail 0.1 to 100, sun from 0 to 90 degrees");
    auto const n = [&](int at_one) { return std::max(3, int(std::lround(at_one * std::sqrt(o.detail)))); };
    float const end = -kBay * float(o.bays);
    SceneBuilder b;
    b.add_camera("gallery", {-2.55, 1.62, 1.1}, {-1.55, 1.78, -8}, 56);
    b.add_camera("arches", {5.6, 1.7, 0.6}, {-1.2, 2.1, -6}, 52);
    b.add_camera("courtyard", {6.2, 1.75, double(end) + 0.9}, {-0.6, 2.5, 0.36 * double(end)}, 62);
    Materials const m = add_materials(b);
    add_building(b, m, o.bays, end, n);
    add_objects(b, m, o.bays, n);

    double const elevation = glm::radians(o.sun_elevation_deg), azimuth = glm::radians(o.sun_azimuth_deg);
    dvec3 const to_sun{std::sin(azimuth) * std::cos(elevation), std::sin(elevation),
                       -std::cos(azimuth) * std::cos(elevation)};
    Light sun;
    sun.type = LightType::directional;
    sun.intensity = vec3{5.8f, 5.2f, 4.3f};
    b.add_light("sun", sun, dvec3{0, 20, 0}, -to_sun);
    Scene scene = b.finish("atrium");
    scene.environment = clear_sky(vec3(to_sun));
    if (o.figure)
        add_figure(
            scene,
            glm::rotate(glm::translate(dmat4(1), dvec3{-2.0, 0, -4.6}), glm::radians(-12.0), dvec3{0, 1, 0}),
            o.detail);
    return scene;
}

} // namespace gi
