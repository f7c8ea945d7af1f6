#pragma once
// Frame sequences by paths, with the renderer of either memory space. Static hit buffers are built once, and dynamic
// geometry is added to them; schedules that build new axes for every frame draw everything together.

#include "gi/core/error.h"
#include "gi/core/threads.h"
#include "gi/methods/paths/choose.h"
#include "gi/methods/paths/renderer.h"
#include "gi/render/pass_loop.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

namespace gi {

/// What only paths on the CPU can do.
class OnlyOnCpu : public PairFrames, public PunctualLeftOut, public FramesGivenUp {};
class Nothing {};

/// @tparam Renderer  PathsRenderer, or a KernelRenderer
template <class Renderer>
class PathsFrames : public FrameRenderer,
                    public FollowingAxes,
                    public LiveSettings,
                    public std::conditional_t<std::is_same_v<Renderer, PathsRenderer>, OnlyOnCpu, Nothing> {
    static constexpr bool kByKernels = !std::is_same_v<Renderer, PathsRenderer>;

public:
    /// @param settings  with the PathAlgorithm
    PathsFrames(MovingWorld const& world, Camera const& camera, RenderSettings const& settings, Report& report)
        : world_(world), asked_(settings), settings_(settings), report_(report)
    {
        if constexpr (kByKernels) Renderer::check(camera, settings);
        if (settings.threads > 0)
            threads_.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(settings.threads));
        if (settings.of<SlhbSettings>().packed && world.world().static_triangles < world.world().triangles.size())
            throw InputError("--packed with dynamic geometry",
                             "the range of packed depths covers static geometry only", "leave out --packed");
        auto const begun = std::chrono::steady_clock::now();
        FrameView const eye = full_size(camera);
        start({&eye, 1});
        start_s_ = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
    }

    void changed(Changes const& changes) override
    {
        if (changes.coverage) restart_ = true; // hit buffers omit transparent parts of surfaces
        if (!restart_) renderer_->changed(changes);
    }

    void update_axes(int axes) override
    {
        updated_axes_ = std::uint32_t(axes);
        if (renderer_) renderer_->update_axes(updated_axes_); // otherwise applied when a renderer starts
    }

    void follow(RenderSettings const& settings) override { cache_ = settings.of<PathsSettings>().cache; }

    // With OnlyOnCpu as base, these override it, and so does `pair`.
    void leave_out_punctual(bool on) { leaves_out_punctual_ = on; }
    void may_give_up() { may_give_up_ = true; }
    bool can_undo() const { return before_.has_value(); }
    void keep() { before_.reset(); }
    void undo()
    {
        if constexpr (!kByKernels) {
            renderer_->go_back(std::move(before_->renderer));
            refused_ = std::min(refused_, renderer_->refused_notes());
        }
        passes_ = before_->passes;
        before_.reset();
    }

    DynamicUpdate dynamic_update() const override
    {
        return renderer_ ? renderer_->dynamic_update() : DynamicUpdate{};
    }

    RenderResult frame(Camera const& camera, StopRequest const& stop, RenderProgress const& progress,
                       Moments const& moments) override
    {
        if (interleaving_) interleaving_->frame_begins();
        PassLoop loop(settings_, stop, progress, report_, moments ? std::exchange(start_s_, 0) : 0);
        see(full_size(camera));
        double const earlier = renderer_->rays();
        if (!(settings_.budget_s > 0))
            renderer_->forget(); // with fixed paths, frames must not depend on earlier ones
        VertexSharing const sharing =
            settings_.of<PathsSettings>().cache == RadianceCaching::on ? VertexSharing::cached : VertexSharing::exact;
        RenderResult result = loop.run(0, [&](Accumulator& sums, std::uint32_t paths) {
            if constexpr (kByKernels)
                if (!moments) {
                    std::uint32_t const before = sums.paths;
                    renderer_->passes(passes_, paths, {&sums, 1}, sharing, &stop);
                    passes_ += sums.paths - before;
                    return;
                }
            for (std::uint32_t i = 0; i < paths && !(i > 0 && stop.requested()); ++i) {
                if (moments) {
                    Moment const now = moments(sums.paths);
                    changed(now.changes);
                    FrameView view = full_size(now.camera);
                    std::vector<Camera> during;
                    if (now.camera_at && settings_.of<PathAlgorithm>().layered_lens)
                        during = cameras_during(now.camera_at, settings_.seed, sums.paths);
                    view.during = during;
                    see(view);
                }
                one_pass({&sums, 1}, sharing, stop);
            }
        });
        finish(result, earlier);
        result.picture = loop.sums().picture(world_.world());
        if (!moments) renderer_->add_motion(0, result.picture);
        end_frame();
        if (interleaving_) interleaving_->frame_ended();
        return result;
    }

    std::vector<RenderResult> views(std::span<FrameView const> views, std::uint32_t paths, VertexSharing sharing,
                                    StopRequest const& stop) override
    {
        if (cache_ == RadianceCaching::on) sharing = VertexSharing::cached;
        bool const may = asked_.of<PathAlgorithm>().caches || asked_.of<PathsSettings>().cache == RadianceCaching::on;
        bool const never = cache_ == RadianceCaching::off || (cache_ == RadianceCaching::automatic && !may);
        if (never && sharing == VertexSharing::cached) sharing = VertexSharing::exact;
        auto const begun = std::chrono::steady_clock::now();
        double earlier = renderer_->rays();
        sums_.resize(views.size());
        for (std::size_t k = 0; k < views.size(); ++k) sums_[k].start(views[k].width, views[k].height);
        before_.reset();
        if (!std::exchange(may_give_up_, false) || !views_whole(views, paths, sharing, stop)) {
            see_all(views);
            earlier = renderer_->rays(); // it may be a new renderer
            if constexpr (!kByKernels) renderer_->leave_out_punctual(leaves_out_punctual_);
            if constexpr (kByKernels)
                passes_of_views(paths, sharing, stop);
            else
                for (std::uint32_t i = 0; i < paths && !(i > 0 && stop.requested()); ++i)
                    pass_of_views(sharing, nullptr);
        }
        std::vector<RenderResult> results(views.size());
        PathCounts lost;
        for (std::size_t k = 0; k < views.size(); ++k) {
            RenderResult& r = results[k];
            r.paths = sums_[k].paths;
            r.end = r.paths < paths ? RenderEnd::interrupted : RenderEnd::paths;
            r.picture = sums_[k].picture(world_.world());
            renderer_->add_motion(k, r.picture);
            auto const from = renderer_->light_from(k);
            r.light_from.assign(from.begin(), from.end());
            lost += sums_[k].counts;
        }
        report_.lose("paths cut at 1024 surfaces", lost.cut_paths);
        report_.lose("path terms that were not finite, dropped", lost.invalid_paths);
        finish(results[0], earlier);
        results[0].seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
        end_frame();
        return results;
    }

    PairResult pair(FrameView const& view, PairSettings const& settings, PairWorld const& turn,
                    StopRequest const& stop)
    {
        return traced_pair(view, settings, turn, stop);
    }

private:
    void pass_of_views(VertexSharing sharing, StopRequest const* stop)
    {
        on_threads(settings_.threads,
                   [&] { renderer_->pass(passes_++, sums_, sharing, PassStop(stop, PassStop::Pass::later)); });
    }
    /// By kernels: the sums stay where these run until all passes are done.
    void passes_of_views(std::uint32_t paths, VertexSharing sharing, StopRequest const& stop)
    {
        on_threads(settings_.threads, [&] { renderer_->passes(passes_, paths, sums_, sharing, &stop); });
        passes_ += sums_[0].paths;
    }

    /// Renders all paths of the views, or throws Interrupted and is as before.
    /// @return false, and nothing is done, if the frame could not be undone
    bool views_whole(std::span<FrameView const> views, std::uint32_t paths, VertexSharing sharing,
                     StopRequest const& stop)
    {
        PathAlgorithm const& by = settings_.of<PathAlgorithm>();
        if (kByKernels || restart_ || by.surfaces != SurfacesBy::rays || by.shadows != ShadowsBy::rays) return false;
        if constexpr (!kByKernels) {
            auto before = renderer_->before(sharing == VertexSharing::cached);
            if (!before) return false;
            before_.emplace(Before{std::move(*before), passes_});
            try {
                renderer_->see(views);
                renderer_->leave_out_punctual(leaves_out_punctual_);
                for (std::uint32_t i = 0; i < paths; ++i) pass_of_views(sharing, &stop);
                if (stop.requested()) throw Interrupted();
            } catch (Interrupted const&) {
                undo();
                throw;
            }
        }
        return true;
    }

    void one_pass(std::span<Accumulator> sums, VertexSharing sharing, StopRequest const& stop)
    {
        if constexpr (kByKernels) {
            renderer_->pass(passes_++, sums, sharing);
        } else {
            settings_.of<PathsSettings>().interleave = interleaving_->n();
            renderer_->interleave(interleaving_->n());
            renderer_->pass(passes_++, sums, sharing, PassStop(&stop, PassStop::of(sums[0].paths)));
            interleaving_->pass_ended(renderer_->indirect_share());
        }
    }

    FrameView full_size(Camera const& camera) const { return {camera, settings_.width, settings_.height}; }

    PairResult traced_pair(FrameView const& view, PairSettings const& settings, PairWorld const& turn,
                           StopRequest const& stop)
    {
        if (view.camera.orthographic)
            throw InputError("pictures with and without dynamic geometry, of an orthographic camera",
                             "its first surfaces are not rasterised", "use a perspective camera");
        auto const begun = std::chrono::steady_clock::now();
        // Streamed axes have dynamic geometry built in; to share axes between both sides, use the same axes with
        // dynamic geometry kept separate.
        bool const looks_up = settings_.of<PathAlgorithm>().surfaces == SurfacesBy::look_ups;
        if (looks_up && settings_.of<SlhbSettings>().schedule == Schedule::streamed) {
            asked_.of<SlhbSettings>().schedule = Schedule::temporal;
            asked_.of<SlhbSettings>().axes = asked_.of<SlhbSettings>().fresh_axes = settings_.of<SlhbSettings>().axes;
            restart_ = true;
        }
        PairResult both;
        both.coverage.assign(std::size_t(view.width) * std::size_t(view.height), 0.0f);
        both.covered.assign(both.coverage.size(), vec3{0});
        changed(turn(PairSide::with));
        see(view);
        double const earlier = renderer_->rays();
        PathCounts const lost = settings.difference == PairDifference::vanishing && can_leave_out()
                                    ? trace_in_place(view, settings, stop, both)
                                    : trace_in_turns(view, settings, turn, stop, both);
        for (RenderResult* const r : {&both.with, &both.without})
            r->end = r->paths < settings.paths ? RenderEnd::interrupted : RenderEnd::paths;
        tbb::parallel_for(std::size_t(0), both.coverage.size(), [&](std::size_t p) {
            both.coverage[p] /= float(both.with.paths);
            both.covered[p] /= float(both.with.paths);
        });
        report_.lose("paths cut at 1024 surfaces", lost.cut_paths);
        report_.lose("path terms that were not finite, dropped", lost.invalid_paths);
        finish(both.with, earlier);
        both.with.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - begun).count();
        end_frame();
        return both;
    }

    /// True if the picture without dynamic geometry can be made from the world with it,
    /// as the lights are the same.
    bool can_leave_out() const
    {
        World const& world = world_.world();
        return !settings_.of<SlhbSettings>().exact.any() && !(has_panes(world) && !world.lights.empty()) &&
               std::ranges::none_of(world.emitters, [&](std::uint32_t t) { return t >= world.static_triangles; });
    }

    PathCounts trace_in_place(FrameView const& view, PairSettings const& settings, StopRequest const& stop,
                              PairResult& both)
    {
        PathCounts lost;
        pair_sums_.start(view.width, view.height);
        for (std::uint32_t i = 0; i < settings.paths && !(i > 0 && stop.requested()); ++i) {
            on_threads(settings_.threads, [&] { renderer_->pair_pass(passes_++, pair_sums_, lost); });
            renderer_->add_coverage(0, both.coverage, both.covered);
        }
        both.with.paths = both.without.paths = pair_sums_.paths();
        both.with.picture = pair_sums_.first(world_.world(), settings.layers);
        both.without.picture = both.with.picture;
        pair_sums_.make_second(world_.world(), both.without.picture);
        return lost;
    }

    PathCounts trace_in_turns(FrameView const& view, PairSettings const& settings, PairWorld const& turn,
                              StopRequest const& stop, PairResult& both)
    {
        sums_.resize(2);
        for (Accumulator& s : sums_) s.start(view.width, view.height);
        // Each pass begins with the side with which the previous one ended,
        // so that the world changes only once per pass.
        PairSide now = PairSide::with;
        for (std::uint32_t i = 0; i < settings.paths && !(i > 0 && stop.requested()); ++i, ++passes_)
            for (int half = 0; half < 2; ++half) {
                if (half == 1) {
                    now = now == PairSide::with ? PairSide::without : PairSide::with;
                    changed(turn(now));
                    see(view);
                }
                on_threads(settings_.threads, [&] {
                    renderer_->pass(passes_, {&sums_[std::size_t(now)], 1}, VertexSharing::none, PassStop(nullptr));
                });
                if (now == PairSide::with) renderer_->add_coverage(0, both.coverage, both.covered);
            }
        PathCounts lost;
        for (Accumulator const& s : sums_) {
            RenderResult& r = &s == sums_.data() ? both.with : both.without;
            r.paths = s.paths;
            r.picture = s.picture(world_.world(), settings.layers);
            lost += s.counts;
        }
        return lost;
    }

    void see(FrameView const& view)
    {
        FrameView whole = view;
        whole.hidden = {};
        see_all({&whole, 1});
    }

    void see_all(std::span<FrameView const> views)
    {
        if (restart_) start(views);
        renderer_->see(views);
    }

    void finish(RenderResult& result, double rays_before)
    {
        renderer_->report_work();
        result.rays = renderer_->rays() - rays_before;
        result.options = as_options(settings_);
    }

    void end_frame()
    {
        renderer_->end_frame();
        report_.lose("layers beyond the limit of a texel", renderer_->lost_layers() - lost_);
        lost_ = renderer_->lost_layers();
        report_.lose("radiance samples for which the radiance cache had no room",
                     renderer_->refused_notes() - refused_);
        refused_ = renderer_->refused_notes();
    }

    void start(std::span<FrameView const> views)
    {
        World const& world = world_.world();
        TriangleSoup soup = make_soup(world);
        settings_ = choose_frame_settings(asked_, world, soup);
        if constexpr (kByKernels) {
            Renderer::limit(settings_);
            for (FrameView const& v : views) Renderer::check(v.camera, settings_);
        }
        if constexpr (!kByKernels)
            interleaving_.emplace(settings_.of<PathsSettings>().interleave,
                                  asked_.of<PathsSettings>().interleave == 0 ? settings_.budget_s : 0);
        renderer_.emplace(world, views, settings_, std::move(soup), world.static_triangles, report_);
        renderer_->update_axes(updated_axes_);
        restart_ = false;
        lost_ = refused_ = 0;
    }

    struct Before { ///< the last frame
        PathsRenderer::Before renderer;
        std::uint32_t passes;
    };

    MovingWorld const& world_;
    RenderSettings asked_, settings_; ///< the second with all numbers chosen
    Report& report_;
    std::optional<tbb::global_control> threads_;
    std::optional<Renderer> renderer_;
    std::optional<FrameInterleaving> interleaving_; ///< none with kernels
    std::vector<Accumulator> sums_;                 ///< of the views
    PairSums pair_sums_;
    RadianceCaching cache_ = RadianceCaching::automatic; ///< as set by the user; automatic: as callers request it
    bool leaves_out_punctual_ = false, may_give_up_ = false;
    std::optional<Before> before_; ///< if the last frame can be undone
    std::uint32_t passes_ = 0, updated_axes_ = 0;
    std::uint64_t lost_ = 0, refused_ = 0; ///< layers and cache notes already reported as lost
    bool restart_ = false;
    double start_s_ = 0; ///< duration of the first start
};

} // namespace gi
