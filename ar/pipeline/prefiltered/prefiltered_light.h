#pragma once
// Light of an environment map on still (real) and moving (virtual) surfaces, without random numbers: prefiltered
// irradiance where nothing is in the way, times the share of it that arrives, by occlusion maps along a fixed set
// of directions; from the directions in which a surface is in the way arrives its light instead.
//
//   E(p, n) = E_map(n) sum_k V_k F_k c_k / sum_k F_k c_k  +  pi sum_k (1 - V_k) L_k w_k c_k / sum_k w_k c_k
//
// k: parts of the sphere (environment_cells.h), F_k their light, w_k their solid angle,
// c_k the cosine, V_k visibility, L_k the radiance of what hides the part.
// E_map is exact to the map's texels, so an open surface has no error of sampling, whatever its normal;
// only shadows have one. L_k is kept for the still surfaces in small patches, with two bounces between them;
// of moving surfaces it is their albedo times what a white ball in their middle would show.

#include "ar/pipeline/prefiltered/environment_cells.h"
#include "ar/pipeline/prefiltered/glossy_table.h"
#include "ar/pipeline/prefiltered/still_surfaces.h"

namespace ar {

/// A point of a surface that receives light.
struct LitPoint {
    gi::vec3 position;  ///< on the triangle, m
    gi::vec3 normal;    ///< unit, of shading
    gi::vec3 geometric; ///< unit, of the triangle, on the same side
    std::uint32_t triangle;
    gi::vec3 to_viewer{0}; ///< unit; used with a glossy lobe
    GlossyLobe lobe;
};

/// Light received by a point, or the change of it.
struct ReceivedLight {
    gi::vec3 irradiance{0}; ///< W/m^2
    gi::vec3 glossy{0};     ///< radiance that its glossy lobe reflects to the viewer
};

/// Numbers for --stats.
struct PrefilteredCounts {
    std::size_t directions = 0, patches = 0;
};

struct PrefilteredSettings {
    /// Moving triangles drawn in a frame, over all maps; the other maps follow in the next frames.
    std::size_t triangles_at_once = 4'000'000;
};

class PrefilteredLight {
public:
    /// Builds everything for the world's present state. @param world  must outlive this object
    /// @throws gi::Interrupted
    explicit PrefilteredLight(gi::World const& world, gi::StopRequest const& stop = {},
                              PrefilteredSettings const& settings = {});

    /// The environment has changed; call moved() after it.
    /// @throws gi::Interrupted; then this object is of no use any more
    void relight(gi::StopRequest const& stop = {});
    /// Call after moving triangles have moved or directions have changed. With very many triangles,
    /// not all maps are drawn at once: those of sharp shadows in this frame, others some frames later.
    /// @throws gi::Interrupted as relight
    void moved(gi::StopRequest const& stop = {});
    /// Draws maps that are not yet up to date; call in frames in which nothing moves.
    /// @return false: there were none
    bool settle();

    ReceivedLight on_moving(LitPoint const& at) const;
    /// How moving surfaces change the light of a still one; exactly 0 where they hide nothing.
    ReceivedLight change_on_still(LitPoint const& at) const;
    /// The light of a still surface without the moving ones.
    /// @param every, first  uses every `every`-th direction from index `first`, plus all bright ones
    ReceivedLight on_still(LitPoint const& at, std::size_t every = 1, std::size_t first = 0) const;
    /// Light without anything in the way.
    ReceivedLight open_light(LitPoint const& at) const;
    gi::vec3 open(gi::vec3 normal) const;

    PrefilteredCounts counts() const { return {directions_.size(), still_.patches().size()}; }

private:
    static constexpr int kSide = 73; ///< nodes, of tables by normal
    /// Sums over directions, weighted by cosine or lobe.
    struct Sums {
        gi::vec3 light{0};    ///< what arrives of the environment
        gi::vec3 radiance{0}; ///< of surfaces, times solid angle
    };
    /// Sums over all light, whether it arrives or not.
    struct All {
        gi::vec3 light{0};
        float solid_angle = 0;
    };
    class Gather;
    static constexpr std::size_t kMostDirections = 128;

    template <class Visit>
    void for_directions(gi::vec3 normal, gi::vec3 way, float least, Visit const& visit) const;
    void take_lamps(std::vector<EnvironmentTexels::Texel>& texels);
    gi::Bounds present_bounds() const;
    void light_patches();
    void light_moving();
    void draw_stale(std::size_t most_triangles);
    float moving_in_the_way(std::size_t k, LitPoint const& at, std::uint32_t& blocker) const;
    gi::vec3 radiance(std::vector<gi::vec3> const& of, std::uint32_t patch) const
    {
        return patch == StillSurfaces::kUnknown ? mean_radiance_ : of[patch];
    }
    gi::vec3 moving_radiance(std::size_t k, std::uint32_t blocker) const
    {
        return white_[k] * moving_albedo_[blocker - world_.static_triangles];
    }
    static gi::vec3 arrived(gi::vec3 open, gi::vec3 by_radiance, Sums const& sums, All const& all);

    PrefilteredSettings settings_;
    gi::World const& world_;
    gi::TriangleSoup soup_;
    gi::CutOuts cut_outs_;
    EnvironmentCells cells_{{.cells = int(kMostDirections)}};
    std::vector<LightDirection> directions_;
    std::array<std::array<float, kMostDirections>, 3> towards_{}; ///< of the directions, x, y, z
    std::vector<EnvironmentTexels::Texel> lamps_;                 ///< the brightest texels
    NormalTable<gi::vec3> smooth_irradiance_{kSide};              ///< E_map without them
    NormalTable<gi::vec3> light_sum_{kSide};                      ///< sum of F_k c_k
    NormalTable<float> angle_sum_{kSide};                         ///< sum of w_k c_k
    bool has_glossy_ = false;                                     ///< some surface has a glossy lobe
    GlossyTable glossy_;
    StillSurfaces still_;
    std::vector<OcclusionMap> moving_;
    std::vector<std::uint8_t> stale_;                   ///< per map of moving_: 1 = older than the last move
    std::size_t next_ = 0;                              ///< map that is drawn next
    std::vector<gi::vec3> patch_light_;                 ///< irradiance per patch without moving surfaces
    std::vector<gi::vec3> radiance_without_, radiance_; ///< per patch, without and with moving surfaces
    gi::vec3 mean_radiance_{0};
    std::vector<gi::vec3> moving_albedo_; ///< per moving triangle
    std::vector<gi::vec3> white_;         ///< per direction: radiance of a white moving surface in the way
    gi::Bounds moving_bounds_;            ///< of the maps
    gi::vec3 moving_centre_{0};
    float moving_radius_ = 0; ///< m; 0 = nothing moves
};

} // namespace ar
