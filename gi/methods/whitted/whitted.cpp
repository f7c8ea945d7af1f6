#include "gi/methods/whitted/whitted.h"

#include "gi/core/step.h"
#include "gi/light_paths/lamp_caustics.h"
#include "gi/render/flush_denormals.h"
#include "gi/render/tiled_pass.h"
#include "gi/scene/model/plan.h"

#include <tbb/combinable.h>

namespace gi {

TreeRenderer::TreeRenderer(World const& world, RenderSettings const& settings, std::size_t first_moving,
                           Report& report, StopRequest const* stop)
    : world_(world), settings_(settings), first_moving_(first_moving), report_(report)
{
    build(stop);
}

void TreeRenderer::build(StopRequest const* stop)
{
    StageTimer const timer(report_, "build (Embree BVH)");
    visibility_ = std::make_unique<ExactVisibility>(world_, plan_scene(world_).alpha_tests, settings_.threads,
                                                    first_moving_, stop_of_building(stop));
}

void TreeRenderer::changed(Changes const& changes)
{
    prepared_.reset();
    // Rays with coverage tests use the materials from when the BVH was built.
    if (changes.coverage || (changes.materials && plan_scene(world_).alpha_tests)) return build(nullptr);
    if (changes.geometry) visibility_->moved(world_);
}

void TreeRenderer::begin(std::uint32_t index, std::span<FrameView const> views, StopRequest const* stop)
{
    light_of_prepared_ = prepare(index, views, stop);
    prepared_ = index;
}

void TreeRenderer::pass(std::uint32_t index, std::span<FrameView const> views, std::span<Accumulator> sums,
                        MotionVectors* motion, StopRequest const* stop)
{
    if (prepared_ != index) begin(index, views, stop);
    prepared_.reset();
    SurfaceLight const* const light = light_of_prepared_;
    StageTimer const timer(report_, "ray trees");
    for (std::size_t k = 0; k < views.size(); ++k)
        trace_view(views[k], index, light, sums[k],
                   motion == nullptr ? std::span<FirstHit>{} : motion->first_hits(k), stop);
}

void TreeRenderer::trace_view(FrameView const& v, std::uint32_t index, SurfaceLight const* light,
                              Accumulator& sums, std::span<FirstHit> first_hits, StopRequest const* stop)
{
    TreeTracer const tracer{.world = view(world_),
                            .visibility = *visibility_,
                            .camera = camera_rays(v.camera, v.width, v.height, world_.origin),
                            .settings = settings_.of<WhittedSettings>(),
                            .seed = settings_.seed,
                            .filter = settings_.filter,
                            .width = v.width,
                            .bounces = settings_.bounces,
                            .light = light,
                            .panes_by_photons = photons_pass_panes()};
    tbb::combinable<TreeCounts> counts;
    PassStop const given_up(stop, PassStop::of(sums.paths));
    TiledPass pass(sums, 1, given_up);
    pass.run([&](TiledPass::Tile const& tile) { // whose trees advance together
        FlushDenormals const guard;
        tile.for_paths([&](std::uint32_t) {
            std::vector<glm::ivec2> pixels;
            for (int y = tile.top; y < tile.bottom; ++y)
                for (int x = tile.left; x < tile.right; ++x) pixels.emplace_back(x, y);
            std::vector<PathSample> samples(pixels.size());
            std::vector<FirstHit> first(pixels.size());
            tracer.trace(pixels, index, samples, first, counts.local());
            for (std::size_t k = 0; k < pixels.size(); ++k) {
                std::size_t const pixel =
                    std::size_t(pixels[k].y) * std::size_t(v.width) + std::size_t(pixels[k].x);
                sums.add(pixel, samples[k], sums.paths);
                if (!first_hits.empty()) first_hits[pixel] = first[k];
            }
        });
    });
    trees_ += double(v.width) * double(v.height);
    counts.combine_each([&](TreeCounts const& c) {
        sums.counts += c.paths;
        work_.cut_rays += c.cut_rays;
        work_.cut_weight += c.cut_weight;
        work_.paths += c.paths;
        rays_ += double(c.paths.nearest_rays + c.paths.shadow_rays);
    });
    pass.end();
}

void TreeRenderer::report_work()
{
    report_.count("closest-hit rays", double(work_.paths.nearest_rays));
    report_.count("shadow rays", double(work_.paths.shadow_rays));
    report_.lose("rays cut by the recursion limit or the cut-off weight", work_.cut_rays);
    if (work_.cut_rays > 0)
        report_.count("their mean share of a picture's light, at most", work_.cut_weight / trees_);
    work_ = {};
    trees_ = 0;
}

std::string TreeRenderer::options() const
{
    return as_options(whitted_options(), settings_, {"recursion", "cutoff", "shadow-rays"});
}

RenderResult render_whitted(World const& world, Camera const& camera, RenderSettings const& settings,
                            StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    lose_lamp_caustics(world, report);
    return render_passes("whitted", start_passes<TreeRenderer>, world, camera, settings, stop, progress, report);
}

std::unique_ptr<FrameRenderer> start_whitted_frames(MovingWorld const& world, Camera const&,
                                                    RenderSettings const& settings, Report& report)
{
    return start_pass_frames(start_passes<TreeRenderer>, world, settings, report);
}

} // namespace gi
