#include "gi/light_paths/photon_map.h"

#include "gi/core/morton.h"
#include "gi/core/rng.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace gi {

PhotonCells::PhotonCells(std::vector<Photon> photons, float radius)
    : radius_(radius),
      photons_(photons.size()),
      first_(std::bit_ceil(std::max<std::size_t>(photons.size(), 1)) + 1)
{
    std::vector<std::uint32_t> bucket_of;
    bucket_of.reserve(photons.size());
    for (Photon const& p : photons) {
        bucket_of.push_back(bucket(cell_of(p.position)));
        ++first_[bucket_of.back() + 1];
        low_ = glm::min(low_, p.position - radius);
        high_ = glm::max(high_, p.position + radius);
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::uint32_t> next = first_;
    for (std::size_t i = 0; i < photons.size(); ++i) photons_[next[bucket_of[i]]++] = photons[i];
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
        for (std::uint32_t i = first_[buckets[k]]; i < first_[buckets[k] + 1]; ++i) f(photons_[i]);
    }
}

KernelSizes sizes_by_density(std::span<Photon const> photons, float largest, std::size_t enough)
{
    constexpr int kLayers = KernelSizes::kLayers;
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
    float const per_m = std::ldexp(1 / (largest * std::sqrt(kPi)), kLayers - 1);
    std::vector<Place> places;
    places.reserve(photons.size());
    constexpr float kCells = 2097152; // of a Morton curve, along an axis
    for (std::uint32_t i = 0; i < photons.size(); ++i) {
        vec3 const at = (photons[i].position - middle) * per_m + kCells / 2;
        // Others are so far away that the largest kernels will do.
        if (!(min_component(at) >= 0) || !(max_component(at) < kCells)) continue;
        glm::uvec3 const cell(at);
        places.push_back({morton(cell.x, cell.y, cell.z), i});
    }
    std::ranges::sort(places, {}, &Place::key);
    KernelSizes out{largest, std::vector<std::uint8_t>(photons.size())};
    for (int layer = 1; layer < kLayers; ++layer) {
        int const shift = 3 * (kLayers - 1 - layer);
        for (std::size_t begin = 0, end = 0; begin < places.size(); begin = end) {
            while (end < places.size() && places[end].key >> shift == places[begin].key >> shift) ++end;
            for (std::size_t k = begin; end - begin >= enough && k < end; ++k)
                out.layer[places[k].photon] = std::uint8_t(layer);
        }
    }
    return out;
}

void sort_along_curve(std::vector<Photon>& photons)
{
    Bounds box;
    for (Photon const& p : photons) box = joined(box, {p.position, p.position});
    vec3 const scale = 1023.0f / glm::max(box.high - box.low, vec3{1e-30f});
    std::vector<std::pair<std::uint64_t, std::uint32_t>> order;
    for (std::uint32_t i = 0; i < photons.size(); ++i) {
        glm::uvec3 const cell(glm::clamp((photons[i].position - box.low) * scale, 0.0f, 1023.0f));
        order.emplace_back(morton(cell.x, cell.y, cell.z), i);
    }
    std::ranges::sort(order);
    std::vector<Photon> sorted;
    for (auto const& [key, i] : order) sorted.push_back(photons[i]);
    photons = std::move(sorted);
}

KernelSizes sizes_by_footprint(std::span<Photon const> photons, float largest, float photons_each)
{
    KernelSizes out{largest, std::vector<std::uint8_t>(photons.size())};
    for (std::size_t i = 0; i < photons.size(); ++i) {
        float const radius = std::sqrt(photons_each * photons[i].footprint * kInvPi);
        float const halvings = radius > 0 ? std::round(std::log2(largest / radius)) : KernelSizes::kLayers;
        out.layer[i] = std::uint8_t(glm::clamp(halvings, 0.0f, float(KernelSizes::kLayers - 1)));
    }
    return out;
}

PhotonMap::PhotonMap(std::span<Photon const> photons, KernelSizes const& sizes, float factor)
    : count_(photons.size())
{
    std::vector<std::vector<Photon>> parts(KernelSizes::kLayers);
    for (std::size_t i = 0; i < photons.size(); ++i) {
        parts[sizes.layer[i]].push_back(photons[i]);
        flux_ += dvec3(photons[i].flux);
    }
    for (int k = 0; k < KernelSizes::kLayers; ++k)
        if (auto& part = parts[std::size_t(k)]; !part.empty())
            layers_.emplace_back(std::move(part), factor * std::ldexp(sizes.largest, -k));
}

vec3 PhotonMap::radiance(ShadingPoint const& at, vec3 wo, bool without_glossy) const
{
    PhotonSum sum(at, wo, without_glossy);
    for (PhotonCells const& layer : layers_)
        layer.search(at.position, [&](Photon const& p) { sum.add({p.position, layer.radius(), p.normal, 0}, p); });
    return sum.radiance();
}

float PhotonMap::mean_radius() const
{
    double sum = 0;
    for (PhotonCells const& layer : layers_) sum += double(layer.radius()) * double(layer.size());
    return count_ == 0 ? 0 : float(sum / double(count_));
}

} // namespace gi
