#include "gi/methods/paths/screen_layers.h"

#include "gi/core/error.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {

void ScreenLayers::draw(TriangleSoup const& soup, std::size_t last, CutOuts const& cut_outs, CameraRays const& eye,
                        int width, int height, std::uint32_t texels, vec2 at, float near_m, std::uint32_t seed,
                        Tiles tiles)
{
    auto const side = [&](int pixels) {
        return std::max(1, int(float(texels) * float(pixels) / float(std::max(width, height)) + 0.5f));
    };
    int const columns = side(width), rows = side(height);
    CameraRays coarse = eye;
    coarse.step_x *= float(width) / float(columns);
    coarse.step_y *= float(height) / float(rows);
    texel_ = std::max(glm::length(coarse.step_x), glm::length(coarse.step_y));
    grid_ = camera_grid(coarse, columns, rows, at, near_m);
    constexpr std::size_t kPart = 32 * TriangleSoup::kChunk;
    std::vector<BorrowedFragments> parts((last + kPart - 1) / kPart);
    tbb::parallel_for(std::size_t(0), parts.size(), [&](std::size_t k) {
        rasterize(soup, k * kPart, std::min(last, (k + 1) * kPart), grid_, *parts[k]);
        cut_outs.remove(*parts[k], grid_, seed);
    });
    offset_.assign(grid_.texels() + 1, 0);
    for (BorrowedFragments& f : parts)
        for (std::size_t k = 0; k < f->count; ++k) ++offset_[f->texel[k] + 1];
    std::uint64_t sum = 0;
    std::uint32_t const across = tiles_across();
    tiles_.assign(std::size_t(across) * ((grid_.height + kTile - 1) / kTile), {});
    for (BorrowedFragments& f : parts) {
        sum += f->count;
        for (std::size_t k = 0; tiles == Tiles::with_depths && k < f->count; ++k) {
            std::uint32_t const x = f->texel[k] % grid_.width, y = f->texel[k] / grid_.width;
            Depths& tile = tiles_[std::size_t(y / kTile) * across + x / kTile];
            float const depth_m = 1 / f->depth[k];
            tile.nearest_m = std::min(tile.nearest_m, depth_m);
            tile.farthest_m = std::max(tile.farthest_m, depth_m);
        }
    }
    if (sum > 0x7fffffff)
        throw InputError("a layered hit buffer of the view has more than 2^31 layers",
                         "they are indexed with 32 bits", "lower --size or --hit-buffer");
    for (std::size_t t = 0; t < grid_.texels(); ++t) offset_[t + 1] += offset_[t];
    layers_.resize(offset_.back());
    std::vector<std::uint32_t> next(offset_.begin(), offset_.end() - 1);
    std::vector<float> nearest(tiles == Tiles::with_depths ? grid_.texels() : 0, 0.0f); // 1 / m
    front_.resize(nearest.size());
    for (BorrowedFragments& f : parts)
        for (std::size_t k = 0; k < f->count; ++k) {
            std::uint32_t const t = f->texel[k], layer = next[t]++;
            layers_[layer] = f->primitive[k] & kPrimitiveMask;
            if (nearest.empty() || !(f->depth[k] > nearest[t])) continue;
            nearest[t] = f->depth[k];
            front_[t] = layer;
        }
}

namespace {

/// A point of the triangle near one on its plane.
vec3 held_on(Surface const& s, vec3 position)
{
    vec2 const w = barycentric_at(s, position);
    return s.corner + w.x * s.edge1 + w.y * s.edge2;
}

} // namespace

std::optional<ScreenLayers::Texel> ScreenLayers::texel_at(vec3 point) const
{
    vec3 const from = point - grid_.eye;
    float const depth = glm::dot(grid_.forward, from), scale = 1 / (grid_.subpixels * depth),
                x = glm::dot(grid_.to_x, from) * scale, y = glm::dot(grid_.to_y, from) * scale;
    if (!(depth > grid_.near_m && x >= 0 && y >= 0 && x < float(grid_.width) && y < float(grid_.height)))
        return {};
    return Texel{std::size_t(y) * grid_.width + std::size_t(x), texel_ * depth};
}

LayerHit ScreenLayers::nearest(View<Surface const> surfaces, vec3 origin, std::uint32_t triangle, vec3 direction,
                               std::uint32_t watched, bool& near_watched) const
{
    // In texels times the distance along the view, which are linear along the ray.
    vec3 const from = origin - grid_.eye;
    float const scale = 1 / grid_.subpixels;
    vec3 const start{glm::dot(grid_.to_x, from) * scale, glm::dot(grid_.to_y, from) * scale,
                     glm::dot(grid_.forward, from)},
        step{glm::dot(grid_.to_x, direction) * scale, glm::dot(grid_.to_y, direction) * scale,
             glm::dot(grid_.forward, direction)};
    if (!(start.z > grid_.near_m)) return {};
    float const end = step.z < 0 ? (grid_.near_m - start.z) / step.z : kInf; // at the near plane
    int at[2];
    int const count[2] = {int(grid_.width), int(grid_.height)};
    int way[2]; // in which the ray moves across the picture, the same all along it
    for (int k = 0; k < 2; ++k) {
        float const place = start[k] / start.z;
        if (!(place > -1 && place < float(count[k] + 1))) return {}; // beside the view
        at[k] = std::clamp(int(place), 0, count[k] - 1);
        float const turn = step[k] * start.z - start[k] * step.z;
        way[k] = turn > 0 ? 1 : turn < 0 ? -1 : 0;
    }
    // Polygons end within texels, so one may be met a little before or after its texel, and a little beside the polygon
    // itself; where its plane is seen edge-on, that would be far.
    constexpr float kBeside = 0.5f; // texels
    float entered = 0;
    LayerHit best; // behind the texel, until one of the next is nearer
    float best_at = kInf;
    while (true) {
        float leaves = end;
        int across = -1; // the border at which the ray leaves the texel
        for (int k = 0; k < 2; ++k) {
            auto const border = float(at[k] + (way[k] > 0 ? 1 : 0)), way_there = float(way[k]);
            float const ahead = way_there * (border * start.z - start[k]),
                        pace = way_there * (step[k] - border * step.z);
            if (!(pace > 0)) continue;
            if (float const t = std::max(ahead / pace, entered); t < leaves) {
                leaves = t;
                across = k;
            }
        }
        float const slack = leaves < kInf ? 0.5f * (leaves - entered) : 0.0f;
        std::size_t const texel = std::size_t(at[1]) * grid_.width + std::size_t(at[0]);
        for (std::uint32_t k = offset_[texel]; k < offset_[texel + 1]; ++k) {
            if (layers_[k] >= watched) near_watched = true;
            Surface const& s = surfaces[layers_[k]];
            vec3 const normal = glm::cross(s.edge1, s.edge2);
            float const height = glm::dot(normal, s.corner - origin), slope = glm::dot(normal, direction);
            if (layers_[k] == triangle || std::abs(height) <= s.clearance * glm::length(normal)) continue;
            float const t = height / slope;
            if (!(t > 0 && t < best_at && t >= entered - slack && t <= leaves + slack)) continue;
            vec3 const met = origin + t * direction, position = held_on(s, met);
            float const depth = start.z + t * step.z;
            if (!(glm::length(position - met) <= kBeside * texel_ * depth + s.clearance)) continue;
            best_at = t;
            best = {layers_[k], position, false};
        }
        if (best_at <= leaves || across < 0) return best;
        at[across] += way[across];
        if (at[across] < 0 || at[across] >= count[across]) return best;
        entered = leaves;
    }
}

} // namespace gi
