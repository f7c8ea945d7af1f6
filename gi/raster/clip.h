#pragma once
// Clipping of triangles to the range of a pinhole raster (Sutherland & Hodgman 1974) and view culling of boxes.
// Each edge is cut with its corners in a fixed order, so that neighbouring triangles get identical cuts, and with
// explicit fused multiply-adds, so that all compilers round identically.

#include "gi/raster/perspective_grid.h"

namespace gi {
namespace clip_detail {

/// Rounds identically with all compilers.
GI_FN inline double dot(dvec3 a, dvec3 b) { return std::fma(a.z, b.z, std::fma(a.y, b.y, a.x * b.x)); }

struct Corner {
    dvec3 raster; ///< x, y in subpixels times w; z = w
};

/// Half space: weights . (x, y, w) >= limit is inside.
struct Plane {
    dvec3 weights;
    double limit;

    GI_FN double distance(Corner const& c) const { return dot(weights, c.raster) - limit; }
};

GI_FN inline bool before(dvec3 a, dvec3 b) { return a.x != b.x ? a.x < b.x : a.y != b.y ? a.y < b.y : a.z < b.z; }

GI_FN inline Corner cut(Corner const& one, Corner const& other, Plane const& plane)
{
    bool const swap = before(other.raster, one.raster);
    dvec3 const a = swap ? other.raster : one.raster, b = swap ? one.raster : other.raster;
    double const da = plane.distance({a}), db = plane.distance({b}), t = da / (da - db);
    return {{std::fma(t, b.x - a.x, a.x), std::fma(t, b.y - a.y, a.y), std::fma(t, b.z - a.z, a.z)}};
}

GI_FN inline Corner corner(PerspectiveGrid const& g, vec3 p)
{
    dvec3 const v = dvec3(p) - dvec3(g.eye);
    return {{dot(v, dvec3(g.to_x)), dot(v, dvec3(g.to_y)), dot(v, dvec3(g.forward))}};
}

} // namespace clip_detail

/// Calls emit(SnappedTriangle, depths) for the parts of a triangle within the guard band and in front of the eye.
template <class Emit>
GI_FN void clip_triangle(PerspectiveGrid const& g, vec3 const* corners, Emit const& emit)
{
    using namespace clip_detail;
    constexpr std::size_t kMost = 16;
    double const guard = 0.5 * double(PerspectiveGrid::kGuard);
    Plane const planes[] = {Plane{{0, 0, 1}, double(g.near_m)}, Plane{{1, 0, guard}, 0}, Plane{{-1, 0, guard}, 0},
                            Plane{{0, 1, guard}, 0}, Plane{{0, -1, guard}, 0}};
    Corner polygon[kMost] = {corner(g, corners[0]), corner(g, corners[1]), corner(g, corners[2])}, kept[kMost];
    std::size_t n = 3;
    for (Plane const& plane : planes) {
        std::size_t m = 0;
        for (std::size_t k = 0; k < n; ++k) {
            Corner const &a = polygon[k], &b = polygon[(k + 1) % n];
            bool const a_in = plane.distance(a) >= 0, b_in = plane.distance(b) >= 0;
            if (a_in) kept[m++] = a;
            if (a_in != b_in) kept[m++] = cut(a, b, plane);
        }
        for (std::size_t k = 0; k < m; ++k) polygon[k] = kept[k];
        n = m;
        if (n < 3) return;
    }
    auto const x = [&](std::size_t k) {
        return std::int32_t(std::rint(polygon[k].raster.x / polygon[k].raster.z));
    };
    auto const y = [&](std::size_t k) {
        return std::int32_t(std::rint(polygon[k].raster.y / polygon[k].raster.z));
    };
    auto const depth = [&](std::size_t k) { return float(1 / polygon[k].raster.z); };
    for (std::size_t k = 1; k + 1 < n; ++k)
        emit(SnappedTriangle{{x(0), x(k), x(k + 1)}, {y(0), y(k), y(k + 1)}},
             vec3{depth(0), depth(k), depth(k + 1)});
}

/// False only if no point of the box is in view.
inline bool sees(PerspectiveGrid const& g, Bounds const& box)
{
    if (box.empty()) return false;
    vec3 const center = box.center() - g.eye, half = 0.5f * (box.high - box.low);
    float const right = float(g.width) * g.subpixels, bottom = float(g.height) * g.subpixels;
    auto const outside = [&](vec3 inwards) { // side of a plane through the eye
        return glm::dot(inwards, center) + glm::dot(glm::abs(inwards), half) < 0;
    };
    if (glm::dot(g.forward, center) + glm::dot(glm::abs(g.forward), half) < g.near_m) return false;
    return !outside(g.to_x) && !outside(right * g.forward - g.to_x) && !outside(g.to_y) &&
           !outside(bottom * g.forward - g.to_y);
}

} // namespace gi
