// Scenes of any size for tests of robustness and speed: a closed room with an area light and many triangles.

#include "gi/core/error.h"
#include "gi/core/rng.h"
#include "gi/scene/generate/builder.h"
#include "gi/scene/generate/generate.h"

#include <algorithm>
#include <array>
#include <fmt/format.h>

namespace gi {
namespace {

constexpr std::uint32_t kMost = 200'000'000;
constexpr float kHalf = 5; ///< m, half the room

void check(std::uint32_t triangles)
{
    if (triangles < 12 || triangles > kMost)
        throw InputError(fmt::format("{} triangles cannot be made", triangles),
                         fmt::format("12 to {} are supported", kMost), "choose a number in between");
}

Material matt_on_both_sides(vec3 albedo)
{
    Material m;
    m.base_color = albedo;
    m.specular = 0;
    m.double_sided = true;
    return m;
}

/// 14 triangles: six walls and the light below the ceiling.
void add_room(SceneBuilder& b)
{
    int const wall = b.add_material("wall", matt_on_both_sides(vec3{0.7f}));
    float const h = 2 * kHalf;
    vec3 const low{-kHalf, 0, -kHalf};
    b.quad(wall, low, {0, 0, h}, {h, 0, 0});
    b.quad(wall, low + vec3{0, h, 0}, {h, 0, 0}, {0, 0, h});
    b.quad(wall, low, {h, 0, 0}, {0, h, 0});
    b.quad(wall, low + vec3{0, 0, h}, {0, h, 0}, {h, 0, 0});
    b.quad(wall, low, {0, h, 0}, {0, 0, h});
    b.quad(wall, low + vec3{h, 0, 0}, {0, 0, h}, {0, h, 0});
    Material lamp = matt_on_both_sides(vec3{0});
    lamp.double_sided = false;
    lamp.emission = vec3{12};
    b.quad(b.add_material("lamp", lamp), {-1.5f, h - 0.05f, -1.5f}, {3, 0, 0}, {0, 0, 3});
    b.add_camera("camera", {0, 0.45 * double(h), 0.97 * double(kHalf)}, {0, 0.4 * double(h), 0}, 75);
}

/// Uniform rotations (Shoemake 1992).
glm::quat random_rotation(Pcg32& rng)
{
    float const u = rng.uniform(), a = 2 * kPi * rng.uniform(), c = 2 * kPi * rng.uniform();
    float const r0 = std::sqrt(1 - u), r1 = std::sqrt(u);
    return {r1 * std::cos(c), r0 * std::sin(a), r0 * std::cos(a), r1 * std::sin(c)};
}

} // namespace

Scene generate_boxes(std::uint32_t triangles, std::uint64_t seed)
{
    check(triangles);
    SceneBuilder b;
    add_room(b);
    constexpr std::array kAlbedos{vec3{0.65f, 0.2f, 0.15f}, vec3{0.2f, 0.55f, 0.25f}, vec3{0.2f, 0.3f, 0.65f},
                                  vec3{0.7f}};
    std::array<int, kAlbedos.size()> materials{};
    for (std::size_t i = 0; i < kAlbedos.size(); ++i)
        materials[i] = b.add_material(fmt::format("box {}", i), matt_on_both_sides(kAlbedos[i]));
    std::uint32_t const boxes = (triangles + 6) / 12;
    auto const side = std::uint32_t(std::ceil(std::cbrt(double(boxes))));
    float const cell = 1.7f * kHalf / float(side);
    Pcg32 rng(mix_bits(seed), 1);
    for (std::uint32_t i = 0; i < boxes; ++i) {
        // Spread evenly over the grid when it is not full.
        auto const at = std::uint64_t(i) * side * side * side / boxes;
        vec3 const place{float(at % side), float(at / side % side), float(at / side / side)};
        vec3 const center = (place + 0.5f) * cell + vec3{-0.85f * kHalf, 0.1f * kHalf, -0.85f * kHalf};
        glm::quat const q = random_rotation(rng);
        vec3 const half = cell * (vec3{0.1f} + 0.2f * vec3{rng.uniform(), rng.uniform(), rng.uniform()});
        auto const turned = [&](float x, float y, float z) { return q * (half * vec3{x, y, z}); };
        int const material = materials[rng.next() % materials.size()];
        for (int axis = 0; axis < 3; ++axis)
            for (float const sign : {-1.0f, 1.0f}) {
                vec3 n{0}, u{0};
                n[axis] = sign;
                u[(axis + 1) % 3] = 1;
                vec3 const v = glm::cross(n, u);
                vec3 const corner = turned(n.x - u.x - v.x, n.y - u.y - v.y, n.z - u.z - v.z);
                b.quad(material, center + corner, 2.0f * turned(u.x, u.y, u.z), 2.0f * turned(v.x, v.y, v.z));
            }
    }
    return b.finish("boxes");
}

Scene generate_sphere(std::uint32_t triangles, std::uint64_t seed)
{
    check(triangles);
    SceneBuilder b;
    add_room(b);
    int const material = b.add_material("sphere", matt_on_both_sides(vec3{0.6f, 0.5f, 0.4f}));
    // A sphere of s segments and s / 2 rings has s * s - 2 s triangles.
    int const segments = std::max(6, int(std::lround(1 + std::sqrt(1 + double(triangles)))));
    Pcg32 rng(mix_bits(seed), 2);
    struct Wave {
        vec3 direction;
        float amplitude, phase;
    };
    std::array<Wave, 24> waves{};
    for (std::size_t i = 0; i < waves.size(); ++i) {
        float const frequency = 2 * std::exp2(float(i) / 5);
        waves[i] = {frequency * (random_rotation(rng) * vec3{0, 0, 1}), 0.12f / frequency,
                    2 * kPi * rng.uniform()};
    }
    auto const place = [&](float u, float v) {
        float const phi = u < 1 ? 2 * kPi * u : 0.0f, theta = kPi * (1 - v);
        bool const pole = v <= 0 || v >= 1;
        float const s = pole ? 0.0f : std::sin(theta);
        vec3 const n{s * std::sin(phi), v <= 0 ? -1.0f : v >= 1 ? 1.0f : std::cos(theta), s * std::cos(phi)};
        float r = 1;
        for (Wave const& w : waves) r += w.amplitude * std::sin(glm::dot(w.direction, n) + w.phase);
        return vec3{0, kHalf, 0} + 2.6f * r * n;
    };
    b.grid(material, segments, segments / 2, [&](float u, float v) {
        constexpr float kStep = 1e-3f;
        vec3 const p = place(u, v);
        vec3 const du = place(std::fmod(u + kStep, 1.0f), v) - place(std::fmod(u + 1 - kStep, 1.0f), v);
        vec3 const dv = place(u, std::min(v + kStep, 1.0f)) - place(u, std::max(v - kStep, 0.0f));
        vec3 n = glm::cross(du, dv);
        n = glm::length(n) > 1e-9f ? glm::normalize(n) : glm::normalize(p - vec3{0, kHalf, 0});
        return GridVertex{p, n, {u, 1 - v}};
    });
    return b.finish("sphere");
}

} // namespace gi
