#pragma once
// Finds the nearest of a set of directions in constant time, with a table over the sphere
// (Yu 2012, sec. 5.3.1 and fig. 5.4).

#include "gi/core/view.h"
#include "gi/hit_buffers/directions/directions.h"

#include <cstdint>

namespace gi {

enum class SphereMapping : std::uint8_t {
    octahedral, ///< size x size; no trigonometry
    lat_long,   ///< 2 size x size; u = 0.5 + atan2(x, -z) / 2 pi, v = acos(y) / pi, as environment maps
};

/// Octahedral mapping of a unit vector to the unit square [0, 1]^2 (Cigolle et al. 2014, "Survey of Efficient
/// Representations for Independent Unit Vectors").
GI_FN inline vec2 octahedral_from_direction(vec3 d)
{
    float const scale = 1 / (std::abs(d.x) + std::abs(d.y) + std::abs(d.z));
    vec2 p{d.x * scale, d.y * scale};
    if (d.z < 0)
        p = {(1 - std::abs(p.y)) * std::copysign(1.0f, p.x), (1 - std::abs(p.x)) * std::copysign(1.0f, p.y)};
    return 0.5f * p + 0.5f;
}

GI_FN inline vec3 direction_from_octahedral(vec2 u)
{
    vec2 const p = 2.0f * u - 1.0f;
    vec3 d{p.x, p.y, 1 - std::abs(p.x) - std::abs(p.y)};
    if (d.z < 0) {
        float const x = d.x;
        d.x = (1 - std::abs(d.y)) * std::copysign(1.0f, x);
        d.y = (1 - std::abs(x)) * std::copysign(1.0f, d.y);
    }
    return glm::normalize(d);
}

struct DirectionMapView {
    View<std::uint16_t const> nearest; ///< per texel, row-major: index of the direction nearest to its centre
    std::uint32_t width = 0, height = 0;
    SphereMapping mapping = SphereMapping::octahedral;

    GI_FN std::uint32_t texel(vec3 direction) const
    {
        vec2 uv;
        if (mapping == SphereMapping::octahedral)
            uv = octahedral_from_direction(direction);
        else
            uv = {0.5f + std::atan2(direction.x, -direction.z) * (0.5f * kInvPi),
                  std::acos(glm::clamp(direction.y, -1.0f, 1.0f)) * kInvPi};
        auto const x = glm::min(std::uint32_t(uv.x * float(width)), width - 1);
        auto const y = glm::min(std::uint32_t(uv.y * float(height)), height - 1);
        return y * width + x;
    }
    /// Returns the index of a direction; it may not be the nearest if a border
    /// between two cells crosses the texel.
    GI_FN std::uint32_t look_up(vec3 direction) const { return nearest[texel(direction)]; }
};

struct DirectionMap {
    std::vector<std::uint16_t> nearest;
    std::uint32_t width = 0, height = 0;
    SphereMapping mapping = SphereMapping::octahedral;
};

/// @param size  number of rows of the table
DirectionMap make_direction_map(DirectionSet const& directions, SphereMapping mapping, std::uint32_t size);

inline DirectionMapView view(DirectionMap const& m) { return {m.nearest, m.width, m.height, m.mapping}; }

/// Nearest direction by exhaustive search: reference for measuring the map.
std::uint32_t nearest_direction(DirectionSet const& directions, dvec3 d);

/// The same results, faster for many directions: tests only the axes that can be nearest somewhere in the cell of
/// the octahedral square. The set must outlive it.
class NearestDirections {
public:
    explicit NearestDirections(DirectionSet const& directions);
    std::uint32_t operator()(dvec3 d) const;

private:
    /// Even, so that the folds of the octahedron are diagonals of cells.
    static constexpr std::uint32_t kAcross = 32;
    DirectionSet const& directions_;
    std::vector<std::uint32_t> first_; ///< index of each cell's first entry in axes_, plus an end entry
    std::vector<std::uint32_t> axes_;  ///< ascending within a cell
};

} // namespace gi
