#include "gi/surfaces/planar_mirrors.h"

#include "gi/scene/shading/seen_mirror.h"

#include <algorithm>
#include <cmath>

namespace gi {
namespace {

constexpr std::size_t kMostPlanes = 64; // a mirror with more is curved: the smallest make room for larger ones
constexpr float kLeastArea = 2e-5f;     // of the square of the scene's radius
constexpr float kSameNormal = 0.9999f, kSamePlane = 1e-4f; // cosine; of the radius
constexpr float kReflects = 0.3f;                          // least luminance of what a mirror reflects

bool is_flat_mirror(Material const& m)
{
    Bsdf const b = make_bsdf(m);
    return b.model == MaterialModel::metal_rough && b.clear == 0 && b.alpha < kSmoothAlpha &&
           luminance(b.f0) > kReflects && m.normal_map.texture < 0 && m.metallic_roughness_map.texture < 0 &&
           m.alpha_mode != AlphaMode::blend;
}

} // namespace

PlanarMirror PlanarMirrors::mirror_of(Group const& group, std::vector<vec3> const& positions)
{
    PlanarMirror m;
    vec3 sum{0}, place{0};
    for (uvec3 const& t : group.triangles) {
        vec3 const a = positions[t.x], b = positions[t.y], c = positions[t.z];
        sum += 0.5f * glm::cross(b - a, c - a);
        for (vec3 const& p : {a, b, c}) m.bounds = joined(m.bounds, {p, p});
        place = a;
    }
    m.area_m2 = glm::length(sum);
    if (m.area_m2 > 0) m.normal = sum / m.area_m2;
    m.distance_m = glm::dot(m.normal, place);
    return m;
}

void PlanarMirrors::take(ShownScene const& scene)
{
    World const& w = *scene.world;
    mirrors_.clear();
    groups_.clear();
    std::vector<char> is_mirror, is_other;
    for (Material const& m : *scene.materials) {
        is_mirror.push_back(is_flat_mirror(m) ? 1 : 0);
        is_other.push_back(is_mirror.back() == 0 && may_mirror(make_bsdf(m)) ? 1 : 0);
    }
    others_ = mirror_boxes(w, is_other);
    Bounds left_out; // of mirrors that are not flat, or small
    auto const leave_out = [&](Group const& g) {
        left_out = joined(left_out, g.moves ? Bounds{vec3(-kInf), vec3(kInf)} : mirror_of(g, w.positions).bounds);
    };
    float const least = kLeastArea * square(scene.radius_m), apart = kSamePlane * scene.radius_m;
    flat_m_ = kFlat * scene.radius_m;
    is_bent_ = false;
    std::size_t placed = 0;
    for (std::size_t t = 0; t < w.triangle_material.size(); ++t) {
        while (placed + 1 < w.placed.size() && w.placed[placed + 1].first_triangle <= t) ++placed;
        if (is_mirror[w.triangle_material[t]] == 0) continue;
        bool const moves = t >= w.static_triangles;
        std::vector<vec3> const& positions = moves ? scene.moved->positions : w.positions;
        uvec3 const corners =
            moves ? scene.moving->triangles[t - w.static_triangles] - w.static_vertices : w.triangles[t];
        std::size_t const instance = moves ? placed : 0;
        Group const alone{moves, instance, {corners}};
        PlanarMirror const own = mirror_of(alone, positions);
        if (!(own.area_m2 > 0)) { // it may grow
            if (moves) leave_out(alone);
            continue;
        }
        std::size_t k = 0;
        while (k < mirrors_.size() && !(groups_[k].moves == moves && groups_[k].instance == instance &&
                                        glm::dot(mirrors_[k].normal, own.normal) > kSameNormal &&
                                        std::abs(mirrors_[k].distance_m - own.distance_m) < apart))
            ++k;
        if (k == kMostPlanes) {
            k = std::size_t(std::ranges::min_element(mirrors_, {}, &PlanarMirror::area_m2) - mirrors_.begin());
            bool const is_larger = own.area_m2 > mirrors_[k].area_m2;
            leave_out(is_larger ? groups_[k] : alone);
            if (!is_larger) continue;
            mirrors_[k] = own;
            groups_[k] = alone;
            continue;
        }
        if (k == mirrors_.size()) {
            mirrors_.push_back(own);
            groups_.push_back({moves, instance, {}});
        } else {
            mirrors_[k].area_m2 += own.area_m2;
        }
        groups_[k].triangles.push_back(corners);
    }
    for (std::size_t k = mirrors_.size(); k-- > 0;) {
        mirrors_[k] = mirror_of(groups_[k], groups_[k].moves ? scene.moved->positions : w.positions);
        if (mirrors_[k].area_m2 > least) continue;
        leave_out(groups_[k]);
        mirrors_.erase(mirrors_.begin() + std::ptrdiff_t(k));
        groups_.erase(groups_.begin() + std::ptrdiff_t(k));
    }
    if (!left_out.empty()) others_.push_back(left_out);
}

void PlanarMirrors::keep_images(LightPicture& light, std::span<SeenImage const> images, dvec3 origin) const
{
    // Places of mirrors in pictures are rounded.
    float const near = 2 * flat_m_ + 1e-6f * float(glm::length(origin));
    std::vector<std::size_t> in(images.size(), mirrors_.size()), pixels(mirrors_.size(), 0);
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (!images[i].is_reflected) continue;
        vec3 const place(dvec3(images[i].mirror) - origin);
        float nearest = near;
        for (std::size_t k = 0; k < mirrors_.size(); ++k) {
            PlanarMirror const& m = mirrors_[k];
            bool const beside = glm::any(glm::lessThan(place, m.bounds.low - near)) ||
                                glm::any(glm::greaterThan(place, m.bounds.high + near));
            float const off = std::abs(glm::dot(m.normal, place) - m.distance_m);
            if (beside || !(off < nearest)) continue;
            nearest = off;
            in[i] = k;
        }
        if (in[i] < mirrors_.size()) ++pixels[in[i]];
    }
    std::vector<std::uint32_t> numbers(mirrors_.size() + 1, 0);
    light.mirrors.clear();
    for (std::uint32_t number = 1; number <= kPictureMirrors && !mirrors_.empty(); ++number) {
        auto const most = std::ranges::max_element(pixels);
        if (*most == 0) break;
        auto const k = std::size_t(most - pixels.begin());
        *most = 0;
        numbers[k] = number;
        light.mirrors.push_back(mirrors_[k]);
    }
    for (std::size_t i = 0; i < images.size(); ++i) {
        if (numbers[in[i]] != 0)
            make_image(light, images[i].pixel, numbers[in[i]]);
        else
            light.texels[images[i].pixel] = {};
    }
}

PixelBox PlanarMirrors::left_out(CameraRays const& camera, int width, int height) const
{
    if (is_bent_) return {{0, 0}, {width, height}};
    PixelBox all;
    auto const add = [&](Bounds const& box) {
        PixelBox const b = pixels_of(box, camera, width, height);
        if (b.empty()) return false;
        all = all.empty() ? b : PixelBox{glm::min(all.low, b.low), glm::max(all.high, b.high)};
        return true;
    };
    std::ranges::for_each(others_, add);
    PixelBox const others = all;
    std::size_t const flat = std::size_t(std::ranges::count_if(mirrors_, add, &PlanarMirror::bounds));
    return flat > kMostDrawn ? all : others;
}

void PlanarMirrors::move(ShownScene::Moved const& now)
{
    is_bent_ = false;
    for (std::size_t k = 0; k < mirrors_.size(); ++k) {
        if (!groups_[k].moves) continue;
        PlanarMirror& m = mirrors_[k] = mirror_of(groups_[k], now.positions);
        for (uvec3 const& t : groups_[k].triangles)
            for (int corner = 0; corner < 3; ++corner)
                is_bent_ |= std::abs(glm::dot(m.normal, now.positions[t[corner]]) - m.distance_m) > flat_m_;
    }
}

} // namespace gi
