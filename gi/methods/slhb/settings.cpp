#include "gi/methods/slhb/settings.h"

#include "gi/core/error.h"
#include "gi/methods/slhb/directions/axis_set.h"
#include "gi/methods/slhb/directions/directions.h"
#include "gi/methods/slhb/hit_buffer/hit_buffer.h"
#include "gi/methods/slhb/ray_plan.h"

#include <algorithm>
#include <fmt/format.h>
#include <tbb/task_arena.h>
#include <unistd.h>

namespace gi {
namespace {

double cores_of(RenderSettings const& s)
{
    return s.threads > 0 ? s.threads : tbb::this_task_arena::max_concurrency();
}

std::size_t physical_bytes() { return std::size_t(sysconf(_SC_PHYS_PAGES)) * std::size_t(sysconf(_SC_PAGE_SIZE)); }

/// Depth complexity of a scene: mean number of layers over non-empty texels, in a coarse buffer along an oblique
/// direction.
double layers_per_texel(World const& world, TriangleSoup const& soup)
{
    HitBuffer const b = make_hit_buffer(
        soup, make_grid(world.bounds, glm::normalize(vec3{0.48f, 0.62f, 0.62f}), 64, vec2{0.5f}, 0));
    std::size_t covered = 0;
    for (std::size_t t = 0; t + 1 < b.offset.size(); ++t) covered += b.offset[t + 1] > b.offset[t];
    return covered > 0 ? double(b.layers.size()) / double(covered) : 0;
}

} // namespace

bool needs_exact_rays(World const& world, bool orthographic, SlhbSettings const& s)
{
    return s.shadows == Shadows::rays || s.look_ups == LookUps::none || s.exact.any() || orthographic ||
           narrow_somewhere(world);
}

namespace {

/// Chooses all settings except those of plan_rays.
SlhbSettings choose_look_ups(RenderSettings const& asked, World const& world, Costs const& costs)
{
    SlhbSettings s = asked.slhb;
    // Only few axes find light that enters through small openings, so a pass needs many at once.
    bool const sky = !world.environment_select.empty();
    if (s.schedule == Schedule::automatic)
        s.schedule = !s.directions.empty()         ? Schedule::stored
                     : s.fresh_axes > 0            ? Schedule::temporal
                     : sky && asked.slhb.axes == 0 ? Schedule::stored
                                                   : Schedule::streamed;
    if (s.directions.empty()) s.directions = "icosahedron:320";
    double const pixels = double(asked.width) * asked.height;
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
    if (s.memory_mib == 0) s.memory_mib = int((physical_bytes() >> 20) / 4);
    auto const map_bytes = [&] { // cube maps, the largest
        return 6.0 * s.light_samples * s.shadow_resolution * s.shadow_resolution * sizeof(NearestTexel);
    };
    while (s.shadow_resolution > kLeast && map_bytes() > double(s.memory_mib) * (1 << 20))
        s.shadow_resolution /= 2;
    if (s.fresh_light_samples == 0) s.fresh_light_samples = s.light_samples;
    s.fresh_light_samples = std::min(s.fresh_light_samples, s.light_samples);
    return s;
}

/// Automatic: for frames, the caller decides.
RadianceCaching choose_cache(RenderSettings const& asked, bool lasting)
{
    SlhbSettings const& s = asked.slhb;
    if (asked.bounces == 0 || s.exact.any() || asked.space == Space::device) return RadianceCaching::off;
    if (s.cache != RadianceCaching::automatic) return s.cache;
    if (asked.budget_s > 0 && !(asked.until_relmse > 0)) return RadianceCaching::on;
    return lasting ? RadianceCaching::automatic : RadianceCaching::off;
}

/// Chooses the interleaving if the first pass would exceed the budget: first surfaces and direct light for all
/// pixels, indirect light for as many as time allows. @param axes  built per pass and bounce
int choose_interleave(RenderSettings const& asked, SlhbSettings const& s, int axes, Costs const& costs)
{
    if (!(asked.budget_s > 0) || asked.bounces == 0) return 1;
    bool const rays = s.look_ups == LookUps::none, shadow_rays = s.shadows == Shadows::rays;
    // Surfaces after the first one: many paths end by roulette, or most of them in the cache.
    double const pixels = double(asked.width) * asked.height, bounces = std::min(asked.bounces, 3),
                 after = s.cache == RadianceCaching::on ? 1.3
                         : s.roulette > 0               ? std::min(bounces, 1.5)
                                                        : bounces;
    double const shadow = shadow_rays ? costs.shadow_ray : 0;
    double const fixed = (rays ? 0 : bounces * axes * costs.axis(s.resolution)) +
                         (shadow_rays ? 0 : s.fresh_light_samples * costs.map(s.shadow_resolution)) +
                         pixels * (costs.direct + shadow),
                 indirect = pixels * after * (costs.bounce + (rays ? costs.ray : 0) + shadow);
    for (int const n : {1, 2, 4})
        if ((fixed + indirect / (n * n)) / cores_of(asked) < asked.budget_s) return n;
    return 4;
}

SlhbSettings with_rays(RenderSettings const& asked, SlhbSettings s, World const& world, TriangleSoup const& soup,
                       Camera const& camera, Costs const& costs, bool lasting)
{
    RayPlan const plan = plan_rays(asked, s.resolution, world, soup, camera, costs, lasting);
    s.look_ups = plan.look_ups;
    // With a budget, paths of low throughput are worth less, as ending them leaves time for more paths.
    constexpr float kRoulette = 2, kRouletteToCells = 3; // measured: docs/decisions/path-tracer.md
    constexpr double kFewPasses = 1.4;
    bool const by_time =
        lasting || asked.until_relmse > 0 || (asked.budget_s > 0 && expected_passes(asked, costs) >= kFewPasses);
    s.cache = choose_cache(asked, lasting);
    if (s.roulette < 0) s.roulette = !by_time ? 0 : s.cache == RadianceCaching::on ? kRouletteToCells : kRoulette;
    s.shadows = plan.shadows;
    if (s.interleave == 0)
        s.interleave =
            choose_interleave(asked, s, lasting && s.schedule == Schedule::stored ? 0 : s.fresh_axes, costs);
    return s;
}

} // namespace

SlhbSettings choose_settings(RenderSettings const& asked, World const& world, TriangleSoup const& soup,
                             Camera const& camera)
{
    Costs const costs(world, layers_per_texel(world, soup));
    return with_rays(asked, choose_look_ups(asked, world, costs), world, soup, camera, costs, false);
}

SlhbSettings choose_frame_settings(RenderSettings const& asked, World const& world, TriangleSoup const& soup,
                                   Camera const& camera)
{
    Costs const costs(world, layers_per_texel(world, soup));
    RenderSettings lasting = asked;
    lasting.budget_s = 0;
    SlhbSettings& wanted = lasting.slhb;
    bool const moves = world.static_triangles < world.triangles.size();
    // Many axes for every frame; each frame only pays for dynamic geometry.
    if (moves && wanted.schedule == Schedule::automatic && wanted.axes == 0 && wanted.fresh_axes == 0)
        wanted.schedule = Schedule::stored;
    SlhbSettings s = choose_look_ups(lasting, world, costs);
    // Each pass replaces only a few light points, and has at least as many as a window of the discontinuity
    // filter has pixels.
    constexpr int kLightSamples = 16, kPasses = 4; // passes that replace as many light points as choose_settings
                                                   // uses in one
    int const fresh = asked.slhb.fresh_light_samples > 0 ? asked.slhb.fresh_light_samples
                                                         : std::max(1, s.light_samples / kPasses);
    if (asked.slhb.light_samples == 0) s.light_samples = std::max(s.light_samples, kLightSamples);
    s.fresh_light_samples = std::min(fresh, s.light_samples);
    return with_rays(asked, s, world, soup, camera, costs, true);
}

std::string as_options(RenderSettings const& chosen)
{
    RenderSettings all = chosen;
    SlhbSettings& s = all.slhb;
    if (s.look_ups == LookUps::automatic) s.look_ups = LookUps::all;
    if (s.shadows == Shadows::automatic) s.shadows = Shadows::maps;
    std::vector<std::string_view> names{"schedule", "hit-buffer", "light-samples", "shadow-map", "interleave"};
    names.push_back(s.schedule == Schedule::stored ? "directions" : "axes");
    if (s.schedule == Schedule::temporal) names.push_back("fresh-axes");
    if (s.fresh_light_samples < s.light_samples) names.push_back("fresh-light-samples");
    if (s.most_layers > 0) names.push_back("max-layers");
    names.insert(names.end(), {"look-ups", "shadows", "roulette"});
    if (s.cache != RadianceCaching::automatic) names.push_back("radiance-cache");
    if (s.cone > 0) names.push_back("cone");
    names.insert(names.end(), {"packed", "gather"});
    std::string const own = as_options(slhb_options(), all, names);
    return chosen.space == Space::device ? own + " " + as_options(common_options(), all, {"device"}) : own;
}

std::vector<PlanItem> explain_settings(World const& world, RenderSettings const& asked, Camera const& camera)
{
    TriangleSoup const soup = make_soup(world);
    Costs const costs(world, layers_per_texel(world, soup));
    SlhbSettings const s = choose_look_ups(asked, world, costs);
    RayPlan const plan = plan_rays(asked, s.resolution, world, soup, camera, costs, false);
    std::vector<PlanItem> items;
    bool const walks = plan.look_ups == LookUps::all;
    items.push_back({"look_ups", "look-ups in hit buffers", walks, plan.why_look_ups});
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
        items.push_back({"hit_buffers",
                         {"hit buffers of {} x {} texels",
                          {figure("width_px", s.resolution), figure("height_px", s.resolution)}},
                         true,
                         {"{} layers per texel, texels of {} m",
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
                     asked.slhb.cache != RadianceCaching::automatic ? "requested"
                     : cached ? "there is a budget; it trades noise for a little blur"
                              : "it would leave a small error even in long renders; --radiance-cache on"});
    bool const lit = !world.light_select.empty(), rays = plan.shadows == Shadows::rays;
    items.push_back({rays ? "shadow_rays" : "shadow_maps",
                     rays ? "shadow rays"
                          : PlanText("{} shadow maps of {} x {}",
                                     {figure("maps", s.light_samples), figure("width_px", s.shadow_resolution),
                                      figure("height_px", s.shadow_resolution)}),
                     lit, lit ? plan.why_shadows : "there are no lights"});
    bool const narrow = narrow_somewhere(world);
    items.push_back({"exact_rays", "exact rays (Embree)", !walks || rays || narrow || camera.orthographic,
                     !walks                ? "in place of look-ups"
                     : rays                ? "for shadows"
                     : camera.orthographic ? "the camera is orthographic"
                     : narrow              ? "mirrors, glass or narrow lobes need more directions than the axes"
                                           : "every lobe is broad"});
    return items;
}

} // namespace gi
