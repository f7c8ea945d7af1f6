#pragma once
// The axes that the paths of a pass may take, with their buffers, and the choice among them by the cosine with a
// normal.

#include "gi/core/progress.h"
#include "gi/methods/slhb/directions/cosine_tables.h"
#include "gi/methods/slhb/hit_buffer/cut_outs.h"
#include "gi/methods/slhb/hit_buffer/moving_layers.h"
#include "gi/methods/slhb/hit_buffer/query_batch.h"

#include <functional>

namespace gi {

/// Plain arrays for choosing among few axes: the cosines of all of them are computed, so that the chance is exact.
/// The integral over the half sphere is estimated by the sum over the axes, each weighted by 2 pi / count times
/// its `share`.
struct FewAxes {
    static constexpr std::size_t kMost = 64;

    std::uint32_t count = 0;
    alignas(64) std::array<float, kMost> x{}, y{}, z{}; ///< unit axes; zero beyond count
    alignas(64) std::array<float, kMost> share{};       ///< solid angle over 2 pi / count; zero beyond count
    std::array<std::uint32_t, kMost> slot{};            ///< in the pool

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
        alignas(64) std::array<float, kMost> weight;
        float total = 0;
        for (std::size_t k = 0; k < count; ++k)
            weight[k] = share[k] * std::abs(normal.x * x[k] + normal.y * y[k] + normal.z * z[k]);
        for (std::size_t k = 0; k < count; ++k) total += weight[k];
        // The first axis up to which the weights sum to more than u of all: no branch on what is random.
        float const wanted = u * total;
        float sum = 0;
        std::uint32_t k = 0;
        for (std::size_t a = 0; a + 1 < count; ++a) {
            sum += weight[a];
            k += sum <= wanted ? 1 : 0;
        }
        vec3 const axis{x[k], y[k], z[k]};
        return {slot[k], glm::dot(axis, normal) < 0 ? -axis : axis, 2 * total / float(count)};
    }
};

/// What AxisSet::sample does, for kernels.
struct AxisChoice {
    View<FewAxes const> few; ///< per sequence
    CosineTablesView tables; ///< where there are any, in place of the few

    GI_FN AxisSample sample(std::uint32_t bounce, vec3 normal, float u) const
    {
        if (!tables.axes.empty()) return tables.sample(normal, double(u));
        return few[bounce % std::uint32_t(few.size())].sample(normal, u);
    }
};

/// Hit buffers would take more memory than they may.
struct HitBuffersTooLarge {};

class AxisSet {
public:
    struct BuiltAxis {
        std::uint64_t layers = 0, lost = 0; ///< of all texels; those beyond most_layers
    };
    /// What all axes are built from.
    struct Source {
        Bounds bounds;
        TriangleSoup const& soup;
        CutOuts const& cut_outs;
        std::uint32_t resolution;
        std::uint32_t most_layers;
        bool packed;
        std::uint64_t seed;
        /// Where it is not empty, buffers are not built here but there, of all that there is, and anew where what
        /// moves is elsewhere: index of the axis, its grid, a seed for the cut-outs. Axes come one after the
        /// other.
        std::function<BuiltAxis(std::size_t, RasterGrid const&, std::uint32_t)> elsewhere = {};
        /// Of all buffers together, while they are made; more throw HitBuffersTooLarge.
        std::size_t most_bytes = ~std::size_t(0);
        /// store() throws Interrupted where it is asked to stop; null = it cannot be.
        StopRequest const* stop = nullptr;
        /// Triangles from here on move: they are left to follow(). As many as there are: none does.
        std::size_t first_moving = ~std::size_t(0);
    };

    explicit AxisSet(Source const& source) : source_(source) {}

    /// All axes of the set, once, turned as the seed says: so its error has no preferred direction and mean zero.
    void store(DirectionSet const& directions);
    /// Bounces that have axes of their own. Axes of one low-discrepancy sequence must not be paired along a path:
    /// they avoid each other, which is a bias that does not go away. Bounce b shares its axes with b + kSequences.
    static constexpr std::uint32_t kSequences = 3;

    /// For each of `sequences` bounces `count` axes (up to FewAxes::kMost) from a scrambled Sobol sequence over
    /// the half sphere: numbers pass * fresh to pass * fresh + count - 1. Those that are there already are kept,
    /// so that a pass has the same axes whether or not the passes before it were made here.
    void refresh(std::uint32_t sequences, std::uint32_t count, std::uint32_t fresh, std::uint32_t pass);

    /// What moves is elsewhere: follow() puts it into the axes as it is now. Not with packed layers.
    void moved() { moved_ = true; }
    /// Puts what moves into all axes that there are, where they are new or something has moved.
    void update_axes();
    /// Of stored axes only some, and paths take no others: for each of `sequences` bounces one part of the set of
    /// about `count` axes (up to FewAxes::kMost), in random order all parts in successive turns. The mean over
    /// the parts is what all axes would bring. @param count  0 = all
    /// @return different axes that follow now
    std::size_t follow_some(std::uint32_t sequences, std::uint32_t count, std::uint32_t turn);
    /// Look-ups find what moves, or go on as if it was not there.
    void show_moving(bool shown) { pool_.without_moving = !shown; }

    /// @param bounce  0 = the first  @param normal unit  @param u uniform in [0, 1)
    AxisSample sample(std::uint32_t bounce, vec3 normal, float u) const
    {
        return AxisChoice{few_, takes_few() ? CosineTablesView{} : view(tables_)}.sample(bounce, normal, u);
    }
    /// Whether paths take the axes of few(), not those of tables().
    bool takes_few() const { return some_ || tables_.axes.empty(); }
    /// Axes that the first bounce chooses from where all follow: the first ones of the pool.
    std::size_t first_bounce_axes() const { return tables_.axes.empty() ? few_count_ : tables_.axes.size(); }
    AxisPool const& pool() const { return pool_; }
    /// The layers of these axes have smaller numbers in the pool.
    std::size_t first_bounce_layers() const
    {
        std::size_t const n = first_bounce_axes();
        return n < pool_.size() && pool_.ranges.empty() ? pool_.first_layer[n]
                                                        : pool_.layers.size() + pool_.packed.size();
    }
    vec3 axis(std::size_t a) const { return pool_.grids[a].axis; }
    float solid_angle(std::size_t a) const
    {
        return tables_.axes.empty() ? 2 * kPi / float(few_count_) : tables_.solid_angles[a];
    }
    std::vector<FewAxes> const& few() const { return few_; }
    CosineTables const& tables() const { return tables_; }
    std::uint64_t built() const { return built_; } ///< axes, so far
    /// Layers beyond most_layers, of what is built once and of what moves.
    std::uint64_t lost() const { return lost_; }
    std::uint64_t layers() const { return layers_; } ///< of all axes built so far

private:
    struct NewAxis {
        std::size_t slot;
        vec3 direction;
        std::uint32_t number; ///< decides where its grid lies
    };
    void build(std::vector<NewAxis> const& axes);
    void build_elsewhere(std::size_t axis);
    void move(std::span<std::uint8_t const> updated);

    Source source_;
    std::vector<HitBuffer> buffers_;
    std::vector<std::uint32_t> cut_seeds_; ///< per axis, of CutOuts
    std::vector<RasterGrid> grids_;        ///< per axis that is built elsewhere
    std::vector<std::uint8_t> stale_;      ///< the same: 1 = what moves is not in it as it is now
    MovingLayers moving_;
    AxisPool pool_;
    CosineTables tables_;
    std::vector<FewAxes> few_; ///< per sequence
    std::uint32_t few_count_ = 0;
    bool some_ = false;       ///< of stored axes paths take `few_`
    std::uint32_t drawn_ = 0; ///< of each sequence, the next number
    bool moved_ = true;       ///< what moves is not where it was when axes last followed it
    std::uint64_t built_ = 0, lost_ = 0, layers_ = 0;
};

} // namespace gi
