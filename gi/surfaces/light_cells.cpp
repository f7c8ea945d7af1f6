#include "gi/surfaces/light_cells.h"

#include "gi/scene/model/projection.h"

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <glm/gtc/packing.hpp>
#include <utility>

namespace gi {
namespace {

/// Width of the narrowest cells, m, in rooms; smaller scenes have narrower ones.
constexpr float kNarrowest_m = 0.15f, kOfRadius = 1.0f / 48;
/// Cells narrower than this share of their distance learn nothing: texels are farther apart.
constexpr float kOfDistance = 0.02f;
/// Weight up to which a cell takes the mean, then the last ones count more; and that of the wider cell's light.
constexpr float kMostWeight = 64, kPrior = 4;
/// A single path that found more light than so many times the mean counts as so much.
constexpr float kBrightest = 8;
/// What is farther behind a plane than this share of a cell's width is hidden by it.
constexpr float kOfWidth = 0.1f;

int side_of(vec3 n)
{
    vec3 const a = glm::abs(n);
    int const axis = a.x >= a.y && a.x >= a.z ? 0 : a.y >= a.z ? 1 : 2;
    return 2 * axis + (n[axis] < 0 ? 1 : 0);
}

} // namespace

std::uint32_t light_cell_key(glm::ivec3 cell, int level, int side)
{
    uvec3 const c(cell);
    // Mixed after each number: exclusive ors of their multiples are the same for many cells beside each other.
    std::uint32_t h = c.x * 73856093u;
    h = (h ^ h >> 15) * 0x2c1b3c6du + c.y * 19349663u;
    h = (h ^ h >> 13) * 0x297a2d39u + c.z * 83492791u;
    h = (h ^ h >> 15) * 0x2c1b3c6du + std::uint32_t(6 * level + side) * 2654435761u;
    h = (h ^ h >> 16) * 0x85ebca6bu;
    h = (h ^ h >> 13) * 0xc2b2ae35u;
    return (h ^ h >> 16) | 1u;
}

LightCells::LightCells(float radius)
    : narrowest_m_(std::clamp(kOfRadius * radius, 1e-30f, kNarrowest_m)), cells_(2 * LightCellTable::kBuckets)
{
}

LightCells::Cell& LightCells::cell(std::uint32_t key)
{
    std::size_t at = key / 2 % cells_.size();
    while (cells_[at].key != 0 && cells_[at].key != key) at = (at + 1) % cells_.size();
    if (cells_[at].key == 0) {
        cells_[at].key = key;
        ++used_;
    }
    return cells_[at];
}

LightCells::Cell const* LightCells::find(std::uint32_t key) const
{
    for (std::size_t at = key / 2 % cells_.size(); cells_[at].key != 0; at = (at + 1) % cells_.size())
        if (cells_[at].key == key) return &cells_[at];
    return nullptr;
}

void LightCells::forget_oldest()
{
    std::vector<std::uint32_t> ages;
    for (Cell const& c : cells_)
        if (c.key != 0) ages.push_back(c.last);
    auto const middle = ages.begin() + std::ptrdiff_t(ages.size() / 2);
    std::ranges::nth_element(ages, middle);
    std::vector<Cell> old(cells_.size());
    old.swap(cells_);
    used_ = 0;
    for (Cell const& c : old)
        if (c.key != 0 && c.last > *middle) cell(c.key) = c;
}

void LightCells::doubt(float share)
{
    constexpr float kLeastWeight = 0.01f; // what was known is better than nothing
    for (Cell& c : cells_) {
        float const weight = max_component(c.weight), by = std::max(share, std::min(1.0f, kLeastWeight / weight));
        if (!(weight > 0)) continue;
        c.sum *= by;
        c.weight *= by;
    }
}

/// Which cells lie behind what a picture shows.
void LightCells::find_hidden(LightPicture const& light, CameraRays const& rays)
{
    Projection const project(rays);
    for (Cell& c : cells_) {
        if (c.key == 0 || !(c.places > 0)) continue;
        vec3 const p = project(c.place);
        vec2 const at = glm::floor(vec2(p) * light.texels_per_pixel);
        if (!(p.z > 0) || !(at.x >= 0 && at.y >= 0 && at.x < float(light.width) && at.y < float(light.height)))
            continue;
        LightTexel const& t = light.texels[std::size_t(at.y) * std::size_t(light.width) + std::size_t(at.x)];
        if (!has_surface(t) || mirror_of(t) != 0) continue;
        float const depth = depth_of(t),
                    before = glm::dot(unpacked_normal(t.normal), c.place - rays.origin) - t.plane_m;
        // What is no longer hidden, learns.
        c.hidden |= p.z > depth && before < -(kOfDepth * depth + kOfWidth * c.width);
    }
}

void LightCells::learn(LightPicture const& light, std::size_t most, dvec3 origin)
{
    if (light.without_punctual != without_punctual_) {
        cells_.assign(cells_.size(), {});
        used_ = 0;
        without_punctual_ = light.without_punctual;
    }
    ++pictures_;
    CameraRays const rays = camera_rays(light.camera, light.camera_width, light.camera_height, origin);
    find_hidden(light, rays);
    std::size_t const step = std::max<std::size_t>(1, (light.texels.size() + most) /
                                                          std::max<std::size_t>(1, most + 1)),
                      first = pictures_ % step;
    for (std::size_t i = first; i < light.texels.size(); i += step) {
        LightTexel const& t = light.texels[i];
        if (!has_surface(t) || mirror_of(t) > light.mirrors.size()) continue;
        if (used_ + LightCellTable::kLevels > kMostCells) forget_oldest();
        vec2 const place =
            (vec2{float(i % std::size_t(light.width)), float(i / std::size_t(light.width))} + light.at) /
            light.texels_per_pixel;
        Ray const ray = rays.through(place);
        float const depth = depth_of(t);
        vec3 position = ray.origin + ray.direction * (depth / glm::dot(ray.direction, rays.forward));
        if (auto const m = mirror_of(t); m != 0) position = reflected(light.mirrors[m - 1], position);
        vec3 const found = glm::min(glm::unpackF3x9_E1x5(t.light), kBrightest * light.mean);
        int const side = side_of(unpacked_normal(t.normal));
        vec3 known;
        for (int c = 0; c < 3; ++c) known[c] = (t.depth_dark >> c & 1) == 0 ? 1.0f : 0.0f;
        std::uint32_t wider = 0;
        for (int level = LightCellTable::kLevels - 1; level >= 0; --level) {
            float const width = std::ldexp(narrowest_m_, level);
            if (width < kOfDistance * depth) break;
            vec3 const at = glm::floor(position / width);
            if (!(max_component(glm::abs(at)) < 0x1p30f)) break;
            std::uint32_t const key = light_cell_key(glm::ivec3(at), level, side);
            Cell& c = cell(key);
            if (std::exchange(c.hidden, false)) c = {.key = key};
            c.width = width;
            c.wider = std::exchange(wider, key);
            c.last = pictures_;
            c.sum += known * found;
            c.weight += known;
            c.places = std::min(c.places + 1, kMostWeight);
            c.place += (position - c.place) / c.places;
            if (float const over = max_component(c.weight) / kMostWeight; over > 1) {
                c.sum /= over;
                c.weight /= over;
            }
        }
    }
}

std::shared_ptr<LightCellTable const> LightCells::table() const
{
    auto table = std::make_shared<LightCellTable>();
    table->narrowest_m = narrowest_m_;
    table->without_punctual = without_punctual_;
    for (Cell const& c : cells_) {
        if (c.key == 0) continue;
        std::array<Cell const*, LightCellTable::kLevels> around{};
        std::size_t n = 0;
        for (Cell const* at = &c; at != nullptr && n < around.size();
             at = at->wider != 0 ? find(at->wider) : nullptr)
            if (at == &c || c.hidden || !at->hidden) around[n++] = at;
        vec3 mean = around[n - 1]->sum / glm::max(around[n - 1]->weight, vec3{1e-20f});
        while (n-- > 1) mean = (around[n - 1]->sum + kPrior * mean) / (around[n - 1]->weight + kPrior);
        bool is_in = false;
        for (std::uint32_t b = 0; b < 3 && !is_in; ++b)
            for (LightCellTable::Cell& free : table->buckets[(c.key / 2 + b) % LightCellTable::kBuckets]) {
                if (free.key != 0 || is_in) continue;
                free = {c.hidden ? c.key & ~1u : c.key, glm::packF3x9_E1x5(mean)};
                is_in = true;
            }
        table->left_out += !is_in;
    }
    return table;
}

} // namespace gi
