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

void trace_pass(PathTracer<ExactVisibility> const& tracer, Accumulator& sums, std::uint32_t first_path,
                std::uint32_t paths)
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
                for (int x = left; x < right; ++x)
                    batch.push_back(tracer.start(x, y, first_path + sums.paths + i));
            tracer.trace(batch, local);
            auto next = batch.begin();
            for (int y = top; y < bottom; ++y)
                for (int x = left; x < right; ++x)
                    sums.add(std::size_t(y) * std::size_t(sums.width) + std::size_t(x), (next++)->sample,
                             sums.paths + i);
        }
    });
    sums.paths += paths;
    sums.counts += counts.combine([](PathCounts a, PathCounts const& b) { return a += b; });
}

/// Rays through a world as it is.
struct Structures {
    std::unique_ptr<ExactVisibility> visibility;

    /// @param first_moving  triangle
    void build(World const& world, int threads, Report& report, std::size_t first_moving)
    {
        StageTimer const timer(report, "build (Embree BVH)");
        visibility =
            std::make_unique<ExactVisibility>(world, plan_scene(world).alpha_tests, threads, first_moving);
    }
    PathTracer<ExactVisibility> tracer(World const& world, Camera const& camera, RenderSettings const& s) const
    {
        return {view(world), *visibility, camera_rays(camera, s.width, s.height, world.origin), s.bounces, s.seed,
                s.filter,    s.width};
    }
};

/// @param print  of the scene and settings
RenderResult trace_all(PassLoop& loop, std::uint64_t print, PassLoop::Pass const& pass, World const& world,
                       Report& report)
{
    RenderResult result = loop.run(print, pass);
    PathCounts const& total = loop.sums().counts;
    report.count("closest-hit rays", double(total.nearest_rays));
    report.count("shadow rays", double(total.shadow_rays));
    result.rays = double(total.nearest_rays + total.shadow_rays);
    result.picture = loop.sums().picture(world);
    return result;
}

class ReferenceFrames : public FrameRenderer {
public:
    ReferenceFrames(MovingWorld const& world, RenderSettings const& settings, Report& report)
        : world_(world), settings_(settings), report_(report)
    {
    }
    void changed(Changes const& changes) override
    {
        if (changes.materials || changes.coverage) structures_.visibility.reset();
        if (!changes.geometry || !structures_.visibility) return;
        StageTimer const timer(report_, "BVH of what moves (Embree)");
        structures_.visibility->moved(world_.world());
    }
    RenderResult frame(Camera const& camera, StopRequest const& stop, RenderProgress const& progress,
                       Moments const& moments) override
    {
        PassLoop loop(settings_, stop, progress, report_);
        auto const pass = [&](Accumulator& sums, std::uint32_t paths) {
            if (!moments) return trace_pass(tracer(camera), sums, paths_, paths);
            for (std::uint32_t i = 0; i < paths; ++i) {
                Moment const now = moments(sums.paths);
                changed(now.changes);
                trace_pass(tracer(now.camera), sums, paths_, 1);
            }
        };
        tracer(camera); // builds before the passes
        RenderResult result = trace_all(loop, 0, pass, world_.world(), report_);
        paths_ += result.paths;
        return result;
    }
    std::vector<RenderResult> views(std::span<FrameView const> views, std::uint32_t paths, Endings,
                                    StopRequest const& stop) override
    {
        RenderProgress const silent;
        std::vector<RenderResult> results;
        for (FrameView const& v : views) {
            RenderSettings settings = settings_;
            settings.width = v.width;
            settings.height = v.height;
            settings.paths = paths;
            settings.budget_s = settings.until_relmse = 0;
            PassLoop loop(settings, stop, silent, report_);
            PathTracer<ExactVisibility> const through = tracer(v.camera, settings);
            results.push_back(trace_all(
                loop, 0, [&](Accumulator& sums, std::uint32_t n) { trace_pass(through, sums, paths_, n); },
                world_.world(), report_));
            hide_pixels(results.back().picture, v.hidden);
        }
        paths_ += paths;
        return results;
    }

private:
    /// Through the world as it is now.
    PathTracer<ExactVisibility> tracer(Camera const& camera) { return tracer(camera, settings_); }
    PathTracer<ExactVisibility> tracer(Camera const& camera, RenderSettings const& settings)
    {
        World const& world = world_.world();
        if (!structures_.visibility) structures_.build(world, settings_.threads, report_, world.static_triangles);
        return structures_.tracer(world, camera, settings);
    }

    MovingWorld const& world_;
    RenderSettings settings_;
    Report& report_;
    Structures structures_;
    std::uint32_t paths_ = 0; ///< so far, of all frames
};

} // namespace

RenderResult render_reference(World const& world, Camera const& camera, RenderSettings const& settings,
                              StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    PassLoop loop(settings, stop, progress, report);
    Structures structures;
    structures.build(world, settings.threads, report, world.triangles.size());
    std::uint64_t const print = loop.keeps_state() ? fingerprint(world, camera, settings, "reference") : 0;
    PathTracer<ExactVisibility> const tracer = structures.tracer(world, camera, settings);
    auto const pass = [&](Accumulator& sums, std::uint32_t paths) {
        trace_pass(tracer, sums, loop.first_path(), paths);
    };
    return trace_all(loop, print, pass, world, report);
}

std::unique_ptr<FrameRenderer> start_reference_frames(MovingWorld const& world, Camera const&,
                                                      RenderSettings const& settings, Report& report)
{
    return std::make_unique<ReferenceFrames>(world, settings, report);
}

} // namespace gi
