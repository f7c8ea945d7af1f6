#include "gi/hit_buffers/directions/axis_set.h"

#include "gi/core/rqmc.h"
#include "gi/core/step.h"

#include <algorithm>
#include <atomic>
#include <numeric>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Bins of normals per side of the octahedral square.
constexpr std::uint32_t kNormalBins = 64;

/// Counted twice, as they are copied into the pool.
std::size_t bytes_of(HitBuffer const& b)
{
    return 2 * (b.offset.size() * sizeof(b.offset[0]) + b.layers.size() * sizeof(HitLayer));
}

/// Uniform direction on the hemisphere. @param u  in [0, 1)^2
vec3 half_sphere(vec2 u)
{
    float const z = 1 - u.x, r = std::sqrt(glm::max(0.0f, 1 - z * z));
    return {r * std::cos(2 * kPi * u.y), r * std::sin(2 * kPi * u.y), z};
}

/// Uniform over all rotations (Shoemake 1992).
dquat random_rotation(std::uint64_t seed)
{
    Pcg32 rng(seed, 0x0707a7);
    double const u = rng.uniform(), a = 2 * glm::pi<double>() * rng.uniform(),
                 b = 2 * glm::pi<double>() * rng.uniform(), low = std::sqrt(1 - u), high = std::sqrt(u);
    return {high * std::cos(b), low * std::sin(a), low * std::cos(a), high * std::sin(b)};
}

} // namespace

void AxisSet::build_elsewhere(std::span<std::size_t const> slots)
{
    constexpr std::size_t kTogether = 64; // so that progress is shown, and a stop is answered
    BuildStop const building(source_.stop);
    for (std::size_t first = 0; first < slots.size(); first += kTogether) {
        if (building.given_up()) throw Interrupted();
        at_step("hit buffers", first, slots.size());
        std::vector<AxisToBuild> axes;
        for (std::size_t const s : slots.subspan(first, std::min(kTogether, slots.size() - first)))
            axes.push_back({s, grids_[s], cut_seeds_[s]});
        std::vector<BuiltAxis> const built = source_.elsewhere(axes);
        for (std::size_t k = 0; k < axes.size(); ++k) {
            ++built_;
            layers_ += built[k].layers;
            lost_ += built[k].lost;
            bytes_[axes[k].slot] = built[k].bytes;
            stale_[axes[k].slot] = 0;
        }
        if (std::accumulate(bytes_.begin(), bytes_.end(), std::size_t(0)) > source_.most_bytes)
            throw HitBuffersTooLarge();
    }
}

void AxisSet::build(std::vector<NewAxis> axes)
{
    std::size_t const coarse = axes.size();
    for (std::size_t level = 1; level < levels(); ++level)
        for (std::size_t k = 0; k < coarse; ++k) {
            NewAxis const& a = axes[k];
            axes.push_back({a.slot + level * axes_, level, a.direction, a.number});
        }
    buffers_.resize(axes_ * levels());
    BuildStop const building(source_.stop);
    std::atomic<std::size_t> bytes = 0;
    for (HitBuffer const& b : buffers_) bytes += bytes_of(b);
    std::atomic<std::size_t> begun = 0;
    auto const build_one = [&](std::size_t k) {
        if (bytes > source_.most_bytes || building.given_up()) return;
        NewAxis const& axis = axes[k];
        Pcg32 rng = Pcg32::for_path(source_.seed ^ 0x51a6, std::uint32_t(axis.slot), axis.number);
        vec2 const jitter = rng.uniform2();
        Bounds const& box = axis.level == 0 ? source_.bounds : source_.windows[axis.level - 1];
        RasterGrid const grid =
            make_window(box, source_.bounds, axis.direction, source_.resolution, jitter, 2 * kPi * rng.uniform());
        cut_seeds_[axis.slot] = rng.next();
        if (source_.elsewhere) {
            grids_[axis.slot] = grid;
            return;
        }
        at_step("hit buffers", begun++, axes.size());
        bytes -= bytes_of(buffers_[axis.slot]);
        BorrowedFragments fragments;
        rasterize(source_.soup, 0, std::min(source_.first_moving, source_.soup.count), grid, MacroPath::edge_table,
                  *fragments);
        source_.cut_outs.remove(*fragments, grid, cut_seeds_[axis.slot]);
        fill_hit_buffer(*fragments, grid, source_.most_layers, buffers_[axis.slot]);
        bytes += bytes_of(buffers_[axis.slot]);
    };
    cut_seeds_.resize(buffers_.size());
    if (source_.elsewhere) {
        if (std::exchange(moved_, false)) std::ranges::fill(stale_, 1);
        stale_.resize(buffers_.size());
        grids_.resize(buffers_.size());
        bytes_.resize(buffers_.size());
        std::vector<std::size_t> slots;
        for (std::size_t k = 0; k < axes.size(); ++k) {
            build_one(k);
            slots.push_back(axes[k].slot);
        }
        return build_elsewhere(slots);
    }
    tbb::parallel_for(std::size_t(0), axes.size(), build_one);
    if (building.given_up()) throw Interrupted();
    if (bytes > source_.most_bytes) throw HitBuffersTooLarge();
    for (NewAxis const& axis : axes) {
        lost_ += buffers_[axis.slot].lost;
        layers_ += buffers_[axis.slot].layers.size();
    }
    built_ += axes.size();
    if (axes.empty() && pool_.size() > 0) return;
    fill_pool(buffers_, pool_, source_.packed, building);
    moving_.forget();
    moved_ = true;
}

void AxisSet::move(std::span<std::uint8_t const> updated)
{
    if (source_.first_moving >= source_.soup.count) return;
    bool const moved = std::exchange(moved_, false);
    if (source_.elsewhere) {
        if (moved) std::ranges::fill(stale_, 1);
        std::vector<std::size_t> outdated;
        for (std::size_t a = 0; a < stale_.size(); ++a)
            if (updated[a] != 0 && stale_[a] != 0) outdated.push_back(a);
        return build_elsewhere(outdated);
    }
    if (moved) moving_.moved();
    lost_ += moving_.append({source_.soup, source_.first_moving, source_.cut_outs, source_.most_layers},
                            cut_seeds_, updated, pool_);
}

void AxisSet::update_axes()
{
    some_ = false;
    move(std::vector<std::uint8_t>(cut_seeds_.size(), 1));
}

std::size_t AxisSet::update_some_axes(std::uint32_t sequences, std::uint32_t count, std::uint32_t turn)
{
    std::size_t const n = tables_.axes.size();
    auto const parts = std::uint32_t(
        count == 0 ? 1 : std::max(n / std::min<std::size_t>(count, n), (n + FewAxes::kMost - 1) / FewAxes::kMost));
    if (parts == 1) {
        update_axes();
        return axes_;
    }
    some_ = true;
    few_.assign(sequences, {});
    std::vector<std::uint8_t> updated(cut_seeds_.size(), 0);
    for (std::uint32_t s = 0; s < sequences; ++s) {
        // Every n-th axis: axes of a subdivided solid are ordered by location,
        // so that each part covers the whole sphere.
        std::vector<std::uint32_t> order(parts);
        std::iota(order.begin(), order.end(), 0u);
        Pcg32 rng = Pcg32::for_path(source_.seed ^ 0xf0110, s, turn / parts);
        for (std::uint32_t k = parts; k > 1; --k) std::swap(order[k - 1], order[rng.next() % k]);
        FewAxes& few = few_[s];
        for (std::size_t a = order[turn % parts]; a < n; a += parts) ++few.count;
        for (std::size_t k = 0, a = order[turn % parts]; a < n; a += parts, ++k) {
            few.set(k, tables_.axes[a], tables_.solid_angles[a] * float(parts * few.count) / (2 * kPi), a);
            for (std::size_t level = 0; level < levels(); ++level) updated[a + level * n] = 1;
        }
    }
    move(updated);
    return std::size_t(std::ranges::count(updated, 1)) / levels();
}

void AxisSet::store(DirectionSet const& directions)
{
    DirectionSet turned = directions;
    dquat const rotation = random_rotation(source_.seed);
    for (dvec3& a : turned.axes) a = glm::normalize(rotation * a);
    tables_ = make_cosine_tables(turned, kNormalBins);
    axes_ = std::uint32_t(turned.axes.size());
    std::vector<NewAxis> axes;
    for (dvec3 const a : turned.axes) axes.push_back({axes.size(), 0, vec3(a), 0});
    build(std::move(axes));
    buffers_.clear();
    buffers_.shrink_to_fit();
}

void AxisSet::refresh(std::uint32_t sequences, std::uint32_t count, std::uint32_t fresh, std::uint32_t pass)
{
    std::uint32_t const first = pass * fresh, last = first + count;
    if (axes_ != sequences * count || drawn_ < first || drawn_ > last) {
        axes_ = sequences * count;
        buffers_.clear();
        few_.assign(sequences, {});
        few_count_ = count;
        drawn_ = first;
    }
    std::vector<NewAxis> axes;
    for (std::uint32_t s = 0; s < sequences; ++s) {
        FewAxes& few = few_[s];
        few.count = count;
        for (std::uint32_t number = drawn_; number < last; ++number) {
            RqmcStream const stream{std::uint32_t(mix_bits(source_.seed ^ (0xa8e5 + s))), number};
            vec3 const axis = half_sphere(vec2(stream.sample_together(0)));
            std::uint32_t const a = number % count;
            axes.push_back({std::size_t(s) * count + a, 0, axis, number});
            few.set(a, axis, 1, std::size_t(s) * count + a);
        }
    }
    drawn_ = last;
    build(std::move(axes));
}

} // namespace gi
