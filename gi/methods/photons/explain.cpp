#include "gi/methods/photons/explain.h"

#include "gi/light_paths/caustics.h"
#include "gi/light_paths/impostors.h"
#include "gi/methods/photons/limits.h"
#include "gi/methods/photons/screen_volume.h"
#include "gi/methods/photons/splat.h"
#include "gi/methods/sh_grid/focus.h"

#include <algorithm>
#include <fmt/format.h>

namespace gi {
namespace {

using Items = std::vector<PlanItem>;

std::string megabytes(std::uint64_t bytes) { return fmt::format("{:.3g} MB", double(bytes) * 1e-6); }

std::string cells_of(GridFrame const& f)
{
    return fmt::format("{} x {} x {} cells of {:.3g} m", f.size.x, f.size.y, f.size.z, double(f.cell));
}

struct LightPathPlan {
    PhotonRays rays;
    int bounces; ///< reflections of a photon
};

/// Why there are no light paths; empty if there are.
std::string why_no_paths(World const& world, LightPathPlan const& plan)
{
    if (world.bounds.empty()) return "there are no surfaces";
    if (world.light_select.empty()) return "there is no light";
    if (plan.bounces < 1) return "no indirect light is asked for (--bounces)";
    return {};
}

PlanItem focus_item(World const& world, RenderSettings const& s, Camera const& camera)
{
    char const* const what = "light from afar towards what is shown";
    bool const afar = world.environment != nullptr || std::ranges::any_of(world.lights, [](Light const& l) {
                          return l.type == LightType::directional;
                      });
    if (!afar) return {what, false, "there is no sky and no parallel light"};
    ExactVisibility const visibility(world, plan_scene(world).alpha_tests, s.threads);
    FrameView const view{camera, s.width, s.height};
    Bounds const shown = focus_of(shown_points(world, visibility, {&view, 1}), 64);
    std::string const extents = fmt::format("what the camera shows is {:.3g} of {:.3g} m long",
                                            double(longest_side(shown)), double(longest_side(world.bounds)));
    if (!needs_fine_grid(shown, world.bounds)) return {what, false, extents};
    return {what, true, extents + "; it gets half of this light's paths"};
}

/// What all methods have in common.
Items light_path_items(World const& world, RenderSettings const& s, Camera const& camera,
                       LightPathPlan const& plan)
{
    PhotonSettings const& p = s.photons;
    Items out;
    out.push_back({"light paths", true,
                   fmt::format("{} for a set of photons (--photons), of at most {} reflections each", p.paths,
                               plan.bounces)});
    bool const map = p.first_bounce == FirstBounce::map;
    out.push_back({"bounce maps", map,
                   map ? "first surfaces are rasterised as seen from the lights"
                       : "rays find the first surfaces (--first-bounce)"});
    bool const look_ups = plan.rays == PhotonRays::look_ups, impostors = plan.rays == PhotonRays::impostors,
               moves = world.static_triangles < world.triangles.size();
    out.push_back({"hit buffers of light paths", look_ups,
                   look_ups ? "broad lobes follow stored directions by look-ups; mirrors and glass exact rays"
                            : "surfaces are found in another way (--photon-rays)"});
    std::uint32_t const side = impostor_resolution(p.impostor_texels);
    out.push_back({"distance impostors", impostors,
                   impostors ? fmt::format("at most {} cube maps of 6 x {} x {} texels, {}", p.impostors, side,
                                           side, megabytes(impostor_bytes(p.impostors, p.impostor_texels, moves)))
                             : "surfaces are found in another way (--photon-rays)"});
    out.push_back(focus_item(world, s, camera));
    bool const frozen = p.frozen == Switch::on;
    out.push_back({"new photons when something moves", moves && !frozen,
                   frozen ? std::string("--frozen-light on: light is computed once and kept")
                   : moves
                       ? fmt::format("{} triangles can move; each frame in which they do has all light paths anew",
                                     world.triangles.size() - world.static_triangles)
                       : std::string("nothing moves")});
    return out;
}

PlanItem caustics_item(World const& world, PhotonSettings const& s)
{
    std::size_t const smooth = find_caustic_targets(world, {}).triangles.size();
    if (smooth == 0)
        return {"caustics", false, "no smooth surface: nothing mirrors or refracts without scattering"};
    if (s.caustic_paths == 0)
        return {"caustics", false, fmt::format("{} smooth triangles, but --caustic-photons 0", smooth)};
    return {"caustics", true,
            fmt::format("{} light paths per pass begin on {} smooth triangles", s.caustic_paths, smooth)};
}

PlanItem cascades_item(char const* option, int cascades)
{
    return {"nested lattices", cascades > 1,
            cascades > 1 ? fmt::format("{} of them about the camera, the cells of each half as wide as the next "
                                       "one's",
                                       cascades)
                         : fmt::format("{} 1: one lattice over the scene", option)};
}

PlanItem bytes_item(char const* what, std::uint64_t bytes)
{
    bool const fits = bytes <= kMostBytes;
    return {what, fits,
            fmt::format("at most {}{}", megabytes(bytes),
                        fits ? "" : fmt::format(": refused, above {} GiB", kMostBytes >> 30))};
}

int reflections(RenderSettings const& s) { return std::min(s.photons.reflections, s.bounces); }

} // namespace

Items explain_ispm(World const& world, RenderSettings const& s, Camera const& camera)
{
    LightPathPlan const plan{s.photons.rays, reflections(s)};
    if (std::string const why = why_no_paths(world, plan); !why.empty()) return {{"light paths", false, why}};
    Items out = light_path_items(world, s, camera, plan);
    out.push_back(caustics_item(world, s.photons));
    out.push_back({"lists of photons by tiles of the screen", true,
                   fmt::format("tiles of {0} x {0} pixels; what mirrors show is found in the photon map",
                               ScreenMap::kTile)});
    return out;
}

Items explain_lpv(World const& world, RenderSettings const& s, Camera const& camera)
{
    // Of a light path the lattice's propagation is the last bounce.
    LightPathPlan const plan{s.photons.rays, reflections(s)};
    if (std::string const why = why_no_paths(world, plan); !why.empty()) return {{"light paths", false, why}};
    Items out = light_path_items(world, s, camera, plan);
    PropagationSettings const of = propagation_of(s.photons);
    auto const frames = nested_frames(world.bounds, world.bounds.center(), of.cells, of.cascades);
    int const steps = of.steps > 0 ? of.steps : 2 * of.cells;
    out.push_back({"lattice in which light propagates", true,
                   fmt::format("{}, {} steps from cell to cell", cells_of(frames.back()), steps)});
    out.push_back(cascades_item("--propagation-cascades", of.cascades));
    out.push_back(bytes_item("memory of lattices", LightPropagation::bytes(of, world.bounds)));
    out.push_back({"caustics", false, "a lattice in which light propagates is too coarse for them"});
    return out;
}

Items explain_isllpm(World const& world, RenderSettings const& s, Camera const& camera)
{
    LightPathPlan const plan{s.photons.rays, reflections(s)};
    if (std::string const why = why_no_paths(world, plan); !why.empty()) return {{"light paths", false, why}};
    Items out = light_path_items(world, s, camera, plan);
    PhotonLatticeSettings const of = lattices_of(s.photons);
    PlanItem const caustics = caustics_item(world, s.photons);
    char const* const names[] = {"lattice of two and more reflections", "lattice of one reflection",
                                 "lattice of caustics"};
    for (std::size_t k = 0; k < 3; ++k) {
        GridFrame const f = frames_off_walls(world.bounds, world.bounds.center(), of.cells[k], of.cascades).back();
        bool const used = k < 2 || caustics.build;
        out.push_back({names[k], used,
                       used ? cells_of(f) + (of.smooth[k] ? ", smoothed over 3 x 3 x 3 cells" : "")
                            : caustics.reason + "; it stays empty"});
    }
    out.push_back(cascades_item("--lattice-cascades", of.cascades));
    out.push_back(bytes_item("memory of lattices", PhotonLattices::bytes(of, world.bounds, surface_area(world))));
    out.push_back(caustics);
    return out;
}

Items explain_multi_image(World const& world, RenderSettings const& s, Camera const& camera)
{
    LightPathPlan const plan{PhotonRays::impostors, reflections(s)};
    if (std::string const why = why_no_paths(world, plan); !why.empty()) return {{"light paths", false, why}};
    Items out = light_path_items(world, s, camera, plan);
    PhotonLatticeSettings const of = volume_of(s.photons);
    out.push_back({"light gathering volume", true,
                   cells_of(frames_off_walls(world.bounds, world.bounds.center(), of.cells[0], 1)[0])});
    out.push_back(
        bytes_item("memory of the volume", PhotonLattices::bytes(of, world.bounds, surface_area(world))));
    PlanItem const caustics = caustics_item(world, s.photons);
    out.push_back(caustics);
    bool const on_screen = caustics.build && !camera.orthographic;
    out.push_back({"caustics in screen space", on_screen,
                   on_screen ? fmt::format("{} x {} pixels of {} bytes, {} steps of gathering", s.width, s.height,
                                           sizeof(ScreenSurface) + sizeof(ShColor), s.photons.screen_gathers)
                   : caustics.build ? std::string("an orthographic camera: caustics come from the photon map")
                                    : caustics.reason});
    return out;
}

} // namespace gi
