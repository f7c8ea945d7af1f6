#include "gi/slhb/ray_plan.h"

#include "gi/slhb/directions.h"
#include "gi/slhb/look_up_trust.h"
#include "gi/slhb/narrow_lobes.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

namespace gi {
namespace {

/// Of look-ups of a pilot, how many have to agree with those beside them.
constexpr double kTrusted = 0.87;
/// A BVH for shadow rays alone is worth that share of the budget.
constexpr double kShareForShadows = 0.2;
constexpr double kMostPasses = 4096;

bool says_look_ups(SlhbSettings const& s)
{
    return s.schedule != Schedule::automatic || !s.directions.empty() || s.resolution > 0 || s.axes > 0 ||
           s.fresh_axes > 0 || s.most_layers > 0 || s.packed || s.cone > 0 || s.gather || s.exact.any() ||
           s.space == Space::device;
}

bool says_maps(SlhbSettings const& s)
{
    return s.lamps > 0 || s.fresh_lamps > 0 || s.shadow_resolution > 0 || s.exact.any() ||
           s.space == Space::device;
}

/// s of one core that a picture may take; 0 = any.
double budget_of(RenderSettings const& s)
{
    return s.budget_s * (s.threads > 0 ? s.threads : tbb::this_task_arena::max_concurrency());
}

/// What differs between a picture with look-ups and one with exact rays, s.
struct Totals {
    double look_ups, rays;
};

Totals totals(RenderSettings const& asked, SlhbSettings const& s, Costs const& c, bool narrow, bool lasting)
{
    double const pixels = double(asked.width) * asked.height;
    // Of a path, after roulette.
    double const bounces = std::min(double(asked.bounces), 1.5), surfaces = 1 + bounces;
    double const by_ray = bounces * c.ray + surfaces * c.shadow_ray, by_look_up = (bounces + surfaces) * c.look_up;
    double passes = std::min(kMostPasses, double(asked.paths));
    if (asked.budget_s > 0)
        passes = std::clamp(budget_of(asked) / (pixels * (c.direct + bounces * c.bounce + by_ray)), 1.0, passes);
    double const sequences = std::min(asked.bounces + 1, 3), axis = c.axis(s.resolution),
                 map = c.map(s.shadow_resolution);
    Totals t{passes * (pixels * by_look_up + s.fresh_lamps * map), passes * pixels * by_ray};
    if (s.schedule == Schedule::stored)
        t.look_ups += lasting ? 0 : axis * double(make_directions(s.directions).axes.size());
    else
        t.look_ups += passes * sequences * s.fresh_axes * axis;
    if (!lasting) {
        t.rays += c.bvh;
        if (narrow) t.look_ups += c.bvh;
    }
    return t;
}

} // namespace

bool narrow_somewhere(World const& world)
{
    std::vector<bool> used(world.materials.size(), false);
    for (std::uint32_t const m : world.triangle_material) used[m] = true;
    for (std::size_t m = 0; m < used.size(); ++m) {
        if (!used[m]) continue;
        Material const& material = world.materials[m];
        if (has_narrow_lobe(world.bsdfs[m])) return true;
        bool const textured = material.metallic_roughness_map.texture >= 0 ||
                              material.transmission_map.texture >= 0 || material.specular_map.texture >= 0;
        // A roughness map can make any roughness smaller.
        if (textured && (material.specular > 0 || material.metallic > 0 || material.transmission > 0)) return true;
    }
    return false;
}

bool smooth_somewhere(World const& world)
{
    for (std::size_t k = 0; k < world.materials.size(); ++k) {
        Material const& m = world.materials[k];
        Bsdf const& b = world.bsdfs[k];
        bool const mirror = b.model == MaterialModel::metal_rough && b.f90.x > 0 &&
                            (b.alpha < kSmoothAlpha || m.metallic_roughness_map.texture >= 0);
        if (mirror || b.clear > 0 || (m.transmission_map.texture >= 0 && m.transmission > 0)) return true;
    }
    return false;
}

RayPlan plan_rays(RenderSettings const& asked, SlhbSettings const& chosen, World const& world,
                  TriangleSoup const& soup, Camera const& camera, Costs const& costs, bool lasting)
{
    RayPlan plan;
    bool const narrow = narrow_somewhere(world);
    bool const free = asked.slhb.look_ups == LookUps::automatic;
    if (!free || says_look_ups(asked.slhb)) {
        plan.look_ups = free ? LookUps::all : asked.slhb.look_ups;
        plan.why_look_ups = "asked for";
    } else if (camera.orthographic) {
        plan.look_ups = LookUps::none;
        plan.why_look_ups = "the camera is orthographic, and needs exact rays anyway";
    } else {
        Totals const t = totals(asked, chosen, costs, narrow, lasting);
        plan.look_ups = t.look_ups < t.rays ? LookUps::all : LookUps::none;
        plan.why_look_ups =
            fmt::format("{:.2g} s of one core by look-ups, {:.2g} s by exact rays", t.look_ups, t.rays);
        if (plan.look_ups == LookUps::all) {
            double const agreement =
                look_up_agreement(world, soup, camera_rays(camera, asked.width, asked.height, world.origin),
                                  std::uint32_t(chosen.resolution));
            if (agreement < kTrusted) plan.look_ups = LookUps::none;
            plan.why_look_ups +=
                fmt::format("; {:.0f} % of look-ups agree with those beside them (at least {:.0f} % "
                            "are asked for): texels of {:.2g} m",
                            100 * agreement, 100 * kTrusted, 2 * world.bounds.radius() / chosen.resolution);
        }
    }
    bool const bvh = narrow || camera.orthographic || plan.look_ups == LookUps::none;
    if (asked.slhb.shadows != Shadows::automatic || says_maps(asked.slhb)) {
        plan.shadows = asked.slhb.shadows != Shadows::automatic ? asked.slhb.shadows : Shadows::maps;
        plan.why_shadows = "asked for";
    } else if (plan.look_ups == LookUps::all && says_look_ups(asked.slhb)) {
        plan.why_shadows = "as look-ups are asked for";
    } else if (bvh) {
        plan.shadows = Shadows::rays;
        plan.why_shadows =
            "a BVH is there, and rays to light samples of each path's own leave no error that pixels "
            "share";
    } else {
        double const budget = budget_of(asked);
        bool const worth = lasting || budget == 0 || costs.bvh < kShareForShadows * budget;
        plan.shadows = worth ? Shadows::rays : Shadows::maps;
        plan.why_shadows = worth ? "a BVH takes little of the time, and pixels share no error then"
                                 : "a BVH would take too much of the budget";
    }
    return plan;
}

} // namespace gi
