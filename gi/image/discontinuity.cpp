#include "gi/image/discontinuity.h"

#include <tbb/parallel_for.h>

namespace gi {
namespace {

constexpr float kCosine = 0.95f;    // 18 degrees
constexpr float kAlbedo = 1;        // only what is too dark in other channels differs by more
constexpr float kPlaneDistance = 1; // in distances of neighbouring pixels

/// Planes of the sums: direct and indirect light as in namespace light, then the weights.
constexpr int kWeight = 6;

/// Where surfaces are in a row: pixels first..end - 1.
struct Extent {
    int first, end;
};

Extent extent_of(Planes const& guides, int y)
{
    float const* const surface = guides.row(guide::surface, y);
    Extent e{0, guides.width()};
    while (e.first < e.end && surface[e.first] == 0) ++e.first;
    while (e.end > e.first && surface[e.end - 1] == 0) --e.end;
    return e;
}

/// Adds to the sums of row y the light of the pixels that lie (dx, dy) away.
template <bool with_direct>
void add_row(Planes const& g, Planes const& light, Extent extent, int y, int dx, int dy, float share, Planes& out)
{
    int const there = y + dy;
    auto const normal = g.row3(guide::normal, y), q_normal = g.row3(guide::normal, there);
    auto const position = g.row3(guide::position, y), q_position = g.row3(guide::position, there);
    auto const q_direct = light.row3(light::direct, there), q_indirect = light.row3(light::indirect, there);
    auto const direct = out.row3(light::direct, y), indirect = out.row3(light::indirect, y);
    float const* const footprint = g.row(guide::inverse_footprint2, y);
    float const *albedo = g.row(guide::albedo, y), *q_albedo = g.row(guide::albedo, there) + dx;
    float* const weight = out.row(kWeight, y);
#pragma GCC ivdep
    for (int x = extent.first; x < extent.end; ++x) {
        vec3 const n = normal[x];
        float const cosine = glm::dot(n, q_normal[x + dx]);
        float const off_plane = glm::dot(n, q_position[x + dx] - position[x]);
        bool const agree = (cosine > kCosine) & (std::abs(q_albedo[x] - albedo[x]) < kAlbedo) &
                           (off_plane * off_plane * footprint[x] < square(kPlaneDistance));
        float const w = agree ? share : 0;
        if constexpr (with_direct) direct.set(x, direct[x] + w * q_direct[x + dx]);
        indirect.set(x, indirect[x] + w * q_indirect[x + dx]);
        weight[x] += w;
    }
}

void filter_row(FilterInput const& input, int window, int y, Planes& out)
{
    int const width = out.width(), radius = window / 2;
    Extent const extent = extent_of(input.guides, y);
    for (int p = 0; p < kWeight; ++p) std::copy_n(input.light.row(p, y), width, out.row(p, y));
    std::fill_n(out.row(kWeight, y), width, 1.0f); // the pixel itself counts whatever its surface
    auto const share = [&](int offset) { return window % 2 == 0 && std::abs(offset) == radius ? 0.5f : 1.0f; };
    for (int dy = std::max(-radius, -y); dy <= std::min(radius, out.height() - 1 - y); ++dy)
        for (int dx = -radius; dx <= radius; ++dx)
            if (dx != 0 || dy != 0)
                add_row<true>(input.guides, input.light, extent, y, dx, dy, share(dx) * share(dy), out);
    for (int p = 0; p < kWeight; ++p)
        for (int x = 0; x < width; ++x) out.row(p, y)[x] /= out.row(kWeight, y)[x];
}

/// Indirect light of `means`, averaged over windows as far apart as they are wide.
void widen_row(Planes const& guides, Planes const& means, int window, int reach, int y, Planes& out)
{
    int const width = out.width();
    Extent const extent = extent_of(guides, y);
    for (int p = light::indirect; p < kWeight; ++p) std::copy_n(means.row(p, y), width, out.row(p, y));
    std::fill_n(out.row(kWeight, y), width, 1.0f);
    for (int j = -reach; j <= reach; ++j) {
        int const there = y + j * window;
        if (there < 0 || there >= out.height()) continue;
        for (int i = -reach; i <= reach; ++i)
            if (i != 0 || j != 0) add_row<false>(guides, means, extent, y, i * window, there - y, 1, out);
    }
}

} // namespace

Planes filter_discontinuity(FilterInput const& input, int window, int reach)
{
    Planes out(kWeight + 1, input.light.width(), input.light.height());
    tbb::parallel_for(0, out.height(), [&](int y) { filter_row(input, window, y, out); });
    if (reach == 0) return out;
    Planes wide(kWeight + 1, out.width(), out.height());
    tbb::parallel_for(0, out.height(), [&](int y) { widen_row(input.guides, out, window, reach, y, wide); });
    tbb::parallel_for(0, out.height(), [&](int y) {
        for (int p = light::indirect; p < kWeight; ++p)
            for (int x = 0; x < out.width(); ++x) out.row(p, y)[x] = wide.row(p, y)[x] / wide.row(kWeight, y)[x];
    });
    return out;
}

} // namespace gi
