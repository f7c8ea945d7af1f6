#include "gi/methods/paths/paths.h"

#include "gi/kernel/device.h"
#include "gi/light_paths/lamp_caustics.h"
#include "gi/methods/paths/frames_of.h"
#include "gi/methods/paths/kernels/kernel_frames.h"
#include "gi/methods/paths/kernels/kernel_render.h"
#include "gi/methods/paths/kernels/kernel_renderer.h"
#include "gi/methods/paths/look_up_trust.h"
#include "gi/render/fingerprint.h"

#include <fmt/format.h>

namespace gi {

RenderResult render_by(char const* name, World const& world, Camera const& camera, RenderSettings const& settings,
                       StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    std::optional<tbb::global_control> limit; // also limits the building of structures before the passes
    if (settings.threads > 0)
        limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(settings.threads));
    PassLoop loop(settings, stop, progress, report, settings.of<SpentBeforehand>().seconds);
    TriangleSoup soup = make_soup(world);
    RenderSettings const chosen = choose_settings(settings, world, soup);
    std::string options = as_options(chosen);
    if (std::string const more = lamp_caustic_options(world, settings); !more.empty()) options += " " + more;
    SurfacesBy const surfaces = chosen.of<PathAlgorithm>().surfaces;
    bool const looks_up = surfaces == SurfacesBy::look_ups && !camera.orthographic;
    FrameView const eye{camera, settings.width, settings.height};
    PathsRenderer renderer(world, {&eye, 1}, chosen, std::move(soup), world.triangles.size(), report,
                           surfaces == SurfacesBy::rays ? FirstSurfaces::by_rays : FirstSurfaces::by_raster,
                           &stop);
    options += renderer.level_option();
    renderer.find_lamp_caustics();
    renderer.control_bias();
    std::uint64_t const print =
        loop.keeps_state() ? fingerprint(world, camera, chosen, name, options + lamp_light_version(world)) : 0;
    bool const cached = chosen.of<PathsSettings>().cache == RadianceCaching::on;
    RenderResult result = loop.run(print, [&](Accumulator& sums, std::uint32_t paths) {
        for (std::uint32_t i = 0; i < paths && !(i > 0 && stop.requested()); ++i)
            renderer.pass(loop.first_path() + sums.paths, {&sums, 1},
                          cached ? VertexSharing::cached : VertexSharing::exact,
                          PassStop(&stop, PassStop::of(sums.paths)));
    });
    renderer.report_work();
    report.lose("layers beyond the limit of a texel", renderer.lost_layers());
    report.lose("radiance samples for which the radiance cache had no room", renderer.refused_notes());
    result.look_up_bias = renderer.look_up_bias();
    report_bias(result.look_up_bias, report);
    if (!result.look_up_bias && looks_up)
        report_untrusted_look_ups(world, renderer.soup(),
                                  camera_rays(camera, settings.width, settings.height, world.origin),
                                  chosen.of<SlhbSettings>(), report);
    result.rays = renderer.rays();
    result.options = options;
    loop.deliver(world, result);
    return result;
}

std::unique_ptr<FrameRenderer> start_frames_by(MovingWorld const& world, Camera const& camera,
                                               RenderSettings const& settings, Report& report)
{
    return std::make_unique<PathsFrames<PathsRenderer>>(world, camera, settings, report);
}

RenderResult render_paths(World const& world, Camera const& camera, RenderSettings const& settings,
                          StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    if (settings.space == Space::device) {
        check_device(Space::device);
        lose_lamp_caustics(world, report);
        return render_paths_by_kernels(Space::device, world, camera, settings, stop, progress, report);
    }
    return render_by("paths", world, camera, with(PathAlgorithm{}, settings), stop, progress, report);
}

std::unique_ptr<FrameRenderer> start_path_frames(MovingWorld const& world, Camera const& camera,
                                                 RenderSettings const& settings, Report& report)
{
    if (settings.space == Space::device) {
        check_device(Space::device);
        return start_path_kernel_frames(Space::device, world, camera, settings, report);
    }
    return start_frames_by(world, camera, with(PathAlgorithm{}, settings), report);
}

RenderResult render_screen_lhb(World const& world, Camera const& camera, RenderSettings const& settings,
                               StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    return render_by("screen_lhb", world, camera, with(kScreenLhb, settings), stop, progress, report);
}

void check_screen_lhb_options(std::vector<std::string> const&, RenderSettings const& settings)
{
    constexpr int kMostTexels = 2048;
    if (int const n = settings.of<SlhbSettings>().resolution; n > kMostTexels)
        throw InputError(fmt::format("--hit-buffer {} with --method screen_lhb", n),
                         "its layers are drawn anew in every pass, and walked through by every ray",
                         fmt::format("give at most {}", kMostTexels));
    if (settings.of<PathsSettings>().cache == RadianceCaching::on)
        throw InputError("--radiance-cache on with --method screen_lhb",
                         "its light depends on the view, cells do not", "leave it out");
}

std::unique_ptr<FrameRenderer> start_screen_lhb_frames(MovingWorld const& world, Camera const& camera,
                                                       RenderSettings const& settings, Report& report)
{
    return start_frames_by(world, camera, with(kScreenLhb, settings), report);
}

namespace {

/// Gathered pixels have no indirect light of their own that could be left to neighbours.
RenderSettings with_layered_lens(RenderSettings settings)
{
    settings.of<PathsSettings>().interleave = 1;
    return with(kPathsLayeredLens, std::move(settings));
}

} // namespace

RenderResult render_layered_lens(World const& world, Camera const& camera, RenderSettings const& settings,
                                 StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    return render_by("paths_layered_lens", world, camera, with_layered_lens(settings), stop, progress, report);
}

std::unique_ptr<FrameRenderer> start_layered_lens_frames(MovingWorld const& world, Camera const& camera,
                                                         RenderSettings const& settings, Report& report)
{
    return start_frames_by(world, camera, with_layered_lens(settings), report);
}

void check_layered_lens_options(std::vector<std::string> const&, RenderSettings const& settings)
{
    if (int const n = settings.of<PathsSettings>().interleave; n > 1)
        throw InputError(fmt::format("--interleave {} with --method paths_layered_lens", n),
                         "pixels gather light of surfaces, they have no paths of their own", "leave it out");
}

RenderSettings paths_for_display(RenderSettings settings)
{
    settings.of<PathsSettings>().cache = RadianceCaching::automatic; // LiveSettings says for every frame
    settings.of<PathsSettings>().interleave = 1;
    return settings;
}

ExposurePlan paths_exposure(World const& world, RenderSettings const& asked, Camera const&, Triangles)
{
    if (!(asked.budget_s > 0)) return {"paths", asked};
    ExposurePlan plan{"paths", choose_settings(with(PathAlgorithm{}, asked), world, make_soup(world))};
    if (asked.space == Space::device) KernelRenderer<Space::device>::limit(plan.settings);
    return plan;
}

} // namespace gi
