#include "gi/methods/photons/explain.h"

#include "gi/light_paths/caustics.h"
#include "gi/light_paths/focus.h"
#include "gi/light_paths/impostor_places.h"
#include "gi/light_paths/impostors.h"
#include "gi/methods/photons/limits.h"
#include "gi/methods/photons/screen_volume.h"
#include "gi/methods/photons/splat.h"

#include <algorithm>
#include <fmt/format.h>

namespace gi {
namespace {

using Items = std::vector<PlanItem>;

/// @param frames  nested ones, the finest first
PlanText cells_of(std::vector<GridFrame> const& frames)
{
    GridFrame const& f = frames.back();
    PlanText const coarsest("{} x {} x {} cells of {} m",
                            {figure("cells_x", f.size.x), figure("cells_y", f.size.y), figure("cells_z", f.size.z),
                             figure("cell_m", double(f.cell), 3)});
    if (frames.size() < 2) return coarsest;
    return coarsest + PlanText(", the finest of {} m", {figure("finest_cell_m", double(frames[0].cell), 3)});
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

/// What the camera shows of a world, as the methods use it.
struct Shown {
    Bounds focus; ///< empty unless the world is much larger
    PlanText extents;
};

Shown what_is_shown(World const& world, RenderSettings const& s, Camera const& camera)
{
    ExactVisibility const visibility(world, plan_scene(world).alpha_tests, s.threads);
    FrameView const view{camera, s.width, s.height};
    std::vector<vec3> const points = shown_points(world, visibility, {&view, 1});
    Bounds const shown = focus_of(points, 64);
    return {focus_in(world.bounds, points, 64),
            {"what the camera shows is {} of {} m long",
             {figure("shown_length_m", double(longest_side(shown)), 3),
              figure("scene_length_m", double(longest_side(world.bounds)), 3)}}};
}

PlanItem focus_item(World const& world, Shown const& shown)
{
    char const *const name = "focus", *const what = "light from afar towards what is shown";
    bool const afar = world.environment != nullptr || std::ranges::any_of(world.lights, [](Light const& l) {
                          return l.type == LightType::directional;
                      });
    if (!afar) return {name, what, false, "there is no sky and no parallel light"};
    if (shown.focus.empty()) return {name, what, false, shown.extents};
    return {name, what, true, shown.extents + "; it gets half of this light's paths"};
}

/// What all methods have in common.
Items light_path_items(World const& world, RenderSettings const& s, Shown const& shown, LightPathPlan const& plan)
{
    PhotonSettings const& p = s.of<PhotonSettings>();
    Items out;
    out.push_back({"light_paths",
                   "light paths",
                   true,
                   {"{} for a set of photons (--photons), of at most {} reflections each",
                    {figure("paths", p.paths), figure("most_reflections", plan.bounces)}}});
    bool const map = p.first_bounce == FirstBounce::map;
    out.push_back({"bounce_maps", "bounce maps", map,
                   map ? "first surfaces are rasterised as seen from the lights"
                       : "rays find the first surfaces (--first-bounce)"});
    bool const look_ups = plan.rays == PhotonRays::look_ups, impostors = plan.rays == PhotonRays::impostors,
               moves = world.static_triangles < world.triangles.size();
    out.push_back({"hit_buffers", "hit buffers of light paths", look_ups,
                   look_ups ? "broad lobes follow stored directions by look-ups; mirrors and glass exact rays"
                            : "surfaces are found in another way (--photon-rays)"});
    std::uint32_t const side = impostor_resolution(p.impostor_texels);
    std::uint64_t const bytes = impostor_bytes(impostor_count(p), p.impostor_texels, moves);
    out.push_back({"distance_impostors", "distance impostors", impostors,
                   impostors ? PlanText("at most {} cube maps of 6 x {} x {} texels, {}",
                                        {figure("most_maps", impostor_count(p)), figure("width_px", side),
                                         figure("height_px", side), figure_of_bytes("most_memory_bytes", bytes)})
                             : "surfaces are found in another way (--photon-rays)"});
    out.push_back(focus_item(world, shown));
    bool const frozen = p.frozen == Switch::on;
    std::size_t const moving = world.triangles.size() - world.static_triangles;
    out.push_back({"new_photons", "new photons when something moves", moves && !frozen,
                   frozen ? "--frozen-light on: light is computed once and kept"
                   : moves
                       ? PlanText("{} triangles can move; each frame in which they do has all light paths anew",
                                  {figure("moving_triangles", moving)})
                       : "nothing moves"});
    return out;
}

/// @param asked  0 = about what is shown  @param cascades  that there are
PlanItem cascades_item(int asked, int cascades, Shown const& shown)
{
    char const *const name = "nested_lattices", *const what = "nested lattices";
    PlanText const many("{} of them, the cells of each half as wide as the next one's",
                        {figure("lattices", cascades)});
    if (asked == 0) return {name, what, cascades > 1, (cascades > 1 ? many + ": " : "") + shown.extents};
    return {name, what, cascades > 1, cascades > 1 ? many + ", about the camera" : "one was asked for"};
}

PlanItem bytes_item(char const* what, std::uint64_t bytes)
{
    bool const fits = bytes <= kMostBytes;
    PlanText const most("at most {}", {figure_of_bytes("most_memory_bytes", bytes)});
    return {"memory", what, fits, fits ? most : most + fmt::format(": refused, above {} GiB", kMostBytes >> 30)};
}

int reflections(RenderSettings const& s) { return std::min(s.of<PhotonSettings>().reflections, s.bounces); }

} // namespace

Items explain_ispm(World const& world, RenderSettings const& s, Camera const& camera)
{
    LightPathPlan const plan{s.of<PhotonSettings>().rays, reflections(s)};
    if (std::string const why = why_no_paths(world, plan); !why.empty())
        return {{"light_paths", "light paths", false, why}};
    Shown const shown = what_is_shown(world, s, camera);
    Items out = light_path_items(world, s, shown, plan);
    out.push_back(explain_caustics(world, s.of<PhotonSettings>()));
    out.push_back({"photon_tiles",
                   "lists of photons by tiles of the screen",
                   true,
                   {"tiles of {} x {} pixels; what mirrors show is found in the photon map",
                    {figure("width_px", ScreenMap::kTile), figure("height_px", ScreenMap::kTile)}}});
    return out;
}

Items explain_lpv(World const& world, RenderSettings const& s, Camera const& camera)
{
    // Of a light path the lattice's propagation is the last bounce.
    LightPathPlan const plan{s.of<PhotonSettings>().rays, reflections(s)};
    if (std::string const why = why_no_paths(world, plan); !why.empty())
        return {{"light_paths", "light paths", false, why}};
    Shown const shown = what_is_shown(world, s, camera);
    Items out = light_path_items(world, s, shown, plan);
    PropagationSettings of = propagation_of(s.of<PhotonSettings>());
    if (of.cascades == 0) of.cascades = nested_cascades(world.bounds, shown.focus, of.kMostCascades);
    auto const frames =
        nested_frames(world.bounds, center_of(shown.focus, world.bounds.center()), of.cells, of.cascades);
    int const steps = of.steps > 0 ? of.steps : 2 * of.cells;
    out.push_back({"propagation_lattice", "lattice in which light propagates", true,
                   cells_of(frames) + PlanText(", {} steps from cell to cell", {figure("steps", steps)})});
    out.push_back(cascades_item(s.of<PhotonSettings>().propagation_cascades, of.cascades, shown));
    out.push_back(bytes_item("memory of lattices", LightPropagation::bytes(of, world.bounds)));
    out.push_back({"caustics", "caustics", false, "a lattice in which light propagates is too coarse for them"});
    return out;
}

Items explain_isllpm(World const& world, RenderSettings const& s, Camera const& camera)
{
    LightPathPlan const plan{s.of<PhotonSettings>().rays, reflections(s)};
    if (std::string const why = why_no_paths(world, plan); !why.empty())
        return {{"light_paths", "light paths", false, why}};
    Shown const shown = what_is_shown(world, s, camera);
    Items out = light_path_items(world, s, shown, plan);
    PhotonLatticeSettings const of = PhotonLattices::placed(lattices_of(s.of<PhotonSettings>()), world, shown.focus);
    PlanItem const caustics = explain_caustics(world, s.of<PhotonSettings>());
    char const *const names[] = {"low_lattice", "middle_lattice", "caustic_lattice"},
                      *const whats[] = {"lattice of two and more reflections", "lattice of one reflection",
                                        "lattice of caustics"};
    for (std::size_t k = 0; k < 3; ++k) {
        auto const frames = frames_off_walls(world.bounds, center_of(shown.focus, world.bounds.center()),
                                             of.cells[k], of.cascades);
        bool const by_kernels = s.of<PhotonSettings>().caustics_by == CausticsBy::kernels;
        bool const used = k < 2 || (caustics.build && !by_kernels);
        out.push_back({names[k], whats[k], used,
                       used ? cells_of(frames) + (of.smooth[k] ? ", smoothed over 3 x 3 x 3 cells" : "")
                       : caustics.build ? "the photon map shows them (--caustics-by kernels)"
                                        : caustics.reason + "; it stays empty"});
    }
    out.push_back(cascades_item(s.of<PhotonSettings>().lattice_cascades, of.cascades, shown));
    out.push_back(bytes_item("memory of lattices", PhotonLattices::bytes(of, world.bounds, surface_area(world))));
    out.push_back(caustics);
    return out;
}

Items explain_multi_image(World const& world, RenderSettings const& s, Camera const& camera)
{
    LightPathPlan const plan{PhotonRays::impostors, reflections(s)};
    if (std::string const why = why_no_paths(world, plan); !why.empty())
        return {{"light_paths", "light paths", false, why}};
    Shown const shown = what_is_shown(world, s, camera);
    Items out = light_path_items(world, s, shown, plan);
    PhotonLatticeSettings const of = PhotonLattices::placed(volume_of(s.of<PhotonSettings>()), world, shown.focus);
    out.push_back({"gathering_volume", "light gathering volume", true,
                   cells_of(frames_off_walls(world.bounds, center_of(shown.focus, world.bounds.center()),
                                             of.cells[0], of.cascades)) +
                       PlanText(", {} steps of gathering", {figure("steps", of.gathers)})});
    out.push_back(cascades_item(s.of<PhotonSettings>().lattice_cascades, of.cascades, shown));
    out.push_back(
        bytes_item("memory of the volume", PhotonLattices::bytes(of, world.bounds, surface_area(world))));
    PlanItem const caustics = explain_caustics(world, s.of<PhotonSettings>());
    out.push_back(caustics);
    bool const on_screen = caustics.build && !camera.orthographic;
    out.push_back({"screen_caustics", "caustics in screen space", on_screen,
                   on_screen        ? PlanText("{} x {} pixels of {} bytes, {} steps of gathering",
                                               {figure("width_px", s.width), figure("height_px", s.height),
                                                figure("pixel_bytes", sizeof(ScreenSurface) + sizeof(ShColor)),
                                                figure("steps", s.of<PhotonSettings>().screen_gathers)})
                   : caustics.build ? "an orthographic camera: caustics come from the photon map"
                                    : caustics.reason});
    return out;
}

} // namespace gi
