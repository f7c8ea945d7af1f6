#pragma once
// Sampling of axes in proportion to the cosine between axis and surface normal, without trigonometry: one alias
// table per bin of normals. As a table does not use the exact normal, a sample is weighted by the ratio of the
// exact cosine to its probability, so that estimates are correct for the discrete set with any number of bins.

#include "gi/core/alias_table.h"
#include "gi/hit_buffers/directions/direction_map.h"

namespace gi {

struct AxisSample {
    std::uint32_t axis;
    vec3 direction; ///< of the axis, on the side of the normal
    float weight;   ///< cos(direction, normal) * solid angle of the direction / (pi * probability), mean 1
};

struct CosineTablesView {
    View<AliasEntry const> entries; ///< bin after bin, one per axis
    View<vec3 const> axes;
    View<float const> solid_angles; ///< per axis, of one of its two directions, sr; they sum to 2 pi
    std::uint32_t bins_across = 0;  ///< bins per side of the octahedral square

    /// @param normal unit  @param u uniform in [0, 1)
    GI_FN AxisSample sample(vec3 normal, double u) const
    {
        vec2 const uv = octahedral_from_direction(normal);
        auto const x = glm::min(std::uint32_t(uv.x * float(bins_across)), bins_across - 1);
        auto const y = glm::min(std::uint32_t(uv.y * float(bins_across)), bins_across - 1);
        AliasTableView const table{{entries.data + std::size_t(y * bins_across + x) * axes.size(), axes.size()}};
        std::uint32_t const axis = table.sample(u);
        float const cosine = glm::dot(axes[axis], normal);
        return {axis, cosine < 0 ? -axes[axis] : axes[axis],
                std::abs(cosine) * solid_angles[axis] * kInvPi / table.probability(axis)};
    }
};

struct CosineTables {
    std::vector<AliasEntry> entries;
    std::vector<vec3> axes;
    std::vector<float> solid_angles;
    std::uint32_t bins_across = 0;
};

/// @param bins_across  with 64, the weights of icosahedron:320 deviate from 1 by 0.052 (root mean square); more
///   for axes at grazing angles, which are rarely drawn
CosineTables make_cosine_tables(DirectionSet const& directions, std::uint32_t bins_across);

inline CosineTablesView view(CosineTables const& t) { return {t.entries, t.axes, t.solid_angles, t.bins_across}; }

} // namespace gi
