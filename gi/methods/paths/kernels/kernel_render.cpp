#include "gi/methods/paths/kernels/kernel_render.h"

#include "gi/methods/paths/choose.h"
#include "gi/methods/paths/kernels/kernel_renderer.h"
#include "gi/methods/paths/look_up_trust.h"
#include "gi/render/fingerprint.h"
#include "gi/render/pass_loop.h"

namespace gi {
namespace {

/// @param name  for checkpoints
template <Space S>
RenderResult render(char const* name, World const& world, Camera const& camera, RenderSettings const& settings,
                    StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    PassLoop loop(settings, stop, progress, report);
    TriangleSoup soup = make_soup(world);
    RenderSettings chosen = choose_settings(settings, world, soup);
    KernelRenderer<S>::limit(chosen);
    bool const free = chosen.of<PathAlgorithm>().surfaces == SurfacesBy::rays;
    if (!free)
        report_untrusted_look_ups(world, soup, camera_rays(camera, settings.width, settings.height, world.origin),
                                  chosen.of<SlhbSettings>(), report);
    FrameView const eye{camera, settings.width, settings.height};
    KernelRenderer<S> renderer(world, {&eye, 1}, chosen, std::move(soup), world.triangles.size(), report,
                               free ? FirstSurfaces::by_rays : FirstSurfaces::by_raster);
    std::string const options = as_options(chosen) + renderer.level_option();
    std::uint64_t const print = loop.keeps_state() ? fingerprint(world, camera, chosen, name, options) : 0;
    bool const cached = chosen.of<PathsSettings>().cache == RadianceCaching::on;
    RenderResult result = loop.run(print, [&](Accumulator& sums, std::uint32_t paths) {
        renderer.passes(loop.next_path(), paths, {&sums, 1}, cached ? VertexSharing::cached : VertexSharing::none,
                        &stop);
    });
    renderer.report_work();
    report.lose("layers beyond the limit of a texel", renderer.lost_layers());
    report.lose("radiance samples for which the radiance cache had no room", renderer.refused_notes());
    result.rays = renderer.rays();
    result.options = options;
    loop.deliver(world, result);
    return result;
}

RenderResult render_in(Space space, char const* name, World const& world, Camera const& camera,
                       RenderSettings const& settings, StopRequest const& stop, RenderProgress const& progress,
                       Report& report)
{
    KernelRenderer<Space::host>::check(camera, settings);
    auto const& run = space == Space::host ? render<Space::host> : render<Space::device>;
    return run(name, world, camera, settings, stop, progress, report);
}

} // namespace

RenderResult render_by_kernels(Space space, World const& world, Camera const& camera,
                               RenderSettings const& settings, StopRequest const& stop,
                               RenderProgress const& progress, Report& report)
{
    return render_in(space, "slhb by kernels", world, camera, with(kSlhb, settings), stop, progress, report);
}

RenderResult render_paths_by_kernels(Space space, World const& world, Camera const& camera,
                                     RenderSettings const& settings, StopRequest const& stop,
                                     RenderProgress const& progress, Report& report)
{
    return render_in(space, "paths by kernels", world, camera, with(PathAlgorithm{}, settings), stop, progress,
                     report);
}

} // namespace gi
