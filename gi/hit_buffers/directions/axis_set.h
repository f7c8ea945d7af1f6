#pragma once
// The axes available to the paths of a pass, with their buffers, and sampling of an axis in proportion to its
// cosine with a normal.

#include "gi/core/progress.h"
#include "gi/kernel/device_code.h"
#include "gi/hit_buffers/directions/cosine_tables.h"
#include "gi/hit_buffers/moving_layers.h"
#include "gi/hit_buffers/query_batch.h"
#include "gi/raster/cut_outs.h"

#include <functional>

namespace gi {

/// Arrays for choosing among few axes: the cosines of all are computed, so that the probability is exact.
/// The integral over the hemisphere is estimated by the sum over the axes, each weighted
/// by 2 pi / count times its `share`.
struct FewAxes {
    static constexpr std::size_t kMost = 64;

    std::uint32_t count = 0;
    alignas(64) std::array<float, kMost> x{}, y{}, z{}; ///< unit axes; zero beyond count
    alignas(64) std::array<float, kMost> share{};       ///< solid angle over 2 pi / count; zero beyond count
    std::array<std::uint32_t, kMost> slot{};            ///< index in the pool

    void set(std::size_t k, vec3 axis, float share_of_all, std::size_t in_pool)
    {
        x[k] = axis.x;
        y[k] = axis.y;
        z[k] = axis.z;
        share[k] = share_of_all;
        slot[k] = std::uint32_t(in_pool);
    }

    GI_FN AxisSample sample(vec3 normal, float u) const
    {
        auto const find = [&](std::size_t k) {
            return share[k] * std::abs(normal.x * x[k] + normal.y * y[k] + normal.z * z[k]);
        };
        // On a device found twice: an array would lie in its slow memory.
        alignas(64) std::array<float, kDeviceCode ? 1 : kMost> weights;
        for (std::size_t k = 0; k < count && !kDeviceCode; ++k) weights[k] = find(k);
        auto const weight = [&](std::size_t k) {
            if constexpr (kDeviceCode)
                return find(k);
            else
                return weights[k];
        };
        float total = 0;
        for (std::size_t k = 0; k < count; ++k) total += weight(k);
        // Finds the first axis at which the cumulative weight exceeds u times the total, without random branches.
        float const wanted = u * total;
        float sum = 0;
        std::uint32_t k = 0;
        for (std::size_t a = 0; a + 1 < count; ++a) {
            sum += weight(a);
            k += sum <= wanted ? 1 : 0;
        }
        vec3 const axis{x[k], y[k], z[k]};
        return {slot[k], glm::dot(axis, normal) < 0 ? -axis : axis, 2 * total / float(count)};
    }
};

/// AxisSet::sample for kernels.
struct AxisChoice {
    View<FewAxes const> few; ///< per sequence
    CosineTablesView tables; ///< used instead of `few` if not empty

    GI_FN AxisSample sample(std::uint32_t bounce, vec3 normal, float u) const
    {
        if (!tables.axes.empty()) return tables.sample(normal, double(u));
        return few[bounce % std::uint32_t(few.size())].sample(normal, u);
    }
};

/// The slot of an axis whose grid is the finest over a point. Slots of all axes of a level follow each other, from the
/// coarsest level to the finest. @param axes  of a level  @param grid_of  of a slot
template <class GridOf>
GI_FN std::uint32_t finest_slot(std::uint32_t axis, std::uint32_t axes, std::size_t levels, vec3 point,
                                GridOf const& grid_of)
{
    for (auto level = std::uint32_t(levels) - 1; level > 0; --level)
        if (std::uint32_t const slot = axis + level * axes; grid_of(slot).holds(point)) return slot;
    return axis;
}

/// Thrown if hit buffers would exceed their memory limit.
struct HitBuffersTooLarge {};

class AxisSet {
public:
    struct BuiltAxis {
        std::uint64_t layers = 0, lost = 0; ///< in all texels; beyond most_layers
        std::size_t bytes = 0;
    };
    struct AxisToBuild {
        std::size_t slot;
        RasterGrid grid;
        std::uint32_t cut_seed; ///< of cut-outs
    };
    /// Input from which all axes are built.
    struct Source {
        Bounds bounds;
        std::vector<Bounds> windows = {}; ///< with finer grids, each within the one before, see windows.h
        TriangleSoup const& soup;
        CutOuts const& cut_outs;
        std::uint32_t resolution;
        std::uint32_t most_layers;
        bool packed;
        std::uint64_t seed;
        /// If set, this callback builds buffers from all triangles, and rebuilds them after dynamic geometry
        /// changes.
        std::function<std::vector<BuiltAxis>(std::span<AxisToBuild const>)> elsewhere = {};
        /// Limit for all buffers together, on the host while they are built; exceeding it throws HitBuffersTooLarge.
        std::size_t most_bytes = ~std::size_t(0);
        /// If not null, store() checks it and throws Interrupted if a stop is requested.
        StopRequest const* stop = nullptr;
        /// Index of the first dynamic triangle; dynamic triangles are added by update_axes(). Number of triangles
        /// or more = all static.
        std::size_t first_moving = ~std::size_t(0);
    };

    explicit AxisSet(Source const& source) : source_(source) {}

    /// Builds all axes of the set once, randomly rotated by the seed, so that the set's error has no preferred
    /// direction and mean zero.
    void store(DirectionSet const& directions);
    /// Number of bounces with separate axes. Axes from one low-discrepancy sequence must not be
    /// combined along a path: they avoid each other, which gives a bias that does not vanish.
    /// Bounce b uses the same axes as b + kSequences.
    static constexpr std::uint32_t kSequences = 3;

    /// Prepares for each of `sequences` bounces `count` axes (up to FewAxes::kMost) from a scrambled Sobol
    /// sequence over the hemisphere: numbers pass * fresh to pass * fresh + count - 1. Existing ones are kept. A
    /// pass has the same axes whether or not the earlier passes were rendered here.
    void refresh(std::uint32_t sequences, std::uint32_t count, std::uint32_t fresh, std::uint32_t pass);

    /// Marks dynamic geometry as moved; update_axes() will update the axes. Not with packed layers.
    void moved() { moved_ = true; }
    /// Updates dynamic geometry in all axes that are new or outdated.
    void update_axes();
    /// Updates only some of the stored axes, and restricts paths to them: for each of `sequences` bounces, one
    /// part of the set with about `count` axes (up to FewAxes::kMost). Successive turns visit all parts in random
    /// order; the mean over the parts equals the result of all axes. @param count  0 = all
    /// @return number of distinct axes updated
    std::size_t update_some_axes(std::uint32_t sequences, std::uint32_t count, std::uint32_t turn);
    /// Makes look-ups find dynamic geometry or ignore it.
    void show_moving(bool shown) { pool_.without_moving = !shown; }

    /// Returns one of first_bounce_axes() or later ones, below axes().
    /// @param bounce  0 = the first  @param normal unit  @param u uniform in [0, 1)
    AxisSample sample(std::uint32_t bounce, vec3 normal, float u) const
    {
        return AxisChoice{few_, takes_few() ? CosineTablesView{} : view(tables_)}.sample(bounce, normal, u);
    }
    std::size_t levels() const { return 1 + source_.windows.size(); }
    std::uint32_t axes() const { return axes_; } ///< of each level
    /// Index in the pool of the finest grid of an axis over a point.
    std::uint32_t slot(std::uint32_t axis, vec3 point) const
    {
        return finest_slot(axis, axes_, levels(), point,
                           [this](std::uint32_t s) -> RasterGrid const& { return pool_.grids[s]; });
    }
    /// True if paths use the axes of few(), not those of tables().
    bool takes_few() const { return some_ || tables_.axes.empty(); }
    /// Number of axes available to the first bounce if all are updated; they come first in the pool.
    std::size_t first_bounce_axes() const { return tables_.axes.empty() ? few_count_ : tables_.axes.size(); }
    AxisPool const& pool() const { return pool_; }
    /// Layers of these axes have indices below this in the pool.
    std::size_t first_bounce_layers() const
    {
        std::size_t const n = first_bounce_axes();
        return n < pool_.size() && pool_.ranges.empty() && levels() == 1
                   ? pool_.first_layer[n]
                   : pool_.layers.size() + pool_.packed.size();
    }
    vec3 axis(std::size_t a) const { return pool_.grids[a].axis; }
    float solid_angle(std::size_t a) const
    {
        return tables_.axes.empty() ? 2 * kPi / float(few_count_) : tables_.solid_angles[a];
    }
    std::vector<FewAxes> const& few() const { return few_; }
    CosineTables const& tables() const { return tables_; }
    std::uint64_t built() const { return built_; } ///< number of axes built so far
    /// Number of layers beyond most_layers, static and dynamic.
    std::uint64_t lost() const { return lost_; }
    std::uint64_t layers() const { return layers_; } ///< of all axes built so far

private:
    struct NewAxis {
        std::size_t slot, level;
        vec3 direction;
        std::uint32_t number; ///< index in the sequence; selects the offset of its grid
    };
    /// The same axes in all levels. @param axes  of the coarsest
    void build(std::vector<NewAxis> axes);
    void build_elsewhere(std::span<std::size_t const> slots);
    void move(std::span<std::uint8_t const> updated);

    Source source_;
    std::vector<HitBuffer> buffers_;
    std::uint32_t axes_ = 0;               ///< of each level
    std::vector<std::uint32_t> cut_seeds_; ///< per slot, of CutOuts
    std::vector<RasterGrid> grids_;        ///< per slot built by the callback `elsewhere`
    std::vector<std::uint8_t> stale_;      ///< per slot built by the callback: 1 = outdated after motion
    std::vector<std::size_t> bytes_;       ///< per slot built by the callback
    MovingLayers moving_;
    AxisPool pool_;
    CosineTables tables_;
    std::vector<FewAxes> few_; ///< per sequence
    std::uint32_t few_count_ = 0;
    bool some_ = false;       ///< stored schedule: paths use only `few_`
    std::uint32_t drawn_ = 0; ///< next number of each sequence
    bool moved_ = true;       ///< dynamic geometry has moved since axes were last updated
    std::uint64_t built_ = 0, lost_ = 0, layers_ = 0;
};

} // namespace gi
