#pragma once
// The axes that the paths of a pass may take, with their buffers, and the choice among them by the cosine with a normal.

#include "gi/slhb/cosine_tables.h"
#include "gi/slhb/cut_outs.h"
#include "gi/slhb/query_batch.h"

namespace gi {

/// Plain arrays for choosing among few axes: the cosines of all of them are computed, so that the chance is exact.
struct FewAxes {
    static constexpr std::size_t kMost = 64;

    std::uint32_t count = 0;                       ///< padded with weight 0 to a multiple of 16
    alignas(64) std::array<float, kMost> x, y, z;
    alignas(64) std::array<float, kMost> solid_angle; ///< sr, of one direction of each axis

    AxisSample sample(vec3 normal, float u) const;
};

class AxisSet {
public:
    /// What all axes are built from.
    struct Source {
        Bounds bounds;
        TriangleSoup const& soup;
        CutOuts const& cut_outs;
        std::uint32_t resolution;
        std::uint32_t most_layers;
        std::uint64_t seed;
    };

    explicit AxisSet(Source const& source) : source_(source) {}

    /// All axes of the set, once.
    void store(DirectionSet const& directions);
    /// `count` axes (2..FewAxes::kMost), of which the next `fresh` ones are replaced by those of a randomly turned
    /// spherical Fibonacci lattice of `count` axes; all when called first.
    void refresh(std::uint32_t count, std::uint32_t fresh, std::uint32_t pass);

    /// @param normal unit  @param u uniform in [0, 1)
    AxisSample sample(vec3 normal, float u) const
    {
        return tables_.axes.empty() ? few_.sample(normal, u) : view(tables_).sample(normal, double(u));
    }
    AxisPool const& pool() const { return pool_; }
    vec3 axis(std::size_t a) const { return pool_.grids[a].axis; }
    float solid_angle(std::size_t a) const { return tables_.axes.empty() ? few_.solid_angle[a] : tables_.solid_angles[a]; }
    std::uint64_t built() const { return built_; }   ///< axes, so far
    std::uint64_t lost() const { return lost_; }     ///< layers beyond most_layers
    std::uint64_t layers() const { return layers_; } ///< of all axes built so far

private:
    void build(std::vector<std::size_t> const& which, std::vector<vec3> const& axes, std::uint32_t pass);

    Source source_;
    std::vector<HitBuffer> buffers_;
    AxisPool pool_;
    CosineTables tables_;
    FewAxes few_;
    std::uint32_t next_ = 0;
    std::uint64_t built_ = 0, lost_ = 0, layers_ = 0;
};

} // namespace gi
