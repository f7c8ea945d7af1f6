#pragma once
// Data that the kernels of slhb read from a world and build from it: everything is in one space, and only first
// surfaces are copied back, on request.

#include "gi/hit_buffers/directions/axis_set.h"
#include "gi/hit_buffers/build_hit_buffer.h"
#include "gi/methods/slhb/kernels/path_kernel.h"
#include "gi/hit_buffers/shadow_maps/light_points.h"
#include "gi/raster/draw_nearest.h"
#include "gi/scene/model/world_on.h"

#include <algorithm>
#include <array>
#include <optional>
#include <utility>

namespace gi {

template <Space S>
class KernelScene {
public:
    /// @param most_layers  per texel, see fill_hit_buffer
    KernelScene(World const& world, TriangleSoup const& soup, CutOuts const& cut_outs, std::uint32_t most_layers)
        : world_(world), soup_(soup), marked_(upload<S>(cut_outs.marked())), most_layers_(most_layers)
    {
    }

    /// Copies the changes. Coverage (transparency) must not have changed. @param soup  current triangles
    void update(World const& world, TriangleSoup const& soup, Changes const& changes)
    {
        world_.update(world, changes);
        if (changes.geometry) soup_.update(soup, world.static_triangles);
        if (changes.geometry && bvh_) bvh_->moved(world_.view());
    }
    bool has_rays() const { return bvh_.has_value(); }
    /// See WorldBvh. Call if has_rays().
    void test_alpha(bool alpha_tests) { bvh_->test_alpha(alpha_tests); }
    /// Builds or drops what exact rays go through. @param first_moving  index of the first dynamic triangle
    void use_rays(bool needed, bool alpha_tests, std::size_t first_moving)
    {
        bvh_.reset();
        if (needed) bvh_.emplace(world_.view(), alpha_tests, first_moving);
    }

    AxisSet::BuiltAxis build_axis(std::size_t a, RasterGrid const& grid, std::uint32_t seed)
    {
        if (axes_.size() <= a) axes_.resize(a + 1);
        with_cut_outs(seed, [&](auto const& keep) {
            axes_[a] = build_hit_buffer<S>(soup_.view(), grid, most_layers_, keep);
        });
        return {axes_[a].layers.size(), axes_[a].lost};
    }

    /// Those that are built from now on may be fewer.
    void forget_axes() { axes_.clear(); }

    void draw_light_points(LightPoints::DeviceDraw const& now)
    {
        maps_.resize(now.light_points.size());
        for (std::size_t const k : now.drawn) {
            LightPoint const& light_point = now.light_points[k];
            for (std::size_t f = 0; f < 6; ++f) {
                bool const empty = light_point.view.parallel
                                       ? int(f) >= light_point.shadow.levels
                                       : sees_only_dark(light_point.view, light_point.shadow.faces[f]);
                maps_[k][f] = empty                       ? Buffer<NearestTexel, S>()
                              : light_point.view.parallel ? draw(light_point.shadow.grids[f], now.seed)
                                                          : draw(light_point.shadow.faces[f], now.seed);
            }
        }
        std::vector<LightPointView> views(now.light_points.size());
        for (std::size_t k = 0; k < views.size(); ++k) {
            LightPoint const& light_point = now.light_points[k];
            views[k].choice = light_point.choice;
            views[k].u = light_point.u;
            ShadowMapView& shadow = views[k].shadow;
            shadow.parallel = light_point.view.parallel;
            shadow.levels = light_point.shadow.levels;
            for (std::size_t f = 0; f < 6; ++f) {
                shadow.grids[f] = light_point.shadow.grids[f];
                shadow.faces[f] = light_point.shadow.faces[f];
                shadow.maps[f] = std::as_const(maps_[k][f]).view().data;
            }
        }
        light_points_ = upload<S>(views);
    }
    void forget_light_points()
    {
        maps_.clear();
        light_points_ = {};
    }

    template <class Grid>
    Buffer<NearestTexel, S> draw(Grid const& grid, std::uint32_t seed) const
    {
        Buffer<NearestTexel, S> map;
        with_cut_outs(seed, [&](auto const& keep) { map = draw_nearest<S>(soup_.view(), grid, keep); });
        return map;
    }

    /// Sets the data shared by all paths of a pass. @param chances  of the light points; empty = equal
    void start_pass(AxisSet const& axes, AliasTableView chances)
    {
        std::vector<AxisView> views;
        std::size_t const slots = std::min(axes_.size(), axes.axes() * axes.levels()); // there may be earlier ones
        for (std::size_t k = 0; k < slots; ++k) views.push_back({{axes_[k].view(), {}}});
        axis_views_ = upload<S>(views);
        axes_of_level_ = axes.axes();
        few_ = upload<S>(axes.few());
        if (tables_.size() != axes.tables().entries.size()) { // stored schedule, once only
            tables_ = upload<S>(axes.tables().entries);
            directions_ = upload<S>(axes.tables().axes);
            solid_angles_ = upload<S>(axes.tables().solid_angles);
        }
        choice_ = {std::as_const(few_).view(), {}};
        if (!axes.takes_few())
            choice_.tables = {std::as_const(tables_).view(), std::as_const(directions_).view(),
                              std::as_const(solid_angles_).view(), axes.tables().bins_across};
        chances_ = upload<S>(std::vector<AliasEntry>(chances.entries.begin(), chances.entries.end()));
    }

    /// Traces a path a pixel. Returns a sample for each, valid until the next call.
    /// @param paths  with the host's parameters and those of the view; this function fills in the rest
    View<PathSample const> trace(PassOfPaths paths)
    {
        std::size_t const pixels = paths.primary.size();
        if (samples_.size() != pixels) samples_ = Buffer<PathSample, S>(pixels);
        constexpr std::size_t kCounts = 1024; // threads that add to one number wait for each other
        Buffer<PathKernelCounts, S> counts = upload<S>(std::vector<PathKernelCounts>(kCounts));
        paths.world = world_.view();
        paths.axes = std::as_const(axis_views_).view();
        paths.axes_of_level = axes_of_level_;
        paths.choice = choice_;
        paths.light_points = std::as_const(light_points_).view();
        paths.chances = {std::as_const(chances_).view()};
        paths.samples = samples_.view();
        paths.counts = counts.view();
        std::size_t const most = std::min(pixels, kMostOnWay);
        if (on_way_[0].size() != most || on_way_[0].has_rays() != bvh_.has_value())
            for (OnWay& w : on_way_) {
                w = {}; // first, as both together may be too much
                w = OnWay(most, bvh_.has_value());
            }
        if (std::size_t const waiting = paths.confirms ? most : 0; doubtful_.size() != waiting)
            doubtful_ = ColumnBuffer<DoubtfulLight, S>(waiting);
        if (bvh_)
            trace_all<true>(paths);
        else
            trace_all<false>(paths);
        counts_ = {};
        for (PathKernelCounts const& c : download(counts)) counts_ += c;
        return std::as_const(samples_).view();
    }

    PathKernelCounts const& counts() const { return counts_; } ///< of the last trace

private:
    /// All paths one surface further, again and again, and the last few to their ends.
    template <bool by_rays>
    void trace_all(PassOfPaths& paths)
    {
        KernelRays const rays = by_rays ? bvh_->rays() : KernelRays{};
        for (paths.first = 0; paths.first < paths.samples.size(); paths.first += kMostOnWay) {
            std::size_t const all = std::min(paths.samples.size() - paths.first, kMostOnWay);
            std::size_t const few = std::min(all / 8, kFewOnWay);
            paths.next = on_way_[0].none();
            paths.doubtful = none_doubtful();
            launch(S, "first steps of paths", all, FirstSteps<by_rays>{{paths}});
            add_doubtful_light(all, rays, paths);
            for (int now = 0; std::size_t const n = on_way_[now].count(); now = 1 - now) {
                PathsOnWay const from = paths.next;
                ColumnView<Hit> const hits = on_way_[now].hits();
                paths.next = on_way_[1 - now].none();
                paths.doubtful = none_doubtful();
                if (by_rays)
                    launch(S, "exact rays of paths", n, NearestHits{world_.view(), rays, from.queries, hits});
                if (n > few)
                    launch(S, "further steps of paths", n,
                           FurtherSteps<by_rays, false>{{paths}, from, hits, rays});
                else
                    launch(S, "last steps of paths", n, FurtherSteps<by_rays, true>{{paths}, from, hits, rays});
                if (n > few) add_doubtful_light(n, rays, paths); // the last steps add it themselves
            }
        }
    }

    DoubtfulLights none_doubtful()
    {
        if (doubtful_.size() == 0) return {};
        fill_bytes(S, doubtful_count_.view().data, 0, sizeof(std::uint32_t));
        return {doubtful_.view(), doubtful_count_.view()};
    }
    void add_doubtful_light(std::size_t paths_of_step, KernelRays const& rays, PassOfPaths const& paths)
    {
        if (paths.confirms)
            launch(S, "doubtful light", paths_of_step,
                   AddDoubtfulLight{world_.view(), rays, paths.doubtful, paths.samples});
    }

    /// Memory of paths between two surfaces.
    class OnWay {
    public:
        OnWay() = default;
        OnWay(std::size_t most, bool rays)
            : paths_(most), queries_(rays ? most : 0), hits_(rays ? most : 0), count_(1)
        {
        }
        std::size_t size() const { return paths_.size(); }
        bool has_rays() const { return queries_.size() > 0; }
        std::size_t count() const { return download(count_).front(); }
        ColumnView<Hit> hits() { return hits_.view(); }
        PathsOnWay none()
        {
            fill_bytes(S, count_.view().data, 0, sizeof(std::uint32_t));
            return {paths_.view(), queries_.view(), count_.view()};
        }

    private:
        ColumnBuffer<PathOnWay, S> paths_;
        ColumnBuffer<RayQuery, S> queries_;
        ColumnBuffer<Hit, S> hits_;
        Buffer<std::uint32_t, S> count_;
    };

    static constexpr std::size_t kFewOnWay = std::size_t(1) << 14;
    /// Bounds memory, and is enough to fill a device.
    static constexpr std::size_t kMostOnWay = std::size_t(1) << 20;

    template <class Work>
    void with_cut_outs(std::uint32_t seed, Work const& work) const
    {
        if (marked_.size() == 0)
            work(KeepAll{});
        else
            work(KeepUncut{world_.view(), marked_.view(), seed});
    }

    WorldOn<S> world_;
    SoupOn<S> soup_;
    Buffer<std::uint8_t, S> marked_;
    std::uint32_t most_layers_;
    std::optional<WorldBvh<S>> bvh_; ///< none if nothing needs exact rays
    std::vector<HitBufferOn<S>> axes_;
    Buffer<AxisView, S> axis_views_;
    std::uint32_t axes_of_level_ = 0;
    Buffer<FewAxes, S> few_;
    Buffer<AliasEntry, S> tables_, chances_;
    Buffer<vec3, S> directions_;
    Buffer<float, S> solid_angles_;
    AxisChoice choice_;
    std::vector<std::array<Buffer<NearestTexel, S>, 6>> maps_; ///< per light point, its faces
    Buffer<LightPointView, S> light_points_;
    Buffer<PathSample, S> samples_;
    OnWay on_way_[2];
    ColumnBuffer<DoubtfulLight, S> doubtful_; ///< empty if no exact rays decide
    Buffer<std::uint32_t, S> doubtful_count_{1};
    PathKernelCounts counts_;
};

} // namespace gi
