#include "gi/methods/sh_grid/caustic_map.h"

#include "gi/core/rng.h"

#include <algorithm>
#include <bit>
#include <numeric>

namespace gi {

std::uint32_t CausticMap::bucket(glm::ivec3 cell) const
{
    std::uint64_t const xy = std::uint64_t(std::uint32_t(cell.x)) << 32 | std::uint32_t(cell.y);
    return std::uint32_t(mix_bits(xy + mix_bits(std::uint32_t(cell.z))) & (first_.size() - 2));
}

glm::ivec3 CausticMap::cell_of(vec3 position) const
{
    return glm::ivec3(glm::floor(glm::clamp(position / (2 * radius_), -1e9f, 1e9f)));
}

CausticMap::CausticMap(std::vector<CausticPhoton> photons, float radius)
    : photons_(photons.size()),
      first_(std::bit_ceil(std::max<std::size_t>(photons.size(), 1)) + 1),
      radius_(radius)
{
    std::vector<std::uint32_t> bucket_of;
    bucket_of.reserve(photons.size());
    for (CausticPhoton const& p : photons) {
        bucket_of.push_back(bucket(cell_of(p.position)));
        ++first_[bucket_of.back() + 1];
    }
    std::partial_sum(first_.begin(), first_.end(), first_.begin());
    std::vector<std::uint32_t> next = first_;
    for (std::size_t i = 0; i < photons.size(); ++i) photons_[next[bucket_of[i]]++] = photons[i];
}

vec3 CausticMap::radiance(ShadingPoint const& at, vec3 wo) const
{
    constexpr float kSameWay = 0.8f;   // least cosine of a photon's normal with the surface's
    constexpr float kFromPlane = 0.2f; // radii; else the light of a table would lie on the paper on it
    vec3 sum{0};
    if (photons_.empty()) return sum;
    glm::ivec3 const low = cell_of(at.position - radius_);
    std::uint32_t buckets[8];
    for (int k = 0; k < 8; ++k) buckets[k] = bucket(low + glm::ivec3{k & 1, k >> 1 & 1, k >> 2});
    std::ranges::sort(buckets); // two cells may share one
    float const r2 = square(radius_);
    for (int k = 0; k < 8; ++k) {
        if (k > 0 && buckets[k] == buckets[k - 1]) continue;
        for (std::uint32_t i = first_[buckets[k]]; i < first_[buckets[k] + 1]; ++i) {
            CausticPhoton const& p = photons_[i];
            vec3 const way = p.position - at.position;
            float const d2 = glm::dot(way, way);
            if (!(d2 < r2) || glm::dot(p.normal, at.geometric_normal) < kSameWay ||
                std::abs(glm::dot(way, at.geometric_normal)) > kFromPlane * radius_)
                continue;
            sum += (1 - d2 / r2) * p.flux * evaluate(at.bsdf, wo, at.frame.to_local(p.from)).f;
        }
    }
    return sum * (2 * kInvPi / r2); // Epanechnikov's kernel
}

float median_radius(std::span<CausticPhoton const> photons, int neighbours)
{
    constexpr std::size_t kAround = 8192, kSamples = 129;
    if (photons.size() < 2) return 0;
    std::size_t const step = (photons.size() + kAround - 1) / kAround, n = (photons.size() + step - 1) / step;
    std::size_t const rank = std::min(std::max<std::size_t>(2, std::size_t(neighbours) / step), n - 1);
    std::vector<float> radii, squared(n);
    for (std::size_t s = 0; s < std::min(kSamples, n); ++s) {
        vec3 const about = photons[s * n / std::min(kSamples, n) * step].position;
        for (std::size_t i = 0; i < n; ++i) {
            vec3 const way = photons[i * step].position - about;
            squared[i] = glm::dot(way, way);
        }
        std::ranges::nth_element(squared,
                                 squared.begin() + std::ptrdiff_t(rank)); // the first is the photon itself
        radii.push_back(std::sqrt(squared[rank] * float(neighbours) / float(rank * step)));
    }
    std::ranges::nth_element(radii, radii.begin() + std::ptrdiff_t(radii.size() / 2));
    return radii[radii.size() / 2];
}

} // namespace gi
