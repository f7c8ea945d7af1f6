#include "gi/filter/outlines.h"

#include "gi/filter/surface_distance.h"

#include <tbb/parallel_for.h>

namespace gi {
namespace {

// A neighbour counts if its variance is this many times less than the pixel's.
constexpr float kLessVariance = 2;
constexpr float kRelativeNoise = 0.2f; // 1 / (standard deviation / mean)^2 from which on pixels are unchanged
constexpr float kKnown = 1e-3f;        // (standard deviation / mean)^2: no light is assumed to be known better
constexpr float kNoVariance = 1e-12f;  // variance of light without noise

/// One row of direct or indirect light.
struct LightRow {
    SurfaceRow surfaces;
    Row3<float const> color;
    float const *luminance, *variance, *surface;
    float inside; ///< 0 if the row is outside the picture

    LightRow(Planes const& guides, Planes const& light, int which, int y)
        : LightRow(guides, light, which, std::clamp(y, 0, light.height() - 1),
                   y >= 0 && y < light.height() ? 1.0f : 0.0f)
    {
    }

private:
    LightRow(Planes const& guides, Planes const& light, int which, int y, float is_inside)
        : surfaces(guides, y),
          color(light.row3(light::direct + 3 * which, y)),
          luminance(light.row(light::luminance + which, y)),
          variance(light.row(light::variance + which, y)),
          surface(guides.row(guide::surface, y)),
          inside(is_inside)
    {
    }
};

/// Accumulates the neighbours' statistics of the light.
struct NeighbourSums {
    float by_variance, albedo;
    float count = 1e-20f, sum = 0, squares = 0;

    /// 0 to 1: how much smaller a neighbour's variance is.
    float less_noisy(LightRow const& r, int i) const
    {
        float const g = 1 - by_variance * r.variance[i], da = r.surfaces.albedo[i] - albedo;
        float const counts = g > 0 && da * da < 1 ? g : 0; // else different channels are too dark to compare
        return counts * r.surface[i] * r.inside;
    }
    void add(LightRow const& r, int i)
    {
        float const g = less_noisy(r, i), l = r.luminance[i];
        count += g;
        sum += g * l;
        squares += g * l * l;
    }
};

void smooth_row(Planes const& guides, Planes const& light, int which, Spans spans, int y, Planes& out)
{
    LightRow const above(guides, light, which, y - 1), row(guides, light, which, y),
        below(guides, light, which, y + 1);
    auto const result = out.row3(light::direct + 3 * which, y);
    float const* const footprint = guides.row(guide::inverse_footprint2, y);
    for (Span const& span : spans)
#pragma GCC ivdep
        for (int x = span.first; x < span.end; ++x) {
            float const variance = row.variance[x], own = row.luminance[x];
            NeighbourSums near{kLessVariance / (variance + kNoVariance), row.surfaces.albedo[x]};
            near.add(above, x - 1);
            near.add(above, x);
            near.add(above, x + 1);
            near.add(row, x - 1);
            near.add(row, x + 1);
            near.add(below, x - 1);
            near.add(below, x);
            near.add(below, x + 1);
            float const mean = near.sum / near.count, square_mean = near.squares / near.count; // spread + mean^2
            float const floor = kKnown * mean * mean + kNoVariance;
            float const noise = 1 - kRelativeNoise * mean * mean / (variance + kNoVariance);
            float const gate = noise > 0 && variance > kNoVariance ? noise : 0;
            SurfacePoint const here(row.surfaces, x, footprint[x] * plane_scale(1));
            float total = 1 / (variance + floor);
            vec3 sum = total * row.color[x];
            auto const take = [&](LightRow const& r, int i) {
                float const d2 = here.distance2(r.surfaces, i), differs = d2 < 1 ? d2 : 1;
                float const apart = r.luminance[i] - own, beyond = apart * apart - variance;
                float const off2 = square_mean + (beyond > 0 ? beyond : 0);
                float const w = gate * near.less_noisy(r, i) / (r.variance[i] + differs * off2 + floor);
                sum += w * r.color[i];
                total += w;
            };
            take(above, x - 1);
            take(above, x);
            take(above, x + 1);
            take(row, x - 1);
            take(row, x + 1);
            take(below, x - 1);
            take(below, x);
            take(below, x + 1);
            result.set(x, (1 / total) * sum);
        }
}

} // namespace

void smooth_outlines(Planes const& guides, Planes const& light, RowSpans const& wanted, Planes& out)
{
    tbb::parallel_for(0, light.height(), [&](int y) {
        for (int which = 0; which < 2; ++which) smooth_row(guides, light, which, wanted[std::size_t(y)], y, out);
    });
}

} // namespace gi
