#include "gi/slhb/slhb.h"

#include "gi/slhb/kernel_render.h"
#include "gi/slhb/primary_map.h"
#include "gi/slhb/settings.h"
#include "gi/slhb/shared_endings.h"
#include "gi/transport/fingerprint.h"
#include "gi/transport/flush_denormals.h"
#include "gi/transport/pass_loop.h"
#include "gi/transport/sampling.h"

#include <memory>
#include <optional>
#include <tbb/combinable.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Pixels whose paths advance together on one thread.
constexpr std::size_t kBlock = 4096;

struct WorkCounts {
    PathCounts paths;
    SlhbCounts slhb;
};

/// Primary hits through exact rays, for the cameras that have no raster.
void exact_hits(ExactVisibility const& exact, CameraRays const& camera, RenderSettings const& s,
                std::uint32_t pass, std::size_t first, std::size_t last, std::vector<PathStart>& out)
{
    std::vector<RayQuery> rays;
    out.clear();
    for (std::size_t p = first; p < last; ++p) {
        RqmcStream const stream{std::uint32_t(mix_bits(s.seed + p)), pass};
        vec2 const place{float(p % std::size_t(s.width)) + 0.5f, float(p / std::size_t(s.width)) + 0.5f};
        Ray const ray = camera.through(place + filter_offset(s.filter, stream.sample2(0)));
        out.push_back({std::uint32_t(p), kNoPrimitive, ray});
        rays.push_back({.ray = ray, .seed = stream.seed + pass});
    }
    std::vector<Hit> hits(rays.size());
    exact.nearest(rays, hits);
    for (std::size_t k = 0; k < hits.size(); ++k) out[k].triangle = hits[k].triangle;
}

} // namespace

RenderResult render_slhb(World const& world, Camera const& camera, RenderSettings const& settings,
                         StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    if (settings.slhb.space == Space::device) {
        check_device(settings.slhb);
        return render_by_kernels(Space::device, world, camera, settings, stop, progress, report);
    }
    std::optional<tbb::global_control> limit; // also of what is built before the passes
    if (settings.threads > 0)
        limit.emplace(tbb::global_control::max_allowed_parallelism, std::size_t(settings.threads));
    PassLoop loop(settings, stop, progress, report);
    ScenePlan const plan = plan_scene(world);
    TriangleSoup const soup = make_soup(world);
    SlhbSettings const slhb = choose_settings(settings, world, soup);
    CameraRays const rays = camera_rays(camera, settings.width, settings.height, world.origin);
    std::unique_ptr<ExactVisibility> exact;
    if (needs_exact_rays(world, camera.orthographic)) {
        StageTimer const timer(report, "build (Embree BVH)");
        exact = std::make_unique<ExactVisibility>(world, plan.alpha_tests, settings.threads);
    }
    std::unique_ptr<ExactVisibility> judge;
    if (slhb.exact.any()) judge = std::make_unique<ExactVisibility>(world, plan.alpha_tests, settings.threads);
    CutOuts const cut_outs(world);
    constexpr int kUnused = 2; // texels: choosing among axes and lamps takes their grids alone
    auto const texels = [](bool unused, int n) { return std::uint32_t(unused ? kUnused : n); };
    AxisSet axes({world.bounds, soup, cut_outs, texels(slhb.exact.queries, slhb.resolution),
                  std::uint32_t(slhb.most_layers), slhb.packed, settings.seed});
    if (slhb.schedule == Schedule::stored) {
        StageTimer const timer(report, "build (hit buffers)");
        axes.store(make_directions(slhb.directions));
    }
    Lamps lamps(world, soup, cut_outs, std::uint32_t(slhb.lamps),
                texels(slhb.exact.shadows, slhb.shadow_resolution), settings.seed);
    PrimaryMap primary(world, soup, cut_outs, rays, settings);
    SlhbTracer const tracer(world, rays, settings, slhb);

    // Surfaces that a path may leave along an axis: the last one only where the sky or exact rays count.
    bool const to_the_end = exact != nullptr || !view(world).environment_radiance.empty();
    bool const walks = settings.bounces > 0 || to_the_end;
    auto const sequences =
        std::uint32_t(std::clamp(settings.bounces + (to_the_end ? 1 : 0), 1, int(AxisSet::kSequences)));
    WorkCounts total;
    SharedEndings shared;
    std::vector<PathSample> samples;
    std::vector<Ending> endings;
    auto const pass = [&](Accumulator& sums) {
        std::uint32_t const index = sums.paths;
        {
            StageTimer const timer(report, "hit buffers of a pass");
            if (walks && slhb.schedule != Schedule::stored)
                axes.refresh(sequences, std::uint32_t(slhb.axes), std::uint32_t(slhb.fresh_axes), index);
        }
        {
            StageTimer const timer(report, "shadow maps");
            lamps.refresh(index);
        }
        if (!camera.orthographic) {
            StageTimer const timer(report, "G-buffer");
            primary.refresh(index);
        }
        StageTimer const timer(report, "paths");
        std::uint32_t const gathered = slhb.gather && walks
                                           ? index / std::uint32_t(slhb.interleave * slhb.interleave) %
                                                 std::uint32_t(axes.first_bounce_axes())
                                           : kNoPrimitive;
        SlhbTracer::Pass const now{axes, lamps, exact.get(), index, gathered, judge.get()};
        std::size_t const pixels = sums.pixels.size();
        // Where many paths end on few layers, what a layer sends back is computed once.
        bool const sharing =
            settings.bounces > 0 && slhb.cone == 0 && !slhb.exact.queries && axes.first_bounce_layers() < pixels;
        shared.start(sharing ? axes.first_bounce_layers() : 0);
        samples.resize(pixels);
        endings.resize(sharing ? pixels : 0);
        tbb::combinable<WorkCounts> counts;
        auto const in_blocks = [&](std::size_t n, auto const& work) {
            tbb::parallel_for(std::size_t(0), (n + kBlock - 1) / kBlock, [&](std::size_t block) {
                FlushDenormals const guard;
                work(block * kBlock, std::min(n, (block + 1) * kBlock), counts.local());
            });
        };
        in_blocks(pixels, [&](std::size_t first, std::size_t last, WorkCounts& local) {
            thread_local std::vector<PathStart> starts;
            if (camera.orthographic)
                exact_hits(*exact, rays, settings, index, first, last, starts);
            else
                primary.hits(first, last, starts);
            std::span const block(samples.data() + first, last - first);
            std::span const ends = sharing ? std::span(endings.data() + first, last - first) : std::span<Ending>();
            tracer.trace(now, starts, block, ends, local.paths, local.slhb);
            if (sharing) shared.note(ends, std::uint32_t(first));
        });
        shared.collect(endings, axes.pool());
        in_blocks(shared.starts().size(), [&](std::size_t first, std::size_t last, WorkCounts& local) {
            thread_local std::vector<PathSample> sent;
            sent.resize(last - first);
            tracer.trace(now, std::span(shared.starts()).subspan(first, last - first), sent, {}, local.paths,
                         local.slhb);
            shared.keep(first, sent);
        });
        in_blocks(pixels, [&](std::size_t first, std::size_t last, WorkCounts&) {
            for (std::size_t p = first; p < last; ++p) {
                if (sharing && endings[p].layer != kNoLayerHit)
                    samples[p].radiance[2] += endings[p].throughput * shared.radiance(endings[p]);
                sums.pixels[p].add(samples[p]);
            }
        });
        counts.combine_each([&](WorkCounts const& c) {
            sums.counts += c.paths;
            total.slhb.queries += c.slhb.queries;
            total.slhb.exact_rays += c.slhb.exact_rays;
            total.slhb.shadow_lookups += c.slhb.shadow_lookups;
        });
        ++sums.paths;
    };
    RenderSettings chosen = settings;
    chosen.slhb = slhb;
    std::uint64_t const print = loop.keeps_state() ? fingerprint(world, camera, chosen, "slhb") : 0;
    RenderResult result = loop.run(print, [&](Accumulator& sums, std::uint32_t paths) {
        for (std::uint32_t i = 0; i < paths; ++i) pass(sums);
    });
    report.count("hit-buffer queries", double(total.slhb.queries));
    report.count("shadow-map look-ups", double(total.slhb.shadow_lookups));
    report.count("exact rays", double(total.slhb.exact_rays));
    report.count("layers shaded for several paths", double(shared.shaded()));
    report.count("axes built", double(axes.built()));
    report.count("layers per texel, mean", axes.built() > 0 ? double(axes.layers()) / double(axes.built()) /
                                                                  (double(slhb.resolution) * slhb.resolution)
                                                            : 0);
    report.count("shadow maps built", double(lamps.maps_built()));
    report.lose("layers beyond the limit of a texel", axes.lost());
    result.rays = double(total.slhb.queries + total.slhb.shadow_lookups + total.slhb.exact_rays);
    result.options = as_options(slhb);
    result.picture = loop.sums().picture(world.origin);
    return result;
}

} // namespace gi
