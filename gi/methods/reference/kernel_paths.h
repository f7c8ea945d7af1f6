#pragma once
// Where the reference traces its paths by kernels: the world and its BVH lie in a memory space, and only samples
// of paths are copied back. Same functions as EmbreePaths.

#include "gi/kernel/host_copy.h"
#include "gi/kernel/launch.h"
#include "gi/methods/reference/path_kernel.h"
#include "gi/render/render_settings.h"
#include "gi/render/tiled_pass.h"
#include "gi/scene/model/plan.h"
#include "gi/scene/model/world_on.h"

#include <algorithm>
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
            bvh_.emplace(there_.view(), plan_scene(world_).alpha_tests, first_moving_, stop_);
        }
        return there_.view();
    }

    template <class Use>
    PathCounts trace(PathSteps const& steps, TiledPass& pass, std::uint32_t first_path,
                     std::span<FirstHit> first_hits, Use const& use)
    {
        constexpr std::size_t kMostItems = std::size_t(1) << 20; // of a launch; limits the memory of samples
        std::size_t const pixels = pass.pixels();
        std::uint32_t const paths = pass.paths;
        auto const together = std::uint32_t(std::max<std::size_t>(1, kMostItems / pixels));
        Buffer<PathCounts, S> counts = upload<S>(std::vector<PathCounts>(1));
        Buffer<FirstHit, S> hits(first_hits.empty() ? 0 : pixels);
        for (std::uint32_t done = 0; done < paths;) {
            std::uint32_t const now = std::min(paths - done, together);
            std::size_t const items = pixels * now;
            if (samples_.size() != items) samples_ = Buffer<PathSample, S>(items);
            launch(S, "trace paths of the reference", items,
                   TraceReference{steps, bvh_->rays(), std::uint32_t(pixels), first_path + done, samples_.view(),
                                  hits.view(), counts.view()});
            std::span<PathSample const> const found = on_host_.of(samples_);
            tbb::parallel_for(std::size_t(0), pixels, [&](std::size_t p) {
                for (std::uint32_t k = 0; k < now; ++k) use(p, done + k, found[k * pixels + p]);
            });
            done += now;
        }
        pass.all_done();
        if (!first_hits.empty()) std::ranges::copy(download(hits), first_hits.begin());
        return download(counts)[0];
    }

private:
    World const& world_;
    WorldOn<S> there_;
    std::size_t first_moving_;
    Report& report_;
    StopRequest const* stop_;
    std::optional<WorldBvh<S>> bvh_;
    Buffer<PathSample, S> samples_;
    HostCopy<PathSample, S> on_host_;
};

} // namespace gi
