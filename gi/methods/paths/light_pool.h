#pragma once
// Light samples drawn once per pass, from which every path chooses: the large tables of a sky with millions of
// texels are read once per sample, not once per path.

#include "gi/render/light_order.h"

#include <array>

namespace gi {

struct PooledLight {
    LightChoice choice;
    vec2 u{0};         ///< where on the light
    LightSample light; ///< see distant_light
    /// A point on a uniformly emitting surface:
    vec3 position{0}, facing{0}, radiance{0}; ///< m; unit; W/(m^2 sr)
    float density = 0;                        ///< of the point, 1/m^2, times the probability of choosing its
                                              ///< light; 0 = no such point
    bool both_sides = false;

    /// Returns what sample_light returns for a lit point.
    GI_FN LightSample seen_from(WorldView const& world, vec3 point) const
    {
        if (light.pdf > 0) return light;
        if (!(density > 0)) return sample_light(world, choice, point, u);
        LightSample s;
        vec3 const way = position - point;
        float const squared = glm::dot(way, way), inverse = 1 / std::sqrt(squared);
        s.direction = inverse * way;
        float const cosine = -glm::dot(facing, s.direction);
        if (!(squared > 0) || (!(cosine > 0) && !both_sides)) return s;
        s.distance = squared * inverse;
        s.radiance = radiance;
        s.pdf = density * squared / std::abs(cosine);
        if (!(s.pdf < kInf)) s.pdf = 0;
        return s;
    }
};

/// A sample from the pool, drawn by resampled importance sampling (Talbot et al. 2005).
struct ChosenLight {
    PooledLight const* light = nullptr; ///< null = no candidate contributes
    float weight = 0;                   ///< factor of its contribution / pdf
};

/// Eight light samples as data for the probabilities of choosing one. (x, y, z) is a point if `near` is 1, else the
/// direction to the light.
struct LightGroup {
    static constexpr std::uint32_t kCandidates = 8;
    using Row = std::array<float, kCandidates>;
    alignas(32) Row x, y, z, near;
    /// Luminance / density (per area, per solid angle, or of the choice).
    alignas(32) Row power;
    /// Normal of the light; 0 = emits equally in all directions.
    alignas(32) Row facing_x, facing_y, facing_z;
    /// Cosine used if there is no normal; 1 if the back emits too.
    alignas(32) Row everywhere, back;

    /// Roughly proportional to the unoccluded contribution to a diffuse surface.
    GI_FN float weight(std::uint32_t k, vec3 position, vec3 normal) const
    {
        float const dx = x[k] - near[k] * position.x, dy = y[k] - near[k] * position.y,
                    dz = z[k] - near[k] * position.z;
        float const squared = dx * dx + dy * dy + dz * dz, inverse = 1 / std::sqrt(squared + 1e-30f);
        float const cosine = (dx * normal.x + dy * normal.y + dz * normal.z) * inverse;
        float const front = -(dx * facing_x[k] + dy * facing_y[k] + dz * facing_z[k]) * inverse;
        float const light_point = everywhere[k] + glm::max(front, -front * back[k]);
        float const w = power[k] * glm::max(cosine, 0.0f) * glm::max(light_point, 0.0f) *
                        (near[k] * inverse * inverse + (1 - near[k]));
        return w < 1e30f ? w : 0;
    }
};

/// A LightPool for kernels.
struct LightPoolView {
    View<LightGroup const> groups; ///< empty = no lights
    View<PooledLight const> lights;
    std::uint32_t rounds = 1;

    /// As LightPool::choose. Weights are found twice: an array would lie in a device's slow memory.
    GI_FN ChosenLight choose(vec3 position, vec3 normal, float u, float pick) const
    {
        auto const all = std::uint32_t(groups.size()), first = glm::min(std::uint32_t(u * float(all)), all - 1),
                   count = rounds * LightGroup::kCandidates;
        auto const group = [&](std::uint32_t k) {
            std::uint64_t const further = std::uint64_t(k / LightGroup::kCandidates) * all / rounds;
            return (first + std::uint32_t(further)) % all;
        };
        auto const weight = [&](std::uint32_t k) {
            return groups[group(k)].weight(k % LightGroup::kCandidates, position, normal);
        };
        float sum = 0;
        for (std::uint32_t k = 0; k < count; ++k) sum += weight(k);
        if (!(sum > 0)) return {};
        float const wanted = pick * sum;
        float up_to = 0, own = 0;
        std::uint32_t chosen = count;
        for (std::uint32_t k = 0; k < count; ++k) {
            float const w = weight(k);
            if (w > 0) chosen = k, own = w; // of the last ones, only because of rounding
            up_to += w;
            if (up_to > wanted && w > 0) break;
        }
        if (chosen == count) return {};
        return {&lights[group(chosen) * LightGroup::kCandidates + chosen % LightGroup::kCandidates],
                sum / (own * float(count))};
    }
};

/// Samples in groups of kCandidates. The lights are split into kCandidates parts and a group has one sample of
/// each part. Groups are ordered like the samples within a part, so that well-distributed numbers in [0, 1)
/// choose well-distributed groups.
class LightPool {
public:
    static constexpr std::uint32_t kCandidates = LightGroup::kCandidates;
    /// With more lights than kManyLights, a choice is made among kMostRounds groups.
    static constexpr std::uint32_t kManyLights = 512, kMostRounds = 4;

    /// Number of groups for a pass: each is shared by few paths; with few lights all groups fit the second-level
    /// cache; with many lights each has about two samples.
    static std::uint32_t groups_for(std::size_t pixels, World const& world);
    /// @param groups  > 0  @param pass  selects the samples
    void fill(LightOrder const& order, World const& world, std::uint32_t groups, std::uint64_t seed,
              std::uint32_t pass);
    bool empty() const { return lights_.empty(); }

    /// Chooses a sample from one or several groups, with probability roughly proportional to its unoccluded
    /// contribution to a diffuse surface: luminance times the cosines over the squared distance.
    /// @param normal  unit, on the viewer's side
    /// @param u, pick  select the group and the sample within it; in [0, 1)
    ChosenLight choose(vec3 position, vec3 normal, float u, float pick) const;
    std::vector<LightGroup> const& groups() const { return groups_; }
    std::vector<PooledLight> const& lights() const { return lights_; }
    std::uint32_t rounds() const { return rounds_; } ///< number of groups among which a choice is made

private:
    std::vector<LightGroup> groups_;
    std::uint32_t rounds_ = 1;
    std::vector<PooledLight> lights_;
};

} // namespace gi
