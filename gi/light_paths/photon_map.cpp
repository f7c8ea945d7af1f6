#include "gi/light_paths/photon_map.h"

#include "gi/core/morton.h"
#include "gi/core/rng.h"

#include <algorithm>
#include <array>
#include <bit>
#include <numeric>

namespace gi {
namespace {

/// Called by the comparisons of long sorts, so that a stop request ends them.
void obey(BuildStop const& stop)
{
    if (stop.given_up()) throw Interrupted();
}

} // namespace

PhotonCells::PhotonCells(std::span<PhotonKernel const> kernels, float radius)
    : radius_(radius),
      kernels_(kernels.size()),
      first_(std::bit_ceil(std::max<std::size_t>(kernels.size(), 1)) + 1)
{
    std::vector<std::uint32_t> bucket_of;
    bucket_of.reserve(kernels.size());
    for (PhotonKernel const& k : kernels) {
        bucket_of.push_back(bucket(cell_of(k.position)));
        ++first_[bucket_of.back() + 1];
        low_ = glm::min(low_, k.position - radius);
        high_ = glm::max(high_, k.position + radius);
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::uint32_t> next = first_;
    for (std::size_t i = 0; i < kernels.size(); ++i) kernels_[next[bucket_of[i]]++] = kernels[i];
}

std::uint32_t PhotonCells::bucket(glm::ivec3 cell) const
{
    std::uint64_t const xy = std::uint64_t(std::uint32_t(cell.x)) << 32 | std::uint32_t(cell.y);
    return std::uint32_t(mix_bits(xy + mix_bits(std::uint32_t(cell.z))) & (first_.size() - 2));
}

glm::ivec3 PhotonCells::cell_of(vec3 position) const
{
    return glm::ivec3(glm::floor(glm::clamp(position / (2 * radius_), -1e9f, 1e9f)));
}

template <class F>
void PhotonCells::search(vec3 position, F const& f) const
{
    if (glm::any(glm::lessThan(position, low_)) || glm::any(glm::lessThan(high_, position))) return;
    glm::ivec3 const low = cell_of(position - radius_);
    std::uint32_t buckets[8];
    for (int k = 0; k < 8; ++k) buckets[k] = bucket(low + glm::ivec3{k & 1, k >> 1 & 1, k >> 2});
    std::ranges::sort(buckets); // two cells may share one
    for (int k = 0; k < 8; ++k) {
        if (k > 0 && buckets[k] == buckets[k - 1]) continue;
        for (std::uint32_t i = first_[buckets[k]]; i < first_[buckets[k] + 1]; ++i) f(kernels_[i]);
    }
}

std::vector<float> radii_by_density(std::span<Photon const> photons, float largest, std::size_t enough,
                                    std::uint64_t seed, BuildStop const& stop)
{
    constexpr int kLevels = 12, kTrees = 4;
    constexpr float kCells = 2097152; // of a Morton curve, along an axis
    struct Place {
        std::uint64_t key; ///< of the finest cell, along a Morton curve
        std::uint32_t photon;
    };
    vec3 middle{0};
    std::vector<float> along(photons.size());
    for (int axis = 0; axis < 3; ++axis) {
        for (std::size_t i = 0; i < photons.size(); ++i) along[i] = photons[i].position[axis];
        auto const median = along.begin() + std::ptrdiff_t(along.size() / 2);
        std::nth_element(along.begin(), median, along.end());
        if (median != along.end()) middle[axis] = *median;
    }
    // The area of a cell's side is that of a kernel.
    float const per_m = std::ldexp(1 / (largest * std::sqrt(kPi)), kLevels - 1);
    std::vector<std::uint16_t> halvings(photons.size());
    std::vector<Place> places;
    for (int tree = 0; tree < kTrees; ++tree) {
        obey(stop);
        Pcg32 rng = Pcg32::for_path(seed ^ 0x0c7e, std::uint32_t(tree), 0);
        vec3 const shift = std::ldexp(1.0f, kLevels - 1) * vec3{rng.uniform(), rng.uniform(), rng.uniform()};
        places.clear();
        for (std::uint32_t i = 0; i < photons.size(); ++i) {
            vec3 const at = (photons[i].position - middle) * per_m + kCells / 2 + shift;
            // Others are so far away that the largest kernels will do.
            if (!(min_component(at) >= 0) || !(max_component(at) < kCells)) continue;
            glm::uvec3 const cell(at);
            places.push_back({morton(cell.x, cell.y, cell.z), i});
        }
        std::ranges::sort(places, [&](Place const& a, Place const& b) {
            obey(stop);
            return a.key < b.key;
        });
        for (int level = 1; level < kLevels; ++level) {
            obey(stop);
            int const bits = 3 * (kLevels - 1 - level);
            for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
                while (end < places.size() && places[end].key >> bits == places[begin].key >> bits) ++end;
                for (std::size_t k = begin; end - begin >= enough && k < end; ++k) ++halvings[places[k].photon];
            }
        }
    }
    std::vector<float> out;
    for (std::uint16_t const h : halvings) out.push_back(largest * std::exp2(-float(h) / kTrees));
    return out;
}

std::vector<float> radii_by_footprint(std::span<Photon const> photons, float largest, float photons_each)
{
    std::vector<float> out;
    for (Photon const& p : photons)
        out.push_back(glm::clamp(std::sqrt(photons_each * p.footprint * kInvPi), 1e-4f * largest, largest));
    return out;
}

void sort_along_curve(std::vector<Photon>& photons, BuildStop const& stop)
{
    Bounds box;
    for (Photon const& p : photons) box = joined(box, {p.position, p.position});
    vec3 const scale = 1023.0f / glm::max(box.high - box.low, vec3{1e-30f});
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    order.reserve(photons.size());
    for (std::uint32_t i = 0; i < photons.size(); ++i) {
        glm::uvec3 const cell(glm::clamp((photons[i].position - box.low) * scale, 0.0f, 1023.0f));
        order.emplace_back(morton(cell.x, cell.y, cell.z), i);
    }
    std::ranges::sort(order, [&](auto const& a, auto const& b) {
        obey(stop);
        return a < b;
    });
    std::vector<Photon> sorted;
    sorted.reserve(photons.size());
    for (auto const& [key, i] : order) {
        obey(stop);
        sorted.push_back(photons[i]);
    }
    photons = std::move(sorted);
}

PhotonMap::PhotonMap(std::span<Photon const> photons, std::span<float const> radii, BuildStop const& stop)
    : photons_(photons)
{
    constexpr int kLayers = 24;
    float largest = 0;
    for (float const r : radii) largest = std::max(largest, r);
    std::vector<std::uint8_t> layer_of;
    layer_of.reserve(photons.size());
    std::array<std::size_t, kLayers> counts{};
    for (float const r : radii) {
        layer_of.push_back(std::uint8_t(glm::clamp(std::floor(std::log2(largest / r)), 0.0f, kLayers - 1.0f)));
        ++counts[layer_of.back()];
    }
    std::vector<PhotonKernel> part;
    for (int k = 0; k < kLayers; ++k) {
        std::size_t const count = counts[std::size_t(k)];
        if (count == 0) continue;
        part.clear();
        part.reserve(count);
        for (std::uint32_t i = 0; part.size() < count; ++i) {
            if (layer_of[i] != k) continue;
            obey(stop);
            part.push_back({photons[i].position, radii[i], photons[i].normal, i});
        }
        layers_.emplace_back(part, std::ldexp(largest, -k));
    }
    for (std::size_t i = 0; i < photons.size(); ++i) {
        flux_ += dvec3(photons[i].flux);
        radii_ += double(radii[i]);
    }
}

vec3 PhotonMap::radiance(ShadingPoint const& at, vec3 wo, bool without_glossy) const
{
    PhotonSum sum(at, wo, without_glossy);
    for (PhotonCells const& layer : layers_)
        layer.search(at.position, [&](PhotonKernel const& k) { sum.add(k, photons_[k.photon]); });
    return sum.radiance();
}

} // namespace gi
