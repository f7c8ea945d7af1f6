#include "gi/surfaces/antialiasing.h"

#include "gi/core/radical_inverse.h"
#include "gi/filter/filter_input.h"

#include <array>
#include <cmath>
#include <hwy/highway.h>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

constexpr float kMostFrames = 8;
/// Earlier colours are held within the mean +- so many standard deviations of 3 x 3 pixels.
constexpr float kSpread = 1;
/// Relative difference of depths from which on a pixel showed another surface.
constexpr float kDepth = 0.05f;

/// Weights of four texels of which the middle two are `t` and 1 - `t` away (Catmull and Rom 1974).
std::array<float, 4> catmull_rom(float t)
{
    return {t * (-0.5f + t * (1 - 0.5f * t)), 1 + t * t * (-2.5f + 1.5f * t), t * (0.5f + t * (2 - 1.5f * t)),
            t * t * (-0.5f + 0.5f * t)};
}

/// Mean and standard deviation of colours in 3 x 3 pixels around each pixel of a row.
struct Around {
    std::vector<float> sums, squares;

    void find(float const* color, int width, int height, int y)
    {
        std::size_t const n = 3 * std::size_t(width);
        float const *const row = color + n * std::size_t(y), *const up = y > 0 ? row - n : row,
                           *const down = y + 1 < height ? row + n : row;
        sums.resize(n + 6);
        squares.resize(n + 6);
        for (std::size_t i = 0; i < n; ++i) {
            sums[i + 3] = row[i] + up[i] + down[i];
            squares[i + 3] = row[i] * row[i] + up[i] * up[i] + down[i] * down[i];
        }
        for (auto* const v : {&sums, &squares})
            for (std::size_t c = 0; c < 3; ++c) {
                (*v)[c] = (*v)[3 + c];
                (*v)[n + 3 + c] = (*v)[n + c];
            }
    }
    vec3 hold(int x, vec3 color) const
    {
        vec3 held;
        for (std::size_t c = 0; c < 3; ++c) {
            std::size_t const i = 3 * std::size_t(x) + c;
            float const mean = (sums[i] + sums[i + 3] + sums[i + 6]) / 9,
                        square = (squares[i] + squares[i + 3] + squares[i + 6]) / 9,
                        reach = kSpread * std::sqrt(std::max(0.0f, square - mean * mean));
            held[int(c)] = std::clamp(color[int(c)], mean - reach, mean + reach);
        }
        return held;
    }
};

} // namespace

vec2 Antialiasing::sample() const
{
    constexpr std::uint32_t kPeriod = 16;
    std::size_t const i = frame_ % kPeriod + 1;
    return {float(radical_inverse(i, 2)), float(radical_inverse(i, 3))};
}

/// What the last picture showed, with 0 frames where that was another surface or beyond its borders.
Antialiasing::Texel Antialiasing::earlier(vec2 place, float depth) const
{
    float const u = place.x - 0.5f, v = place.y - 0.5f;
    Texel found{};
    if (!(u > -0.5f && v > -0.5f && u < float(width_) - 0.5f && v < float(height_) - 0.5f)) return found;
    int const left = int(std::floor(u)), top = int(std::floor(v));
    std::array<std::size_t, 4> columns, rows; // the middle two are next to the place
    for (int k = 0; k < 4; ++k) {
        columns[std::size_t(k)] = std::size_t(std::clamp(left + k - 1, 0, width_ - 1));
        rows[std::size_t(k)] = std::size_t(std::clamp(top + k - 1, 0, height_ - 1)) * std::size_t(width_);
    }
    bool same = false;
    for (std::size_t k = 0; k < 4; ++k)
        same |= std::abs(last_depths_[rows[1 + (k >> 1)] + columns[1 + (k & 1)]] - depth) <= kDepth * depth;
    if (!same) return found;
    std::array<float, 4> const across = catmull_rom(u - float(left)), down = catmull_rom(v - float(top));
    hn::FixedTag<float, 4> const lanes;
    auto sum = hn::Zero(lanes);
    for (std::size_t j = 0; j < 4; ++j)
        for (std::size_t i = 0; i < 4; ++i)
            sum = hn::MulAdd(hn::Set(lanes, across[i] * down[j]),
                             hn::LoadU(lanes, &last_[rows[j] + columns[i]].color.x), sum);
    static_assert(sizeof(Texel) == 4 * sizeof(float));
    hn::StoreU(sum, lanes, &found.color.x);
    if (!std::isfinite(found.color.x + found.color.y + found.color.z)) return {};
    found.color = glm::max(found.color, vec3{0});
    return found;
}

void Antialiasing::add(Picture& picture)
{
    int const width = picture.width, height = picture.height;
    Layer &color = *picture.find("color"), &motion = *picture.find("motion");
    Layer const& depth = *picture.find("depth");
    std::swap(texels_, last_);
    std::swap(depths_, last_depths_);
    texels_.resize(picture.pixels());
    depths_ = depth.data;
    vec2 const scale{float(width_) / float(width), float(height_) / float(height)};
    tbb::parallel_for(0, height, [&](int y) {
        thread_local Around around;
        around.find(color.data.data(), width, height, y);
        for (int x = 0; x < width; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(width) + std::size_t(x);
            vec3 const now = rgb(color, i), was = rgb(motion, i);
            vec2 const place = scale * (vec2{float(x) + 0.5f, float(y) + 0.5f} + vec2(was));
            Texel const before = std::isfinite(was.x + was.y + was.z) ? earlier(place, was.z) : Texel{};
            float const frames = std::clamp(before.frames, 0.0f, kMostFrames - 1) + 1;
            texels_[i] = {frames > 1 ? glm::mix(around.hold(x, before.color), now, 1 / frames) : now, frames};
        }
    });
    tbb::parallel_for(std::size_t(0), texels_.size(), [&](std::size_t i) {
        for (std::size_t c = 0; c < 3; ++c) color.data[3 * i + c] = texels_[i].color[int(c)];
    });
    std::erase_if(picture.layers, [](Layer const& l) { return l.name == "motion"; });
    width_ = width;
    height_ = height;
    ++frame_;
}

} // namespace gi
