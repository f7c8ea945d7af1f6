#include "gi/hit_buffers/windows.h"

#include "gi/raster/nearest_map.h"

#include <algorithm>
#include <cmath>
#include <tbb/parallel_for.h>
#include <utility>

namespace gi {
namespace {

bool holds(Bounds const& b, vec3 p)
{
    return glm::all(glm::greaterThanEqual(p, b.low)) && glm::all(glm::lessThanEqual(p, b.high));
}

Bounds common(Bounds const& a, Bounds const& b) { return {glm::max(a.low, b.low), glm::min(a.high, b.high)}; }

float size_of(Bounds const& b) { return b.empty() ? 0 : max_component(b.high - b.low); }

Bounds scaled(Bounds const& b, float by)
{
    vec3 const half = 0.5f * by * (b.high - b.low);
    return {b.center() - half, b.center() + half};
}

} // namespace

Surroundings surroundings(TriangleSoup const& soup, vec3 eye, float near_m)
{
    constexpr std::uint32_t kTexels = 32; // a side of each face of a cube
    constexpr double kShare = 0.8;
    constexpr std::size_t kPart = 32 * TriangleSoup::kChunk;
    std::vector<vec3> seen;
    for (int face = 0; face < 6; ++face) {
        PerspectiveGrid const grid = cube_face(eye, face, kTexels, near_m);
        NearestMap map;
        clear(map, grid.width, grid.height);
        tbb::parallel_for(std::size_t(0), (soup.count + kPart - 1) / kPart, [&](std::size_t k) {
            BorrowedFragments fragments;
            rasterize(soup, k * kPart, std::min(soup.count, (k + 1) * kPart), grid, *fragments);
            resolve_shared(*fragments, 1, map);
        });
        for (std::uint32_t j = 0; j < grid.height; ++j)
            for (std::uint32_t i = 0; i < grid.width; ++i)
                if (NearestTexel const& t = map.texels[j * grid.width + i]; t.primitive != kNoPrimitive)
                    seen.push_back(grid.point(i, j, t.key));
    }
    if (seen.empty()) return {};
    auto const nearer = [&](vec3 a, vec3 b) { return glm::length(a - eye) < glm::length(b - eye); };
    auto const nearest = [&](double share) {
        auto const at = seen.begin() + std::ptrdiff_t(share * double(seen.size() - 1));
        std::ranges::nth_element(seen, at, nearer);
        return at;
    };
    float const middle_m = glm::length(*nearest(0.5) - eye);
    auto const last = nearest(kShare);
    Bounds near{eye, eye};
    for (auto p = seen.begin(); p <= last; ++p) near = joined(near, {*p, *p});
    return {near, middle_m};
}

namespace {

/// With a little room, and no thin slab: walls are seen along them too.
Bounds box_around(Bounds const& near, float room, float least)
{
    Bounds box = scaled(near, room);
    float const thinnest = std::max(0.25f * size_of(box), least);
    for (glm::length_t c = 0; c < 3; ++c) {
        float const half = 0.5f * std::max(box.high[c] - box.low[c], thinnest), middle = box.center()[c];
        box.low[c] = middle - half;
        box.high[c] = middle + half;
    }
    return box;
}

} // namespace

std::vector<Bounds> nested_windows(Bounds const& whole, Bounds const& near, std::uint32_t resolution,
                                   std::size_t levels)
{
    constexpr float kWorthwhile = 6, kStep = 4, kRoom = 1.1f; // measured: below, light is as right by one level
    constexpr float kMostTexels =
        1 << 19; // across the whole: vertices keep places between texels, see make_window
    if (near.empty() || levels == 1) return {};
    Bounds const inner = box_around(near, kRoom, size_of(whole) * float(resolution) / kMostTexels);
    float const ratio = size_of(whole) / size_of(inner);
    if (!(ratio >= kWorthwhile) || !std::isfinite(ratio)) return {};
    auto n = std::size_t(std::max(1.0f, std::round(std::log(ratio) / std::log(kStep))));
    n = std::min(n, (levels == 0 ? kMostLevels : std::min(levels, kMostLevels)) - 1);
    std::vector<Bounds> boxes;
    for (std::size_t k = n; k-- > 0;)
        boxes.push_back(common(scaled(inner, std::pow(ratio, float(k) / float(n))), whole));
    return boxes;
}

bool Windows::follow(Bounds const& whole, TriangleSoup const& soup, std::span<CameraRays const> cameras)
{
    constexpr float kRoom = 1.5f;     // beyond what was near, half of what is near then has coarser texels
    constexpr float kNothing = 0.05f; // of the world, where nothing is seen
    constexpr float kOther = 2;       // times as large, or as small
    bool const orthographic = std::ranges::any_of(cameras, [](CameraRays const& c) { return c.orthographic; });
    bool const has_none = orthographic || levels_ == 1;
    bool const same_world = placed_ && whole.low == whole_.low && whole.high == whole_.high;
    auto const all = [&](auto const& test) { return std::ranges::all_of(cameras, test); };
    bool const within = same_world && all([&](CameraRays const& c) { return holds(near_, c.origin); });
    bool const looked = all([&](CameraRays const& c) {
        return std::ranges::any_of(looks_,
                                   [&](Look const& l) { return glm::length(c.origin - l.eye) <= l.reach_m; });
    });
    if (same_world && (has_none ? boxes_.empty() : within && looked)) return false;
    Bounds seen, near;
    std::vector<Look> looks;
    for (std::size_t k = 0; k < cameras.size() && !has_none; ++k) {
        vec3 const eye = cameras[k].origin;
        if (holds(near, eye)) continue;
        Surroundings const around = surroundings(soup, eye, 1e-5f * std::max(whole.radius(), 1e-30f));
        bool const none = around.box.empty();
        float const still = kNothing * size_of(whole);
        looks.push_back({eye, none ? still : 0.25f * around.middle_m});
        near = joined(near, none ? Bounds{eye - still, eye + still} : box_around(around.box, kRoom, 0));
        if (!none) seen = joined(seen, around.box);
    }
    looks_ = std::move(looks);
    float const size = size_of(seen);
    if (within && !has_none && size <= kOther * size_ && size_ <= kOther * size) return false;
    placed_ = true;
    whole_ = whole;
    near_ = near;
    size_ = size;
    std::vector<Bounds> const before = std::exchange(boxes_, nested_windows(whole, seen, resolution_, levels_));
    return !std::ranges::equal(
        before, boxes_, [](Bounds const& a, Bounds const& b) { return a.low == b.low && a.high == b.high; });
}

} // namespace gi
