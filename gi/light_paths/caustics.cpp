#include "gi/light_paths/caustics.h"

#include "gi/core/rng.h"
#include "gi/render/flush_denormals.h"
#include "gi/render/ray_path.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

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

/// Light that reaches a smooth triangle.
struct CausticStart {
    LightStart light;
    RayQuery shadow; ///< nothing may be in its way
    std::uint32_t target;
};

/// A point of a smooth triangle and a sample of the lights; no power without light.
CausticStart start_caustic(WorldView const& world, CausticTargets const& targets, std::uint32_t i,
                           std::uint32_t count, Pcg32 rng)
{
    double which = (double(i) + rng.uniform_double()) / double(count);
    std::uint32_t const k = view(targets.choice).sample(which), triangle = targets.triangles[k];
    vec2 const place = square_to_triangle(rng.uniform2());
    vec3 const position = shading_detail::SurfacePoint{world.surfaces[triangle], place}.position();
    LightChoice const choice = choose_light(world, rng.uniform_double());
    LightSample const light = sample_light(world, choice, position, rng.uniform2());
    CausticStart out{{{triangle, place, light.distance}, -light.direction, vec3{0}, i, 0}, {}, k};
    if (!(light.pdf > 0)) return out;
    ShadingPoint const at = shading_point(world, triangle, place, -light.direction);
    float const chance = view(targets.choice).probability(k) * float(count);
    vec3 const power = light.radiance * (std::abs(glm::dot(light.direction, at.geometric_normal)) / light.pdf) *
                       (area_of(world, triangle) * coverage(world, triangle, place) / chance);
    out.shadow = shadow_ray(at.position, at.geometric_normal, at.clearance, light);
    out.shadow.seed = rng.next();
    if (out.shadow.reach > 0 && all_finite(power)) out.light.power = power;
    return out;
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
    if (settings_.photons.caustic_paths == 0) return;
    paths_ = std::max(1u, std::uint32_t(share * settings_.photons.caustic_paths));
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
        photons_.clear();
        return;
    }
    try {
        trace(visibility, counts);
    } catch (Interrupted const&) {
        if (map() == nullptr) throw;
    }
}

std::vector<Photon> Caustics::photons_of_set(ExactVisibility const& visibility, PathCounts& counts)
{
    constexpr std::uint32_t kTogether = 4096; // bounds memory, and the time to a stop
    // Chances that follow from random numbers need others, else there were a bias.
    std::uint64_t const stream = learned_.value_or(false) ? 0xca58 : 0xca57;
    BuildStop const stop(stop_);
    WorldView const w = view(world_);
    std::uint32_t const blocks = (paths_ + kTogether - 1) / kTogether, pass = *first_index_ + sets_;
    std::vector<std::vector<CausticStart>> found(blocks);
    std::vector<std::size_t> tested(blocks);
    tbb::parallel_for(0u, blocks, [&](std::uint32_t block) {
        FlushDenormals const guard;
        if (stop.given_up()) throw Interrupted();
        std::vector<CausticStart>& starts = found[block];
        for (std::uint32_t i = block * kTogether; i < std::min(paths_, (block + 1) * kTogether); ++i) {
            CausticStart const s =
                start_caustic(w, targets_, i, paths_, Pcg32::for_path(settings_.seed ^ stream, i, pass));
            if (max_component(s.light.power) > 0) starts.push_back(s);
        }
        std::vector<RayQuery> shadows;
        for (CausticStart const& s : starts) shadows.push_back(s.shadow);
        std::vector<std::uint8_t> blocked(shadows.size());
        visibility.occluded(shadows, blocked);
        tested[block] = shadows.size();
        std::size_t lit = 0;
        for (std::size_t k = 0; k < starts.size(); ++k)
            if (blocked[k] == 0) starts[lit++] = starts[k];
        starts.resize(lit);
    });
    for (std::size_t const n : tested) counts.shadow_rays += n;
    std::vector<Photon> photons;
    std::vector<LightStart> lights;
    ExactPathRays const rays(visibility);
    for (std::vector<CausticStart> const& starts : found) {
        lights.clear();
        for (CausticStart const& s : starts) lights.push_back(s.light);
        LightPaths const paths{.count = paths_,
                               .bounces = 1,
                               .seed = settings_.seed ^ stream,
                               .pass = pass,
                               .delta_only = true,
                               .stop = &stop};
        for (LightVertex const& v : trace_from_surfaces(w, rays, lights, paths, counts)) {
            photons.push_back(to_photon(v));
            photons.back().path = starts[v.path].target;
        }
    }
    return photons;
}

/// Half of the paths then begin where others brought light.
void Caustics::learn_chances(std::span<Photon const> photons)
{
    std::vector<float> weights(targets_.triangles.size());
    double sum = 0;
    for (Photon const& p : photons) {
        weights[p.path] += luminance(p.flux);
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
    std::vector<Photon> photons = photons_of_set(visibility, counts);
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
        for (Photon const& p : photons) box = joined(box, {p.position, p.position});
    float const chosen = settings_.photons.caustic_radius_m,
                largest = chosen > 0 ? chosen : kLargest * max_component(box.high - box.low);
    shrunk_ = sets_ == 0 ? 1.0f : shrunk_ * std::sqrt((float(sets_) + kAlpha) / (float(sets_) + 1));
    ++sets_;
    map_ = {};
    if (!photons.empty() && largest > 0) { // else they all lie at one point: no area to spread them over
        std::vector<float> radii = chosen > 0 ? std::vector<float>(photons.size(), largest)
                                              : radii_by_density(photons, largest, 16, settings_.seed + sets_);
        for (float& r : radii) r *= shrunk_;
        map_ = PhotonMap(photons, radii);
    }
    photons_ = std::move(photons);
}

void Caustics::report_counts()
{
    if (targets_.choice.empty()) return;
    report_.count("caustic photons: smooth triangles", double(targets_.triangles.size()));
    report_.count("caustic photons: stored, of the last set", double(map_.count()));
    report_.count("caustic photons: sets since the last change", double(sets_));
    report_.count("caustic photons: flux, W (luminance)", double(luminance(vec3(map_.flux()))));
    report_.count("caustic photons: mean radius of the last disks, m", double(map_.mean_radius()));
}

} // namespace gi
