#include "gi/light_paths/caustics.h"

#include "gi/core/rng.h"
#include "gi/render/flush_denormals.h"
#include "gi/render/ray_path.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

float area_of(WorldView const& world, std::uint32_t triangle)
{
    return 0.5f * glm::length(light_detail::area_vector(world.surfaces[triangle]));
}

} // namespace

float smooth_share(Bsdf const& b)
{
    float const mirrors = bsdf_detail::specular_is_delta(b) ? max_component(b.f0) : 0;
    return std::min(1.0f, b.clear + mirrors);
}

StartTargets find_caustic_targets(World const& world, Bounds const& focus)
{
    StartTargets out;
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

PlanItem explain_caustics(World const& world, PhotonSettings const& s)
{
    std::size_t const smooth = find_caustic_targets(world, {}).triangles.size();
    if (smooth == 0)
        return {"caustics", "caustics", false,
                "no smooth surface: nothing mirrors or refracts without scattering"};
    Figure const triangles = figure("smooth_triangles", smooth);
    if (s.caustic_paths == 0)
        return {"caustics", "caustics", false, {"{} smooth triangles, but --caustic-photons 0", {triangles}}};
    return {
        "caustics",
        "caustics",
        true,
        {"{} light paths per pass begin on {} smooth triangles", {figure("paths", s.caustic_paths), triangles}}};
}

Caustics::Caustics(World const& world, RenderSettings const& settings, Report& report)
    : world_(world), settings_(settings), report_(report)
{
}

void Caustics::changed(Changes const& c)
{
    surfaces_changed_ = surfaces_changed_ || c.geometry || c.bounds || c.materials || c.coverage;
    light_changed_ = light_changed_ || c.lights || c.emitters || c.environment;
}

void Caustics::prepare(ExactVisibility const& visibility, std::uint32_t index, std::span<FrameView const> views,
                       Bounds const& focus, double share, BuildStop const& stop, PathCounts& counts)
{
    if (settings_.of<PhotonSettings>().caustic_paths == 0) return;
    paths_ = std::max(1u, std::uint32_t(share * settings_.of<PhotonSettings>().caustic_paths));
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
        ++version_;
        return;
    }
    trace(visibility, stop, counts);
}

std::vector<Photon> Caustics::photons_of_set(ExactVisibility const& visibility, BuildStop const& stop,
                                             PathCounts& counts)
{
    WorldView const w = view(world_);
    LightPaths paths{.count = paths_,
                     .bounces = 1,
                     .seed = settings_.seed,
                     .pass = *first_index_ + sets_,
                     .delta_only = true,
                     .stop = &stop};
    paths.seed ^= learned_.value_or(false) ? 0xca58u : 0xca57u; // see learn_chances()
    LitStarts const lit =
        start_on_surfaces(w, visibility, targets_, {paths_, paths.seed, paths.pass}, stop, counts);
    std::vector<Photon> photons;
    for (LightVertex const& v : trace_from_surfaces(w, ExactPathRays(visibility), lit.starts, paths, counts)) {
        photons.push_back(to_photon(v));
        photons.back().path = lit.targets[v.path];
    }
    return photons;
}

void Caustics::trace(ExactVisibility const& visibility, BuildStop const& stop, PathCounts& counts)
{
    constexpr float kAlpha = 2.0f / 3; // Knaus and Zwicker 2011: how slowly disks shrink
    constexpr float kLargest = 0.05f;  // radius over the longest side of what is lit, or of the focus
    StageTimer const timer(report_, "caustic photons");
    std::vector<Photon> photons = photons_of_set(visibility, stop, counts);
    std::size_t const few = paths_ / 4;
    if (!learned_) {
        learned_ = !photons.empty() && photons.size() < few;
        if (*learned_) {
            std::vector<float> light(targets_.triangles.size());
            for (Photon const& p : photons) light[p.path] += luminance(p.flux);
            learn_chances(light, targets_);
            photons = photons_of_set(visibility, stop, counts);
        }
    }
    Bounds box = focus_;
    if (focus_.empty())
        for (Photon const& p : photons) box = joined(box, {p.position, p.position});
    float const chosen = settings_.of<PhotonSettings>().caustic_radius_m,
                largest = chosen > 0 ? chosen : kLargest * max_component(box.high - box.low);
    float const shrunk = sets_ == 0 ? 1.0f : shrunk_ * std::sqrt((float(sets_) + kAlpha) / (float(sets_) + 1));
    PhotonMap map;
    if (!photons.empty() && largest > 0) { // else all are at one point: no area to spread them over
        std::vector<float> radii = chosen > 0
                                       ? std::vector<float>(photons.size(), largest)
                                       : radii_by_density(photons, largest, 16, settings_.seed + sets_ + 1, stop);
        for (float& r : radii) r *= shrunk;
        map = PhotonMap(photons, radii, stop);
    }
    shrunk_ = shrunk;
    ++sets_;
    ++version_;
    map_ = std::move(map); // which borrows the photons: they stay in their place
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
