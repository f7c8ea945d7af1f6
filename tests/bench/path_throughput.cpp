// How much of the time of the reference path tracer is not Embree: the same rays, once traced by the path tracer
// and once replayed in a bare loop, alternating in one process on one thread. Prints medians over the rounds and
// their ratio.
//   bench_path_throughput [SCENE...]      default: boxes of 1M triangles, atrium, cornell

#include "gi/base/report.h"
#include "gi/reference/path_tracer.h"
#include "gi/scene/generate.h"
#include "gi/scene/load.h"
#include "gi/scene/plan.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <numeric>

namespace {

using namespace gi;

struct RecordedRay {
    vec3 origin, direction;
    float distance; ///< < 0: nearest hit wanted
    std::uint32_t seed;
};

struct RecordingVisibility {
    ExactVisibility const& exact;
    std::vector<RecordedRay>& rays;

    Hit nearest(vec3 origin, vec3 direction, std::uint32_t seed) const
    {
        rays.push_back({origin, direction, -1, seed});
        return exact.nearest(origin, direction, seed);
    }
    bool occluded(vec3 origin, vec3 direction, float distance, std::uint32_t seed) const
    {
        rays.push_back({origin, direction, distance, seed});
        return exact.occluded(origin, direction, distance, seed);
    }
};

template <class Visibility>
double trace_all(PathTracer<Visibility> const& tracer, int size, std::uint32_t paths)
{
    constexpr int kTile = 16;
    PathCounts counts;
    double sum = 0;
    std::vector<Path> batch;
    for (int top = 0; top < size; top += kTile)
        for (int left = 0; left < size; left += kTile)
            for (std::uint32_t i = 0; i < paths; ++i) {
                batch.clear();
                for (int y = top; y < top + kTile; ++y)
                    for (int x = left; x < left + kTile; ++x) batch.push_back(tracer.start(x, y, i));
                tracer.trace(batch, counts);
                for (Path const& p : batch)
                    sum += double(p.sample.radiance[0].x + p.sample.radiance[1].x + p.sample.radiance[2].x);
            }
    return sum;
}

std::uint64_t replay(ExactVisibility const& exact, std::vector<RecordedRay> const& rays)
{
    std::uint64_t hits = 0;
    for (RecordedRay const& r : rays)
        hits += r.distance < 0 ? exact.nearest(r.origin, r.direction, r.seed).triangle != kNoTriangle
                               : exact.occluded(r.origin, r.direction, r.distance, r.seed);
    return hits;
}

template <class Work>
double seconds(Work const& work)
{
    auto const start = std::chrono::steady_clock::now();
    work();
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double median(std::vector<double> v)
{
    std::nth_element(v.begin(), v.begin() + std::ptrdiff_t(v.size() / 2), v.end());
    return v[v.size() / 2];
}

void measure(std::string const& name, Scene scene)
{
    constexpr int kSize = 96, kRounds = 9;
    constexpr std::uint32_t kPaths = 8;
    Report report;
    World const world = build_world(std::make_shared<Scene const>(std::move(scene)), std::nullopt, report);
    ExactVisibility const exact(world, plan_scene(world).alpha_tests, 1);
    CameraRays const camera = camera_rays(world.cameras.at(0), kSize, kSize, world.origin);

    std::vector<RecordedRay> rays;
    RecordingVisibility const recorder{exact, rays};
    double const expected =
        trace_all(PathTracer<RecordingVisibility>{view(world), recorder, camera, 64, 0, PixelFilter::box, kSize},
                  kSize, kPaths);
    PathTracer<ExactVisibility> const tracer{view(world), exact, camera, 64, 0, PixelFilter::box, kSize};

    std::vector<double> traced, replayed, ratios;
    std::uint64_t hits = 0;
    for (int round = 0; round < kRounds; ++round) {
        traced.push_back(seconds([&] {
            if (trace_all(tracer, kSize, kPaths) != expected) throw std::runtime_error("the two traces differ");
        }));
        replayed.push_back(seconds([&] { hits += replay(exact, rays); }));
        ratios.push_back(traced.back() / replayed.back());
    }
    double const n = double(rays.size());
    auto const [low, high] = std::minmax_element(ratios.begin(), ratios.end());
    fmt::print("{:<28} {:>9} {:>9} {:>9.3f} {:>9.3f} {:>8.3f} [{:.3f}, {:.3f}] {:>6.0f}\n", name,
               world.triangles.size(), rays.size(), n / median(traced) * 1e-6, n / median(replayed) * 1e-6,
               median(ratios), *low, *high, (median(traced) - median(replayed)) / n * 1e9);
    if (hits == 0) fmt::print("  nothing was hit\n");
}

} // namespace

int main(int argc, char** argv)
{
    fmt::print("{:<28} {:>9} {:>9} {:>9} {:>9} {:>8} {:>14} {:>8}\n", "scene", "triangles", "rays", "paths",
               "bare", "ratio", "[min, max]", "ns/ray");
    fmt::print("{:<48} {:>9} {:>9} {:>8} {:>14} {:>8}\n", "", "Mray/s", "Mray/s", "of time", "of 9 rounds",
               "more");
    if (argc == 1) {
        measure("boxes, 1M triangles", generate_boxes(1'000'000, 0));
        measure("atrium", generate_atrium({}));
        measure("cornell", generate_cornell());
    }
    for (int i = 1; i < argc; ++i) {
        Report report;
        measure(argv[i], load_scene(argv[i], report));
    }
}
