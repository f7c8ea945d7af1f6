#pragma once
// Data that the kernels of paths and slhb read from a world and build from it: everything is in one space, and only first
// surfaces are copied back, on request.

#include "gi/hit_buffers/build_hit_buffer.h"
#include "gi/hit_buffers/directions/axis_set.h"
#include "gi/hit_buffers/shadow_maps/light_points.h"
#include "gi/methods/paths/kernels/kernel_cache.h"
#include "gi/methods/paths/kernels/path_kernel.h"
#include "gi/raster/draw_nearest.h"
#include "gi/scene/model/used_materials.h"
#include "gi/scene/model/world_on.h"

#include <algorithm>
#include <array>
#include <functional>
#include <numeric>
#include <optional>
#include <utility>

namespace gi {

template <Space S>
class KernelScene {
public:
    /// @param most_layers  per texel, see fill_hit_buffer
    KernelScene(World const& world, TriangleSoup const& soup, CutOuts const& cut_outs, std::uint32_t most_layers)
        : world_(world),
          soup_(soup),
          marked_(upload<S>(cut_outs.marked())),
          most_layers_(most_layers),
          panes_(has_panes(world))
    {
        forget_counts();
    }

    /// Copies the changes. Coverage (transparency) must not have changed. @param soup  current triangles
    void update(World const& world, TriangleSoup const& soup, Changes const& changes)
    {
        world_.update(world, changes);
        panes_ = has_panes(world);
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

    std::vector<AxisSet::BuiltAxis> build_axes(std::span<AxisSet::AxisToBuild const> axes)
    {
        std::vector<RasterGrid> grids;
        std::vector<std::uint32_t> seeds;
        for (AxisSet::AxisToBuild const& a : axes) {
            if (axes_.size() <= a.slot) axes_.resize(a.slot + 1);
            axes_[a.slot] = {}; // first, as both together may be too much
            grids.push_back(a.grid);
            seeds.push_back(a.cut_seed);
        }
        std::vector<HitBufferOn<S>> built;
        with_cut_outs([&](auto const& keep) {
            built = build_hit_buffers<S>(soup_.view(), grids, seeds, most_layers_, keep);
        });
        std::vector<AxisSet::BuiltAxis> sizes;
        for (std::size_t k = 0; k < axes.size(); ++k) {
            sizes.push_back({built[k].layers.size(), built[k].lost, built[k].bytes()});
            axes_[axes[k].slot] = std::move(built[k]);
        }
        return sizes;
    }

    /// Those that are built from now on may be fewer.
    void forget_axes() { axes_.clear(); }

    void draw_light_points(LightPoints::DeviceDraw const& now)
    {
        maps_.resize(now.light_points.size());
        FacesToDraw<RasterGrid> levels;
        FacesToDraw<PerspectiveGrid> faces;
        for (std::size_t const k : now.drawn) {
            LightPoint const& light_point = now.light_points[k];
            ShadowMap const& shadow = light_point.shadow;
            for (std::size_t f = 0; f < 6; ++f) {
                maps_[k][f] = {};
                if (!light_point.view.parallel && !sees_only_dark(light_point.view, shadow.faces[f]))
                    faces.add(shadow.faces[f], k, f);
                if (light_point.view.parallel && int(f) < shadow.levels) levels.add(shadow.grids[f], k, f);
            }
        }
        draw_faces(levels, now.seed);
        draw_faces(faces, now.seed);
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

    /// First surfaces of views. @param seed  of cut-outs
    std::vector<Buffer<NearestTexel, S>> draw(std::span<PerspectiveGrid const> grids, std::uint32_t seed) const
    {
        return draw_all(grids, std::vector<std::uint32_t>(grids.size(), seed));
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

    /// See KernelCache.
    void use_cache(float radius, std::size_t most_bytes, std::size_t paths)
    {
        cache_.emplace(radius, most_bytes, paths);
    }
    KernelCache<S>* cache() { return cache_ ? &*cache_ : nullptr; }

    /// Sets the light samples of a pass.
    void take_pool(LightPool const& pool)
    {
        pool_groups_ = upload<S>(pool.groups());
        pool_lights_ = upload<S>(pool.lights());
        pool_ = {std::as_const(pool_groups_).view(), std::as_const(pool_lights_).view(), pool.rounds()};
    }

    /// Traces a path a pixel. Returns a sample for each, valid until the next call.
    /// @param free  by exact rays alone, see FindBy  @param cached  paths may end in the cells of use_cache()
    /// @param paths  with the host's parameters and those of the view; this function fills in the rest
    View<PathSample const> trace(PassOfPaths paths, bool free, bool cached)
    {
        std::size_t const pixels = paths.pixels;
        if (samples_.size() != pixels) samples_ = Buffer<PathSample, S>(pixels);
        paths.world = world_.view();
        paths.axes = std::as_const(axis_views_).view();
        paths.axes_of_level = axes_of_level_;
        paths.choice = choice_;
        paths.light_points = std::as_const(light_points_).view();
        paths.chances = {std::as_const(chances_).view()};
        paths.pool = pool_;
        paths.samples = samples_.view();
        paths.counts = counts_.view();
        std::size_t const most = std::min(pixels + kPixelsOfTurn, kMostOnWay);
        if (on_way_[0].size() != most || on_way_[0].has_rays() != bvh_.has_value())
            for (OnWay& w : on_way_) {
                w = {}; // first, as both together may be too much
                w = OnWay(most, bvh_.has_value());
            }
        if (std::size_t const waiting = paths.confirms || free ? most : 0; waiting_.size() != waiting)
            waiting_ = ColumnBuffer<WaitingLight, S>(waiting);
        if (free && cached && cache_)
            trace_to_cells(paths);
        else if (free)
            trace_all<FindBy::rays>(paths, 0, pixels);
        else if (bvh_)
            trace_all<FindBy::look_ups_and_rays>(paths, 0, pixels);
        else
            trace_all<FindBy::look_ups>(paths, 0, pixels);
        return std::as_const(samples_).view();
    }
    /// Of the paths traced since the last call.
    PathKernelCounts take_counts()
    {
        PathKernelCounts sum;
        for (PathKernelCounts const& c : download(counts_)) sum += c;
        forget_counts();
        return sum;
    }

    /// What a step of all paths has left, for programs that compare spaces: they may change it.
    struct AfterStep {
        ColumnBuffer<PathOnWay, S>& paths; ///< that go on
        ColumnBuffer<RayQuery, S>& queries;
        ColumnBuffer<Hit, S>& hits;      ///< of queries, after rays of the camera
        Buffer<std::uint32_t, S>& count; ///< [0]: of paths
        ColumnBuffer<WaitingLight, S>& waiting;
        Buffer<std::uint32_t, S>& waits; ///< [0]: number of waiting lights
        Buffer<PathSample, S>& samples;
    };
    std::function<void(AfterStep const&)> after_step; ///< called by trace()

private:
    void forget_counts() { fill_bytes(S, counts_.view().data, 0, counts_.size() * sizeof(PathKernelCounts)); }

    /// Paths that may end in cells, and teach them. An empty cache is taught in turns.
    void trace_to_cells(PassOfPaths& paths)
    {
        std::size_t const blocks = (paths.pixels + kPixelsOfTurn - 1) / kPixelsOfTurn;
        bool const by_turns = cache_->empty();
        std::array<std::size_t, kCacheTurns + 1> first{};
        if (by_turns) {
            std::vector<std::uint32_t> order(blocks);
            std::iota(order.begin(), order.end(), 0u);
            std::ranges::stable_sort(order, {}, [](std::uint32_t b) { return turn_of(b); });
            for (std::uint32_t const b : order) first[turn_of(b) + 1] += kPixelsOfTurn;
            std::partial_sum(first.begin(), first.end(), first.begin());
            blocks_ = upload<S>(order);
            paths.blocks = std::as_const(blocks_).view();
        } else {
            first[1] = paths.pixels;
        }
        for (std::size_t turn = 0; turn < (by_turns ? kCacheTurns : 1); ++turn) {
            paths.cache = cache_->lend(paths.pixels);
            trace_all<FindBy::rays>(paths, first[turn], first[turn + 1]);
            cache_->learn(std::as_const(samples_).view());
        }
    }

    /// All paths one surface further, again and again, and the last few to their ends. How many go on from the first
    /// surfaces is not asked, as the host would wait for the answer.
    template <FindBy by>
    void trace_all(PassOfPaths& paths, std::size_t first, std::size_t last)
    {
        constexpr bool by_rays = by != FindBy::look_ups;
        bool const from_camera = by == FindBy::rays && paths.primary.empty();
        KernelRays const rays = by_rays ? bvh_->rays() : KernelRays{};
        for (paths.first = first; paths.first < last; paths.first += kMostOnWay) {
            std::size_t const all = std::min(last - paths.first, kMostOnWay);
            std::size_t const few = std::min(all / 8, kFewOnWay);
            paths.next = on_way_[0].none();
            paths.waiting = none_waiting();
            if (from_camera)
                launch(S, "rays of the camera", all, StartRays{{paths}, rays, on_way_[0].hits()});
            else
                launch(S, "first steps of paths", all, FirstSteps<by>{{paths}});
            if (after_step) after_step(left(0));
            std::size_t waits = from_camera ? 0 : all; // at most
            int now = 0;
            for (int surface = from_camera ? 0 : 1;; ++surface, now = 1 - now) {
                std::size_t const n = surface < std::min(paths.bounces, kSure) ? all : on_way_[now].count();
                if (by_rays && surface > 0) trace_rays(now, n, waiting_.size() > 0 ? waits : 0, paths);
                if (n == 0) break;
                PathsOnWay const from = paths.next;
                ColumnView<Hit> const hits = on_way_[now].hits();
                paths.next = on_way_[1 - now].none();
                paths.waiting = none_waiting();
                if (n > few)
                    launch(S, "further steps of paths", n, FurtherSteps<by, false>{{paths}, from, hits, rays});
                else
                    launch(S, "last steps of paths", n, FurtherSteps<by, true>{{paths}, from, hits, rays});
                waits = n > few ? n : 0; // the last steps trace their own rays
                if (after_step) after_step(left(1 - now));
            }
        }
    }
    void trace_rays(int now, std::size_t nearest, std::size_t waits, PassOfPaths const& paths)
    {
        if (nearest + waits == 0) return;
        auto const launch_rays = [&]<bool panes>(std::bool_constant<panes>) {
            launch(S, "rays of paths", nearest + waits,
                   RaysOfSteps<panes>{world_.view(),
                                      bvh_->rays(),
                                      nearest,
                                      paths.next.queries,
                                      {paths.next.count.data, 1},
                                      on_way_[now].hits(),
                                      paths.waiting,
                                      paths.samples});
        };
        if (panes_)
            launch_rays(std::true_type());
        else
            launch_rays(std::false_type());
    }

    WaitingLights none_waiting()
    {
        if (waiting_.size() == 0) return {};
        fill_bytes(S, waiting_count_.view().data, 0, sizeof(std::uint32_t));
        return {waiting_.view(), waiting_count_.view()};
    }
    AfterStep left(int next) { return on_way_[next].left(waiting_, waiting_count_, samples_); }

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
        AfterStep left(ColumnBuffer<WaitingLight, S>& waiting, Buffer<std::uint32_t, S>& waits,
                       Buffer<PathSample, S>& samples)
        {
            return {paths_, queries_, hits_, count_, waiting, waits, samples};
        }
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

    static constexpr int kSure = 4; ///< surfaces from which most paths go on
    static constexpr std::size_t kFewOnWay = std::size_t(1) << 14;
    /// Bounds memory (1.2 GB, if a picture has so many pixels); a headset's eyes have fewer, so that a pass is traced at once.
    static constexpr std::size_t kMostOnWay = std::size_t(1) << 22;

    template <class Work>
    void with_cut_outs(Work const& work) const
    {
        if (marked_.size() == 0)
            work(KeepAll{});
        else
            work(KeepUncut{world_.view(), marked_.view()});
    }
    template <class Grid>
    std::vector<Buffer<NearestTexel, S>> draw_all(std::span<Grid const> grids,
                                                  std::vector<std::uint32_t> const& seeds) const
    {
        std::vector<Buffer<NearestTexel, S>> maps;
        with_cut_outs([&](auto const& keep) { maps = draw_nearest<S>(soup_.view(), grids, seeds, keep); });
        return maps;
    }

    /// Faces of shadow maps, and whose they are.
    template <class Grid>
    struct FacesToDraw {
        std::vector<Grid> grids;
        std::vector<std::pair<std::size_t, std::size_t>> of; ///< light point, face

        void add(Grid const& grid, std::size_t light_point, std::size_t face)
        {
            grids.push_back(grid);
            of.emplace_back(light_point, face);
        }
    };
    template <class Grid>
    void draw_faces(FacesToDraw<Grid> const& faces, std::uint32_t seed)
    {
        std::vector<Buffer<NearestTexel, S>> maps =
            draw_all(std::span<Grid const>(faces.grids), std::vector<std::uint32_t>(faces.grids.size(), seed));
        for (std::size_t i = 0; i < maps.size(); ++i)
            maps_[faces.of[i].first][faces.of[i].second] = std::move(maps[i]);
    }

    WorldOn<S> world_;
    SoupOn<S> soup_;
    Buffer<std::uint8_t, S> marked_;
    std::uint32_t most_layers_;
    bool panes_;
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
    Buffer<LightGroup, S> pool_groups_;
    Buffer<PooledLight, S> pool_lights_;
    LightPoolView pool_;
    std::optional<KernelCache<S>> cache_;
    Buffer<std::uint32_t, S> blocks_; ///< see PassOfPaths
    Buffer<PathSample, S> samples_;
    OnWay on_way_[2];
    ColumnBuffer<WaitingLight, S> waiting_; ///< empty if no exact rays decide
    Buffer<std::uint32_t, S> waiting_count_{1};
    Buffer<PathKernelCounts, S> counts_{1024}; ///< threads that add to one number wait for each other
};

} // namespace gi
