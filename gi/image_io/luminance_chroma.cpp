#include "gi/image_io/luminance_chroma.h"

#include <algorithm>
#include <array>

namespace gi {
namespace {

/// Value halfway between samples `at` and `at` + 1 of `count`, which are `stride` apart.
float halfway(float const* samples, int at, int count, std::size_t stride)
{
    static constexpr std::array<float, 7> kTaps{0.627123f, -0.186077f, 0.087929f, -0.043159f,
                                                0.019597f, -0.007540f, 0.002128f};
    float sum = 0;
    for (int k = 0; k < int(kTaps.size()); ++k) {
        auto const before = std::size_t(std::max(0, at - k)), after = std::size_t(std::min(count - 1, at + 1 + k));
        sum += kTaps[std::size_t(k)] * (samples[before * stride] + samples[after * stride]);
    }
    return sum;
}

} // namespace

std::vector<float> spread(SparsePlane const& plane, int width, int height)
{
    int const columns = (width + plane.step_x - 1) / plane.step_x;
    int const rows = (height + plane.step_y - 1) / plane.step_y;
    auto const w = std::size_t(width);
    std::vector<float> wide(w * std::size_t(rows)), out(w * std::size_t(height));
    for (int y = 0; y < rows; ++y) {
        float const* const from = &plane.values[std::size_t(y) * std::size_t(columns)];
        for (int x = 0; x < width; ++x)
            wide[std::size_t(y) * w + std::size_t(x)] =
                x % plane.step_x == 0 ? from[x / plane.step_x] : halfway(from, x / 2, columns, 1);
    }
    for (int y = 0; y < height; ++y)
        for (std::size_t x = 0; x < w; ++x)
            out[std::size_t(y) * w + x] = y % plane.step_y == 0 ? wide[std::size_t(y / plane.step_y) * w + x]
                                                                : halfway(&wide[x], y / 2, rows, w);
    return out;
}

} // namespace gi
