#pragma once
// Nearest surface along the axis: a look-up in a layered hit buffer instead of a ray.
//
// A look-up starts on a triangle of the scene and leaves it along the axis (up) or against it. In the column under
// the nearest texel centre it finds the layer of its own surface; the next layer is the hit. The hit position is
// the point of the polygon at the texel centre (at any other point, this layer's depth would be off the surface).
//
// The origin's own layer is that of its triangle; else, as the texel centre may lie beside the triangle, the
// nearest layer with the same facing within `margin`, which is how much the depth of the origin's surface can
// change across a texel due to its slope. So thin walls, contacts and coplanar duplicates need no global epsilon:
// layers are in their true order.
//
// A column is accepted if it contains the own layer and its hit can be hit from the origin: the origin is on the
// right side of the hit's plane (tested only for near hits, where it can fail, and for back faces), and, for a
// back face, the walk from the true origin passes its triangle within kBackReach texels. The last test is needed
// because a back face is mostly the inside of a solid: floors continue under columns and walls behind ledges, and
// a texel centre that lies there, where no origin does, sees only dark surfaces.
//
// If the column is not accepted, the other three of the four texel centres around the origin are tried (across an
// edge or beyond a wall, the first centre may see different geometry). If none is accepted, the hit of the first
// column with an own layer is used; if none has an own layer, the first face towards the walk from the origin's
// depth on, in the nearest column.
//
// A result is doubtful if the nearest column was not accepted, or if another of the four has no own layer or gives
// another surface: then an edge lies near the line from the origin, on either side of it. Where one of the four gives
// a blended surface, results differ by lot, and a difference raises no doubt.

#include "gi/hit_buffers/hit_buffer.h"

namespace gi {

inline constexpr std::uint32_t kNoLayerHit = 0xffffffffu;
/// Bit stored with the starting triangle of a batch look-up: set = walk along the axis, else against it.
inline constexpr std::uint32_t kWalkUp = 0x40000000u;

/// An axis as used by look-ups: static layers and dynamic layers, in the same grid.
struct AxisView {
    HitBufferView part[2]; ///< the second may be empty (no offsets)

    GI_FN RasterGrid const& grid() const { return part[0].grid; }
};

struct WalkOrigin {
    vec3 position;
    std::uint32_t triangle;
    bool along;      ///< the triangle's normal points along the axis
    bool up;         ///< walk along the axis, else against it
    float slope = 0; ///< tangent of the angle between axis and normal
};

struct LayerHit {
    std::uint32_t triangle = kNoLayerHit;
    vec3 position{0};
    bool along = false; ///< its normal points along the axis
};

/// Largest difference in depth, m, between the origin and its own surface under a texel centre.
GI_FN inline float own_margin(RasterGrid const& grid, float slope) { return grid.texel * (1 + slope); }

/// Distance, in texels, at which a walk may pass a triangle hit from behind. Chosen by measurement: about as many
/// true back-face hits are missed as false ones are accepted.
inline constexpr float kBackReach = 0.25f;

/// Distance from a plane, texels, up to which surfaces hit in different columns are one.
inline constexpr float kSameSurface = 0.25f;

/// Hits nearer than this, m, are checked to face the origin.
GI_FN inline float near_gap(RasterGrid const& grid) { return 4 * grid.texel; }

namespace query_detail {

/// Result of one column. Depths are along the walk, relative to the origin, m, unless noted.
struct Column {
    bool own = false;
    std::uint32_t own_triangle = 0;
    float own_depth = 0;
    std::uint32_t hit = kNoLayerHit; ///< primitive with its facing bit
    float depth = 0;                 ///< of the hit, along the axis
    float gap = 0;                   ///< from the own layer to the hit
};

/// Iterates over the layers of a texel in the order of the walk, with both parts merged.
struct Walk {
    HitLayer const* at[2];
    std::ptrdiff_t left[2] = {0, 0};
    int step;

    GI_FN Walk(AxisView const& axis, std::size_t texel, bool up) : step(up ? 1 : -1)
    {
        for (int k = 0; k < 2; ++k) {
            HitBufferView const& part = axis.part[k];
            if (part.offset.empty()) continue;
            std::uint32_t const begin = part.offset[texel], end = part.offset[texel + 1];
            at[k] = part.layers.data + (up ? std::ptrdiff_t(begin) : std::ptrdiff_t(end) - 1);
            left[k] = std::ptrdiff_t(end) - std::ptrdiff_t(begin);
        }
    }
    GI_FN bool next(HitLayer& layer)
    {
        if (left[0] == 0 && left[1] == 0) return false;
        int const k = left[0] == 0 ? 1 : left[1] == 0 ? 0 : (at[1]->depth < at[0]->depth) == (step > 0) ? 1 : 0;
        layer = *at[k];
        at[k] += step;
        --left[k];
        return true;
    }
};

GI_FN inline Column look_into(AxisView const& axis, std::size_t texel, WalkOrigin const& o)
{
    RasterGrid const& grid = axis.grid();
    float const sign = o.up ? 1.0f : -1.0f;
    float const origin = sign * grid.depth(o.position), margin = own_margin(grid, o.slope);
    float best = margin;
    Column with_own, without; // without: the first face towards the walk
    Walk walk(axis, texel, o.up);
    for (HitLayer layer; walk.next(layer);) {
        float const z = sign * layer.depth - origin;
        bool const along = (layer.primitive & kAlongAxis) != 0;
        bool const same = (layer.primitive & kPrimitiveMask) == o.triangle;
        if (same || (along == o.along && std::abs(z) <= best)) {
            with_own = {true, layer.primitive & kPrimitiveMask, z, kNoLayerHit, 0, 0};
            best = same ? -1.0f : std::abs(z);
            continue;
        }
        if (with_own.own && with_own.hit == kNoLayerHit && z - with_own.own_depth > grid.rounding) {
            with_own.hit = layer.primitive;
            with_own.depth = layer.depth;
            with_own.gap = z - with_own.own_depth;
        }
        if (without.hit == kNoLayerHit && z > grid.rounding && along != o.up) {
            without.hit = layer.primitive;
            without.depth = layer.depth;
            without.gap = z;
        }
        bool const answered = (with_own.own ? with_own.hit : without.hit) != kNoLayerHit;
        if (answered && (best < 0 || z > margin)) break; // no later layer can be a nearer own layer
    }
    return with_own.own ? with_own : without;
}

GI_FN inline bool is_back(std::uint32_t primitive, WalkOrigin const& o)
{
    return ((primitive & kAlongAxis) != 0) == o.up;
}

/// True if the triangle, seen along the axis, covers the position or lies within `reach` of it, m.
GI_FN inline bool covers(Surface const& s, vec3 position, RasterGrid const& grid, float reach)
{
    auto const seen = [&](vec3 v) { return vec2{glm::dot(v, grid.right), glm::dot(v, grid.up)}; };
    vec2 const first = seen(s.corner - position), edge1 = seen(s.edge1), edge2 = seen(s.edge2);
    vec2 const corner[3] = {first, first + edge1, first + edge2};
    float const winding = edge1.x * edge2.y < edge1.y * edge2.x ? -1.0f : 1.0f;
    bool inside = true;
    for (int k = 0; k < 3; ++k) {
        vec2 const a = corner[k], edge = corner[(k + 1) % 3] - a; // the position is at 0
        float const squared = glm::dot(edge, edge);
        float const along = squared > 0 ? glm::clamp(-glm::dot(a, edge) / squared, 0.0f, 1.0f) : 0.0f;
        vec2 const nearest = a + along * edge;
        if (glm::dot(nearest, nearest) <= reach * reach) return true;
        inside = inside && winding * (edge.y * a.x - edge.x * a.y) >= 0;
    }
    return inside;
}

/// True if a walk from the true origin can hit the triangle: tests its plane for front faces, and for back faces
/// also the triangle with a small tolerance.
GI_FN inline bool can_be_hit(Surface const& s, std::uint32_t primitive, WalkOrigin const& o,
                             RasterGrid const& grid)
{
    vec3 const normal = glm::cross(s.edge1, s.edge2);
    float const side = glm::dot(normal, o.position - s.corner);
    float const far_enough = s.clearance * glm::length(normal);
    if (!is_back(primitive, o)) return side > far_enough;
    return side < -far_enough && covers(s, o.position, grid, kBackReach * grid.texel);
}

/// True if the first hit of a column can be one of the look-up.
GI_FN inline bool accepts(Column const& c, View<Surface const> surfaces, WalkOrigin const& o,
                          RasterGrid const& grid)
{
    if (!c.own) return false;
    if (c.hit == kNoLayerHit || (c.gap >= near_gap(grid) && !is_back(c.hit, o))) return true;
    return can_be_hit(surfaces[c.hit & kPrimitiveMask], c.hit, o, grid);
}

/// The four texels around a point: the nearest centre's; then the neighbour across the nearer border, the other
/// neighbour, and the diagonal one. Beyond the grid's border, the last one again.
struct TexelsAround {
    std::uint32_t i[2], j[2];
    bool nearer_in_x;

    GI_FN TexelsAround(RasterGrid const& grid, vec3 position)
    {
        float const x = (glm::dot(position, grid.right) - grid.corner.x) / grid.texel;
        float const y = (glm::dot(position, grid.up) - grid.corner.y) / grid.texel;
        auto const held = [](float v, std::uint32_t count) {
            return v > 0 ? glm::min(std::uint32_t(v), count - 1) : 0u;
        };
        auto const other = [](std::uint32_t k, float at, std::uint32_t count) {
            if (at - float(k) < 0.5f) return k > 0 ? k - 1 : k;
            return k + 1 < count ? k + 1 : k;
        };
        i[0] = held(x, grid.width);
        j[0] = held(y, grid.height);
        i[1] = other(i[0], x, grid.width);
        j[1] = other(j[0], y, grid.height);
        nearer_in_x = std::abs(x - float(i[0]) - 0.5f) > std::abs(y - float(j[0]) - 0.5f);
    }
    GI_FN std::uint32_t column(int attempt) const
    {
        return i[attempt == 3 || (attempt == 1) == nearer_in_x ? int(attempt > 0) : 0];
    }
    GI_FN std::uint32_t row(int attempt) const
    {
        return j[attempt == 3 || (attempt == 2) == nearer_in_x ? int(attempt > 0) : 0];
    }
};

/// True if two columns found different surfaces: farther than a quarter texel from one plane, or one found none.
GI_FN inline bool are_different(View<Surface const> surfaces, RasterGrid const& grid, LayerHit const& a,
                                LayerHit const& b)
{
    if (a.triangle == b.triangle) return false;
    if (a.triangle == kNoLayerHit || b.triangle == kNoLayerHit) return true;
    Surface const& s = surfaces[a.triangle];
    vec3 const normal = glm::cross(s.edge1, s.edge2);
    return std::abs(glm::dot(normal, b.position - a.position)) > kSameSurface * grid.texel * glm::length(normal);
}

/// True if a surface is in a column or not by lot.
GI_FN inline bool is_by_lot(View<Surface const> surfaces, std::uint32_t triangle)
{
    return triangle != kNoLayerHit && surfaces[triangle].is(Surface::kBlended);
}

} // namespace query_detail

GI_FN inline LayerHit nearest_layer(AxisView const& axis, View<Surface const> surfaces, WalkOrigin const& o)
{
    using namespace query_detail;
    RasterGrid const& grid = axis.grid();
    TexelsAround const around(grid, o.position);
    Column first;
    std::uint32_t first_i = around.i[0], first_j = around.j[0];
    for (int attempt = 0; attempt < 4; ++attempt) {
        std::uint32_t const i = around.column(attempt), j = around.row(attempt);
        Column const c = look_into(axis, std::size_t(j) * grid.width + i, o);
        if (attempt == 0 || (!first.own && c.own)) {
            first = c;
            first_i = i;
            first_j = j;
        }
        if (!accepts(c, surfaces, o, grid)) continue;
        if (c.hit == kNoLayerHit) return {};
        return {c.hit & kPrimitiveMask, grid.point(i, j, c.depth), (c.hit & kAlongAxis) != 0};
    }
    if (first.hit == kNoLayerHit) return {};
    return {first.hit & kPrimitiveMask, grid.point(first_i, first_j, first.depth), (first.hit & kAlongAxis) != 0};
}

/// See above. @param found  the look-up's result
GI_FN inline bool is_doubtful(AxisView const& axis, View<Surface const> surfaces, WalkOrigin const& o,
                              LayerHit const& found)
{
    using namespace query_detail;
    RasterGrid const& grid = axis.grid();
    TexelsAround const around(grid, o.position);
    bool differ = false, by_lot = is_by_lot(surfaces, found.triangle);
    for (int attempt = 0; attempt < 4; ++attempt) {
        std::uint32_t const i = around.column(attempt), j = around.row(attempt);
        Column const c = look_into(axis, std::size_t(j) * grid.width + i, o);
        if (!c.own || (attempt == 0 && !accepts(c, surfaces, o, grid))) return true;
        LayerHit const other{c.hit == kNoLayerHit ? kNoLayerHit : c.hit & kPrimitiveMask,
                             grid.point(i, j, c.depth)};
        differ = differ || are_different(surfaces, grid, found, other);
        by_lot = by_lot || is_by_lot(surfaces, other.triangle);
    }
    return differ && !by_lot;
}

} // namespace gi
