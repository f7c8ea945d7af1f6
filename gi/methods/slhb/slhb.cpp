#include "gi/methods/slhb/slhb.h"

#include "gi/kernel/device.h"
#include "gi/methods/slhb/kernels/kernel_render.h"
#include "gi/methods/slhb/renderer.h"
#include "gi/methods/slhb/settings.h"
#include "gi/render/fingerprint.h"
#include "gi/render/pass_loop.h"

#include <optional>
#include <tbb/global_control.h>

namespace gi {

RenderResult render_slhb(World const& world, Camera const& camera, RenderSettings const& settings,
                         StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    if (settings.space == Space::device) {
        check_device(Space::device);
        return render_by_kernels(Space::device, world, camera, settings, stop, progress, report);
    }
    std::optional<tbb::global_control> limit; // also limits the building of structures before the passes
    if (settings.threads > 0)
        limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(settings.threads));
    PassLoop loop(settings, stop, progress, report);
    TriangleSoup soup = make_soup(world);
    RenderSettings chosen = settings;
    chosen.slhb = choose_settings(settings, world, soup, camera);
    FrameView const eye{camera, settings.width, settings.height};
    SlhbRenderer renderer(
        world, {&eye, 1}, chosen, std::move(soup), world.triangles.size(), report,
        chosen.slhb.look_ups == LookUps::none ? FirstSurfaces::by_rays : FirstSurfaces::by_raster, &stop);
    std::uint64_t const print = loop.keeps_state() ? fingerprint(world, camera, chosen, "slhb") : 0;
    VertexSharing const sharing =
        chosen.slhb.cache == RadianceCaching::on ? VertexSharing::cached : VertexSharing::exact;
    RenderResult result = loop.run(print, [&](Accumulator& sums, std::uint32_t paths) {
        for (std::uint32_t i = 0; i < paths && !(i > 0 && stop.requested()); ++i)
            renderer.pass(loop.first_path() + sums.paths, {&sums, 1}, sharing, &stop);
    });
    renderer.report_work();
    report.lose("layers beyond the limit of a texel", renderer.lost_layers());
    report.lose("radiance samples for which the radiance cache had no room", renderer.refused_notes());
    result.rays = renderer.rays();
    result.options = as_options(chosen);
    loop.deliver(world, result);
    return result;
}

} // namespace gi
