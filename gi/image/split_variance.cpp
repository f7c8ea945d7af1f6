#include "gi/image/split_variance.h"

#include <array>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

constexpr int kRadius = 2;

/// Squared second differences of one luminance along row y; 0 where a neighbour is no surface.
void measure_noise(FilterInput const& in, int which, int y, float* out)
{
    int const above = std::max(y - 1, 0), below = std::min(y + 1, in.light.height() - 1);
    auto const luminance_row = [&](int j) { return in.light.row(light::luminance + which, j); };
    auto const surface_row = [&](int j) { return in.guides.row(guide::surface, j); };
    float const *here = luminance_row(y), *up = luminance_row(above), *down = luminance_row(below);
    float const *surface = surface_row(y), *surface_up = surface_row(above), *surface_down = surface_row(below);
#pragma GCC ivdep
    for (int x = 0; x < in.light.width(); ++x) {
        float const along = (here[x - 1] - 2 * here[x] + here[x + 1]) * surface[x - 1] * surface[x + 1];
        float const across = (up[x] - 2 * here[x] + down[x]) * surface_up[x] * surface_down[x];
        float const a = along * along, b = across * across;
        out[x] = a < b ? a : b;
    }
}

} // namespace

void split_variance(FilterInput& in)
{
    int const width = in.light.width(), height = in.light.height();
    Planes noise(2, width, height);
    tbb::parallel_for(0, height, [&](int y) {
        for (int k = 0; k < 2; ++k) measure_noise(in, k, y, noise.row(k, y));
    });
    tbb::parallel_for(0, height, [&](int y) {
        Planes columns(4, width, 1), sums(4, width, 1);
        for (int k = 0; k < 4; ++k) {
            float *const column = columns.row(k, 0), *const sum = sums.row(k, 0);
            std::fill(column, column + width, 0.0f);
            for (int j = std::max(0, y - kRadius); j <= std::min(height - 1, y + kRadius); ++j) {
                std::array<float const*, 4> const rows{noise.row(0, j), noise.row(1, j),
                                                       in.guides.row(guide::variance, j),
                                                       in.guides.row(guide::surface, j)};
                float const* const row = rows[std::size_t(k)];
                for (int x = 0; x < width; ++x) column[x] += row[x];
            }
            for (int x = 0; x < width; ++x)
                sum[x] = column[x - 2] + column[x - 1] + column[x] + column[x + 1] + column[x + 2];
        }
        float const *direct = sums.row(0, 0), *indirect = sums.row(1, 0), *variance = sums.row(2, 0),
                    *surfaces = sums.row(3, 0);
        float *out_direct = in.light.row(light::variance, y), *out_indirect = in.light.row(light::variance + 1, y);
#pragma GCC ivdep
        for (int x = 0; x < width; ++x) {
            float const mean = variance[x] / (surfaces[x] > 1 ? surfaces[x] : 1);
            float const share = (direct[x] + 1e-20f) / (direct[x] + indirect[x] + 2e-20f);
            out_direct[x] = mean * share;
            out_indirect[x] = mean * (1 - share);
        }
    });
}

} // namespace gi
