#pragma once
// Where the reference traces its paths by kernels: the world, its BVH and the sums of a pass lie in a memory
// space. Same functions as EmbreePaths.

#include "gi/core/step.h"
#include "gi/kernel/launch.h"
#include "gi/methods/reference/path_kernel.h"
#include "gi/render/render_settings.h"
#include "gi/render/sums_on.h"
#include "gi/render/tiled_pass.h"
#include "gi/scene/model/plan.h"
#include "gi/scene/model/used_materials.h"
#include "gi/scene/model/world_on.h"

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <tbb/parallel_for.h>

namespace gi {

/// Memory of paths on their way.
template <Space S>
struct PathMemory {
    PathMemory() = default;
    /// @param n  number of slots  @param pixels  of the picture
    PathMemory(std::size_t n, std::size_t pixels)
        : slots(n),
          carried(n),
          lights(n),
          seen(n),
          queries(n),
          shadows(n),
          hits(n),
          left(n),
          added(pixels),
          taken_paths(1)
    {
    }
    std::size_t pixels() const { return added.size(); }

    void lend(PathSlots& to)
    {
        to.slots = slots.view();
        to.carried = carried.view();
        to.lights = lights.view();
        to.seen = seen.view();
        to.queries = queries.view();
        to.shadows = shadows.view();
        to.hits = hits.view();
        to.left = left.view();
        to.added = added.view();
        to.taken = taken_paths.view();
    }
    void take_none()
    {
        for (View<std::uint32_t> const of : {added.view(), taken_paths.view()})
            fill_bytes(S, of.data, 0, of.size() * sizeof(std::uint32_t));
    }
    std::uint32_t taken() const { return download(taken_paths).front(); }

    // As in PathSlots.
    ColumnBuffer<PathSlot, S> slots;
    ColumnBuffer<PathCarry, S> carried;
    ColumnBuffer<PathLight, S> lights;
    ColumnBuffer<FirstSurface, S> seen;
    ColumnBuffer<RayQuery, S> queries, shadows;
    ColumnBuffer<Hit, S> hits;
    ColumnBuffer<vec3, S> left;
    Buffer<std::uint32_t, S> added, taken_paths;
};

template <Space S>
class KernelPaths {
public:
    KernelPaths(World const& world, RenderSettings const&, std::size_t first_moving, Report& report,
                StopRequest const* stop = nullptr)
        : world_(world), there_(world), first_moving_(first_moving), report_(report), stop_(stop)
    {
    }

    void changed(Changes const& changes)
    {
        StageTimer const timer(report_, "update of dynamic triangles");
        there_.update(world_, changes);
        if (!bvh_) return;
        if (changes.materials || changes.coverage) bvh_->test_alpha(plan_scene(world_).alpha_tests);
        if (changes.geometry) bvh_->moved(there_.view());
        finish(S);
    }

    WorldView prepare()
    {
        if (!bvh_) {
            StageTimer const timer(report_, "build (BVH)");
            bvh_.emplace(there_.view(), plan_scene(world_).alpha_tests, first_moving_, stop_of_building(stop_));
            finish(S);
        }
        return there_.view();
    }

    template <class Use>
    PathCounts trace(PathSteps const& steps, TiledPass& pass, std::uint32_t first_path,
                     std::span<FirstHit> first_hits, Use const& use)
    {
        Buffer<PathSample, S> samples(pass.pixels());
        on_host_.resize(pass.pixels());
        return run(
            steps, pass, first_path, first_hits, 1, [&](std::uint32_t) { return KeepSamples{samples.view()}; },
            [&](std::uint32_t path) {
                copy_bytes(Space::host, on_host_.data(), S, samples.view().data,
                           samples.size() * sizeof(PathSample));
                tbb::parallel_for(std::size_t(0), on_host_.size(),
                                  [&](std::size_t p) { use(p, path, on_host_[p]); });
            });
    }
    PathCounts add(PathSteps const& steps, TiledPass& pass, std::uint32_t first_path,
                   std::span<FirstHit> first_hits, Accumulator& sums)
    {
        sums_.take(sums);
        PathCounts const counts = run(
            steps, pass, first_path, first_hits, pass.paths,
            [&](std::uint32_t path) {
                return AddToMeans{sums_.means(), sums.paths + path};
            },
            [](std::uint32_t) {});
        sums_.give(sums, sums.paths + pass.done());
        return counts;
    }

    std::function<void(PathMemory<S>&)> after_step; ///< for programs that compare spaces: they may change it

private:
    /// @param most  paths of each pixel that are traced together
    /// @param to     (number of its first path) -> where samples go
    /// @param ended  called with that number when all samples are there
    template <class To, class Ended>
    PathCounts run(PathSteps const& steps, TiledPass& pass, std::uint32_t first_path,
                   std::span<FirstHit> first_hits, std::uint32_t most, To const& to, Ended const& ended)
    {
        constexpr std::size_t kCounts = 1024; // threads that add to one number wait for each other
        std::size_t const pixels = pass.pixels();
        Buffer<PathCounts, S> counts = upload<S>(std::vector<PathCounts>(kCounts));
        Buffer<FirstHit, S> hits(first_hits.empty() ? 0 : pixels);
        std::size_t const n = std::min(pixels, kMostSlots);
        if (memory_.pixels() != pixels) {
            memory_ = {}; // first, as both together may be too much
            memory_ = PathMemory<S>(n, pixels);
        }
        std::uint32_t const countable = std::uint32_t((std::numeric_limits<std::uint32_t>::max() - n) / pixels);
        PathSlots all;
        all.steps = steps;
        memory_.lend(all);
        all.pixels = std::uint32_t(pixels);
        all.first_hits = hits.view();
        all.counts = counts.view();
        for (std::uint32_t done = pass.done(); done < pass.paths && !pass.given_up();) {
            all.paths = std::min({pass.paths - done, most, countable});
            all.first_path = first_path + done;
            std::uint32_t const traced = trace_all(all, pass, to(done));
            ended(done);
            done += traced;
            pass.set_done(done);
        }
        if (!first_hits.empty() && pass.done() == pass.paths)
            std::ranges::copy(download(hits), first_hits.begin());
        PathCounts sum;
        for (PathCounts const& c : download(counts)) sum += c;
        return sum;
    }

    /// Returns the number of paths of each pixel: fewer than asked for if the pass is given up.
    template <class Samples>
    std::uint32_t trace_all(PathSlots all, TiledPass const& pass, Samples const& to)
    {
        constexpr int kSteps = 8; // between looks at how far it is
        constexpr std::uint32_t kFew = 16384;
        auto const n = std::uint32_t(all.slots.count), few = std::min(n / 8, kFew);
        WorldView const& world = all.steps.world;
        KernelRays const rays = bvh_->rays();
        bool const panes = has_panes(world_);
        auto const trace = [&] {
            if (panes)
                launch(S, "rays of paths", 2 * std::size_t(n),
                       RaysOfPaths<true>{world, rays, all.queries, all.shadows, all.hits, all.left});
            else
                launch(S, "rays of paths", 2 * std::size_t(n),
                       RaysOfPaths<false>{world, rays, all.queries, all.shadows, all.hits, all.left});
        };
        auto const scatter = [&] {
            launch(S, "scatter paths", n, ScatterPaths<Samples>{{all, to}});
            if (after_step) after_step(memory_);
        };
        memory_.take_none();
        launch(S, "start paths", n, StartPaths{all});
        for (;;) {
            std::uint32_t const taken = memory_.taken();
            if (pass.given_up())
                all.paths = std::min(all.paths, taken / all.pixels + (taken % all.pixels != 0 ? 1 : 0));
            std::uint32_t const end = all.pixels * all.paths, idle = taken > end ? taken - end : 0;
            if (idle == n) return all.paths;
            if (n - idle <= few) {
                if (panes)
                    launch(S, "finish paths", n, FinishPaths<Samples, true>{{all, to}, rays});
                else
                    launch(S, "finish paths", n, FinishPaths<Samples, false>{{all, to}, rays});
                scatter();
                continue;
            }
            for (int k = 0; k < kSteps; ++k) {
                trace();
                scatter();
            }
        }
    }

    static constexpr std::size_t kMostSlots = std::size_t(1) << 20; ///< enough to fill a device

    World const& world_;
    WorldOn<S> there_;
    std::size_t first_moving_;
    Report& report_;
    StopRequest const* stop_;
    std::optional<WorldBvh<S>> bvh_;
    std::vector<PathSample> on_host_; ///< kept, as fresh memory would take longer than the copy
    PathMemory<S> memory_;
    SumsOn<S> sums_;
};

} // namespace gi
