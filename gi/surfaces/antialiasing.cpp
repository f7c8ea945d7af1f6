#include "gi/surfaces/antialiasing.h"

#include "gi/core/catmull_rom.h"
#include "gi/core/radical_inverse.h"
#include "gi/filter/filter_input.h"

#include <array>
#include <cmath>
#include <hwy/highway.h>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

namespace hn = hwy::HWY_NAMESPACE;

/// Weight of the earlier samples, at most.
constexpr float kMost = 4;
/// Earlier colours are clamped to the mean +- this many standard deviations of 3 x 3 pixels.
constexpr float kSpread = 2;
/// Share of the difference from the four pixels around that is added again to what is shown.
constexpr float kSharpness = 0.2f;
/// Relative difference of depths from which on a pixel showed another surface.
constexpr float kDepth = 0.05f;

/// Range of colours in 3 x 3 pixels around each pixel of a row: the mean +- kSpread standard deviations.
struct Around {
    std::vector<float> sums, squares, least, most;

    void find(float const* color, int width, int height, int y)
    {
        std::size_t const n = 3 * std::size_t(width);
        float const *const row = color + n * std::size_t(y), *const up = y > 0 ? row - n : row,
                           *const down = y + 1 < height ? row + n : row;
        for (auto* const v : {&sums, &squares, &least, &most}) v->resize(n + 6);
        for (std::size_t i = 0; i < n; ++i) {
            sums[i + 3] = row[i] + up[i] + down[i];
            squares[i + 3] = row[i] * row[i] + up[i] * up[i] + down[i] * down[i];
        }
        for (auto* const v : {&sums, &squares})
            for (std::size_t c = 0; c < 3; ++c) {
                (*v)[c] = (*v)[3 + c];
                (*v)[n + 3 + c] = (*v)[n + c];
            }
        for (std::size_t i = 0; i < n; ++i) {
            float const mean = (sums[i] + sums[i + 3] + sums[i + 6]) / 9,
                        square = (squares[i] + squares[i + 3] + squares[i + 6]) / 9,
                        reach = kSpread * std::sqrt(std::max(0.0f, square - mean * mean));
            least[i] = mean - reach;
            most[i] = mean + reach;
        }
    }
    vec3 hold(int x, vec3 color) const
    {
        std::size_t const i = 3 * std::size_t(x);
        return glm::clamp(color, vec3{least[i], least[i + 1], least[i + 2]},
                          vec3{most[i], most[i + 1], most[i + 2]});
    }
};

/// Where the middles of a mean's pixels lie along one axis of a picture.
struct Axis {
    struct Pixel {
        float place;  ///< from the sample of the picture's first pixel, in its pixels
        int nearest;  ///< pixel of the picture
        float weight; ///< of its sample
    };
    std::vector<Pixel> pixels;

    /// @param at  where samples lie in the picture's pixels
    Axis(int of_mean, int of_picture, float at)
    {
        float const scale = float(of_picture) / float(of_mean);
        for (int x = 0; x < of_mean; ++x) {
            float const place = (float(x) + 0.5f) * scale - at;
            int const nearest = std::clamp(int(std::floor(place + 0.5f)), 0, of_picture - 1);
            float const away = (float(nearest) - place) / scale;
            pixels.push_back({place, nearest, std::exp(-away * away)});
        }
    }
};

/// Interpolates between samples; @param x, y  from the first pixel's sample, in pixels
vec3 bilinear(Layer const& color, int width, int height, float x, float y)
{
    float const left = std::floor(x), top = std::floor(y);
    vec2 const f{x - left, y - top};
    auto const at = [&](int i, int j) {
        return rgb(color, std::size_t(std::clamp(int(top) + j, 0, height - 1)) * std::size_t(width) +
                              std::size_t(std::clamp(int(left) + i, 0, width - 1)));
    };
    return glm::mix(glm::mix(at(0, 0), at(1, 0), f.x), glm::mix(at(0, 1), at(1, 1), f.x), f.y);
}

/// The mean minus a share of its Laplacian, within the range of it and the four pixels around, so that outlines
/// get no halos: sharpens what resampling has softened.
vec3 sharpened(vec3 middle, std::array<vec3, 4> const& around)
{
    vec3 least = middle, most = middle, sum{0};
    for (vec3 const& c : around) {
        least = glm::min(least, c);
        most = glm::max(most, c);
        sum += c;
    }
    vec3 const sharp = middle + kSharpness * (4.0f * middle - sum);
    return all_finite(sharp) ? glm::clamp(sharp, least, most) : middle;
}

} // namespace

vec2 Antialiasing::sample() const
{
    constexpr std::uint32_t kPeriod = 16;
    std::size_t const i = frame_ % kPeriod + 1;
    return {float(radical_inverse(i, 2)), float(radical_inverse(i, 3))};
}

/// What the last mean showed, with weight 0 where that was another surface or beyond its borders.
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
    for (std::size_t j = 0; j < 4; ++j) {
        Texel const* const row = &last_[rows[j]];
        auto of_row = hn::Mul(hn::Set(lanes, across[0]), hn::LoadU(lanes, &row[columns[0]].color.x));
        for (std::size_t i = 1; i < 4; ++i)
            of_row = hn::MulAdd(hn::Set(lanes, across[i]), hn::LoadU(lanes, &row[columns[i]].color.x), of_row);
        sum = hn::MulAdd(hn::Set(lanes, down[j]), of_row, sum);
    }
    static_assert(sizeof(Texel) == 4 * sizeof(float));
    hn::StoreU(sum, lanes, &found.color.x);
    if (!std::isfinite(found.color.x + found.color.y + found.color.z)) return {};
    found.color = glm::max(found.color, vec3{0});
    return found;
}

Picture Antialiasing::add(Picture const& picture, int width, int height)
{
    Layer const &color = *picture.find("color"), &motion = *picture.find("motion"),
                &depth = *picture.find("depth");
    Picture shown{width, height, {}, {}};
    shown.add("color", 3);
    shown.add("depth", 1);
    std::vector<float>&mean = shown.find("color")->data, &depths = shown.find("depth")->data;
    std::swap(texels_, last_);
    texels_.resize(shown.pixels());
    vec2 const at = sample(), larger{float(width) / float(picture.width), float(height) / float(picture.height)},
               scale{float(width_) / float(width), float(height_) / float(height)};
    Axis const columns(width, picture.width, at.x), rows(height, picture.height, at.y);
    tbb::parallel_for(0, height, [&](int y) {
        thread_local Around around;
        Axis::Pixel const row = rows.pixels[std::size_t(y)];
        around.find(color.data.data(), picture.width, picture.height, row.nearest);
        for (int x = 0; x < width; ++x) {
            std::size_t const i = std::size_t(y) * std::size_t(width) + std::size_t(x);
            Axis::Pixel const& column = columns.pixels[std::size_t(x)];
            std::size_t const nearest =
                std::size_t(row.nearest) * std::size_t(picture.width) + std::size_t(column.nearest);
            vec3 const was = rgb(motion, nearest);
            vec2 const place = scale * (vec2{float(x) + 0.5f, float(y) + 0.5f} + larger * vec2(was));
            Texel const before = std::isfinite(was.x + was.y + was.z) ? earlier(place, was.z) : Texel{};
            float const earlier_weight = std::clamp(before.weight, 0.0f, kMost),
                        weight = column.weight * row.weight;
            vec3 const now = earlier_weight > 0
                                 ? glm::mix(around.hold(column.nearest, before.color), rgb(color, nearest),
                                            weight / (earlier_weight + weight))
                                 : bilinear(color, picture.width, picture.height, column.place, row.place);
            texels_[i] = {now, earlier_weight + weight};
            depths[i] = depth.data[nearest];
        }
    });
    tbb::parallel_for(0, height, [&](int y) {
        auto const mean_of = [&](int i, int j) {
            return texels_[std::size_t(j) * std::size_t(width) + std::size_t(i)].color;
        };
        int const up = std::max(y - 1, 0), down = std::min(y + 1, height - 1);
        for (int x = 0; x < width; ++x) {
            vec3 const c =
                sharpened(mean_of(x, y), {mean_of(std::max(x - 1, 0), y), mean_of(std::min(x + 1, width - 1), y),
                                          mean_of(x, up), mean_of(x, down)});
            std::size_t const i = std::size_t(y) * std::size_t(width) + std::size_t(x);
            for (std::size_t k = 0; k < 3; ++k) mean[3 * i + k] = c[int(k)];
        }
    });
    last_depths_ = depths;
    width_ = width;
    height_ = height;
    ++frame_;
    return shown;
}

} // namespace gi
