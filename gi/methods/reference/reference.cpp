#include "gi/methods/reference/reference.h"

#include "gi/kernel/device.h"
#include "gi/methods/reference/embree_paths.h"
#include "gi/methods/reference/kernel_paths.h"
#include "gi/methods/reference/kernels.h"
#include "gi/render/fingerprint.h"
#include "gi/render/motion.h"
#include "gi/render/pass_loop.h"
#include "gi/render/render_option.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

double rays_of(PathCounts const& c) { return double(c.nearest_rays + c.shadow_rays); }

/// @tparam Paths  EmbreePaths, or KernelPaths of a space
/// @param first_hits  one per pixel, set by its last path; empty = not needed
/// @param memory  buffer for interleaved passes, in which pixels take indirect light from those in turn
/// @param stop  throws Interrupted; what was traced is kept, but of interleaved passes. Null = never
template <class Paths>
void trace_pass(Paths& tracing, PathSteps const& steps, Accumulator& sums, std::uint32_t first_path,
                std::uint32_t paths, std::span<FirstHit> first_hits = {},
                std::vector<PathSample>* memory = nullptr, StopRequest const* stop = nullptr)
{
    std::uint32_t const first = first_path + sums.paths;
    PassStop const given_up(stop, PassStop::of(sums.paths));
    TiledPass pass(sums, paths, given_up);
    if (steps.interleaving.n > 1) {
        memory->resize(sums.pixels.size());
        std::span<PathSample> const waiting = *memory;
        auto const keep = [&](std::size_t pixel, std::uint32_t, PathSample const& s) { waiting[pixel] = s; };
        PathCounts const counts = tracing.trace(steps, pass, first, first_hits, keep);
        given_up.check(); // before pixels take light that others lack
        sums.counts += counts;
        spread_indirect(waiting, sums.width, steps.interleaving, first);
        tbb::parallel_for(std::size_t(0), waiting.size(),
                          [&](std::size_t p) { sums.add(p, waiting[p], sums.paths); });
    } else {
        sums.counts += tracing.add(steps, pass, first, first_hits, sums);
    }
    pass.end();
}

/// Builds what is missing for tracing.
template <class Paths>
PathSteps start_steps(Paths& tracing, World const& world, Camera const& camera, RenderSettings const& s)
{
    return {tracing.prepare(), camera_rays(camera, s.width, s.height, world.origin),
            s.bounces,         s.seed,
            s.filter,          s.width};
}

/// @param print  of the scene and settings
RenderResult trace_all(PassLoop& loop, std::uint64_t print, PassLoop::Pass const& pass, World const& world,
                       RenderSettings const& settings, Report& report)
{
    RenderResult result = loop.run(print, pass);
    PathCounts const& total = loop.sums().counts;
    report.count("closest-hit rays", double(total.nearest_rays));
    report.count("shadow rays", double(total.shadow_rays));
    result.rays = rays_of(total);
    loop.deliver(world, result);
    if (settings.space == Space::device) result.options = as_options(common_options(), settings, {"device"});
    return result;
}

template <class Paths>
class ReferenceFrames : public FrameRenderer {
public:
    ReferenceFrames(MovingWorld const& world, RenderSettings const& settings, Report& report)
        : world_(world),
          settings_(settings),
          report_(report),
          interleaving_(settings.budget_s > 0 ? kMostInterleaving : 1, settings.budget_s),
          tracing_(world.world(), settings_, world.world().static_triangles, report),
          motion_(world.world())
    {
        tracing_.prepare();
    }
    void changed(Changes const& changes) override
    {
        motion_.changed(changes);
        tracing_.changed(changes);
    }
    RenderResult frame(Camera const& camera, StopRequest const& stop, RenderProgress const& progress,
                       Moments const& moments) override
    {
        interleaving_.frame_begins();
        PassLoop loop(settings_, stop, progress, report_);
        FrameView const whole{camera, settings_.width, settings_.height};
        motion_.see({&whole, 1});
        auto const pass = [&](Accumulator& sums, std::uint32_t paths) {
            if (!moments) return trace_frame(camera, sums, paths, stop);
            for (std::uint32_t i = 0; i < paths && !(i > 0 && stop.requested()); ++i) {
                Moment const now = moments(sums.paths);
                changed(now.changes);
                trace_pass(tracing_, steps(now.camera), sums, paths_, 1, {}, nullptr, &stop);
            }
        };
        steps(camera); // so that the BVH is built before the passes
        RenderResult result = trace_all(loop, 0, pass, world_.world(), settings_, report_);
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
        StopRequest const never; // all views have as many paths as the first
        std::vector<RenderResult> results;
        motion_.see(views);
        for (FrameView const& v : views) {
            std::size_t const k = results.size();
            RenderSettings settings = settings_;
            settings.width = v.width;
            settings.height = v.height;
            settings.paths = k == 0 ? paths : results[0].paths;
            settings.budget_s = settings.until_relmse = 0;
            PassLoop loop(settings, k == 0 ? stop : never, silent, report_);
            PathSteps const through = steps(v.camera, settings);
            results.push_back(trace_all(
                loop, 0,
                [&](Accumulator& sums, std::uint32_t n) {
                    trace_pass(tracing_, through, sums, paths_, n, motion_.first_hits(k));
                },
                world_.world(), settings, report_));
            motion_.add(k, results.back().picture);
            hide_pixels(results.back().picture, v.hidden);
        }
        if (!results.empty()) paths_ += results[0].paths;
        motion_.end_frame();
        return results;
    }

private:
    /// With a budget, renders passes of one path, in which pixels may wait for indirect light.
    void trace_frame(Camera const& camera, Accumulator& sums, std::uint32_t paths, StopRequest const& stop)
    {
        PathSteps through = steps(camera);
        if (!(settings_.budget_s > 0))
            return trace_pass(tracing_, through, sums, paths_, paths, motion_.first_hits(0), nullptr, &stop);
        for (std::uint32_t i = 0; i < paths && !(i > 0 && stop.requested()); ++i) {
            double const earlier = rays_of(sums.counts);
            through.interleaving.n = std::uint32_t(interleaving_.n());
            trace_pass(tracing_, through, sums, paths_, 1, motion_.first_hits(0), &waiting_, &stop);
            // Two rays per pixel are for its first surface.
            double const first = 2.0 * sums.width * sums.height,
                         later = std::max(0.0, rays_of(sums.counts) - earlier - first);
            interleaving_.pass_ended(later / (first + later));
        }
    }

    /// Steps through the current world.
    PathSteps steps(Camera const& camera) { return steps(camera, settings_); }
    PathSteps steps(Camera const& camera, RenderSettings const& settings)
    {
        return start_steps(tracing_, world_.world(), camera, settings);
    }

    MovingWorld const& world_;
    RenderSettings settings_;
    Report& report_;
    std::uint32_t paths_ = 0; ///< so far, over all frames
    FrameInterleaving interleaving_;
    Paths tracing_;
    std::vector<PathSample> waiting_; ///< buffer for interleaved passes
    MotionVectors motion_;
};

/// @param name  for checkpoints
template <class Paths>
RenderResult render_picture(char const* name, World const& world, Camera const& camera,
                            RenderSettings const& settings, StopRequest const& stop,
                            RenderProgress const& progress, Report& report)
{
    PassLoop loop(settings, stop, progress, report);
    Paths tracing(world, settings, world.triangles.size(), report, &stop);
    PathSteps const steps = start_steps(tracing, world, camera, settings);
    constexpr bool kMayFindCaustics = std::is_same_v<Paths, EmbreePaths>;
    std::string const options = kMayFindCaustics ? lamp_caustic_options(world, settings) : "";
    std::uint64_t const print =
        loop.keeps_state() ? fingerprint(world, camera, settings, name, options + lamp_light_version(world)) : 0;
    if constexpr (kMayFindCaustics) tracing.find_caustics(settings);
    auto const pass = [&](Accumulator& sums, std::uint32_t paths) {
        if constexpr (kMayFindCaustics)
            if (tracing.finds_caustics()) {
                for (std::uint32_t i = 0; i < paths && !(i > 0 && stop.requested()); ++i) {
                    tracing.prepare_caustics(loop.first_path() + sums.paths, BuildStop(&stop), sums.counts);
                    trace_pass(tracing, steps, sums, loop.first_path(), 1, {}, nullptr, &stop);
                }
                return;
            }
        trace_pass(tracing, steps, sums, loop.first_path(), paths, {}, nullptr, &stop);
    };
    RenderResult result = trace_all(loop, print, pass, world, settings, report);
    if (!options.empty()) result.options = options;
    return result;
}

} // namespace

RenderResult render_reference(World const& world, Camera const& camera, RenderSettings const& settings,
                              StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    if (settings.space == Space::host)
        return render_picture<EmbreePaths>("reference", world, camera, settings, stop, progress, report);
    check_device(Space::device);
    lose_lamp_caustics(world, report);
    return render_reference_by_kernels(Space::device, world, camera, settings, stop, progress, report);
}

std::unique_ptr<FrameRenderer> start_reference_frames(MovingWorld const& world, Camera const&,
                                                      RenderSettings const& settings, Report& report)
{
    if (settings.space == Space::host)
        return std::make_unique<ReferenceFrames<EmbreePaths>>(world, settings, report);
    check_device(Space::device);
    return start_reference_kernel_frames(Space::device, world, settings, report);
}

RenderResult render_reference_by_kernels(Space space, World const& world, Camera const& camera,
                                         RenderSettings const& settings, StopRequest const& stop,
                                         RenderProgress const& progress, Report& report)
{
    auto const& render = space == Space::host ? render_picture<KernelPaths<Space::host>>
                                              : render_picture<KernelPaths<Space::device>>;
    return render("reference by kernels", world, camera, settings, stop, progress, report);
}

std::unique_ptr<FrameRenderer> start_reference_kernel_frames(Space space, MovingWorld const& world,
                                                             RenderSettings const& settings, Report& report)
{
    if (space == Space::host)
        return std::make_unique<ReferenceFrames<KernelPaths<Space::host>>>(world, settings, report);
    return std::make_unique<ReferenceFrames<KernelPaths<Space::device>>>(world, settings, report);
}

} // namespace gi
