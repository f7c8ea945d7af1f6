#include "gi/slhb/axis_set.h"

#include "gi/base/rng.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Bins of normals across the octahedral square.
constexpr std::uint32_t kNormalBins = 64;

/// Uniform over all rotations (Shoemake 1992).
glm::quat random_rotation(Pcg32& rng)
{
    float const u = rng.uniform(), a = 2 * kPi * rng.uniform(), c = 2 * kPi * rng.uniform();
    float const r0 = std::sqrt(1 - u), r1 = std::sqrt(u);
    return {r1 * std::cos(c), r0 * std::sin(a), r0 * std::cos(a), r1 * std::sin(c)};
}

/// Axis k of a spherical Fibonacci lattice on the half sphere.
vec3 fibonacci_axis(std::uint32_t k, std::uint32_t count)
{
    constexpr float kGolden = 0.61803398874989f;
    float const z = (float(k) + 0.5f) / float(count), phi = 2 * kPi * (float(k) * kGolden - std::floor(float(k) * kGolden));
    float const r = std::sqrt(1 - z * z);
    return {r * std::cos(phi), r * std::sin(phi), z};
}

} // namespace

AxisSample FewAxes::sample(vec3 normal, float u) const
{
    constexpr std::size_t kBlock = 16;
    alignas(64) std::array<float, kMost> weight;
    std::array<float, kMost / kBlock> block;
    float total = 0;
    for (std::size_t first = 0, b = 0; first < count; first += kBlock, ++b) {
        float sum = 0;
        for (std::size_t k = first; k < first + kBlock; ++k)
            weight[k] = std::abs(normal.x * x[k] + normal.y * y[k] + normal.z * z[k]) * solid_angle[k];
        for (std::size_t k = first; k < first + kBlock; ++k) sum += weight[k];
        block[b] = sum;
        total += sum;
    }
    float left = u * total;
    std::size_t b = 0;
    while (kBlock * (b + 1) < count && left >= block[b]) left -= block[b++];
    std::size_t k = b * kBlock;
    while (k + 1 < (b + 1) * kBlock && left >= weight[k]) left -= weight[k++];
    while (k > 0 && weight[k] == 0) --k; // rounding may end on the padding
    vec3 const axis{x[k], y[k], z[k]};
    return {std::uint32_t(k), glm::dot(axis, normal) < 0 ? -axis : axis, total * kInvPi};
}

void AxisSet::build(std::vector<std::size_t> const& which, std::vector<vec3> const& axes, std::uint32_t pass)
{
    tbb::parallel_for(std::size_t(0), which.size(), [&](std::size_t k) {
        thread_local Fragments fragments;
        std::size_t const a = which[k];
        Pcg32 rng = Pcg32::for_path(source_.seed ^ 0x51a6, std::uint32_t(a), pass);
        vec2 const jitter = rng.uniform2();
        RasterGrid const grid = make_grid(source_.bounds, axes[k], source_.resolution, jitter, 2 * kPi * rng.uniform());
        fragments.count = 0;
        rasterize(source_.soup, 0, source_.soup.count, grid, MacroPath::edge_table, fragments);
        source_.cut_outs.remove(fragments, grid, rng.next());
        fill_hit_buffer(fragments, grid, source_.most_layers, buffers_[a]);
    });
    for (std::size_t const a : which) {
        lost_ += buffers_[a].lost;
        layers_ += buffers_[a].layers.size();
    }
    built_ += which.size();
    fill_pool(buffers_, pool_);
}

void AxisSet::store(DirectionSet const& directions)
{
    tables_ = make_cosine_tables(directions, kNormalBins);
    buffers_.resize(directions.axes.size());
    std::vector<std::size_t> which;
    std::vector<vec3> axes;
    for (dvec3 const a : directions.axes) {
        which.push_back(axes.size());
        axes.push_back(vec3(a));
    }
    build(which, axes, 0);
    buffers_.clear();
    buffers_.shrink_to_fit();
}

void AxisSet::refresh(std::uint32_t count, std::uint32_t fresh, std::uint32_t pass)
{
    if (buffers_.size() != count) {
        buffers_.resize(count);
        fresh = count;
        next_ = 0;
    }
    Pcg32 rng = Pcg32::for_path(source_.seed ^ 0xa8e5, 0, pass);
    glm::quat const turn = random_rotation(rng);
    std::vector<std::size_t> which;
    std::vector<vec3> axes;
    few_.count = (count + 15) / 16 * 16;
    for (std::uint32_t k = 0; k < fresh; ++k) {
        std::uint32_t const a = (next_ + k) % count;
        vec3 const axis = glm::normalize(turn * fibonacci_axis(a, count));
        which.push_back(a);
        axes.push_back(axis);
        few_.x[a] = axis.x;
        few_.y[a] = axis.y;
        few_.z[a] = axis.z;
    }
    for (std::uint32_t k = 0; k < few_.count; ++k) {
        few_.solid_angle[k] = k < count ? 2 * kPi / float(count) : 0.0f;
        if (k >= count) few_.x[k] = few_.y[k] = few_.z[k] = 0;
    }
    next_ = (next_ + fresh) % count;
    build(which, axes, pass);
}

} // namespace gi
