#include "gi/scene/generate/masonry.h"

namespace gi {
namespace {

constexpr float kUvPerMetre = 0.5f;

} // namespace

void add_arch_wall(SceneBuilder& b, int material, ArchWall const& w)
{
    float const middle = 0.5f * (w.z0 + w.z1), radius = 0.5f * w.opening;
    float const left = middle - radius, right = middle + radius;
    /// Adds a piece of both faces between two heights that vary along z.
    auto const faces = [&](float za, float zb, int n, auto const& low, auto const& high) {
        for (bool const front : {false, true})
            b.grid(material, n, 1, [&](float u, float v) {
                float const z = glm::mix(za, zb, front ? 1 - u : u);
                float const y = glm::mix(low(z), high(z), v);
                return GridVertex{
                    {front ? w.x1 : w.x0, y, z}, {front ? 1.0f : -1.0f, 0, 0}, kUvPerMetre * vec2{z, -y}};
            });
    };
    auto const constant = [](float y) { return [y](float) { return y; }; };
    faces(w.z0, left, 1, constant(w.y0), constant(w.y1));
    faces(right, w.z1, 1, constant(w.y0), constant(w.y1));
    if (w.sill > w.y0) faces(left, right, 1, constant(w.y0), constant(w.sill));
    // Above the arch, pieces meet at the arch's corners, so that there are no gaps.
    for (int i = 0; i < w.segments; ++i) {
        auto const angle = [&](int k) { return kPi * float(k) / float(w.segments); };
        auto const z_at = [&](int k) { return middle - radius * std::cos(angle(k)); };
        auto const y_at = [&](int k) { return w.spring + radius * std::sin(angle(k)); };
        float const za = z_at(i), zb = z_at(i + 1), ya = y_at(i), yb = y_at(i + 1);
        faces(
            za, zb, 1, [=](float z) { return glm::mix(ya, yb, (z - za) / (zb - za)); }, constant(w.y1));
    }
    // The inside of the opening: jambs, arch, sill.
    b.grid(material, w.segments, 1, [&](float u, float v) {
        float const a = kPi * u;
        return GridVertex{
            {glm::mix(w.x1, w.x0, v), w.spring + radius * std::sin(a), middle - radius * std::cos(a)},
            {0, -std::sin(a), std::cos(a)},
            kUvPerMetre * vec2{v * (w.x1 - w.x0), radius * a}};
    });
    float const jamb = w.spring - w.sill, depth = w.x1 - w.x0;
    if (jamb > 0) {
        b.quad(material, {w.x0, w.sill, left}, {depth, 0, 0}, {0, jamb, 0}, kUvPerMetre);
        b.quad(material, {w.x1, w.sill, right}, {-depth, 0, 0}, {0, jamb, 0}, kUvPerMetre);
    }
    if (w.sill > w.y0) b.quad(material, {w.x0, w.sill, right}, {depth, 0, 0}, {0, 0, left - right}, kUvPerMetre);
}

void add_column(SceneBuilder& b, int material, vec3 foot, float height, float radius, int segments)
{
    float const r = radius;
    b.box(material, foot + vec3{-1.5f * r, 0, -1.5f * r}, foot + vec3{1.5f * r, 0.12f, 1.5f * r}, kUvPerMetre);
    std::vector<vec2> profile;
    auto const torus = [&](float center_r, float center_y, float size, int n) {
        for (int i = 0; i <= n; ++i) {
            float const a = -0.5f * kPi + kPi * float(i) / float(n);
            profile.push_back({center_r + size * std::cos(a), center_y + size * std::sin(a)});
        }
    };
    float const top = height - 0.42f;
    torus(1.22f * r, 0.18f, 0.06f, 5);
    torus(1.08f * r, 0.29f, 0.04f, 4);
    for (int i = 0; i <= 8; ++i) {
        float const t = float(i) / 8;
        float const entasis = 0.03f * std::sin(kPi * glm::min(1.0f, 1.4f * t));
        profile.push_back({r * (1 - 0.14f * t + entasis), glm::mix(0.36f, top, t)});
    }
    torus(0.92f * r, top + 0.04f, 0.03f, 4);
    for (int i = 1; i <= 6; ++i) {
        float const t = float(i) / 6;
        profile.push_back({r * (0.88f + 0.55f * t * t), top + 0.07f + 0.2f * t});
    }
    b.lathe(material, foot, profile, segments);
    b.box(material, foot + vec3{-1.55f * r, height - 0.15f, -1.55f * r}, foot + vec3{1.55f * r, height, 1.55f * r},
          kUvPerMetre);
}

void add_vault(SceneBuilder& b, int material, float x0, float x1, float z0, float z1, float spring, float rise,
               int across, int along)
{
    float const middle = 0.5f * (x0 + x1), half = 0.5f * (x1 - x0);
    b.grid(material, across, along, [&](float u, float v) {
        float const a = kPi * u;
        vec3 const normal{std::cos(a) * rise, -std::sin(a) * half, 0};
        float const z = glm::mix(z0, z1, v);
        return GridVertex{{middle - half * std::cos(a), spring + rise * std::sin(a), z},
                          glm::normalize(normal),
                          kUvPerMetre * vec2{half * a, z}};
    });
}

} // namespace gi
