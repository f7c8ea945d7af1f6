#pragma once
// Light samples that are drawn once for a pass, from which every path chooses its own: tables of a sky of millions
// of texels are read once for each sample, not once for each path.

#include "gi/scene/shading/light_sampling.h"

#include <array>

namespace gi {

/// All lights of a world in one order, neighbours beside each other, so that numbers that are spread well choose
/// lights (and texels of a sky) that are: every pass has its share of a small sun. Alias tables leave that to
/// chance.
class LightOrder {
public:
    /// As the world is now. It outlives this.
    void update(World const& world);
    /// @param u  in [0, 1), all 53 bits of it
    LightChoice choose(double u) const;

private:
    World const* world_ = nullptr;
    std::vector<double> light_sums_, texel_sums_; ///< of probabilities
    double texel_total_ = 0;                      ///< of the table that they belong to
};

/// The light sample where it does not depend on the point that is lit; else pdf = 0.
LightSample distant_light(World const& world, LightChoice const& choice, vec2 u);

struct PooledLight {
    LightChoice choice;
    vec2 u{0};         ///< where on the light
    LightSample light; ///< see distant_light
    /// A point on a surface that emits the same everywhere:
    vec3 position{0}, facing{0}, radiance{0}; ///< m; unit; W/(m^2 sr)
    float density = 0;                        ///< of the point, 1/m^2 times that of its choice; 0 = it is none
    bool both_sides = false;

    /// What sample_light says for that point.
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

/// One of the pool, drawn by resampled importance sampling (Talbot et al. 2005).
struct ChosenLight {
    PooledLight const* light = nullptr; ///< null = none of the candidates brings anything
    float weight = 0;                   ///< that its contribution over its pdf is multiplied by
};

/// Samples in groups of kCandidates. A group has one sample of each of kCandidates parts of all lights, and groups
/// follow each other as samples do within a part: a number in [0, 1) that is spread well chooses groups that are.
class LightPool {
public:
    static constexpr std::uint32_t kCandidates = 8;
    /// Where there are more lights, a choice is made among kMostRounds groups.
    static constexpr std::uint32_t kManyLights = 512, kMostRounds = 4;

    /// @param groups  > 0  @param pass  decides which samples
    void fill(LightOrder const& order, World const& world, std::uint32_t groups, std::uint64_t seed,
              std::uint32_t pass);
    bool empty() const { return lights_.empty(); }

    /// Of one group, or several, one sample, with chance in proportion to about what it would bring to a matt
    /// surface where nothing is in the way: its luminance times the cosines over the squared distance.
    /// @param normal  unit, on the side of the viewer  @param u  which group, pick  which sample of it; in [0, 1)
    ChosenLight choose(vec3 position, vec3 normal, float u, float pick) const;

private:
    /// What decides chances, per group. A point at `at` if `near` is 1, else the direction to it.
    struct Group {
        using Row = std::array<float, kCandidates>;
        alignas(32) Row x, y, z, near;
        alignas(32) Row power;                        ///< luminance over the density, of area, direction or choice
        alignas(32) Row facing_x, facing_y, facing_z; ///< normal of the light; 0 = it shines to all sides alike
        alignas(32) Row everywhere, back;             ///< cosine where it has no normal; of what its back sends
    };
    static void weigh(Group const& from, vec3 position, vec3 normal, float* weight);

    std::vector<Group> groups_;
    std::uint32_t rounds_ = 1; ///< groups that a choice is made among
    std::vector<PooledLight> lights_;
};

} // namespace gi
