#include "gi/filter/light_variance.h"

#include "gi/filter/for_rows.h"
#include "gi/filter/surface_distance.h"

#include <algorithm>

namespace gi {
namespace {

constexpr int kRadius = 2;

/// Squared second differences of one luminance along row y; 0 if a neighbour has no surface.
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

/// Writes to row k of `sums` the window sums, over (2 kRadius + 1)^2 pixels around row y, of the rows row_of(k,
/// j) of light and guides.
template <class RowOf>
void sum_windows(FilterInput const& in, int y, RowOf const& row_of, Planes& sums)
{
    int const width = in.light.width(), height = in.light.height();
    Planes column(1, width, 1);
    float* const at = column.row(0, 0);
    for (int k = 0; k < sums.count(); ++k) {
        std::fill(at, at + width, 0.0f);
        for (int j = std::max(0, y - kRadius); j <= std::min(height - 1, y + kRadius); ++j) {
            float const* const row = row_of(k, j);
            for (int x = 0; x < width; ++x) at[x] += row[x];
        }
        float* const sum = sums.row(k, 0);
        for (int x = 0; x < width; ++x) sum[x] = at[x - 2] + at[x - 1] + at[x] + at[x + 1] + at[x + 2];
    }
}

void split_variance(FilterInput& in)
{
    int const width = in.light.width(), height = in.light.height();
    Planes noise(2, width, height);
    for_rows(height, in.stop, [&](int y) {
        for (int k = 0; k < 2; ++k) measure_noise(in, k, y, noise.row(k, y));
    });
    for_rows(height, in.stop, [&](int y) {
        Planes sums(4, width, 1);
        auto const row_of = [&](int k, int j) {
            return k < 2 ? noise.row(k, j) : in.guides.row(k == 2 ? guide::variance : guide::surface, j);
        };
        sum_windows(in, y, row_of, sums);
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

/// Variance of direct and indirect luminance over surrounding pixels with a similar surface.
vec2 variance_around(FilterInput const& in, int x, int y)
{
    constexpr int kReach = 3;
    SurfacePoint const here(SurfaceRow(in.guides, y), x,
                            in.guides.row(guide::inverse_footprint2, y)[x] * plane_scale(kReach));
    float weights = 0;
    vec2 sum{0}, squares{0};
    for (int j = std::max(0, y - kReach); j <= std::min(in.light.height() - 1, y + kReach); ++j) {
        SurfaceRow const row(in.guides, j);
        float const *l1 = in.light.row(light::luminance, j), *l2 = in.light.row(light::luminance + 1, j);
        for (int i = x - kReach; i <= x + kReach; ++i) { // pixels beyond the border have no surface
            float const like = std::max(0.0f, 1 - here.distance2(row, i));
            vec2 const light{l1[i], l2[i]};
            weights += like;
            sum += like * light;
            squares += like * light * light;
        }
    }
    if (!(weights > 0)) return vec2{0};
    vec2 const mean = sum / weights;
    return glm::max(vec2{0}, squares / weights - mean * mean);
}

void pool_variance(FilterInput& in)
{
    int const width = in.light.width(), height = in.light.height();
    Planes known(3, width, height); // known variances, and a mask of where they are known
    for_rows(height, in.stop, [&](int y) {
        float const *direct = in.light.row(light::variance, y), *indirect = in.light.row(light::variance + 1, y);
        for (int x = 0; x < width; ++x) {
            bool const is = direct[x] >= 0 && indirect[x] >= 0;
            known.row(0, y)[x] = is ? direct[x] : 0;
            known.row(1, y)[x] = is ? indirect[x] : 0;
            known.row(2, y)[x] = is;
        }
    });
    for_rows(height, in.stop, [&](int y) {
        constexpr float kFew = 5; // of 25
        Planes sums(3, width, 1);
        sum_windows(
            in, y, [&](int k, int j) { return known.row(k, j); }, sums);
        float *direct = in.light.row(light::variance, y), *indirect = in.light.row(light::variance + 1, y);
        float const *surface = in.guides.row(guide::surface, y), *count = sums.row(2, 0);
        for (int x = 0; x < width; ++x) {
            vec2 v{0};
            if (count[x] >= kFew)
                v = vec2{sums.row(0, 0)[x], sums.row(1, 0)[x]} / count[x];
            else if (surface[x] > 0)
                v = variance_around(in, x, y);
            direct[x] = v.x;
            indirect[x] = v.y;
        }
    });
}

} // namespace

void find_variances(FilterInput& in)
{
    if (in.measured)
        pool_variance(in);
    else
        split_variance(in);
}

} // namespace gi
