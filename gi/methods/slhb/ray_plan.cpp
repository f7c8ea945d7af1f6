#include "gi/methods/slhb/ray_plan.h"

#include "gi/methods/slhb/hit_buffer/look_up_trust.h"
#include "gi/scene/shading/narrow_lobes.h"

#include <fmt/format.h>
#include <tbb/task_arena.h>

namespace gi {
namespace {

/// Fraction of a pilot's look-ups that must be right, as far as columns show.
constexpr double kTrusted = 0.87;
/// Largest fraction of the budget that building a BVH may take.
constexpr double kMostForBvh = 0.8;

bool says_maps(RenderSettings const& asked)
{
    SlhbSettings const& s = asked.slhb;
    return s.light_samples > 0 || s.fresh_light_samples > 0 || s.shadow_resolution > 0 || s.exact.any() ||
           asked.space == Space::device;
}

/// Seconds of one core that a picture may take; 0 = unlimited.
double budget_of(RenderSettings const& s)
{
    return s.budget_s * (s.threads > 0 ? s.threads : tbb::this_task_arena::max_concurrency());
}

} // namespace

double expected_passes(RenderSettings const& asked, Costs const& c)
{
    double const most = double(asked.paths);
    if (!(asked.budget_s > 0)) return most;
    double const pixels = double(asked.width) * asked.height;
    double const bounces = std::min(double(asked.bounces), 1.5), surfaces = 1 + bounces; // after roulette
    double const path = c.direct + bounces * (c.bounce + c.ray) + surfaces * c.shadow_ray;
    return std::clamp((budget_of(asked) - c.bvh) / (pixels * path), 1.0, most);
}

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
        // A roughness map can reduce any roughness.
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

RayPlan plan_rays(RenderSettings const& asked, int resolution, World const& world, TriangleSoup const& soup,
                  Camera const& camera, Costs const& costs, bool lasting)
{
    RayPlan plan;
    SlhbSettings const& s = asked.slhb;
    bool const no_time = !lasting && asked.budget_s > 0 && costs.bvh > kMostForBvh * budget_of(asked);
    if (s.look_ups != LookUps::automatic || asked.has_look_up_options()) {
        plan.look_ups = s.look_ups != LookUps::automatic ? s.look_ups : LookUps::all;
        plan.why_look_ups = "requested";
    } else if (!no_time || camera.orthographic) {
        plan.why_look_ups = "pixels would share their error, which no filter removes; --look-ups all";
    } else {
        double const trusted = look_up_agreement(
            world, soup, camera_rays(camera, asked.width, asked.height, world.origin), std::uint32_t(resolution));
        plan.look_ups = trusted < kTrusted ? LookUps::none : LookUps::all;
        plan.why_look_ups = {"a BVH takes about {} s of one core, and {} % of look-ups can be trusted",
                             {figure("bvh_s", costs.bvh, 2),
                              Figure{{"trusted_percent", 100 * trusted}, fmt::format("{:.0f}", 100 * trusted)}}};
    }
    bool const bvh = narrow_somewhere(world) || plan.look_ups == LookUps::none;
    if (s.shadows != Shadows::automatic) {
        plan.shadows = s.shadows;
        plan.why_shadows = "requested";
    } else if (says_maps(asked) || asked.has_look_up_options() || !bvh) {
        plan.shadows = Shadows::maps;
        plan.why_shadows = bvh ? "requested" : "there is no BVH";
    } else {
        plan.why_shadows = "each path has its own light samples, so that pixels share no error";
    }
    return plan;
}

} // namespace gi
