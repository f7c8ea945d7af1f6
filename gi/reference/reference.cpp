#include "gi/reference/reference.h"

#include "gi/reference/path_tracer.h"
#include "gi/scene/plan.h"
#include "gi/transport/fingerprint.h"
#include "gi/transport/flush_denormals.h"
#include "gi/transport/pass_loop.h"

#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

void trace_pass(PathTracer<ExactVisibility> const& tracer, Accumulator& sums, std::uint32_t paths)
{
    tbb::combinable<PathCounts> counts;
    int const columns = (sums.width + kTile - 1) / kTile, rows = (sums.height + kTile - 1) / kTile;
    tbb::parallel_for(0, columns * rows, [&](int tile) {
        FlushDenormals const guard;
        PathCounts& local = counts.local();
        int const left = tile % columns * kTile, right = std::min(left + kTile, sums.width);
        int const top = tile / columns * kTile, bottom = std::min(top + kTile, sums.height);
        std::vector<Path> batch;
        for (std::uint32_t i = 0; i < paths; ++i) {
            batch.clear();
            for (int y = top; y < bottom; ++y)
                for (int x = left; x < right; ++x) batch.push_back(tracer.start(x, y, sums.paths + i));
            tracer.trace(batch, local);
            auto next = batch.begin();
            for (int y = top; y < bottom; ++y)
                for (int x = left; x < right; ++x)
                    sums.pixels[std::size_t(y) * std::size_t(sums.width) + std::size_t(x)].add((next++)->sample);
        }
    });
    sums.paths += paths;
    sums.counts += counts.combine([](PathCounts a, PathCounts const& b) { return a += b; });
}

} // namespace

RenderResult render_reference(World const& world, Camera const& camera, RenderSettings const& settings,
                              StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    PassLoop loop(settings, stop, progress, report);
    ScenePlan const plan = plan_scene(world);
    std::unique_ptr<ExactVisibility> visibility;
    {
        StageTimer const timer(report, "build (Embree BVH)");
        visibility = std::make_unique<ExactVisibility>(world, plan.alpha_tests, settings.threads);
    }
    PathTracer<ExactVisibility> const tracer{
        view(world),      *visibility,   camera_rays(camera, settings.width, settings.height, world.origin),
        settings.bounces, settings.seed, settings.filter,
        settings.width};
    std::uint64_t const print = loop.keeps_state() ? fingerprint(world, camera, settings, "reference") : 0;
    RenderResult result =
        loop.run(print, [&](Accumulator& sums, std::uint32_t paths) { trace_pass(tracer, sums, paths); });
    PathCounts const& total = loop.sums().counts;
    report.count("closest-hit rays", double(total.nearest_rays));
    report.count("shadow rays", double(total.shadow_rays));
    result.rays = double(total.nearest_rays + total.shadow_rays);
    result.picture = loop.sums().picture(world);
    return result;
}

} // namespace gi
