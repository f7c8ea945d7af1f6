#pragma once
// Where the reference traces its paths on the CPU: tile by tile, through Embree.

#include "gi/core/step.h"
#include "gi/light_paths/lamp_caustics.h"
#include "gi/methods/reference/path_tracer.h"
#include "gi/render/exact_visibility.h"
#include "gi/render/flush_denormals.h"
#include "gi/render/render_settings.h"
#include "gi/render/tiled_pass.h"
#include "gi/scene/model/plan.h"
#include "gi/scene/motion/moving_world.h"

#include <memory>
#include <optional>
#include <tbb/combinable.h>

namespace gi {

class EmbreePaths {
public:
    /// Builds nothing yet. All arguments must outlive this object.
    /// @param first_moving, stop  see ExactVisibility
    EmbreePaths(World const& world, RenderSettings const& settings, std::size_t first_moving, Report& report,
                StopRequest const* stop = nullptr)
        : world_(world), threads_(settings.threads), first_moving_(first_moving), report_(report), stop_(stop)
    {
    }

    void changed(Changes const& changes)
    {
        if (changes.materials || changes.coverage) visibility_.reset();
        if (!changes.geometry || !visibility_) return;
        StageTimer const timer(report_, "BVH of dynamic triangles (Embree)");
        visibility_->moved(world_);
    }

    /// Builds what is missing. Returns the current world as trace() needs it.
    WorldView prepare()
    {
        if (!visibility_) {
            StageTimer const timer(report_, "build (Embree BVH)");
            visibility_ = std::make_unique<ExactVisibility>(world_, plan_scene(world_).alpha_tests, threads_,
                                                            first_moving_, stop_of_building(stop_));
        }
        return view(world_);
    }

    /// From the next pass on, paths find the caustics of lamps, if there are any: each pass is then of one path, and
    /// prepare_caustics() precedes it.
    void find_caustics(RenderSettings const& settings)
    {
        if (LampCaustics::exist(world_, settings)) caustics_.emplace(world_, settings, report_);
    }
    bool finds_caustics() const { return caustics_.has_value(); }
    void prepare_caustics(std::uint32_t path, BuildStop const& stop, PathCounts& counts)
    {
        caustics_->prepare(*visibility_, path, stop, counts);
    }

    /// Traces some paths of every pixel; those of a tile advance together.
    /// @param first_path  number of the first of them
    /// @param first_hits  per pixel, set by the last path; empty = not needed
    /// @param use  (pixel, number of the path from 0, PathSample), from several threads; the paths of a pixel in
    ///   order, by one thread
    template <class Use>
    PathCounts trace(PathSteps const& steps, TiledPass& pass, std::uint32_t first_path,
                     std::span<FirstHit> first_hits, Use const& use) const
    {
        PathTracer<ExactVisibility> const tracer{steps, *visibility_, caustics_ ? caustics_->map() : nullptr};
        tbb::combinable<PathCounts> counts;
        pass.run([&](TiledPass::Tile const& tile) {
            FlushDenormals const guard;
            PathCounts& local = counts.local();
            std::vector<Path> batch;
            tile.for_paths([&](std::uint32_t i) {
                batch.clear();
                for (int y = tile.top; y < tile.bottom; ++y)
                    for (int x = tile.left; x < tile.right; ++x)
                        batch.push_back(steps.start(x, y, first_path + i));
                tracer.trace(batch, local);
                auto next = batch.begin();
                bool const last = i + 1 == pass.paths && !first_hits.empty();
                for (int y = tile.top; y < tile.bottom; ++y)
                    for (int x = tile.left; x < tile.right; ++x, ++next) {
                        std::size_t const pixel = std::size_t(y) * std::size_t(steps.width) + std::size_t(x);
                        use(pixel, i, next->sample);
                        if (last) first_hits[pixel] = next->first;
                    }
            });
        });
        return counts.combine([](PathCounts a, PathCounts const& b) { return a += b; });
    }
    /// Adds them to the sums of the pass.
    PathCounts add(PathSteps const& steps, TiledPass& pass, std::uint32_t first_path,
                   std::span<FirstHit> first_hits, Accumulator& sums) const
    {
        return trace(
            steps, pass, first_path, first_hits,
            [&](std::size_t pixel, std::uint32_t k, PathSample const& s) { sums.add(pixel, s, sums.paths + k); });
    }

private:
    World const& world_;
    int threads_;
    std::size_t first_moving_;
    Report& report_;
    StopRequest const* stop_;
    std::unique_ptr<ExactVisibility> visibility_;
    std::optional<LampCaustics> caustics_;
};

} // namespace gi
