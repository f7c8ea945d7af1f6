#include "gi/methods/vpl/renderer.h"

#include "gi/core/rqmc.h"
#include "gi/core/step.h"
#include "gi/methods/vpl/settings.h"
#include "gi/render/flush_denormals.h"
#include "gi/render/tiled_pass.h"
#include "gi/scene/model/plan.h"

namespace gi {
namespace {

/// Default distance within which virtual lights are bounded, relative to the scene's radius.
constexpr float kNear = 0.02f;

/// b of camera_paths.h, 1/m^2.
float bound_of(World const& world, VirtualLightSettings const& s)
{
    float const near_m = s.near_m > 0 ? s.near_m : kNear * world.bounds.radius();
    return near_m > 0 ? 1 / (near_m * near_m) : kInf;
}

} // namespace

VirtualLightRenderer::VirtualLightRenderer(VisibilityKind kind, World const& world, RenderSettings const& settings,
                                           std::size_t first_moving, Report& report, StopRequest const* stop)
    : kind_(kind), world_(world), settings_(settings), first_moving_(first_moving), report_(report)
{
    build(stop);
}

void VirtualLightRenderer::build(StopRequest const* stop)
{
    term_.reset();
    {
        StageTimer const timer(report_, "build (Embree BVH)");
        visibility_ = std::make_unique<ExactVisibility>(world_, plan_scene(world_).alpha_tests, settings_.threads,
                                                        first_moving_, stop_of_building(stop));
    }
    StageTimer const timer(report_, "build (visibility)");
    term_ = make_term(kind_, {world_, *visibility_, settings_, first_moving_, report_, stop});
}

void VirtualLightRenderer::changed(Changes const& changes)
{
    // Rays with coverage tests use the materials from when the BVH was built.
    if (changes.coverage || (changes.materials && plan_scene(world_).alpha_tests)) return build(nullptr);
    if (!changes.geometry) return;
    visibility_->moved(world_);
    term_->world_changed();
}

void VirtualLightRenderer::pass(std::uint32_t index, std::span<FrameView const> views, std::span<Accumulator> sums,
                                MotionVectors* motion, StopRequest const* stop)
{
    PassStop const given_up(stop, PassStop::of(sums[0].paths));
    PathCounts counts;
    std::vector<LightVertex> lights;
    {
        BuildStop const tracing(stop);
        StageTimer const timer(report_, "virtual lights");
        lights = trace_light_paths(view(world_), world_.bounds, ExactPathRays(*visibility_),
                                   {.count = std::uint32_t(settings_.of<VirtualLightSettings>().light_paths),
                                    .bounces = settings_.bounces,
                                    .seed = settings_.seed,
                                    .pass = index,
                                    .stop = &tracing},
                                   counts);
    }
    lights_ += lights.size();
    sums[0].counts += counts;
    rays_ += double(counts.nearest_rays);
    {
        StageTimer const timer(report_, "visibility of a pass");
        term_->prepare(lights, index, given_up);
    }
    StageTimer const timer(report_, "paths");
    for (std::size_t k = 0; k < views.size(); ++k)
        trace_view(views[k], index, lights, sums[k],
                   motion == nullptr ? std::span<FirstHit>{} : motion->first_hits(k), stop);
}

void VirtualLightRenderer::trace_view(FrameView const& v, std::uint32_t index, std::span<LightVertex const> lights,
                                      Accumulator& sums, std::span<FirstHit> first_hits, StopRequest const* stop)
{
    CameraPaths const paths{.world = view(world_),
                            .visibility = *visibility_,
                            .camera = camera_rays(v.camera, v.width, v.height, world_.origin),
                            .bounces = settings_.bounces,
                            .seed = settings_.seed,
                            .filter = settings_.filter,
                            .width = v.width,
                            .bound = bound_of(world_, settings_.of<VirtualLightSettings>())};
    tbb::combinable<Counts> counts;
    PassStop const given_up(stop, PassStop::of(sums.paths));
    TiledPass pass(sums, 1, given_up);
    auto const trace_tile = [&](TiledPass::Tile const& tile, Counts& local) { // its paths advance together
        thread_local std::vector<CameraSubpath> batch;
        thread_local std::vector<Receiver> receivers;
        thread_local std::vector<vec3> gathered;
        batch.clear();
        receivers.clear();
        for (int y = tile.top; y < tile.bottom; ++y)
            for (int x = tile.left; x < tile.right; ++x) batch.push_back(paths.start(x, y, index));
        paths.trace(batch, receivers, local.paths);
        gathered.assign(receivers.size(), vec3{0});
        std::uint32_t const seed =
            hash_words(hash_words(std::uint32_t(settings_.seed), std::uint32_t(tile.index)), index);
        gather({receivers, seed}, lights, *term_, paths.bound, given_up, gathered, local.paths, local.gather);
        for (std::size_t k = 0; k < receivers.size(); ++k)
            layer_of(batch[receivers[k].path].sample, 2) += gathered[k];
        auto next = batch.begin();
        for (int y = tile.top; y < tile.bottom; ++y)
            for (int x = tile.left; x < tile.right; ++x, ++next) {
                std::size_t const pixel = std::size_t(y) * std::size_t(v.width) + std::size_t(x);
                sums.add(pixel, next->sample, sums.paths);
                if (!first_hits.empty()) first_hits[pixel] = next->first;
            }
    };
    pass.run([&](TiledPass::Tile const& tile) {
        FlushDenormals const guard;
        tile.for_paths([&](std::uint32_t) { trace_tile(tile, counts.local()); });
    });
    Counts const all = counts.combine([](Counts a, Counts const& b) {
        a.paths += b.paths;
        a.gather += b.gather;
        return a;
    });
    sums.counts += all.paths;
    gathered_ += all.gather;
    rays_ += double(all.paths.nearest_rays + all.paths.shadow_rays);
    pass.end();
}

void VirtualLightRenderer::report_work()
{
    report_.count("virtual lights", double(lights_));
    report_.count("connections to virtual lights", double(gathered_.connections));
    report_.count("connections bounded, the rest computed by camera paths", double(gathered_.bounded));
    term_->report_work(report_);
}

} // namespace gi
