#include "gi/reference/reference.h"

#include "gi/reference/accumulator.h"
#include "gi/reference/fingerprint.h"
#include "gi/scene/plan.h"

#include <algorithm>
#include <chrono>
#include <pmmintrin.h>
#include <tbb/combinable.h>
#include <tbb/parallel_for.h>
#include <tbb/task_arena.h>

namespace gi {
namespace {

using Clock = std::chrono::steady_clock;

double seconds_since(Clock::time_point start)
{
    return std::chrono::duration<double>(Clock::now() - start).count();
}

/// Denormals cost hundreds of cycles each and carry no light.
class FlushDenormals {
public:
    FlushDenormals() : saved_(_mm_getcsr()) { _mm_setcsr(saved_ | _MM_FLUSH_ZERO_ON | _MM_DENORMALS_ZERO_ON); }
    ~FlushDenormals() { _mm_setcsr(saved_); }
    FlushDenormals(FlushDenormals const&) = delete;
    FlushDenormals& operator=(FlushDenormals const&) = delete;

private:
    unsigned saved_;
};

void trace_pass(PathTracer<ExactVisibility> const& tracer, Accumulator& sums, std::uint32_t paths)
{
    tbb::combinable<PathCounts> counts;
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
                for (int x = left; x < right; ++x) batch.push_back(tracer.start(x, y, sums.paths + i));
            tracer.trace(batch, local);
            auto next = batch.begin();
            for (int y = top; y < bottom; ++y)
                for (int x = left; x < right; ++x)
                    sums.pixels[std::size_t(y) * std::size_t(sums.width) + std::size_t(x)].add((next++)->sample);
        }
    });
    sums.paths += paths;
    sums.counts += counts.combine([](PathCounts a, PathCounts const& b) { return a += b; });
}

/// How many paths the next pass takes: short enough to answer Ctrl-C, the budget and the progress bar, long enough
/// that the overhead of a pass does not show.
std::uint32_t next_pass(RenderSettings const& s, std::uint32_t done, double seconds_per_path, double spent)
{
    constexpr double kPassSeconds = 0.5;
    double paths = seconds_per_path > 0 ? kPassSeconds / seconds_per_path : 1;
    if (s.budget_s > 0 && seconds_per_path > 0) paths = std::min(paths, (s.budget_s - spent) / seconds_per_path);
    if (s.until_relmse > 0) paths = std::min(paths, std::max(16.0, 0.25 * double(done)));
    return std::uint32_t(std::clamp(paths, 1.0, double(s.paths - done)));
}

} // namespace

RenderResult render_reference(World const& world, Camera const& camera, RenderSettings const& settings,
                              StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    constexpr double kCheckpointSeconds = 30;
    constexpr std::uint32_t kPathsForVariance = 16;

    ScenePlan const plan = plan_scene(world);
    std::unique_ptr<ExactVisibility> visibility;
    {
        StageTimer const timer(report, "build (Embree BVH)");
        visibility = std::make_unique<ExactVisibility>(world, plan.alpha_tests, settings.threads);
    }
    PathTracer<ExactVisibility> const tracer{
        view(world),      *visibility,   camera_rays(camera, settings.width, settings.height, world.origin),
        settings.bounces, settings.seed, settings.filter,
        settings.width};

    Accumulator sums(settings.width, settings.height);
    bool const keeps_state = !settings.checkpoint.empty();
    std::uint64_t const print = keeps_state ? fingerprint(world, camera, settings) : 0;
    if (settings.resume) load_checkpoint(settings.checkpoint, sums, print);
    std::uint32_t const resumed = sums.paths;

    tbb::task_arena arena(settings.threads > 0 ? settings.threads : tbb::task_arena::automatic);
    double const earlier = sums.seconds;
    RenderResult result;
    auto const start = Clock::now();
    auto saved = start;
    double relmse = resumed > 0 ? sums.relative_mse() : 0;
    double per_path = 0;
    while (true) {
        double const spent = seconds_since(start);
        if (sums.paths >= settings.paths) break;
        if (sums.paths > 0 && stop.requested()) {
            result.end = RenderEnd::interrupted;
            break;
        }
        if (settings.budget_s > 0 && sums.paths > resumed && spent + per_path > settings.budget_s) {
            result.end = RenderEnd::budget;
            break;
        }
        if (settings.until_relmse > 0 && sums.paths >= kPathsForVariance && relmse < settings.until_relmse) {
            result.end = RenderEnd::error_target;
            break;
        }
        arena.execute([&] { trace_pass(tracer, sums, next_pass(settings, sums.paths, per_path, spent)); });
        double const now = seconds_since(start);
        sums.seconds = earlier + now;
        per_path = now / double(sums.paths - resumed);
        relmse = sums.relative_mse();
        if (progress) {
            double fraction = double(sums.paths) / double(settings.paths);
            if (settings.budget_s > 0) fraction = std::max(fraction, now / settings.budget_s);
            if (settings.until_relmse > 0 && relmse > 0)
                fraction = std::max(fraction, settings.until_relmse / relmse);
            progress({std::min(1.0, fraction), sums.paths, relmse});
        }
        if (keeps_state && seconds_since(saved) > kCheckpointSeconds) {
            save_checkpoint(settings.checkpoint, sums, print);
            saved = Clock::now();
        }
    }
    result.resumable = keeps_state && (result.end == RenderEnd::interrupted ||
                                       (settings.resume && result.end != RenderEnd::paths));
    if (result.resumable) save_checkpoint(settings.checkpoint, sums, print);

    PathCounts const& total = sums.counts;
    result.seconds = sums.seconds;
    report.add_time("trace", seconds_since(start));
    report.count("closest-hit rays", double(total.nearest_rays));
    report.count("shadow rays", double(total.shadow_rays));
    report.lose("paths cut at 1024 surfaces", total.cut_paths);
    report.lose("path terms that were not finite, dropped", total.invalid_paths);
    result.rays = double(total.nearest_rays + total.shadow_rays);
    result.paths = sums.paths;
    result.relmse = relmse;
    result.picture = sums.picture(world.origin);
    return result;
}

} // namespace gi
