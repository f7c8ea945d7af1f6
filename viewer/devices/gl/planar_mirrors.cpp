#include "viewer/devices/gl/planar_mirrors.h"

#include "gi/scene/shading/bsdf.h"

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

constexpr std::size_t kMost = 64;   // planes; a mirror with more is curved: the smallest make room for larger ones
constexpr float kLeastArea = 2e-5f; // of the square of the scene's radius
constexpr float kSameNormal = 0.9999f, kSamePlane = 1e-4f; // cosine; of the radius
constexpr float kReflects = 0.3f;                          // least luminance of what a mirror reflects

bool is_flat_mirror(gi::Material const& m)
{
    gi::Bsdf const b = gi::make_bsdf(m);
    return b.model == gi::MaterialModel::metal_rough && b.clear == 0 && b.alpha < gi::kSmoothAlpha &&
           gi::luminance(b.f0) > kReflects && m.normal_map.texture < 0 && m.metallic_roughness_map.texture < 0 &&
           m.alpha_mode != gi::AlphaMode::blend;
}

} // namespace

PlanarMirror PlanarMirrors::mirror_of(Group const& group, std::vector<gi::vec3> const& positions)
{
    PlanarMirror m;
    gi::vec3 sum{0}, place{0};
    for (gi::uvec3 const& t : group.triangles) {
        gi::vec3 const a = positions[t.x], b = positions[t.y], c = positions[t.z];
        sum += 0.5f * glm::cross(b - a, c - a);
        for (gi::vec3 const& p : {a, b, c}) m.bounds = gi::joined(m.bounds, {p, p});
        place = a;
    }
    m.area_m2 = glm::length(sum);
    if (m.area_m2 > 0) m.normal = sum / m.area_m2;
    m.distance_m = glm::dot(m.normal, place);
    return m;
}

void PlanarMirrors::take(gi::ShownScene const& scene)
{
    gi::World const& w = *scene.world;
    mirrors_.clear();
    groups_.clear();
    std::vector<char> is_mirror;
    for (gi::Material const& m : *scene.materials) is_mirror.push_back(is_flat_mirror(m) ? 1 : 0);
    float const least = kLeastArea * gi::square(scene.radius_m), apart = kSamePlane * scene.radius_m;
    for (std::size_t t = 0; t < w.triangle_material.size(); ++t) {
        if (is_mirror[w.triangle_material[t]] == 0) continue;
        bool const moves = t >= w.static_triangles;
        std::vector<gi::vec3> const& positions = moves ? scene.moved->positions : w.positions;
        gi::uvec3 const corners =
            moves ? scene.moving->triangles[t - w.static_triangles] - w.static_vertices : w.triangles[t];
        PlanarMirror const own = mirror_of({moves, {corners}}, positions);
        if (!(own.area_m2 > 0)) continue;
        std::size_t k = 0;
        while (k < mirrors_.size() &&
               !(groups_[k].moves == moves && glm::dot(mirrors_[k].normal, own.normal) > kSameNormal &&
                 std::abs(mirrors_[k].distance_m - own.distance_m) < apart))
            ++k;
        if (k == kMost) {
            k = std::size_t(std::ranges::min_element(mirrors_, {}, &PlanarMirror::area_m2) - mirrors_.begin());
            if (own.area_m2 <= mirrors_[k].area_m2) continue;
            mirrors_[k] = own;
            groups_[k] = {moves, {corners}};
            continue;
        }
        if (k == mirrors_.size()) {
            mirrors_.push_back(own);
            groups_.push_back({moves, {}});
        } else {
            mirrors_[k].area_m2 += own.area_m2;
        }
        groups_[k].triangles.push_back(corners);
    }
    for (std::size_t k = mirrors_.size(); k-- > 0;) {
        mirrors_[k] = mirror_of(groups_[k], groups_[k].moves ? scene.moved->positions : w.positions);
        if (mirrors_[k].area_m2 > least) continue;
        mirrors_.erase(mirrors_.begin() + std::ptrdiff_t(k));
        groups_.erase(groups_.begin() + std::ptrdiff_t(k));
    }
}

void PlanarMirrors::move(gi::ShownScene::Moved const& now)
{
    for (std::size_t k = 0; k < mirrors_.size(); ++k)
        if (groups_[k].moves) mirrors_[k] = mirror_of(groups_[k], now.positions);
}

} // namespace viewer
