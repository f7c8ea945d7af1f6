#include "gi/methods/paths/choose.h"

#include "gi/core/error.h"
#include "gi/hit_buffers/directions/axis_set.h"
#include "gi/hit_buffers/directions/directions.h"
#include "gi/hit_buffers/hit_buffer.h"
#include "gi/hit_buffers/options.h"
#include "gi/kernel/device.h"
#include "gi/light_paths/lamp_caustics.h"
#include "gi/methods/paths/costs.h"
#include "gi/methods/paths/lobes.h"
#include "gi/scene/model/used_materials.h"

#include <algorithm>
#include <fmt/format.h>
#include <tbb/task_arena.h>

namespace gi {
namespace {

double cores_of(RenderSettings const& s)
{
    return s.threads > 0 ? s.threads : tbb::this_task_arena::max_concurrency();
}

/// Depth complexity of a scene: mean number of layers over non-empty texels,
/// in a coarse buffer along an oblique direction.
double layers_per_texel(World const& world, TriangleSoup const& soup)
{
    HitBuffer const b = make_hit_buffer(
        soup, make_grid(world.bounds, glm::normalize(vec3{0.48f, 0.62f, 0.62f}), 64, vec2{0.5f}, 0));
    std::size_t covered = 0;
    for (std::size_t t = 0; t + 1 < b.offset.size(); ++t) covered += b.offset[t + 1] > b.offset[t];
    return covered > 0 ? double(b.layers.size()) / double(covered) : 0;
}

} // namespace

Costs costs_of(World const& world, TriangleSoup const& soup) { return {world, layers_per_texel(world, soup)}; }

bool needs_exact_rays(World const& world, bool orthographic, RenderSettings const& s)
{
    SlhbSettings const& look_ups = s.of<SlhbSettings>();
    return !s.of<PathAlgorithm>().only_looks_up() || look_ups.exact.any() || look_ups.confirm == Confirming::on ||
           orthographic || narrow_somewhere(world) || has_panes(world);
}

namespace {

/// Chooses the numbers of hit buffers and shadow maps.
SlhbSettings choose_look_ups(RenderSettings const& asked, World const& world, Costs const& costs)
{
    SlhbSettings s = asked.of<SlhbSettings>();
    // Only few axes find light that enters through small openings, so a pass needs many at once.
    bool const sky = !world.environment_select.empty();
    if (s.schedule == Schedule::automatic)
        s.schedule = !s.directions.empty()         ? Schedule::stored
                     : s.fresh_axes > 0            ? Schedule::temporal
                     : sky && asked.of<SlhbSettings>().axes == 0 ? Schedule::stored
                                                   : Schedule::streamed;
    if (s.directions.empty()) s.directions = "icosahedron:320";
    // Each level costs as much as the first, and packed depths have few steps for a whole world.
    if (s.packed || !asked.of<PathAlgorithm>().nested)
        s.levels = 1;
    else if (s.levels == 0 && asked.budget_s > 0)
        s.levels = 2;
    double const pixels = double(asked.width) * asked.height;
    constexpr int kScreenTexels = 256;
    if (asked.of<PathAlgorithm>().surfaces == SurfacesBy::screen && s.resolution == 0)
        s.resolution = kScreenTexels;
    constexpr double kShareForDoubts = 0.2;
    PathAlgorithm const& by = asked.of<PathAlgorithm>();
    bool const by_texels = by.surfaces == SurfacesBy::look_ups || by.shadows == ShadowsBy::maps,
               bvh_is_cheap =
                   asked.budget_s <= 0 || costs.bvh <= kShareForDoubts * asked.budget_s * cores_of(asked);
    if (!by.nested || !by_texels)
        s.confirm = Confirming::off;
    else if (s.confirm == Confirming::automatic) // a cone moves origins on purpose
        s.confirm = bvh_is_cheap && s.cone == 0 ? Confirming::on : Confirming::off;
    // Building the structures of a pass should cost only a fraction of its paths and of the budget, or there
    // would be too few paths to share them.
    constexpr double kPath = 0.5e-6, kShare = 0.5, kShareOfBudget = 0.2;
    double const budget = asked.budget_s > 0 ? asked.budget_s * cores_of(asked) : double(kInf);
    double const worth = std::min(kShare * kPath * pixels, kShareOfBudget * budget);
    // With few passes, each needs more axes and light points, because what they miss is missing from the whole
    // picture. Fewer texels are the smaller loss.
    bool const few_passes = budget < 8 * kPath * pixels;
    int const enough = few_passes ? 8 : 4;
    constexpr int kLeast = 64; // texels
    auto const texels_for = [&](int texels, double count, double most_s, auto const& cost) {
        while (texels > kLeast && count * cost(texels) > most_s) texels /= 2;
        return texels;
    };
    auto const axis = [&](int texels) { return costs.axis(texels); };
    auto const map = [&](int texels) { return costs.map(texels); };
    double const unless_few = few_passes ? worth : double(kInf);
    constexpr double kCluttered = 3; // layers
    if (s.resolution == 0) {
        int const wanted = costs.layers < kCluttered ? 128 : 256;
        s.resolution = s.schedule == Schedule::stored
                           ? texels_for(wanted, double(make_directions(s.directions).axes.size()),
                                        kShareOfBudget * budget, axis)
                           : texels_for(wanted, enough, unless_few, axis);
    }
    if (s.axes == 0)
        s.axes = s.schedule == Schedule::temporal ? 16 : std::clamp(int(worth / axis(s.resolution)), 2, enough);
    if (s.axes > int(FewAxes::kMost))
        throw InputError(fmt::format("{} axes in a pass", s.axes),
                         fmt::format("there is room for {}", FewAxes::kMost), "use --schedule stored for more");
    if (s.schedule != Schedule::temporal) s.fresh_axes = s.axes;
    if (s.fresh_axes == 0) s.fresh_axes = std::max(1, s.axes / 8);
    s.fresh_axes = std::min(s.fresh_axes, s.axes);
    bool const from_points = world.emitters.empty() && world.environment_select.empty();
    int const most_light_samples = sky ? 16 : enough;
    if (s.shadow_resolution == 0)
        s.shadow_resolution = from_points ? 1024
                                          : texels_for(sky && budget == double(kInf) ? 512 : 256,
                                                       most_light_samples, unless_few, map);
    if (s.light_samples == 0)
        s.light_samples =
            from_points ? 16 : std::clamp(int(worth / map(s.shadow_resolution)), sky ? 8 : 1, most_light_samples);
    if (s.memory_mib == 0) s.memory_mib = int((memory_bytes(asked.space) >> 20) / 4);
    auto const map_bytes = [&] { // cube maps, the largest
        return 6.0 * s.light_samples * s.shadow_resolution * s.shadow_resolution * sizeof(NearestTexel);
    };
    while (s.shadow_resolution > kLeast && map_bytes() > double(s.memory_mib) * (1 << 20))
        s.shadow_resolution /= 2;
    if (s.fresh_light_samples == 0) s.fresh_light_samples = s.light_samples;
    s.fresh_light_samples = std::min(s.fresh_light_samples, s.light_samples);
    return s;
}

/// Seconds of one core that a picture may take; 0 = unlimited.
double budget_of(RenderSettings const& s) { return s.budget_s * cores_of(s); }

/// Number of paths per pixel that the budget allows with exact rays, at least 1.
double expected_passes(RenderSettings const& asked, Costs const& c)
{
    double const most = double(asked.paths);
    if (!(asked.budget_s > 0)) return most;
    double const pixels = double(asked.width) * asked.height;
    double const bounces = std::min(double(asked.bounces), 1.5), surfaces = 1 + bounces; // after roulette
    double const path = c.direct + bounces * (c.bounce + c.ray) + surfaces * c.shadow_ray;
    return std::clamp((budget_of(asked) - c.bvh) / (pixels * path), 1.0, most);
}

/// Automatic: for frames, the caller decides.
RadianceCaching choose_cache(RenderSettings const& asked, bool lasting)
{
    RadianceCaching const cache = asked.of<PathsSettings>().cache;
    bool const none = asked.bounces == 0 || asked.of<SlhbSettings>().exact.any() ||
                      (asked.space == Space::device && asked.of<PathAlgorithm>().surfaces != SurfacesBy::rays);
    if (none) return RadianceCaching::off;
    if (cache != RadianceCaching::automatic) return cache;
    if (!asked.of<PathAlgorithm>().caches) return lasting ? RadianceCaching::automatic : RadianceCaching::off;
    if (asked.budget_s > 0 && !(asked.until_relmse > 0)) return RadianceCaching::on;
    return lasting ? RadianceCaching::automatic : RadianceCaching::off;
}

/// Chooses the interleaving if the first pass would exceed the budget: first surfaces and direct light for all
/// pixels, indirect light for as many as time allows. @param axes  built per pass and bounce
/// @param bvh_s  of building what exact rays go through
int choose_interleave(RenderSettings const& asked, RenderSettings const& chosen, int axes, double bvh_s,
                      Costs const& costs)
{
    if (!(asked.budget_s > 0) || asked.bounces == 0) return 1;
    SlhbSettings const& s = chosen.of<SlhbSettings>();
    PathsSettings const& p = chosen.of<PathsSettings>();
    PathAlgorithm const& by = asked.of<PathAlgorithm>();
    bool const rays = by.surfaces != SurfacesBy::look_ups, shadow_rays = by.shadows == ShadowsBy::rays;
    // Surfaces after the first one: many paths end by roulette, or most of them in the cache.
    double const pixels = double(asked.width) * asked.height, bounces = std::min(asked.bounces, 3),
                 after = p.cache == RadianceCaching::on ? 1.3
                         : p.roulette > 0               ? std::min(bounces, 1.5)
                                                        : bounces;
    double const shadow = shadow_rays ? costs.shadow_ray : 0;
    bool const confirms = s.confirm == Confirming::on;
    constexpr double kDoubtful = 0.5; // of look-ups, in cluttered scenes
    double const fixed = (confirms ? bvh_s : 0) + (rays ? 0 : bounces * axes * costs.axis(s.resolution)) +
                         (shadow_rays ? 0 : s.fresh_light_samples * costs.map(s.shadow_resolution)) +
                         pixels * (costs.direct + shadow),
                 indirect = pixels * after *
                            (costs.bounce +
                             (rays       ? costs.ray
                              : confirms ? kDoubtful * costs.ray
                                         : 0) +
                             shadow);
    for (int const n : {1, 2, 4})
        if ((fixed + indirect / (n * n)) / cores_of(asked) < asked.budget_s) return n;
    return 4;
}

/// Adds the choices about paths.
RenderSettings with_paths(RenderSettings const& asked, SlhbSettings const& buffers, Costs const& costs, bool lasting)
{
    RenderSettings chosen = asked;
    chosen.of<SlhbSettings>() = buffers;
    // With a budget, paths of low throughput are worth less, as ending them leaves time for more paths.
    constexpr float kRoulette = 2, kRouletteToCells = 3; // measured: docs/decisions/path-tracer.md
    constexpr double kFewPasses = 1.4;
    bool const by_time =
        lasting || asked.until_relmse > 0 || (asked.budget_s > 0 && expected_passes(asked, costs) >= kFewPasses);
    PathsSettings& p = chosen.of<PathsSettings>();
    p.cache = choose_cache(asked, lasting);
    if (p.roulette < 0) p.roulette = !by_time ? 0 : p.cache == RadianceCaching::on ? kRouletteToCells : kRoulette;
    bool const kept = lasting && buffers.schedule == Schedule::stored;
    if (p.interleave == 0)
        p.interleave =
            choose_interleave(asked, chosen, kept ? 0 : buffers.fresh_axes, lasting ? 0 : costs.bvh, costs);
    return chosen;
}

} // namespace

RenderSettings choose_settings(RenderSettings const& asked, World const& world, TriangleSoup const& soup)
{
    Costs const costs = costs_of(world, soup);
    return with_paths(asked, choose_look_ups(asked, world, costs), costs, false);
}

RenderSettings choose_frame_settings(RenderSettings const& asked, World const& world, TriangleSoup const& soup)
{
    Costs const costs = costs_of(world, soup);
    RenderSettings lasting = asked;
    lasting.budget_s = 0;
    SlhbSettings& wanted = lasting.of<SlhbSettings>();
    bool const moves = world.static_triangles < world.triangles.size();
    // Many axes for every frame; each frame only pays for dynamic geometry.
    if (moves && wanted.schedule == Schedule::automatic && wanted.axes == 0 && wanted.fresh_axes == 0)
        wanted.schedule = Schedule::stored;
    SlhbSettings s = choose_look_ups(lasting, world, costs);
    // Each pass replaces only a few light points, and has at least as many as a window
    // of the discontinuity filter has pixels.
    // kPasses: passes that replace as many light points as choose_settings uses in one.
    constexpr int kLightSamples = 16, kPasses = 4;
    int const fresh = asked.of<SlhbSettings>().fresh_light_samples > 0 ? asked.of<SlhbSettings>().fresh_light_samples
                                                         : std::max(1, s.light_samples / kPasses);
    if (asked.of<SlhbSettings>().light_samples == 0) s.light_samples = std::max(s.light_samples, kLightSamples);
    s.fresh_light_samples = std::min(fresh, s.light_samples);
    return with_paths(asked, s, costs, true);
}

std::string as_options(RenderSettings const& chosen)
{
    SlhbSettings const& s = chosen.of<SlhbSettings>();
    PathAlgorithm const& by = chosen.of<PathAlgorithm>();
    std::vector<std::string_view> own{"roulette", "interleave"}, buffers;
    bool const states_levels = s.levels > 0 && !s.packed && by.nested,
               states_confirm = s.confirm != Confirming::automatic && by.nested;
    if (chosen.of<PathsSettings>().cache != RadianceCaching::automatic) own.push_back("radiance-cache");
    if (by.surfaces == SurfacesBy::look_ups) {
        buffers = {"schedule", "hit-buffer", s.schedule == Schedule::stored ? "directions" : "axes"};
        if (s.schedule == Schedule::temporal) buffers.push_back("fresh-axes");
        if (s.most_layers > 0) buffers.push_back("max-layers");
        if (s.cone > 0) buffers.push_back("cone");
        if (states_levels) buffers.push_back("levels");
        if (states_confirm) buffers.push_back("confirm");
        buffers.insert(buffers.end(), {"packed", "gather"});
    }
    if (by.surfaces == SurfacesBy::screen) buffers = {"hit-buffer"};
    if (by.shadows == ShadowsBy::maps) {
        bool const first = by.surfaces != SurfacesBy::look_ups;
        if (first && states_levels) buffers.push_back("levels");
        if (first && states_confirm) buffers.push_back("confirm");
        buffers.insert(buffers.end(), {"light-samples", "shadow-map"});
        if (s.fresh_light_samples < s.light_samples) buffers.push_back("fresh-light-samples");
    }
    std::string text = as_options(paths_options(), chosen, own);
    if (std::string const more = as_options(hit_buffer_options(), chosen, buffers); !more.empty()) text += " " + more;
    if (chosen.space == Space::device) text += " " + as_options(common_options(), chosen, {"device"});
    return text;
}

std::vector<PlanItem> explain_choices(World const& world, RenderSettings const& asked, Camera const& camera)
{
    TriangleSoup const soup = make_soup(world);
    Costs const costs = costs_of(world, soup);
    SlhbSettings const s = choose_look_ups(asked, world, costs);
    PathAlgorithm const& by = asked.of<PathAlgorithm>();
    bool const screen = by.surfaces == SurfacesBy::screen, walks = by.surfaces == SurfacesBy::look_ups,
               rays = by.shadows == ShadowsBy::rays;
    std::vector<PlanItem> items;
    items.push_back({"look_ups", "look-ups in hit buffers", walks,
                     walks    ? "how this method finds surfaces"
                     : screen ? "this method finds surfaces among what the view shows"
                              : "this method finds surfaces by exact rays"});
    if (walks) {
        char const* const names[] = {"automatic", "stored", "streamed", "temporal"};
        items.push_back({std::string("schedule_") + names[int(s.schedule)],
                         std::string("schedule ") + names[int(s.schedule)], true,
                         s.schedule == Schedule::streamed ? "the error is not limited by a fixed set of directions"
                                                          : "there is a sky, or it was requested"});
        if (s.schedule == Schedule::stored)
            items.push_back(
                {"directions", "directions " + s.directions, true,
                 world.environment_select.empty() ? "requested" : "a sky needs many axes to be found"});
        else
            items.push_back({"axes",
                             {"{} axes for each bounce of a pass", {figure("axes", s.axes)}},
                             true,
                             {"for {} triangles and {} x {} pixels",
                              {figure("triangles", world.triangles.size()), figure("width_px", asked.width),
                               figure("height_px", asked.height)}}});
        items.push_back(
            {"hit_buffers",
             {"hit buffers of {} x {} texels",
              {figure("width_px", s.resolution), figure("height_px", s.resolution)}},
             true,
             {"{} layers per texel, texels of {} m, finer around the cameras of a large world (--levels)",
              {Figure{{"layers_per_texel", costs.layers}, fmt::format("{:.1f}", costs.layers)},
               figure("texel_m", 2 * double(world.bounds.radius()) / s.resolution, 2)}}});
        Figure const most{{"most_memory_bytes", std::int64_t(s.memory_mib) << 20}, std::to_string(s.memory_mib)};
        items.push_back({"hit_buffer_memory",
                         {"at most {} MiB of hit buffers", {most}},
                         true,
                         "else they get fewer texels (--memory)"});
    }
    bool const cached = choose_cache(asked, false) == RadianceCaching::on;
    items.push_back({"radiance_cache", "radiance cache", cached,
                     asked.of<PathsSettings>().cache != RadianceCaching::automatic ? "requested"
                     : cached     ? "there is a budget; it trades noise for a little blur"
                     : screen     ? "its light would depend on the view"
                     : !by.caches ? "it is not part of this method; --radiance-cache on"
                                  : "it would leave a small error even in long renders; --radiance-cache on"});
    bool const lit = !world.light_select.empty();
    items.push_back({rays ? "shadow_rays" : "shadow_maps",
                     rays ? "shadow rays"
                          : PlanText("{} shadow maps of {} x {}",
                                     {figure("maps", s.light_samples), figure("width_px", s.shadow_resolution),
                                      figure("height_px", s.shadow_resolution)}),
                     lit, !lit   ? "there are no lights"
                     : rays ? "each path has its own light samples, so that pixels share no error"
                            : "all paths of a pass share a few light samples"});
    items.push_back(explain_lamp_caustics(world, asked));
    bool const narrow = narrow_somewhere(world), confirms = s.confirm == Confirming::on && (walks || !rays);
    items.push_back({"exact_rays", "exact rays (Embree)",
                     !walks || rays || narrow || confirms || camera.orthographic,
                     screen                ? "for mirrors, glass, narrow lobes and shadows"
                     : !walks              ? "in place of look-ups"
                     : rays                ? "for shadows"
                     : camera.orthographic ? "the camera is orthographic"
                     : narrow              ? "mirrors, glass or narrow lobes need more directions than the axes"
                     : confirms            ? "where the texels around a look-up disagree (--confirm)"
                                           : "every lobe is broad"});
    return items;
}

} // namespace gi
