#include "gi/methods/sh_grid/caustics.h"

#include "gi/core/rng.h"
#include "gi/methods/sh_grid/focus.h"
#include "gi/render/flush_denormals.h"
#include "gi/render/ray_path.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

constexpr int kMostSmooth = 64; ///< smooth surfaces along one light path

/// How much a material mirrors and refracts, 0 to 1.
float smooth_share(Bsdf const& b)
{
    float const mirrors = bsdf_detail::specular_is_delta(b) ? max_component(b.f0) : 0;
    return std::min(1.0f, b.clear + mirrors);
}

float area_of(WorldView const& world, std::uint32_t triangle)
{
    return 0.5f * glm::length(light_detail::area_vector(world.surfaces[triangle]));
}

/// A light path between two surfaces.
struct CausticPath {
    Pcg32 rng{0, 0};
    ShadingPoint at; ///< where the path begins
    Ray ray;         ///< to the next surface
    vec3 flux{0};    ///< W; 0 = the path has ended
    std::uint32_t target = 0;
};

/// Starts a path on a smooth triangle, lit by a sample of the lights if nothing is between.
RayQuery start_caustic(WorldView const& world, CausticTargets const& targets, std::uint32_t i, std::uint32_t count,
                       CausticPath& p)
{
    double which = (double(i) + p.rng.uniform_double()) / double(count);
    std::uint32_t const k = view(targets.choice).sample(which), triangle = targets.triangles[k];
    p.target = k;
    vec2 const place = square_to_triangle(p.rng.uniform2());
    vec3 const position = shading_detail::SurfacePoint{world.surfaces[triangle], place}.position();
    LightChoice const choice = choose_light(world, p.rng.uniform_double());
    LightSample const light = sample_light(world, choice, position, p.rng.uniform2());
    if (!(light.pdf > 0)) return {};
    p.at = shading_point(world, triangle, place, -light.direction);
    float const chance = view(targets.choice).probability(k) * float(count);
    p.ray.direction = -light.direction;
    p.flux = light.radiance * (std::abs(glm::dot(light.direction, p.at.geometric_normal)) / light.pdf) *
             (area_of(world, triangle) * coverage(world, triangle, place) / chance);
    RayQuery query = shadow_ray(p.at.position, p.at.geometric_normal, p.at.clearance, light);
    query.seed = p.rng.next();
    if (!(query.reach > 0) || !all_finite(p.flux)) p.flux = vec3{0};
    return query;
}

/// Continues a path by one of the delta lobes, or ends it.
/// @param arrived  towards where the light came from, in at.frame
void leave_by_delta_lobe(ShadingPoint const& at, vec3 arrived, CausticPath& p)
{
    BsdfSample lobes[3];
    vec3 directions[3];
    float sum = 0;
    int const n = delta_lobes(at.bsdf, arrived, at.front, lobes);
    for (int k = 0; k < n; ++k) {
        BsdfSample& lobe = lobes[k];
        directions[k] = at.frame.to_world(lobe.wi);
        // As in trace_light_paths(): flux has no cosine, and refraction does not scale it.
        lobe.weight *= std::abs(glm::dot(directions[k], at.geometric_normal) / lobe.wi.z);
        if (lobe.transmitted && !at.bsdf.thin) lobe.weight *= square(at.front ? at.bsdf.ior : 1 / at.bsdf.ior);
        if (!is_on_one_side(at, directions[k], lobe.wi) || !all_finite(lobe.weight)) lobe.weight = vec3{0};
        sum += max_component(lobe.weight);
    }
    float u = p.rng.uniform() * std::max(sum, 1.0f); // Russian roulette if the sum is below 1
    vec3 const flux = p.flux;
    p.flux = vec3{0};
    for (int k = 0; k < n; ++k) {
        float const share = max_component(lobes[k].weight);
        if (u < share) {
            p.flux = flux * lobes[k].weight * (std::max(sum, 1.0f) / share);
            p.ray = {leave(at, directions[k]), directions[k]};
            return;
        }
        u -= share;
    }
}

/// Lets a path meet a surface. @param found  takes the photon if that is no mirror and no glass
void meet_surface(ShadingPoint const& at, bool first, CausticPath& p, std::vector<CausticPhoton>& found)
{
    vec3 const from = -p.ray.direction, arrived = at.frame.to_local(from);
    float const cos_arrived = glm::dot(from, at.geometric_normal);
    p.flux = arrived.z > 0 && cos_arrived > 0 ? p.flux * (arrived.z / cos_arrived) : vec3{0};
    if (!(max_component(p.flux) > 0)) return;
    if (!first && !only_delta(at.bsdf))
        found.push_back({at.position, at.geometric_normal, from, p.flux, p.target});
    leave_by_delta_lobe(at, arrived, p);
}

/// Traces some paths together, so that rays are in packets. Returns how many were cut.
std::size_t trace_caustics(WorldView const& world, ExactVisibility const& visibility,
                           std::vector<CausticPath*> active, std::vector<CausticPhoton>& found, PathCounts& counts)
{
    auto const drop_ended = [&] { std::erase_if(active, [](auto* p) { return !(max_component(p->flux) > 0); }); };
    for (CausticPath* p : active) meet_surface(p->at, true, *p, found);
    drop_ended();
    std::vector<RayQuery> queries;
    std::vector<Hit> hits;
    for (int surface = 1; !active.empty() && surface < kMostSmooth; ++surface) {
        queries.clear();
        for (CausticPath* p : active) queries.push_back({.ray = p->ray, .seed = p->rng.next()});
        hits.resize(active.size());
        visibility.nearest(queries, hits);
        counts.nearest_rays += active.size();
        for (std::size_t k = 0; k < active.size(); ++k) {
            CausticPath& p = *active[k];
            if (hits[k].triangle == kNoTriangle)
                p.flux = vec3{0};
            else
                meet_surface(shading_point(world, hits[k].triangle, hits[k].barycentric, p.ray.direction), false,
                             p, found);
        }
        drop_ended();
    }
    return active.size();
}

} // namespace

CausticTargets find_caustic_targets(World const& world, Bounds const& focus)
{
    CausticTargets out;
    std::vector<float> share;
    for (Bsdf const& b : world.bsdfs) share.push_back(smooth_share(b));
    if (world.light_select.empty() || std::ranges::none_of(share, [](float s) { return s > 0; })) return out;
    struct Group {
        double area = 0, count = 0;
    } groups[2]; // beside the focus, in it
    WorldView const w = view(world);
    auto const group_of = [&](std::uint32_t triangle) {
        if (focus.empty()) return 1;
        Surface const& s = world.surfaces[triangle];
        vec3 const a = s.corner, b = a + s.edge1, c = a + s.edge2;
        vec3 const low = glm::min(a, glm::min(b, c)), high = glm::max(a, glm::max(b, c));
        return glm::all(glm::lessThanEqual(low, focus.high)) && glm::all(glm::lessThanEqual(focus.low, high)) ? 1
                                                                                                              : 0;
    };
    for (std::uint32_t t = 0; t < world.triangles.size(); ++t) {
        float const s = share[world.triangle_material[t]], area = s > 0 ? area_of(w, t) : 0;
        if (!(area > 0 && area < kInf)) continue;
        out.triangles.push_back(t);
        Group& g = groups[group_of(t)];
        g.area += double(s * area);
        g.count += double(s);
    }
    std::vector<float> weights;
    for (std::uint32_t const t : out.triangles) {
        Group const& g = groups[group_of(t)];
        weights.push_back(
            float(double(share[world.triangle_material[t]]) * (double(area_of(w, t)) / g.area + 1 / g.count)));
    }
    out.choice = make_alias_table(weights);
    return out;
}

Caustics::Caustics(World const& world, RenderSettings const& settings, Report& report, StopRequest const* stop)
    : world_(world), settings_(settings), report_(report), stop_(stop)
{
}

void Caustics::changed(Changes const& c)
{
    surfaces_changed_ = surfaces_changed_ || c.geometry || c.bounds || c.materials || c.coverage;
    light_changed_ = light_changed_ || c.lights || c.emitters || c.environment;
}

void Caustics::prepare(ExactVisibility const& visibility, std::uint32_t index, std::span<FrameView const> views,
                       Bounds const& focus, double share, PathCounts& counts)
{
    if (settings_.sh_grid.caustic_photons == 0) return;
    paths_ = std::max(1u, std::uint32_t(share * settings_.sh_grid.caustic_photons));
    if (!first_index_) first_index_ = index;
    bool const new_focus = focus.low != focus_.low || focus.high != focus_.high;
    bool const new_cameras = !std::ranges::equal(views, cameras_, {}, &FrameView::camera);
    cameras_.clear();
    for (FrameView const& v : views) cameras_.push_back(v.camera);
    focus_ = focus;
    if (surfaces_changed_ || light_changed_ || new_focus) {
        targets_ = find_caustic_targets(world_, focus_);
        learned_.reset();
        sets_ = 0;
    } else if (new_cameras) {
        if (sets_ == 1) return;
        sets_ = 0;
    }
    surfaces_changed_ = light_changed_ = false;
    if (targets_.choice.empty()) {
        map_ = {};
        return;
    }
    try {
        trace(visibility, counts);
    } catch (Interrupted const&) {
        if (map() == nullptr) throw;
    }
}

std::vector<CausticPhoton> Caustics::photons_of_set(ExactVisibility const& visibility, PathCounts& counts)
{
    constexpr std::uint32_t kTogether = 64;
    // Chances that follow from random numbers need others, else there were a bias.
    std::uint64_t const stream = learned_.value_or(false) ? 0xca58 : 0xca57;
    BuildStop const stop(stop_);
    WorldView const w = view(world_);
    std::uint32_t const count = paths_;
    std::uint32_t const blocks = (count + kTogether - 1) / kTogether, pass = *first_index_ + sets_;
    std::vector<std::vector<CausticPhoton>> found(blocks);
    std::vector<PathCounts> counts_of(blocks);
    std::vector<std::size_t> cut(blocks);
    tbb::parallel_for(0u, blocks, [&](std::uint32_t block) {
        FlushDenormals const guard;
        if (stop.given_up()) throw Interrupted();
        std::uint32_t const first = block * kTogether, n = std::min(count - first, kTogether);
        std::vector<CausticPath> paths(n);
        std::vector<CausticPath*> lit;
        std::vector<RayQuery> shadows;
        for (std::uint32_t k = 0; k < n; ++k) {
            CausticPath& p = paths[k];
            p.rng = Pcg32::for_path(settings_.seed ^ stream, first + k, pass);
            RayQuery const shadow = start_caustic(w, targets_, first + k, count, p);
            if (!(max_component(p.flux) > 0)) continue;
            lit.push_back(&p);
            shadows.push_back(shadow);
        }
        std::vector<std::uint8_t> blocked(shadows.size());
        visibility.occluded(shadows, blocked);
        counts_of[block].shadow_rays += shadows.size();
        for (std::size_t k = 0; k < lit.size(); ++k)
            if (blocked[k] != 0) lit[k] = nullptr;
        std::erase(lit, nullptr);
        cut[block] = trace_caustics(w, visibility, std::move(lit), found[block], counts_of[block]);
    });
    std::vector<CausticPhoton> photons;
    for (std::uint32_t b = 0; b < blocks; ++b) {
        photons.insert(photons.end(), found[b].begin(), found[b].end());
        counts += counts_of[b];
        cut_ += cut[b];
    }
    return photons;
}

/// Half of the paths then begin where others brought light.
void Caustics::learn_chances(std::span<CausticPhoton const> photons)
{
    std::vector<float> weights(targets_.triangles.size());
    double sum = 0;
    for (CausticPhoton const& p : photons) {
        weights[p.target] += luminance(p.flux);
        sum += double(luminance(p.flux));
    }
    for (std::uint32_t k = 0; k < weights.size(); ++k)
        weights[k] = float(double(weights[k]) / sum) + view(targets_.choice).probability(k);
    targets_.choice = make_alias_table(weights);
}

void Caustics::trace(ExactVisibility const& visibility, PathCounts& counts)
{
    constexpr float kAlpha = 2.0f / 3; // Knaus and Zwicker 2011: how slowly disks shrink
    constexpr float kLargest = 0.05f;  // radius over the longest side of what is lit, or of the focus
    StageTimer const timer(report_, "caustic photons");
    std::vector<CausticPhoton> photons = photons_of_set(visibility, counts);
    std::size_t const few = paths_ / 4;
    if (!learned_) {
        learned_ = !photons.empty() && photons.size() < few;
        if (*learned_) {
            learn_chances(photons);
            photons = photons_of_set(visibility, counts);
        }
    }
    Bounds box = focus_;
    if (focus_.empty())
        for (CausticPhoton const& p : photons) box = joined(box, {p.position, p.position});
    float const chosen = settings_.sh_grid.caustic_radius_m,
                largest = chosen > 0 ? chosen : kLargest * longest_side(box);
    shrunk_ = sets_ == 0 ? 1.0f : shrunk_ * std::sqrt((float(sets_) + kAlpha) / (float(sets_) + 1));
    ++sets_;
    map_ = {};
    if (largest > 0) // else they all lie at one point: no area to spread them over
        map_ = CausticMap(photons, {.largest = largest, .factor = shrunk_, .same = chosen > 0});
}

void Caustics::report_counts()
{
    if (targets_.choice.empty()) return;
    report_.count("caustic photons: smooth triangles", double(targets_.triangles.size()));
    report_.count("caustic photons: stored, of the last set", double(map_.count()));
    report_.count("caustic photons: sets since the last change", double(sets_));
    report_.count("caustic photons: flux, W (luminance)", double(luminance(vec3(map_.flux()))));
    report_.count("caustic photons: mean radius of the last disks, m", double(map_.mean_radius()));
    report_.lose("light paths of caustics cut at 64 smooth surfaces", cut_);
    cut_ = 0;
}

} // namespace gi
