#include "gi/methods/reference/reference.h"

#include "gi/methods/reference/path_tracer.h"
#include "gi/render/exact_visibility.h"
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

/// First surface of a pixel's last path.
struct FirstHit {
    std::uint32_t triangle;
    vec2 weights; ///< of corners 1 and 2
};

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
                    if (last) first_hits[pixel] = {next->first_triangle, next->first_weights};
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
    ReferenceFrames(MovingWorld const& world, Camera const& camera, RenderSettings const& settings, Report& report)
        : world_(world),
          settings_(settings),
          report_(report),
          interleaving_(settings.budget_s > 0 ? kMostInterleaving : 1, settings.budget_s),
          now_(corners_of(world.world(), first_moving()))
    {
        earlier_.first_moving = first_moving();
        FrameView const whole{camera, settings.width, settings.height};
        see({&whole, 1});
    }
    void changed(Changes const& changes) override
    {
        if (changes.geometry) {
            if (earlier_.corners.empty()) earlier_.corners = std::move(now_);
            now_ = corners_of(world_.world(), first_moving());
        }
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
        see({&whole, 1});
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
        if (!moments) add_motion(seen_.front(), result.picture);
        end_frame();
        interleaving_.frame_ended();
        return result;
    }
    std::vector<RenderResult> views(std::span<FrameView const> views, std::uint32_t paths, VertexSharing,
                                    StopRequest const& stop) override
    {
        RenderProgress const silent;
        std::vector<RenderResult> results;
        see(views);
        for (FrameView const& v : views) {
            RenderSettings settings = settings_;
            settings.width = v.width;
            settings.height = v.height;
            settings.paths = paths;
            settings.budget_s = settings.until_relmse = 0;
            PassLoop loop(settings, stop, silent, report_);
            PathTracer<ExactVisibility> const through = tracer(v.camera, settings);
            results.push_back(trace_all(
                loop, 0,
                [&](Accumulator& sums, std::uint32_t n) { trace_pass(through, sums, paths_, n, first_hits_); },
                world_.world(), report_));
            add_motion(seen_[results.size() - 1], results.back().picture);
            hide_pixels(results.back().picture, v.hidden);
        }
        paths_ += paths;
        end_frame();
        return results;
    }

private:
    /// Rays through the centre of the lens.
    struct SeenFrom {
        CameraRays now, earlier;
        int width, height;
    };

    /// With a budget, renders passes of one path, in which pixels may wait for indirect light.
    void trace_frame(Camera const& camera, Accumulator& sums, std::uint32_t paths)
    {
        PathTracer<ExactVisibility> through = tracer(camera);
        if (!(settings_.budget_s > 0)) return trace_pass(through, sums, paths_, paths, first_hits_);
        for (std::uint32_t i = 0; i < paths; ++i) {
            double const earlier = rays_of(sums.counts);
            through.interleaving.n = std::uint32_t(interleaving_.n());
            trace_pass(through, sums, paths_, 1, first_hits_, &waiting_);
            // Two rays per pixel are for its first surface.
            double const first = 2.0 * sums.width * sums.height,
                         later = std::max(0.0, rays_of(sums.counts) - earlier - first);
            interleaving_.pass_ended(later / (first + later));
        }
    }

    std::size_t first_moving() const { return world_.world().static_triangles; }

    /// Each view continues the previous frame's view of the same index.
    void see(std::span<FrameView const> views)
    {
        std::size_t const known = std::min(seen_.size(), views.size());
        seen_.resize(views.size());
        std::size_t most_pixels = 0;
        for (std::size_t k = 0; k < views.size(); ++k) {
            FrameView const& v = views[k];
            SeenFrom& s = seen_[k];
            CameraRays const now = camera_rays(v.camera, v.width, v.height, world_.world().origin);
            bool const same = k < known && s.width == v.width && s.height == v.height;
            s = {now, same ? s.earlier : now, v.width, v.height};
            most_pixels = std::max(most_pixels, std::size_t(v.width) * std::size_t(v.height));
        }
        first_hits_.resize(most_pixels);
    }
    void end_frame()
    {
        earlier_.corners.clear();
        for (SeenFrom& s : seen_) s.earlier = s.now;
    }
    /// Adds the motion vectors of the view traced last.
    void add_motion(SeenFrom const& from, Picture& picture) const
    {
        if (from.now.orthographic) return;
        World const& world = world_.world();
        std::size_t const width = std::size_t(from.width);
        auto const seen = [&](std::size_t y, std::span<SeenPoint> row) {
            for (std::size_t x = 0; x < width; ++x) {
                auto const [triangle, weights] = first_hits_[y * width + x];
                if (triangle == kNoTriangle) continue;
                uvec3 const v = world.triangles[triangle];
                Corners const corners{world.positions[v.x], world.positions[v.y], world.positions[v.z]};
                row[x] = {triangle, weights, point_on(corners, weights)};
            }
        };
        gi::add_motion(seen, from.now, from.earlier, earlier_, picture);
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
    std::vector<SeenFrom> seen_;
    std::vector<FirstHit> first_hits_; ///< of the view traced last
    std::vector<Corners> now_;         ///< of dynamic triangles
    EarlierCorners earlier_;
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

std::unique_ptr<FrameRenderer> start_reference_frames(MovingWorld const& world, Camera const& camera,
                                                      RenderSettings const& settings, Report& report)
{
    return std::make_unique<ReferenceFrames>(world, camera, settings, report);
}

} // namespace gi
