#include "gi/filter/atrous.h"

#include "gi/filter/for_rows.h"
#include "gi/filter/light_variance.h"
#include "gi/filter/outlines.h"
#include "gi/filter/surface_distance.h"

#include <array>

namespace gi {
namespace {

constexpr std::array<float, 3> kSpline{3.0f / 8, 1.0f / 4, 1.0f / 16};
// Luminance difference, in standard deviations, from which on weights are 0. Larger in the first iteration, whose
// variance is the least certain, and for indirect light, which has fewer edges.
constexpr float kDirect = 7, kDirectFirst = 10, kIndirect = 10, kIndirectFirst = 14;
constexpr float kTinyVariance = 1e-12f; // of light without noise

struct Iteration {
    Planes const& guides;
    Planes const& in;
    Planes& out; ///< the luminance planes hold the sums of the weights until finished
    int step;    ///< pixels between taps
    float plane_scale;
    float direct2, indirect2; ///< squared limits, in standard deviations, from which on weights are 0
};

/// Adds the taps of row y + dy * step to the sums of row y. The middle row starts the sums with its central tap,
/// which has the spline's full weight even if no neighbour is similar.
template <bool kMiddle>
void add_row(Iteration const& it, Spans spans, int y, int dy)
{
    Planes const& g = it.guides;
    int const there = y + dy * it.step, step = it.step;
    SurfaceRow const surfaces(g, y), q_surfaces(g, there);
    auto const q_direct = it.in.row3(light::direct, there), q_indirect = it.in.row3(light::indirect, there);
    auto const direct = it.out.row3(light::direct, y), indirect = it.out.row3(light::indirect, y);
    float const* const footprint = g.row(guide::inverse_footprint2, y);
    float const *l1 = it.in.row(light::luminance, y), *q_l1 = it.in.row(light::luminance, there);
    float const *l2 = it.in.row(light::luminance + 1, y), *q_l2 = it.in.row(light::luminance + 1, there);
    float const *v1 = it.in.row(light::variance, y), *q_v1 = it.in.row(light::variance, there);
    float const *v2 = it.in.row(light::variance + 1, y), *q_v2 = it.in.row(light::variance + 1, there);
    float *weight1 = it.out.row(light::luminance, y), *weight2 = it.out.row(light::luminance + 1, y);
    float *variance1 = it.out.row(light::variance, y), *variance2 = it.out.row(light::variance + 1, y);
    float const share = kSpline[std::size_t(std::abs(dy))], centre = share * kSpline[0];
    float const by_reach = it.plane_scale, direct2 = it.direct2, indirect2 = it.indirect2;

    for (Span const& span : spans)
#pragma GCC ivdep
        for (int x = span.first; x < span.end; ++x) {
            SurfacePoint const here(surfaces, x, footprint[x] * by_reach);
            float const by_l1 = 1 / (direct2 * v1[x] + kTinyVariance);
            float const by_l2 = 1 / (indirect2 * v2[x] + kTinyVariance);
            vec3 sum1 = kMiddle ? centre * q_direct[x] : direct[x],
                 sum2 = kMiddle ? centre * q_indirect[x] : indirect[x];
            float w1 = kMiddle ? centre : weight1[x], w2 = kMiddle ? centre : weight2[x];
            float s1 = kMiddle ? centre * centre * v1[x] : variance1[x];
            float s2 = kMiddle ? centre * centre * v2[x] : variance2[x];
            auto const tap = [&](int i, float spline) {
                float const d1 = q_l1[i] - l1[x], d2 = q_l2[i] - l2[x];
                float const like = 1 - here.distance2(q_surfaces, i);
                float const like1 = like - by_l1 * d1 * d1, like2 = like - by_l2 * d2 * d2;
                float const some1 = like1 > 0 ? like1 : 0, some2 = like2 > 0 ? like2 : 0;
                float const a = share * spline * some1 * some1, b = share * spline * some2 * some2;
                sum1 += a * q_direct[i];
                sum2 += b * q_indirect[i];
                s1 += a * a * q_v1[i];
                s2 += b * b * q_v2[i];
                w1 += a;
                w2 += b;
            };
            tap(x - 2 * step, kSpline[2]);
            tap(x - step, kSpline[1]);
            if constexpr (!kMiddle) tap(x, kSpline[0]);
            tap(x + step, kSpline[1]);
            tap(x + 2 * step, kSpline[2]);
            direct.set(x, sum1);
            indirect.set(x, sum2);
            weight1[x] = w1;
            weight2[x] = w2;
            variance1[x] = s1;
            variance2[x] = s2;
        }
}

/// Turns sums into means.
void divide(Planes& out, Spans spans, int y)
{
    for (int k = 0; k < 2; ++k) {
        auto const color = out.row3(light::direct + 3 * k, y);
        float *const weight = out.row(light::luminance + k, y), *const variance = out.row(light::variance + k, y);
        for (Span const& span : spans)
#pragma GCC ivdep
            for (int x = span.first; x < span.end; ++x) {
                float const scale = 1 / weight[x];
                vec3 const mean = scale * color[x];
                color.set(x, mean);
                variance[x] *= scale * scale;
                weight[x] = luminance(mean);
            }
    }
}

void filter_row(Iteration const& it, Spans spans, int y)
{
    add_row<true>(it, spans, y, 0);
    for (int const dy : {-2, -1, 1, 2})
        if (int const there = y + dy * it.step; there >= 0 && there < it.in.height())
            add_row<false>(it, spans, y, dy);
    divide(it.out, spans, y);
}

/// The partner's light is already filtered and counts as free of noise.
void lay(FilteredLight const& known, Planes const& from, int y, Planes& out)
{
    known.area.for_known(y, [&](Span span) {
        for (int p = light::direct; p < light::luminance && &from != &out; ++p)
            std::copy(from.row(p, y) + span.first, from.row(p, y) + span.end, out.row(p, y) + span.first);
        for (int k = 0; k < 2; ++k) {
            auto const color = out.row3(light::direct + 3 * k, y);
            float* const bright = out.row(light::luminance + k, y);
            float* const variance = out.row(light::variance + k, y);
            for (int x = span.first; x < span.end; ++x) {
                bright[x] = luminance(color[x]);
                variance[x] = 0;
            }
        }
    });
}

} // namespace

Planes filter_atrous(FilterInput& input, int iterations, FilteredLight const& known)
{
    find_variances(input);
    int const height = input.light.height();
    Planes other(light::count, input.light.width(), height);
    Planes const& where_known = known.light ? *known.light : input.light;
    auto const lay_in = [&](Planes& out) {
        for_rows(height, input.stop, [&](int y) { lay(known, where_known, y, out); });
    };
    lay_in(other);
    for (int i = 0; i < iterations; ++i) {
        int const step = 1 << i;
        Iteration const it{input.guides,
                           input.light,
                           other,
                           step,
                           plane_scale(step),
                           square(i == 0 ? kDirectFirst : kDirect),
                           square(i == 0 ? kIndirectFirst : kIndirect)};
        for_rows(height, input.stop, [&](int y) { filter_row(it, known.area.wanted[std::size_t(y)], y); });
        if (i == 0) lay_in(input.light); // the first iteration used the picture's own light
        std::swap(input.light, other);
    }
    smooth_outlines(input.guides, input.light, known.area.wanted, other);
    return other;
}

} // namespace gi
