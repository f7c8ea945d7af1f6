#include "gi/methods/reference/reference.h"

#include "gi/methods/reference/path_tracer.h"
#include "gi/render/fingerprint.h"
#include "gi/render/flush_denormals.h"
#include "gi/render/motion.h"
#include "gi/render/pass_loop.h"
#include "gi/scene/model/plan.h"

#include <algorithm>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

double rays_of(PathCounts const& c) { return double(c.nearest_rays + c.shadow_rays); }

/// @param first_hits  one per pixel, set by its last path; empty = not needed
/// @param memory  buffer for interleaved passes, in which pixels take indirect light from those in turn
void trace_pass(PathTracer<ExactVisibility> const& tracer, Accumulator& sums, std::uint32_t first_path,
                std::uint32_t paths, std::span<FirstHit> first_hits = {},
                std::vector<PathSample>* memory = nullptr)
{
    tbb::combinable<PathCounts> counts;
    bool const interleaved = tracer.interleaving.n > 1;
    std::span<PathSample> waiting;
    if (interleaved) {
        memory->resize(sums.pixels.size());
        waiting = *memory;
    }
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
            bool const last = i + 1 == paths && !first_hits.empty();
            for (int y = top; y < bottom; ++y)
                for (int x = left; x < right; ++x, ++next) {
                    std::size_t const pixel = std::size_t(y) * std::size_t(sums.width) + std::size_t(x);
                    if (interleaved)
                        waiting[pixel] = next->sample;
                    else
                        sums.add(pixel, next->sample, sums.paths + i);
                    if (last) first_hits[pixel] = next->first;
                }
        }
    });
    if (interleaved) {
        spread_indirect(waiting, sums.width, tracer.interleaving, first_path + sums.paths);
        tbb::parallel_for(std::size_t(0), waiting.size(),
                          [&](std::size_t p) { sums.add(p, waiting[p], sums.paths); });
    }
    sums.paths += paths;
    sums.counts += counts.combine([](PathCounts a, PathCounts const& b) { return a += b; });
}

/// The BVH of a world, and path tracers that use it.
struct Structures {
    std::unique_ptr<ExactVisibility> visibility;

    /// @param first_moving  index of the first dynamic triangle
    /// @param stop  see ExactVisibility
    void build(World const& world, int threads, Report& report, std::size_t first_moving,
               StopRequest const* stop = nullptr)
    {
        StageTimer const timer(report, "build (Embree BVH)");
        visibility =
            std::make_unique<ExactVisibility>(world, plan_scene(world).alpha_tests, threads, first_moving, stop);
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
    result.rays = rays_of(total);
    result.picture = loop.sums().picture(world);
    return result;
}

class ReferenceFrames : public FrameRenderer {
public:
    ReferenceFrames(MovingWorld const& world, RenderSettings const& settings, Report& report)
        : world_(world),
          settings_(settings),
          report_(report),
          interleaving_(settings.budget_s > 0 ? kMostInterleaving : 1, settings.budget_s),
          motion_(world.world())
    {
    }
    void changed(Changes const& changes) override
    {
        motion_.changed(changes);
        if (changes.materials || changes.coverage) structures_.visibility.reset();
        if (!changes.geometry || !structures_.visibility) return;
        StageTimer const timer(report_, "BVH of dynamic triangles (Embree)");
        structures_.visibility->moved(world_.world());
    }
    RenderResult frame(Camera const& camera, StopRequest const& stop, RenderProgress const& progress,
                       Moments const& moments) override
    {
        interleaving_.frame_begins();
        PassLoop loop(settings_, stop, progress, report_);
        FrameView const whole{camera, settings_.width, settings_.height};
        motion_.see({&whole, 1});
        auto const pass = [&](Accumulator& sums, std::uint32_t paths) {
            if (!moments) return trace_frame(camera, sums, paths);
            for (std::uint32_t i = 0; i < paths; ++i) {
                Moment const now = moments(sums.paths);
                changed(now.changes);
                trace_pass(tracer(now.camera), sums, paths_, 1);
            }
        };
        tracer(camera); // so that the BVH is built before the passes
        RenderResult result = trace_all(loop, 0, pass, world_.world(), report_);
        paths_ += result.paths;
        if (!moments) motion_.add(0, result.picture);
        motion_.end_frame();
        interleaving_.frame_ended();
        return result;
    }
    std::vector<RenderResult> views(std::span<FrameView const> views, std::uint32_t paths, VertexSharing,
                                    StopRequest const& stop) override
    {
        RenderProgress const silent;
        std::vector<RenderResult> results;
        motion_.see(views);
        for (FrameView const& v : views) {
            std::size_t const k = results.size();
            RenderSettings settings = settings_;
            settings.width = v.width;
            settings.height = v.height;
            settings.paths = paths;
            settings.budget_s = settings.until_relmse = 0;
            PassLoop loop(settings, stop, silent, report_);
            PathTracer<ExactVisibility> const through = tracer(v.camera, settings);
            results.push_back(trace_all(
                loop, 0,
                [&](Accumulator& sums, std::uint32_t n) {
                    trace_pass(through, sums, paths_, n, motion_.first_hits(k));
                },
                world_.world(), report_));
            motion_.add(k, results.back().picture);
            hide_pixels(results.back().picture, v.hidden);
        }
        paths_ += paths;
        motion_.end_frame();
        return results;
    }

private:
    /// With a budget, renders passes of one path, in which pixels may wait for indirect light.
    void trace_frame(Camera const& camera, Accumulator& sums, std::uint32_t paths)
    {
        PathTracer<ExactVisibility> through = tracer(camera);
        if (!(settings_.budget_s > 0)) return trace_pass(through, sums, paths_, paths, motion_.first_hits(0));
        for (std::uint32_t i = 0; i < paths; ++i) {
            double const earlier = rays_of(sums.counts);
            through.interleaving.n = std::uint32_t(interleaving_.n());
            trace_pass(through, sums, paths_, 1, motion_.first_hits(0), &waiting_);
            // Two rays per pixel are for its first surface.
            double const first = 2.0 * sums.width * sums.height,
                         later = std::max(0.0, rays_of(sums.counts) - earlier - first);
            interleaving_.pass_ended(later / (first + later));
        }
    }

    /// Returns a tracer for the current world.
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
    std::uint32_t paths_ = 0; ///< so far, over all frames
    FrameInterleaving interleaving_;
    std::vector<PathSample> waiting_; ///< buffer for interleaved passes
    MotionVectors motion_;
};

} // namespace

RenderResult render_reference(World const& world, Camera const& camera, RenderSettings const& settings,
                              StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    PassLoop loop(settings, stop, progress, report);
    Structures structures;
    structures.build(world, settings.threads, report, world.triangles.size(), &stop);
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
