#include "gi/slhb/kernel_render.h"

#include "gi/base/device.h"
#include "gi/raster/draw_nearest.h"
#include "gi/scene/world_on.h"
#include "gi/slhb/build_hit_buffer.h"
#include "gi/slhb/lamps.h"
#include "gi/slhb/path_kernel.h"
#include "gi/slhb/primary_map.h"
#include "gi/slhb/settings.h"
#include "gi/transport/fingerprint.h"
#include "gi/transport/pass_loop.h"
#include "gi/transport/pass_samples.h"

#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// What kernels read of a world, and what they make of it in every pass.
template <Space S>
class KernelScene {
public:
    KernelScene(World const& world, TriangleSoup const& soup, CutOuts const& cut_outs, SlhbSettings const& slhb)
        : world_(world), soup_(soup), marked_(upload<S>(cut_outs.marked())), slhb_(slhb)
    {
    }

    void build_axis(std::size_t a, RasterGrid const& grid, std::uint32_t seed)
    {
        if (axes_.size() <= a) axes_.resize(a + 1);
        auto const most = std::uint32_t(slhb_.most_layers);
        with_cut_outs(seed,
                      [&](auto const& keep) { axes_[a] = build_hit_buffer<S>(soup_.view(), grid, most, keep); });
        lost_ += axes_[a].lost;
        layers_ += axes_[a].layers.size();
    }
    void draw_lamps(std::vector<Lamp> const& lamps, std::uint32_t seed)
    {
        std::vector<LampView> views;
        faces_.clear();
        for (Lamp const& lamp : lamps) {
            LampView v;
            v.choice = lamp.choice;
            v.u = lamp.u;
            v.shadow.parallel = lamp.view.parallel;
            v.shadow.grid = lamp.shadow.grid;
            for (std::size_t f = 0; f < 6; ++f) {
                v.shadow.faces[f] = lamp.shadow.faces[f];
                bool const empty = lamp.view.parallel ? f > 0 : sees_only_dark(lamp.view, lamp.shadow.faces[f]);
                if (empty) continue;
                if (lamp.view.parallel)
                    faces_.push_back(draw(lamp.shadow.grid, seed));
                else
                    faces_.push_back(draw(lamp.shadow.faces[f], seed));
                v.shadow.maps[f] = std::as_const(faces_.back()).view().data;
            }
            views.push_back(v);
        }
        lamps_ = upload<S>(views);
    }
    void draw_primary(PerspectiveGrid const& grid, std::uint32_t seed) { primary_ = draw(grid, seed); }

    /// @param paths  all that does not lie in the space; the rest is filled in
    std::vector<PathSample> trace(TracePaths paths, AxisSet const& axes, AliasTableView chances)
    {
        std::vector<AxisView> views;
        for (HitBufferOn<S> const& b : axes_) views.push_back({{b.view(), {}}});
        Buffer<AxisView, S> const there = upload<S>(views);
        Buffer<FewAxes, S> const few = upload<S>(axes.few());
        if (tables_.size() != axes.tables().entries.size()) { // of the stored schedule, once
            tables_ = upload<S>(axes.tables().entries);
            directions_ = upload<S>(axes.tables().axes);
            solid_angles_ = upload<S>(axes.tables().solid_angles);
        }
        Buffer<AliasEntry, S> const lamp_chances =
            upload<S>(std::vector<AliasEntry>(chances.entries.begin(), chances.entries.end()));
        Buffer<PathKernelCounts, S> counts = upload<S>(std::vector<PathKernelCounts>(1));
        std::size_t const pixels = primary_.size();
        Buffer<PathSample, S> samples(pixels);
        paths.world = world_.view();
        paths.primary = std::as_const(primary_).view();
        paths.axes = there.view();
        paths.choice = {few.view(),
                        {std::as_const(tables_).view(), std::as_const(directions_).view(),
                         std::as_const(solid_angles_).view(), axes.tables().bins_across}};
        paths.lamps = std::as_const(lamps_).view();
        paths.chances = {lamp_chances.view()};
        paths.samples = samples.view();
        paths.counts = counts.view();
        launch(S, "trace paths", pixels, paths);
        PathKernelCounts const done = download(counts)[0];
        counts_.queries += done.queries;
        counts_.shadow_lookups += done.shadow_lookups;
        counts_.narrow_ends += done.narrow_ends;
        pass_counts_ = done;
        return download(samples);
    }
    PathKernelCounts const& counts() const { return counts_; }
    PathKernelCounts const& last_pass() const { return pass_counts_; }
    std::uint64_t lost() const { return lost_; }
    std::uint64_t layers() const { return layers_; }

private:
    template <class Work>
    void with_cut_outs(std::uint32_t seed, Work const& work) const
    {
        if (marked_.size() == 0)
            work(KeepAll{});
        else
            work(KeepUncut{world_.view(), marked_.view(), seed});
    }
    template <class Grid>
    Buffer<NearestTexel, S> draw(Grid const& grid, std::uint32_t seed) const
    {
        Buffer<NearestTexel, S> map;
        with_cut_outs(seed, [&](auto const& keep) { map = draw_nearest<S>(soup_.view(), grid, keep); });
        return map;
    }

    WorldOn<S> world_;
    SoupOn<S> soup_;
    Buffer<std::uint8_t, S> marked_;
    SlhbSettings const& slhb_;
    std::vector<HitBufferOn<S>> axes_;
    std::vector<Buffer<NearestTexel, S>> faces_; ///< of all lamps
    Buffer<LampView, S> lamps_;
    Buffer<NearestTexel, S> primary_;
    Buffer<AliasEntry, S> tables_;
    Buffer<vec3, S> directions_;
    Buffer<float, S> solid_angles_;
    PathKernelCounts counts_, pass_counts_;
    std::uint64_t lost_ = 0, layers_ = 0;
};

void check_kernels_can(Camera const& camera, SlhbSettings const& s)
{
    char const* const suggestion = "leave it out, or render with --device cpu";
    if (camera.orthographic)
        throw InputError("--device cuda with an orthographic camera",
                         "what it sees first takes exact rays, which the device lacks",
                         "choose a perspective camera, or --device cpu");
    if (s.cone > 0) throw InputError("--device cuda with --cone", "its kernels know one column only", suggestion);
    if (s.packed)
        throw InputError("--device cuda with --packed", "its kernels read plain layers only", suggestion);
    if (s.interleave > 1)
        throw InputError("--device cuda with --interleave", "its kernels take indirect light in every pixel",
                         suggestion);
    if (s.fresh_lamps > 0)
        throw InputError("--device cuda with --fresh-lamps", "its shadow maps are drawn anew in every pass",
                         suggestion);
    if (s.gather) throw InputError("--device cuda with --gather", "its kernels choose axes by chance", suggestion);
}

template <Space S>
RenderResult render(World const& world, Camera const& camera, RenderSettings const& settings,
                    StopRequest const& stop, RenderProgress const& progress, Report& report)
{
    PassLoop loop(settings, stop, progress, report);
    TriangleSoup const soup = make_soup(world);
    SlhbSettings slhb = choose_settings(settings, world, soup);
    slhb.interleave = 1; // whatever the budget
    CameraRays const rays = camera_rays(camera, settings.width, settings.height, world.origin);
    CutOuts const cut_outs(world);
    KernelScene<S> scene(world, soup, cut_outs, slhb);
    AxisSet axes({world.bounds, soup, cut_outs, std::uint32_t(slhb.resolution), std::uint32_t(slhb.most_layers),
                  false, settings.seed, [&](std::size_t a, RasterGrid const& grid, std::uint32_t seed) {
                      scene.build_axis(a, grid, seed);
                  }});
    if (slhb.schedule == Schedule::stored) {
        StageTimer const timer(report, "build (hit buffers)");
        axes.store(make_directions(slhb.directions));
    }
    LampSettings const lamp_settings{.count = std::uint32_t(slhb.lamps),
                                     .fresh = std::uint32_t(slhb.lamps),
                                     .resolution = std::uint32_t(slhb.shadow_resolution),
                                     .seed = settings.seed};
    Lamps lamps(world, world.bounds, soup, cut_outs, lamp_settings,
                [&](std::vector<Lamp> const& all, std::uint32_t seed) { scene.draw_lamps(all, seed); });

    bool const sky = !view(world).environment_radiance.empty();
    auto const sequences =
        std::uint32_t(std::clamp(settings.bounces + (sky ? 1 : 0), 1, int(AxisSet::kSequences)));
    auto const pass = [&](Accumulator& sums) {
        std::uint32_t const index = loop.first_path() + sums.paths;
        {
            StageTimer const timer(report, "hit buffers of a pass");
            if (slhb.schedule != Schedule::stored)
                axes.refresh(sequences, std::uint32_t(slhb.axes), std::uint32_t(slhb.fresh_axes), index);
        }
        {
            StageTimer const timer(report, "shadow maps");
            lamps.refresh(index);
        }
        CameraRays const eye = eye_of_pass(rays, settings.seed, index);
        TracePaths paths{};
        paths.place = place_in_pixel(settings.filter, settings.seed, index);
        {
            StageTimer const timer(report, "G-buffer");
            PerspectiveGrid const grid =
                camera_grid(eye, settings.width, settings.height, paths.place, near_plane(world.bounds));
            scene.draw_primary(grid, std::uint32_t(mix_bits(settings.seed) + index));
        }
        StageTimer const timer(report, "paths");
        paths.camera = eye;
        paths.width = std::uint32_t(settings.width);
        paths.bounces = settings.bounces;
        paths.seed = std::uint32_t(settings.seed) ^ std::uint32_t(settings.seed >> 32);
        paths.pass = index;
        std::vector<PathSample> const samples =
            scene.trace(paths, axes, lamps.fixed() ? lamps.chances() : AliasTableView{});
        tbb::parallel_for(std::size_t(0), samples.size(),
                          [&](std::size_t p) { sums.add(p, samples[p], sums.paths); });
        sums.counts.cut_paths += scene.last_pass().cut_paths;
        sums.counts.invalid_paths += scene.last_pass().invalid_paths;
        ++sums.paths;
    };
    RenderSettings chosen = settings;
    chosen.slhb = slhb;
    std::uint64_t const print = loop.keeps_state() ? fingerprint(world, camera, chosen, "slhb by kernels") : 0;
    RenderResult result = loop.run(print, [&](Accumulator& sums, std::uint32_t paths) {
        for (std::uint32_t i = 0; i < paths; ++i) pass(sums);
    });
    PathKernelCounts const& done = scene.counts();
    report.count("hit-buffer queries", double(done.queries));
    report.count("shadow-map look-ups", double(done.shadow_lookups));
    report.count("axes built", double(axes.built()));
    report.count("layers per texel, mean", axes.built() > 0 ? double(scene.layers()) / double(axes.built()) /
                                                                  (double(slhb.resolution) * slhb.resolution)
                                                            : 0);
    report.count("shadow maps built", double(lamps.maps_built()));
    report.lose("layers beyond the limit of a texel", scene.lost());
    report.lose("paths that ended at a mirror, glass or narrow lobe, as the kernels have no exact rays",
                done.narrow_ends);
    result.rays = double(done.queries + done.shadow_lookups);
    result.options = as_options(slhb);
    result.picture = loop.sums().picture(world);
    return result;
}

} // namespace

void check_device(SlhbSettings const& settings)
{
    if (settings.space == Space::host) return;
    if (!kCudaBuild)
        throw InputError("--device cuda cannot be used", "this program was built without CUDA",
                         "build the cuda preset, or render with --device cpu");
    if (!device_present())
        throw InputError("--device cuda cannot be used", "no CUDA device is present",
                         "run on a machine with one and its driver, or render with --device cpu");
}

RenderResult render_by_kernels(Space space, World const& world, Camera const& camera,
                               RenderSettings const& settings, StopRequest const& stop,
                               RenderProgress const& progress, Report& report)
{
    check_kernels_can(camera, settings.slhb);
    auto const& run = space == Space::host ? render<Space::host> : render<Space::device>;
    return run(world, camera, settings, stop, progress, report);
}

} // namespace gi
