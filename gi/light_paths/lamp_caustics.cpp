#include "gi/light_paths/lamp_caustics.h"

#include "gi/light_paths/caustics.h"
#include "gi/light_paths/options.h"
#include "gi/scene/model/used_materials.h"

#include <algorithm>
#include <cmath>

namespace gi {
namespace {

/// Factor of the disks' radii for set number `index`: the square root of the product of (k + a) / (k + 1), k = 1 to index.
double shrunk(std::uint32_t index)
{
    constexpr double kAlpha = 2.0 / 3; // Knaus and Zwicker 2011: how slowly disks shrink
    double const n = double(index);
    return std::exp(0.5 * (std::lgamma(n + 1 + kAlpha) - std::lgamma(1 + kAlpha) - std::lgamma(n + 2)));
}

/// A fraction of the pixels: photons should take no longer than the paths.
std::uint32_t photon_paths(RenderSettings const& s)
{
    constexpr std::size_t kPixelsOfPath = 4, kLeast = 16384;
    std::size_t const for_pixels = std::max(kLeast, std::size_t(s.width) * std::size_t(s.height) / kPixelsOfPath);
    return std::uint32_t(std::min(for_pixels, std::size_t(s.of<PhotonSettings>().caustic_paths)));
}

/// As far as no texture changes it.
bool has_smooth(World const& world)
{
    return uses_material(world, [](Material const&, Bsdf const& b) { return smooth_share(b) > 0; });
}

} // namespace

bool LampCaustics::exist(World const& world, RenderSettings const& settings)
{
    return explain_lamp_caustics(world, settings).build;
}

LampCaustics::LampCaustics(World const& world, RenderSettings const& settings, Report& report)
    : world_(world),
      settings_(settings),
      report_(report),
      targets_(find_caustic_targets(world, {})),
      paths_(photon_paths(settings))
{
}

std::vector<Photon> LampCaustics::photons_of(ExactVisibility const& visibility, std::uint32_t index,
                                             BuildStop const& stop, PathCounts& counts) const
{
    WorldView const w = view(world_);
    LightPaths paths{.count = paths_,
                     .bounces = 1,
                     .seed = settings_.seed ^ (has_learned_ ? 0x1a39u : 0x1a38u), // see learn_chances()
                     .pass = index,
                     .delta_only = true,
                     .stop = &stop};
    LitStarts const lit =
        start_on_surfaces(w, visibility, targets_, {paths_, paths.seed, index}, stop, counts, StartLights::lamps);
    std::vector<Photon> photons;
    for (LightVertex const& v : trace_from_surfaces(w, ExactPathRays(visibility), lit.starts, paths, counts)) {
        if (v.by_panes_alone) continue;
        photons.push_back(to_photon(v));
        photons.back().path = lit.targets[v.path];
    }
    return photons;
}

void LampCaustics::learn(ExactVisibility const& visibility, BuildStop const& stop, PathCounts& counts)
{
    std::vector<float> light(targets_.triangles.size());
    for (Photon const& p : photons_of(visibility, 0, stop, counts)) light[p.path] += luminance(p.flux);
    learn_chances(light, targets_);
    has_learned_ = true;
}

void LampCaustics::prepare(ExactVisibility const& visibility, std::uint32_t index, BuildStop const& stop,
                           PathCounts& counts)
{
    constexpr float kLargest = 0.05f; // radius over the longest side of what is lit
    constexpr std::size_t kEnough = 16;
    StageTimer const timer(report_, "caustic photons");
    if (!has_learned_) learn(visibility, stop, counts);
    std::vector<Photon> photons = photons_of(visibility, index, stop, counts);
    Bounds box;
    for (Photon const& p : photons) box = joined(box, {p.position, p.position});
    float const chosen = settings_.of<PhotonSettings>().caustic_radius_m,
                largest = chosen > 0 || box.empty() ? chosen : kLargest * max_component(box.high - box.low);
    PhotonMap map;
    if (largest > 0) {
        std::vector<float> radii =
            chosen > 0 ? std::vector<float>(photons.size(), largest)
                       : radii_by_density(photons, largest, kEnough, settings_.seed + index + 1, stop);
        for (float& r : radii) r *= float(shrunk(index));
        map = PhotonMap(photons, radii, stop);
    }
    map_ = std::move(map); // which borrows the photons: they stay in their place
    photons_ = std::move(photons);
}

PlanItem explain_lamp_caustics(World const& world, RenderSettings const& settings)
{
    char const* const what = "caustics of lamps";
    if (world.lights.empty()) return {"lamp_caustics", what, false, "no lamp without extent"};
    if (!has_smooth(world))
        return {"lamp_caustics", what, false,
                "no material mirrors or refracts without scattering (textures aside)"};
    Figure const lamps = figure("lamps", world.lights.size());
    if (settings.of<PhotonSettings>().caustic_paths == 0)
        return {"lamp_caustics", what, false, {"{} lamps, but --caustic-photons 0", {lamps}}};
    return {"lamp_caustics",
            what,
            true,
            {"{} lamps, mirrors or glass: in pictures of paths, slhb and reference on the CPU, and of photon "
             "methods; not in "
             "frames, with --shutter, nor by vpl_*, whitted, lpv or CUDA",
             {lamps}}};
}

std::string lamp_caustic_options(World const& world, RenderSettings const& settings)
{
    if (world.lights.empty() || !has_smooth(world)) return {};
    return changed_options(photon_options(), settings, {"caustic-photons", "caustic-radius"});
}

std::string lamp_light_version(World const& world)
{
    return !world.lights.empty() && has_smooth(world) ? "lamps behind glass" : "";
}

void lose_lamp_caustics(World const& world, Report& report)
{
    if (explain_lamp_caustics(world, {}).build)
        report.lose("lamps whose light by way of mirrors and glass was not found", world.lights.size());
}

} // namespace gi
