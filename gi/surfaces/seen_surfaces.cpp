#include "gi/surfaces/seen_surfaces.h"

#include "gi/render/path_step.h"
#include "gi/render/ray_path.h"
#include "gi/scene/model/plan.h"
#include "gi/scene/model/used_materials.h"
#include "gi/scene/shading/seen_mirror.h"
#include "gi/surfaces/light_picture.h"
#include "gi/surfaces/mirror_boxes.h"

#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Pixels between those whose shadows are found first.
constexpr int kCoarse = 4;
/// Two pixels show one surface if its normals agree, and if one is near the other's plane, relative to the depth.
constexpr float kCosine = 0.95f, kPlane = 0.01f;

bool one_surface(SeenSurface const& a, SeenSurface const& b)
{
    return glm::dot(a.normal, b.normal) > kCosine &&
           std::abs(glm::dot(a.normal, b.position - a.position)) < kPlane * std::max(a.depth, 1e-6f);
}

} // namespace

/// The way of a pixel's light, from the eye on.
struct SeenSurfaces::Way {
    std::uint32_t pixel; ///< in its row
    vec3 eye_direction;  ///< of the pixel's ray
    Ray ray;             ///< its last piece
    vec3 left{1};        ///< share of the light that arrives
    mat3 image{1};       ///< from directions where the way is, to their images
    float length_m = 0;  ///< up to the last piece
    int mirrors = 0;
    std::uint32_t medium = kNoMedium;
    bool aside = false; ///< ray of a pane's other lobe: only emitters count
};

/// Light on its way to a surface.
struct SeenSurfaces::Sent {
    std::uint32_t pixel, light;
    vec3 radiance;
    RayQuery ray;
};

SeenSurfaces::SeenSurfaces(World const& world, int threads)
    : world_(world), threads_(threads), view_(view(world)), soup_(make_soup(world)), cut_outs_(world)
{
    earlier_.first_moving = first_moving();
    now_ = corners_of(world_, first_moving());
    find_needs();
}

bool SeenSurfaces::mirrors_in(World const& world)
{
    return std::any_of(world.triangle_material.begin(), world.triangle_material.end(),
                       [&](std::uint32_t m) { return may_mirror(world.bsdfs[m]); });
}

bool SeenSurfaces::can_light(World const& world)
{
    return !world.lights.empty() && world.lights.size() <= kMostLights;
}

bool SeenSurfaces::has_few_lights(World const& world)
{
    return can_light(world) && !has_panes(world); // which colour light, as OpenGL's shadow maps cannot say
}

void SeenSurfaces::find_needs()
{
    std::vector<char> may;
    for (Bsdf const& b : world_.bsdfs) may.push_back(may_mirror(b) ? 1 : 0);
    mirrors_ = mirror_boxes(world_, may);
    panes_ = has_panes(world_);
    bool const needed = has_mirrors() || can_light(world_);
    if (needed == (exact_ != nullptr)) return;
    exact_.reset();
    if (needed)
        exact_ =
            std::make_unique<ExactVisibility>(world_, plan_scene(world_).alpha_tests, threads_, first_moving());
}

void SeenSurfaces::changed(Changes const& changes)
{
    view_ = view(world_);
    if (changes.geometry) {
        update_soup(world_, first_moving(), soup_);
        if (exact_) exact_->moved(world_);
        if (earlier_.corners.empty()) earlier_.corners = std::move(now_);
        now_ = corners_of(world_, first_moving());
    }
    if (changes.coverage) {
        cut_outs_ = CutOuts(world_);
        exact_.reset(); // which tests coverage or not
    }
    if (changes.materials || changes.coverage || changes.lights) find_needs();
}

float SeenSurfaces::depth(int x, int y) const
{
    NearestTexel const& t = map_.texels[std::size_t(y) * map_.width + std::size_t(x)];
    return t.primitive == kNoPrimitive ? 0 : 1 / t.key;
}

bool SeenSurfaces::may_show_mirrors(CameraRays const& camera, int width, int height) const
{
    return std::ranges::any_of(mirrors_,
                               [&](Bounds const& box) { return !pixels_of(box, camera, width, height).empty(); });
}

void SeenSurfaces::look_at_mirrors(CameraRays const& camera, int width, int height, Lights lights)
{
    look(camera, width, height);
    lights_ = lights == Lights::few && can_light(world_) ? std::uint32_t(world_.lights.size()) : 0;
}

void SeenSurfaces::look(CameraRays const& camera, int width, int height, Lights lights, vec2 at)
{
    constexpr float kNear = 1e-5f;         // of the world's radius
    constexpr std::uint32_t kSeed = 0x5ee; // of partial coverage: the same in all frames
    camera_ = camera;
    camera_.focus = 0;
    at_ = at;
    clear(map_, std::uint32_t(width), std::uint32_t(height));
    grid_ = camera_grid(camera_, width, height, at, kNear * glm::max(world_.bounds.radius(), 1e-30f));
    draw_view(soup_, 0, soup_.count, cut_outs_, grid_, kSeed, map_);
    coarse_.clear();
    lights_ = lights == Lights::few && can_light(world_) ? std::uint32_t(world_.lights.size()) : 0;
    if (lights_ == 0) return;
    // First every fourth row and column: a pixel whose surrounding ones agree needs no shadow ray of its own.
    int const columns = (width + kCoarse - 1) / kCoarse, rows = (height + kCoarse - 1) / kCoarse;
    std::vector<SeenSurface> found(std::size_t(columns) * std::size_t(rows));
    tbb::parallel_for(0, rows, [&](int k) {
        thread_local std::vector<SeenSurface> row;
        row.assign(std::size_t(width), {});
        fill(std::min(k * kCoarse + kCoarse / 2, height - 1), row, Pixels::coarse);
        for (int i = 0; i < columns; ++i)
            found[std::size_t(k) * std::size_t(columns) + std::size_t(i)] =
                row[std::size_t(std::min(i * kCoarse + kCoarse / 2, width - 1))];
    });
    coarse_ = std::move(found);
}

/// Whether a light reaches a surface, if the coarse pixels around agree.
std::optional<bool> SeenSurfaces::known_shadow(SeenSurface const& s, std::uint32_t light, int x, int y) const
{
    if (coarse_.empty() || panes_) return std::nullopt;
    int const columns = (int(map_.width) + kCoarse - 1) / kCoarse,
              rows = (int(map_.height) + kCoarse - 1) / kCoarse;
    int const left = (x + kCoarse / 2) / kCoarse - 1, top = (y + kCoarse / 2) / kCoarse - 1;
    int lit = 0, blocked = 0; // of those that face the light
    for (int j = top; j < top + 2; ++j)
        for (int i = left; i < left + 2; ++i) {
            if (i < 0 || j < 0 || i >= columns || j >= rows) return std::nullopt;
            SeenSurface const& c = coarse_[std::size_t(j) * std::size_t(columns) + std::size_t(i)];
            if (!(c.depth > 0) || !one_surface(s, c)) return std::nullopt;
            lit += c.lit >> light & 1;
            blocked += c.blocked >> light & 1;
        }
    if (lit != 4 && blocked != 4) return std::nullopt;
    return lit == 4;
}

/// Sends the light of all lights to a surface.
void SeenSurfaces::light(ShadingPoint const& at, Way const& way, SeenSurface const& s, int y,
                         std::vector<Sent>& sent, SeenSurface& out) const
{
    vec3 const wo = at.frame.to_local(-way.ray.direction);
    for (std::uint32_t k = 0; k < lights_; ++k) {
        LightSample const light = light_detail::sample_punctual(view_.lights[k], at.position);
        vec3 const radiance =
            way.left * unshadowed_light(at, wo, light, true, [](BsdfValue const&, vec3) { return 0.0f; });
        if (!(max_component(radiance) > 0)) continue;
        if (std::optional<bool> const lit = known_shadow(s, k, int(way.pixel), y)) {
            if (*lit) out.direct += radiance;
            continue;
        }
        RayQuery const ray = shadow_ray(at.position, at.geometric_normal, at.clearance, light);
        if (ray.reach > 0) {
            sent.push_back({way.pixel, k, radiance, ray});
        } else { // the light lies on the surface
            out.direct += radiance;
            out.lit |= std::uint8_t(1u << k);
        }
    }
}

/// Describes a surface that a way arrives at. Returns true if it is a mirror: the way's ray then leads on, and
/// those of its other lobes are appended to `aside`.
bool SeenSurfaces::arrive(std::uint32_t triangle, vec2 weights, int y, Way& way, std::vector<Way>& aside,
                          std::vector<Sent>& sent, SeenSurface& out) const
{
    ShadingPoint const at = shading_point(view_, triangle, weights, way.ray.direction);
    float const length_m = glm::length(at.position - way.ray.origin);
    way.left *= left_by_medium(view_, way.medium, triangle, at, length_m);
    out.emitted += way.left * at.emission;
    way.length_m += length_m;
    vec3 const wo = at.frame.to_local(-way.ray.direction);
    BsdfSample lobes[3];
    if (int const n = exact_ && way.mirrors < kMostMirrors ? find_mirror(at, wo, lobes) : 0) {
        auto const follow = [&](BsdfSample const& lobe, Way& on) {
            vec3 const direction = at.frame.to_world(lobe.wi);
            on.left *= lobe.weight;
            on.medium = medium_beyond(view_, on.medium, triangle, at, lobe);
            on.ray = {leave(at, direction), direction};
            ++on.mirrors;
        };
        for (int k = 1; k < n && !way.aside; ++k) {
            aside.push_back(way);
            aside.back().aside = true;
            follow(lobes[k], aside.back());
        }
        if (lobes[0].wi.z > 0) { // reflected; what is seen through a pane stays where it is
            vec3 const normal = at.frame.normal;
            way.image = way.image - 2.0f * glm::outerProduct(way.image * normal, normal);
        }
        follow(lobes[0], way);
        return true;
    }
    if (way.aside) return false;
    out.albedo = way.left * albedo(at.bsdf);
    out.normal = way.image * at.frame.normal;
    out.position = way.mirrors == 0 ? at.position : camera_.origin + way.length_m * way.eye_direction;
    out.depth = glm::dot(out.position - camera_.origin, camera_.forward);
    out.in_mirror = way.mirrors > 0;
    out.is_image = out.in_mirror && glm::length(out.position - at.position) > kOfDepth * way.length_m;
    out.is_reflected = way.mirrors == 1 && way.image != mat3{1};
    if (triangle >= earlier_.first_moving && !earlier_.corners.empty())
        out.moved =
            way.image * (at.position - point_on(earlier_.corners[triangle - earlier_.first_moving], weights));
    if (lights_ > 0) light(at, way, out, y, sent, out);
    return false;
}

void SeenSurfaces::fill(int y, std::span<SeenSurface> out, Pixels which) const
{
    bool const only_mirrors = which == Pixels::mirrors;
    thread_local std::vector<Sent> sent;
    thread_local std::vector<vec3> left_of;
    sent.clear();
    thread_local std::vector<Way> ways, aside;
    thread_local std::vector<RayQuery> rays;
    thread_local std::vector<Hit> hits;
    ways.clear();
    aside.clear();
    NearestTexel const* const texels = &map_.texels[std::size_t(y) * map_.width];
    for (std::uint32_t x = 0; x < map_.width; ++x) {
        NearestTexel const& seen = texels[x];
        if (which == Pixels::coarse && x % kCoarse != kCoarse / 2 && x + 1 != map_.width) continue;
        if (only_mirrors) {
            if (seen.primitive == kNoPrimitive) continue;
            Surface const& surface = view_.surfaces[seen.primitive];
            if (!surface.is(Surface::kVaries) && !may_mirror(view_.bsdfs[surface.material])) continue;
        }
        Ray const ray = camera_.through(vec2{float(x), float(y)} + at_);
        SeenSurface found;
        if (seen.primitive == kNoPrimitive) {
            found.emitted = background_radiance(view_, ray.direction);
        } else {
            Way way{x, ray.direction, ray};
            vec3 const at = ray.origin + ray.direction / (seen.key * glm::dot(ray.direction, camera_.forward));
            if (arrive(seen.primitive, barycentric_at(view_.surfaces[seen.primitive], at), y, way, aside, sent,
                       found))
                ways.push_back(way);
            else if (only_mirrors)
                continue;
        }
        out[x] = found;
    }
    while (true) {
        if (which == Pixels::all) ways.insert(ways.end(), aside.begin(), aside.end());
        aside.clear();
        if (ways.empty()) break;
        rays.clear();
        for (Way const& w : ways) rays.push_back({.ray = w.ray});
        hits.resize(rays.size());
        exact_->nearest(rays, hits);
        std::size_t left = 0;
        for (std::size_t k = 0; k < ways.size(); ++k) {
            Way& way = ways[k];
            SeenSurface& to = out[way.pixel];
            if (hits[k].triangle == kNoTriangle) {
                to.emitted += way.left * environment_radiance(view_, way.ray.direction);
                to.in_mirror |= !way.aside;
            } else if (arrive(hits[k].triangle, hits[k].barycentric, y, way, aside, sent, to)) {
                ways[left++] = way;
            }
        }
        ways.resize(left);
    }
    if (sent.empty()) return;
    rays.clear();
    for (Sent const& l : sent) rays.push_back(l.ray);
    left_of.resize(rays.size());
    exact_->transmittance(rays, left_of);
    for (std::size_t k = 0; k < sent.size(); ++k) {
        SeenSurface& to = out[sent[k].pixel];
        auto const bit = std::uint8_t(1u << sent[k].light);
        if (left_of[k] == vec3{0}) {
            to.blocked |= bit;
            continue;
        }
        to.direct += left_of[k] * sent[k].radiance;
        to.lit |= bit;
    }
}

} // namespace gi
