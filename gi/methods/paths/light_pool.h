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
    LightSample seen_from(WorldView const& world, vec3 point) const
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

/// Samples in groups of kCandidates. The lights are split into kCandidates parts and a group has one sample of
/// each part. Groups are ordered like the samples within a part, so that well-distributed numbers in [0, 1)
/// choose well-distributed groups.
class LightPool {
public:
    static constexpr std::uint32_t kCandidates = 8;
    /// With more lights than kManyLights, a choice is made among kMostRounds groups.
    static constexpr std::uint32_t kManyLights = 512, kMostRounds = 4;

    /// @param groups  > 0  @param pass  selects the samples
    void fill(LightOrder const& order, World const& world, std::uint32_t groups, std::uint64_t seed,
              std::uint32_t pass);
    bool empty() const { return lights_.empty(); }

    /// Chooses a sample from one or several groups, with probability roughly proportional to its unoccluded
    /// contribution to a diffuse surface: luminance times the cosines over the squared distance.
    /// @param normal  unit, on the viewer's side
    /// @param u, pick  select the group and the sample within it; in [0, 1)
    ChosenLight choose(vec3 position, vec3 normal, float u, float pick) const;

private:
    /// Data for the probabilities, per group. (x, y, z) is a point if `near` is 1,
    /// else the direction to the light.
    struct Group {
        using Row = std::array<float, kCandidates>;
        alignas(32) Row x, y, z, near;
        /// Luminance / density (per area, per solid angle, or of the choice).
        alignas(32) Row power;
        /// Normal of the light; 0 = emits equally in all directions.
        alignas(32) Row facing_x, facing_y, facing_z;
        /// Cosine used if there is no normal; 1 if the back emits too.
        alignas(32) Row everywhere, back;
    };
    static void weigh(Group const& from, vec3 position, vec3 normal, float* weight);

    std::vector<Group> groups_;
    std::uint32_t rounds_ = 1; ///< number of groups among which a choice is made
    std::vector<PooledLight> lights_;
};

} // namespace gi
