#pragma once
// What is cut out of surfaces (alpha masks, blending) is taken out of the buffers when they are built, so that no
// query has to ask. Partial coverage is a random decision per fragment.

#include "gi/raster/nearest_map.h"

namespace gi {

/// Weights of vertices 1 and 2 at a point on (or near) a triangle, within the triangle.
GI_FN inline vec2 barycentric_at(Surface const& s, vec3 position)
{
    vec3 const p = position - s.corner;
    float const a = glm::dot(s.edge1, s.edge1), b = glm::dot(s.edge1, s.edge2), c = glm::dot(s.edge2, s.edge2);
    float const p1 = glm::dot(p, s.edge1), p2 = glm::dot(p, s.edge2), determinant = a * c - b * b;
    if (!(determinant > 0)) return vec2{1.0f / 3};
    vec2 w{(c * p1 - b * p2) / determinant, (a * p2 - b * p1) / determinant};
    if (!(w.x == w.x) || !(w.y == w.y)) return vec2{1.0f / 3};
    w = glm::clamp(w, 0.0f, 1.0f);
    float const sum = w.x + w.y;
    return sum > 1 ? w / sum : w;
}

class CutOuts {
public:
    /// Empty where every material is opaque.
    explicit CutOuts(World const& world);

    bool none() const { return marked_.empty(); }
    /// Drops fragments where the surface is not. @param seed another one, another decision where coverage is
    /// partial
    void remove(Fragments& fragments, RasterGrid const& grid, std::uint32_t seed) const;
    void remove(Fragments& fragments, PerspectiveGrid const& grid, std::uint32_t seed) const;

private:
    template <class Position>
    void remove_where(Fragments& fragments, std::uint32_t seed, Position const& position) const;

    WorldView world_;
    std::vector<bool> marked_; ///< per triangle
};

} // namespace gi
