#include "gi/methods/automatic/automatic.h"

#include "gi/core/error.h"
#include "gi/methods/paths/look_up_trust.h"
#include "gi/methods/paths/lobes.h"
#include "gi/methods/paths/paths.h"
#include "gi/methods/reference/reference.h"
#include "gi/methods/slhb/slhb.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <fmt/format.h>
#include <tbb/task_arena.h>

namespace gi {
namespace {

/// Largest fraction of the budget that building a BVH may take.
constexpr double kMostForBvh = 0.8;

/// Seconds of one core that a picture may take; 0 = unlimited.
double budget_of(RenderSettings const& s)
{
    return s.budget_s * (s.threads > 0 ? s.threads : tbb::this_task_arena::max_concurrency());
}

struct Candidate {
    std::string_view name;
    RenderFunction render;
    StartFrames frames;
};
constexpr std::array kCandidates{Candidate{"paths", render_paths, start_path_frames},
                                 Candidate{"slhb", render_slhb, start_slhb_frames},
                                 Candidate{SlhbShadowRays::kName, SlhbShadowRays::render, SlhbShadowRays::frames},
                                 Candidate{"reference", render_reference, start_reference_frames}};
Candidate const& find(std::string_view name) { return *std::ranges::find(kCandidates, name, &Candidate::name); }

/// What its paths do, for the method named.
PathAlgorithm algorithm_of(std::string_view name)
{
    return name == "slhb" ? kSlhb : name == SlhbShadowRays::kName ? SlhbShadowRays::kBy : PathAlgorithm{};
}

} // namespace

AlgorithmChoice choose_algorithm(World const& world, RenderSettings const& asked, Camera const& camera,
                                 RenderUse use)
{
    constexpr char const* kRays = "exact rays: of look-ups, pixels would share the error, which no filter removes";
    if (use == RenderUse::frames || !(asked.budget_s > 0) || camera.orthographic) return {{}, kRays};
    double const bvh_s = Costs(world, 1).bvh;
    if (!(bvh_s > kMostForBvh * budget_of(asked))) return {{}, kRays};
    TriangleSoup const soup = make_soup(world);
    RenderSettings const chosen = choose_settings(with({SurfacesBy::look_ups, ShadowsBy::maps}, asked), world, soup);
    double const trusted = look_up_agreement(
        world, soup, camera_rays(camera, asked.width, asked.height, world.origin), chosen.of<SlhbSettings>());
    bool const look_ups = trusted >= kTrustedLookUps, bvh = narrow_somewhere(world);
    PathAlgorithm const by{look_ups ? SurfacesBy::look_ups : SurfacesBy::rays,
                           look_ups && !bvh ? ShadowsBy::maps : ShadowsBy::rays};
    return {by,
            {"a BVH takes about {} s of one core, and {} % of look-ups can be trusted",
             {figure("bvh_s", bvh_s, 2),
              Figure{{"trusted_percent", 100 * trusted}, fmt::format("{:.0f}", 100 * trusted)}}}};
}

MethodChoice choose_method(World const& world, RenderSettings const& asked, Camera const& camera, RenderUse use)
{
    if (asked.space == Space::device)
        return {"reference", "exact rays took half of the time of look-ups on a CUDA device, and are unbiased"};
    AlgorithmChoice const c = choose_algorithm(world, asked, camera, use);
    bool const rays = c.algorithm.surfaces == SurfacesBy::rays, maps = c.algorithm.shadows == ShadowsBy::maps;
    return {rays ? "paths" : maps ? "slhb" : "slhb_shadow_rays", c.why};
}

RenderResult render_auto(World const& world, Camera const& camera, RenderSettings const& settings,
                         StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    auto const begun = std::chrono::steady_clock::now();
    MethodChoice const choice = choose_method(world, settings, camera, RenderUse::picture);
    RenderSettings left = settings;
    left.of<SpentBeforehand>().seconds =
        std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    RenderResult result = find(choice.method).render(world, camera, left, stop, progress, report);
    result.method = choice.method;
    result.why_method = choice.why.text;
    return result;
}

std::unique_ptr<FrameRenderer> start_auto_frames(MovingWorld const& world, Camera const& camera,
                                                 RenderSettings const& settings, Report& report)
{
    MethodChoice const choice = choose_method(world.world(), settings, camera, RenderUse::frames);
    return find(choice.method).frames(world, camera, settings, report);
}

std::vector<PlanItem> explain_auto(World const& world, RenderSettings const& asked, Camera const& camera)
{
    MethodChoice const choice = choose_method(world, asked, camera, RenderUse::picture);
    std::vector<PlanItem> items{{"method", "method " + std::string(choice.method), true, choice.why}};
    if (asked.space == Space::device) return items;
    std::vector<PlanItem> const own = explain_choices(world, with(algorithm_of(choice.method), asked), camera);
    items.insert(items.end(), own.begin(), own.end());
    return items;
}

ExposurePlan auto_exposure(World const& world, RenderSettings const& asked, Camera const& camera, Triangles triangles)
{
    bool const still = triangles == Triangles::still;
    MethodChoice const choice = choose_method(world, asked, camera, still ? RenderUse::picture : RenderUse::frames);
    if (!(asked.budget_s > 0) || asked.space == Space::device) return {choice.method, asked, choice.why};
    return {choice.method, choose_settings(with(algorithm_of(choice.method), asked), world, make_soup(world)),
            choice.why};
}

void check_auto_options(std::vector<std::string> const& given, RenderSettings const& settings)
{
    if (settings.space != Space::device) return;
    for (RenderOption const& o : paths_options())
        if (std::ranges::find(given, o.name) != given.end())
            throw InputError("--" + o.name + " with --method auto --device cuda",
                             "auto chooses reference there, which does not have it",
                             "leave it out, or choose --method slhb or --device cpu");
}

} // namespace gi
