#include "gi/render/pass_renderer.h"

#include "gi/core/threads.h"
#include "gi/render/fingerprint.h"
#include "gi/render/pass_loop.h"

#include <chrono>
#include <optional>
#include <tbb/global_control.h>

namespace gi {
namespace {

/// Also limits the building of structures before the passes.
std::optional<tbb::global_control> limit_threads(int threads)
{
    std::optional<tbb::global_control> limit;
    if (threads > 0) limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(threads));
    return limit;
}

/// Calls pass() up to `most` times, at least once; ends when a stop is requested or half a second is over, as
/// passes that make light of their own may take much longer than those from which PassLoop foretells their time.
template <class Pass>
void run_some(std::uint32_t most, StopRequest const& stop, Pass const& pass)
{
    constexpr auto kLong = std::chrono::milliseconds(500);
    auto const begun = std::chrono::steady_clock::now();
    for (std::uint32_t i = 0; i < most; ++i) {
        if (i > 0 && (stop.requested() || std::chrono::steady_clock::now() - begun > kLong)) return;
        pass();
    }
}

class PassFrames : public FrameRenderer {
public:
    PassFrames(StartPasses const& start, MovingWorld const& world, RenderSettings const& settings, Report& report)
        : world_(world),
          settings_(settings),
          report_(report),
          threads_(limit_threads(settings.threads)),
          renderer_(start(world.world(), settings_, world.world().static_triangles, report, nullptr)),
          motion_(world.world())
    {
    }
    void changed(Changes const& changes) override
    {
        motion_.changed(changes);
        renderer_->changed(changes);
    }
    RenderResult frame(Camera const& camera, StopRequest const& stop, RenderProgress const& progress,
                       Moments const& moments) override
    {
        PassLoop loop(settings_, stop, progress, report_);
        double const earlier = renderer_->rays();
        FrameView const whole{camera, settings_.width, settings_.height};
        motion_.see({&whole, 1});
        if (!moments) renderer_->begin(passes_, {&whole, 1}, &stop);
        RenderResult result = loop.run(0, [&](Accumulator& sums, std::uint32_t paths) {
            run_some(paths, stop, [&] {
                FrameView eye = whole;
                if (moments) {
                    Moment const now = moments(sums.paths);
                    changed(now.changes);
                    eye.camera = now.camera;
                }
                renderer_->pass(passes_++, {&eye, 1}, {&sums, 1}, &motion_, &stop);
            });
        });
        finish(result, earlier);
        result.picture = loop.sums().picture(world_.world());
        if (!moments) motion_.add(0, result.picture);
        motion_.end_frame();
        return result;
    }
    std::vector<RenderResult> views(std::span<FrameView const> views, std::uint32_t paths, VertexSharing,
                                    StopRequest const& stop) override
    {
        auto const begun = std::chrono::steady_clock::now();
        double const earlier = renderer_->rays();
        motion_.see(views);
        std::vector<Accumulator> sums;
        for (FrameView const& v : views) sums.emplace_back(v.width, v.height);
        for (std::uint32_t i = 0; i < paths && !(i > 0 && stop.requested()); ++i)
            on_threads(settings_.threads, [&] { renderer_->pass(passes_++, views, sums, &motion_, nullptr); });
        std::vector<RenderResult> results(views.size());
        PathCounts lost;
        for (std::size_t k = 0; k < views.size(); ++k) {
            results[k].paths = sums[k].paths;
            results[k].end = sums[k].paths < paths ? RenderEnd::interrupted : RenderEnd::paths;
            results[k].picture = sums[k].picture(world_.world());
            motion_.add(k, results[k].picture);
            hide_pixels(results[k].picture, views[k].hidden);
            lost += sums[k].counts;
        }
        motion_.end_frame();
        report_.lose("paths cut at 1024 surfaces", lost.cut_paths);
        report_.lose("path terms that were not finite, dropped", lost.invalid_paths);
        finish(results[0], earlier);
        results[0].seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
        return results;
    }

private:
    void finish(RenderResult& result, double rays_before)
    {
        renderer_->report_work();
        result.rays = renderer_->rays() - rays_before;
        result.options = renderer_->options();
    }

    MovingWorld const& world_;
    RenderSettings settings_;
    Report& report_;
    std::optional<tbb::global_control> threads_;
    std::unique_ptr<PassRenderer> renderer_;
    MotionVectors motion_;
    std::uint32_t passes_ = 0; ///< so far, over all frames
};

} // namespace

RenderResult render_passes(char const* name, StartPasses const& start, World const& world, Camera const& camera,
                           RenderSettings const& settings, StopRequest const& stop, RenderProgress const& progress,
                           Report& report)
{
    auto const limit = limit_threads(settings.threads);
    PassLoop loop(settings, stop, progress, report);
    auto const renderer = start(world, settings, world.triangles.size(), report, &stop);
    std::uint64_t const print = loop.keeps_state() ? fingerprint(world, camera, settings, name, renderer->asked_options()) : 0;
    FrameView const eye{camera, settings.width, settings.height};
    loop.resume(print);
    on_threads(settings.threads, [&] { renderer->begin(loop.next_path(), {&eye, 1}, &stop); });
    RenderResult result = loop.run(print, [&](Accumulator& sums, std::uint32_t paths) {
        run_some(paths, stop, [&] { renderer->pass(loop.next_path(), {&eye, 1}, {&sums, 1}, nullptr, &stop); });
    });
    renderer->report_work();
    result.rays = renderer->rays();
    result.options = renderer->options();
    loop.deliver(world, result);
    return result;
}

std::unique_ptr<FrameRenderer> start_pass_frames(StartPasses const& start, MovingWorld const& world,
                                                 RenderSettings const& settings, Report& report)
{
    return std::make_unique<PassFrames>(start, world, settings, report);
}

} // namespace gi
