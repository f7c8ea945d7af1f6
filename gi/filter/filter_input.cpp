#include "gi/filter/filter_input.h"

#include "gi/core/error.h"
#include "gi/filter/for_rows.h"

#include <array>
#include <atomic>
#include <utility>

namespace gi {
namespace {

struct Layers {
    Layer const *l1, *l2, *albedo, *normal, *position, *variance;
    std::array<Layer const*, 2> measured; ///< variances of direct and indirect light; null = not measured
};

/// Differs by more than 1 between surfaces whose dark channels differ.
float albedo_guide(vec3 a)
{
    return luminance(a) + 4.0f * float((a.x < kDarkest) + 2 * (a.y < kDarkest) + 4 * (a.z < kDarkest));
}

/// Noise of the three channels is mostly correlated, so standard deviations are added.
float luminance_variance(vec3 variance, vec3 albedo)
{
    return square(luminance(over_albedo(glm::sqrt(glm::max(variance, vec3{0})), albedo)));
}

/// Origin of positions, so that products with them have smaller rounding errors.
vec3 first_position(Layers const& layers, std::size_t pixels)
{
    for (std::size_t i = 0; i < pixels; ++i)
        if (rgb(*layers.normal, i) != vec3{0} && in_range(rgb(*layers.position, i)))
            return rgb(*layers.position, i);
    return vec3{0};
}

void fill(Layers const& layers, vec3 origin, Span span, int y, FilterInput& in, DenoiseReport& report)
{
    auto const normal = in.guides.row3(guide::normal, y), position = in.guides.row3(guide::position, y),
               direct = in.light.row3(light::direct, y), indirect = in.light.row3(light::indirect, y);
    float *const surface = in.guides.row(guide::surface, y), *const variance = in.guides.row(guide::variance, y);
    float* const albedo = in.guides.row(guide::albedo, y);
    float *const l1 = in.light.row(light::luminance, y), *const l2 = in.light.row(light::luminance + 1, y);
    for (int x = span.first; x < span.end; ++x) {
        std::size_t const i = std::size_t(y) * std::size_t(in.light.width()) + std::size_t(x);
        vec3 const n = rgb(*layers.normal, i), p = rgb(*layers.position, i), a = rgb(*layers.albedo, i);
        vec3 const direct_light = rgb(*layers.l1, i), indirect_light = rgb(*layers.l2, i);
        vec3 const var = layers.variance ? rgb(*layers.variance, i) : vec3{0};
        vec3 const e1 = over_albedo(direct_light, a), e2 = over_albedo(indirect_light, a);
        float const v = luminance_variance(var, a);
        bool const finite = in_range(n) && in_range(p) && in_range(a) && in_range(direct_light) &&
                            in_range(indirect_light) && in_range(var) && in_range(e1) && in_range(e2) &&
                            v < kLargest;
        bool const known = finite && n != vec3{0} && max_component(a) >= kDarkest;
        report.not_finite += !finite;
        report.without_surface += finite && !known;
        report.no_variance &= !(known && (v > 0 || in.measured));
        for (int k = 0; k < 2 && in.measured; ++k) {
            float const m = layers.measured[std::size_t(k)]->data[i];
            in.light.row(light::variance + k, y)[x] = known && m < kLargest ? m : -1;
        }
        normal.set(x, known ? n / std::max(1.0f, glm::length(n)) : vec3{0});
        position.set(x, known ? p - origin : vec3{0});
        direct.set(x, known ? e1 : vec3{0});
        indirect.set(x, known ? e2 : vec3{0});
        surface[x] = known;
        albedo[x] = known ? albedo_guide(a) : 0;
        variance[x] = known ? v : 0;
        l1[x] = known ? luminance(e1) : 0;
        l2[x] = known ? luminance(e2) : 0;
    }
}

/// Distance to the nearest of the four neighbours: on a surface seen at a grazing angle that is the distance
/// across the line of sight. At least the rounding error of the coordinates.
void measure_footprints(Layer const& positions, Span span, int y, Planes& guides)
{
    auto const here = guides.row3(guide::position, y);
    float* const out = guides.row(guide::inverse_footprint2, y);
    int const width = guides.width();
    std::fill(out + span.first, out + span.end, kLargest);
    auto const look = [&](int dx, int dy) {
        if (y + dy < 0 || y + dy >= guides.height()) return;
        auto const there = guides.row3(guide::position, y + dy);
        float const* const surface = guides.row(guide::surface, y + dy);
#pragma GCC ivdep
        for (int x = span.first; x < span.end; ++x) {
            vec3 const d = there[x + dx] - here[x];
            float const distance2 = surface[x + dx] > 0 ? glm::dot(d, d) : kLargest;
            out[x] = distance2 < out[x] ? distance2 : out[x];
        }
    };
    look(-1, 0);
    look(1, 0);
    look(0, -1);
    look(0, 1);
    for (int x = span.first; x < span.end; ++x) {
        vec3 const p = glm::abs(rgb(positions, std::size_t(y) * std::size_t(width) + std::size_t(x)));
        float const rounding = 2.4e-7f * max_component(p);
        bool const known = guides.row(guide::surface, y)[x] > 0;
        out[x] = known ? 1 / std::max({out[x], square(rounding), 1e-30f}) : 0;
    }
}

} // namespace

Layer const& needed_layer(Picture const& picture, char const* name)
{
    Layer const* const layer = picture.find(name);
    if (layer == nullptr || layer->channels != 3)
        throw InputError(std::string("the picture has no layer '") + name + "'",
                         "the filters divide by the albedo and stop at edges of the surface",
                         "keep all layers until it is filtered");
    return *layer;
}

Layer& needed_layer(Picture& picture, char const* name)
{
    return const_cast<Layer&>(needed_layer(std::as_const(picture), name));
}

FilterInput make_filter_input(Picture const& picture, bool with_variance, FilterArea const& area,
                              StopRequest const* stop)
{
    std::array<Layer const*, 2> const measured{picture.find("variance_direct"), picture.find("variance_indirect")};
    bool const is_measured = with_variance && measured[0] != nullptr && measured[1] != nullptr;
    Layers const layers{&needed_layer(picture, "L1"),
                        &needed_layer(picture, "L2"),
                        &needed_layer(picture, "albedo"),
                        &needed_layer(picture, "normal"),
                        &needed_layer(picture, "position"),
                        with_variance && !is_measured ? &needed_layer(picture, "variance") : nullptr,
                        measured};
    FilterInput in{{guide::count, picture.width, picture.height},
                   {light::count, picture.width, picture.height},
                   is_measured,
                   {},
                   stop};
    vec3 const origin = first_position(layers, picture.pixels());
    std::atomic<std::size_t> without_surface = 0, not_finite = 0;
    std::atomic<bool> no_variance = true;
    for_rows(picture.height, stop, [&](int y) {
        DenoiseReport row{0, 0, true}, known{0, 0, true};
        for (Span const& s : area.wanted[std::size_t(y)]) fill(layers, origin, s, y, in, row);
        area.for_known(y, [&](Span s) { fill(layers, origin, s, y, in, area.takes ? known : row); });
        without_surface += row.without_surface;
        not_finite += row.not_finite;
        if (!row.no_variance || !known.no_variance) no_variance = false;
    });
    for_rows(picture.height, stop, [&](int y) {
        RowSpans const& rows = is_measured ? area.near : area.wanted;
        for (Span const& s : rows[std::size_t(y)]) measure_footprints(*layers.position, s, y, in.guides);
    });
    in.report = {without_surface, not_finite, with_variance && no_variance};
    return in;
}

} // namespace gi
