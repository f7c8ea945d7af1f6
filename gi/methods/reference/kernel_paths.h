#pragma once
// Where the reference traces its paths by kernels: the world, its BVH and the sums of a pass lie in a memory
// space. Same functions as EmbreePaths.

#include "gi/core/step.h"
#include "gi/kernel/launch.h"
#include "gi/methods/reference/path_kernel.h"
#include "gi/render/path_workers.h"
#include "gi/render/render_settings.h"
#include "gi/render/sums_on.h"
#include "gi/render/tiled_pass.h"
#include "gi/scene/model/plan.h"
#include "gi/scene/model/world_on.h"

#include <algorithm>
#include <chrono>
#include <optional>
#include <tbb/parallel_for.h>

namespace gi {

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
    }

    WorldView prepare()
    {
        if (!bvh_) {
            StageTimer const timer(report_, "build (BVH)");
            bvh_.emplace(there_.view(), plan_scene(world_).alpha_tests, first_moving_, stop_of_building(stop_));
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
        sums_.give(sums);
        return counts;
    }

private:
    /// @param most  paths of a launch
    /// @param to  (number of its first path) -> where samples go  @param ended  called with that after the launch
    template <class To, class Ended>
    PathCounts run(PathSteps const& steps, TiledPass& pass, std::uint32_t first_path,
                   std::span<FirstHit> first_hits, std::uint32_t most, To const& to, Ended const& ended)
    {
        constexpr double kLaunch_s = 0.1;
        constexpr std::size_t kCounts = 1024; // threads that add to one number wait for each other
        std::size_t const pixels = pass.pixels(), workers = path_workers(pixels);
        Buffer<PathCounts, S> counts = upload<S>(std::vector<PathCounts>(kCounts));
        Buffer<FirstHit, S> hits(first_hits.empty() ? 0 : pixels);
        for (std::uint32_t done = pass.done(); done < pass.paths && !pass.given_up();) {
            std::uint32_t const now = std::min({pass.paths - done, together_, most});
            auto const begun = std::chrono::steady_clock::now();
            launch(S, "trace paths of the reference", workers,
                   TraceReference<decltype(to(done))>{steps, bvh_->rays(), std::uint32_t(pixels),
                                                      first_path + done, now, workers, to(done), hits.view(),
                                                      counts.view()});
            std::chrono::duration<double> const took = std::chrono::steady_clock::now() - begun;
            together_ = std::uint32_t(std::clamp(now * kLaunch_s / took.count(), 1.0, 4.0 * now));
            ended(done);
            done += now;
            pass.set_done(done);
        }
        if (!first_hits.empty() && pass.done() == pass.paths)
            std::ranges::copy(download(hits), first_hits.begin());
        PathCounts all;
        for (PathCounts const& c : download(counts)) all += c;
        return all;
    }

    World const& world_;
    WorldOn<S> there_;
    std::size_t first_moving_;
    Report& report_;
    StopRequest const* stop_;
    std::optional<WorldBvh<S>> bvh_;
    std::vector<PathSample> on_host_; ///< kept, as fresh memory would take longer than the copy
    std::uint32_t together_ = 1; ///< paths of a launch: as many as take kLaunch_s, so that a stop is soon noticed
    SumsOn<S> sums_;
};

} // namespace gi
