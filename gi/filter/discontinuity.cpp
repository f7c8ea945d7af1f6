#include "gi/filter/discontinuity.h"

#include "gi/filter/for_rows.h"

namespace gi {
namespace {

constexpr float kCosineStep = 0.95f; // 18 degrees
constexpr float kAlbedoStep = 1;     // larger differences occur only if other channels are too dark
constexpr float kPlaneDistance = 1;  // in units of the distance between neighbouring pixels

/// Planes of the sums: direct and indirect light as in namespace light, then the weights.
constexpr int kWeight = 6;

/// Adds the light of the pixels at offset (dx, dy) to the sums of row y.
template <bool with_direct>
void add_row(Planes const& g, Planes const& light, Spans spans, int y, int dx, int dy, float share, Planes& out)
{
    int const there = y + dy;
    auto const normal = g.row3(guide::normal, y), q_normal = g.row3(guide::normal, there);
    auto const position = g.row3(guide::position, y), q_position = g.row3(guide::position, there);
    auto const q_direct = light.row3(light::direct, there), q_indirect = light.row3(light::indirect, there);
    auto const direct = out.row3(light::direct, y), indirect = out.row3(light::indirect, y);
    float const* const footprint = g.row(guide::inverse_footprint2, y);
    float const *albedo = g.row(guide::albedo, y), *q_albedo = g.row(guide::albedo, there) + dx;
    float* const weight = out.row(kWeight, y);
    for (Span const& span : spans)
#pragma GCC ivdep
        for (int x = span.first; x < span.end; ++x) {
            vec3 const n = normal[x];
            float const cosine = glm::dot(n, q_normal[x + dx]);
            float const off_plane = glm::dot(n, q_position[x + dx] - position[x]);
            bool const agree = (cosine > kCosineStep) & (std::abs(q_albedo[x] - albedo[x]) < kAlbedoStep) &
                               (off_plane * off_plane * footprint[x] < square(kPlaneDistance));
            float const w = agree ? share : 0;
            if constexpr (with_direct) direct.set(x, direct[x] + w * q_direct[x + dx]);
            indirect.set(x, indirect[x] + w * q_indirect[x + dx]);
            weight[x] += w;
        }
}

/// Starts the sums of a span with its own light: a pixel always counts itself.
void start_sums(Planes const& light, int first_plane, Span span, int y, Planes& out)
{
    for (int p = first_plane; p < kWeight; ++p)
        std::copy(light.row(p, y) + span.first, light.row(p, y) + span.end, out.row(p, y) + span.first);
    std::fill(out.row(kWeight, y) + span.first, out.row(kWeight, y) + span.end, 1.0f);
}

void divide(Planes const& sums, int first_plane, Spans spans, int y, Planes& out)
{
    for (int p = first_plane; p < kWeight; ++p)
        for (Span const& s : spans)
            for (int x = s.first; x < s.end; ++x) out.row(p, y)[x] = sums.row(p, y)[x] / sums.row(kWeight, y)[x];
}

void filter_row(FilterInput const& input, int window, Spans spans, int y, Planes& out)
{
    int const radius = window / 2;
    for (Span const& s : spans) start_sums(input.light, light::direct, s, y, out);
    auto const share = [&](int offset) { return window % 2 == 0 && std::abs(offset) == radius ? 0.5f : 1.0f; };
    for (int dy = std::max(-radius, -y); dy <= std::min(radius, out.height() - 1 - y); ++dy)
        for (int dx = -radius; dx <= radius; ++dx)
            if (dx != 0 || dy != 0)
                add_row<true>(input.guides, input.light, spans, y, dx, dy, share(dx) * share(dy), out);
    divide(out, light::direct, spans, y, out);
}

/// Indirect light of `means`, averaged over adjacent windows (spaced by their width).
void widen_row(Planes const& guides, Planes const& means, int window, int reach, Spans spans, int y, Planes& out)
{
    for (Span const& s : spans) start_sums(means, light::indirect, s, y, out);
    for (int j = -reach; j <= reach; ++j) {
        int const there = y + j * window;
        if (there < 0 || there >= out.height()) continue;
        for (int i = -reach; i <= reach; ++i)
            if (i != 0 || j != 0) add_row<false>(guides, means, spans, y, i * window, there - y, 1, out);
    }
}

} // namespace

Planes filter_discontinuity(FilterInput const& input, int window, int reach, FilteredLight const& known)
{
    Planes out(kWeight + 1, input.light.width(), input.light.height());
    auto const in_rows = [&](auto const& work) {
        for_rows(out.height(), input.stop, [&](int y) { work(Spans(known.area.wanted[std::size_t(y)]), y); });
    };
    Planes const& where_known = known.light ? *known.light : input.light;
    for_rows(out.height(), input.stop, [&](int y) {
        known.area.for_known(y, [&](Span span) { start_sums(where_known, light::direct, span, y, out); });
    });
    in_rows([&](Spans spans, int y) { filter_row(input, window, spans, y, out); });
    if (reach == 0) return out;
    Planes wide(kWeight + 1, out.width(), out.height());
    in_rows([&](Spans spans, int y) { widen_row(input.guides, out, window, reach, spans, y, wide); });
    in_rows([&](Spans spans, int y) { divide(wide, light::indirect, spans, y, out); });
    return out;
}

} // namespace gi
