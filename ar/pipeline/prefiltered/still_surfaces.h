#pragma once
// What of the still surfaces is in the way of each direction of light, from any point: depth maps drawn once from
// both ends of each direction, and the surfaces in small patches, whose light can be kept.

#include "ar/pipeline/prefiltered/occlusion_map.h"
#include "gi/core/progress.h"

#include <span>

namespace ar {

/// A direction from which light comes, for a part of the sphere.
struct LightDirection {
    gi::vec3 towards{0, 1, 0}; ///< unit, towards the light; world
    gi::vec3 light{0};         ///< irradiance of a face turned to the part, W/m^2
    float solid_angle_sr = 0;  ///< of the part
    bool sharp = false;        ///< has a large share of all light: its shadows have sharp edges
};

/// A part of still surfaces that is treated as one point.
struct SurfacePatch {
    gi::vec3 position; ///< m
    gi::vec3 normal;   ///< unit, of the triangle, on the side that is seen
    std::uint32_t triangle;
    gi::vec3 albedo; ///< mean over where the maps see it
    std::uint32_t samples;
};

class StillSurfaces {
public:
    static constexpr std::uint32_t kOpen = 0xffffffffu, kUnknown = 0xfffffffeu;

    /// @param world  must outlive this object; its triangles before static_triangles are meant
    explicit StillSurfaces(gi::World const& world) : world_(world) {}

    /// Draws the maps and finds the patches. @throws gi::Interrupted
    void build(std::span<LightDirection const> directions, gi::TriangleSoup const& soup,
               gi::CutOuts const& cut_outs, gi::BuildStop const& stop);
    /// Finds patches that suit the moving surfaces, if they have become much larger or smaller. @return false:
    /// they have not. @throws gi::Interrupted
    bool fit_patches(std::span<LightDirection const> directions, gi::Bounds const& moving,
                     gi::BuildStop const& stop);

    /// The patch that a point sees in direction k; kOpen: none; kUnknown: one that the maps do not show.
    /// @param normal  unit, of the triangle  @param triangle  that holds the point; kNoPrimitive = a point in space
    std::uint32_t in_the_way(std::size_t k, gi::vec3 p, gi::vec3 normal, std::uint32_t triangle) const;
    std::vector<SurfacePatch> const& patches() const { return patches_; }
    /// The same for a patch, of directions in front of it.
    std::uint32_t seen_from(std::size_t patch, std::size_t k) const { return seen_[patch * still_.size() + k]; }

private:
    bool find_patches(std::span<LightDirection const> directions, gi::Bounds const& moving, float size_m,
                      gi::BuildStop const& stop);

    gi::World const& world_;
    gi::Bounds bounds_;
    std::vector<OcclusionMap> still_;                        ///< per direction: what is nearest to the light
    std::vector<OcclusionMap> facing_;                       ///< what is nearest to a surface far from the light
    std::vector<std::vector<std::uint32_t>> patch_of_texel_; ///< of facing_
    std::vector<SurfacePatch> patches_;
    std::vector<std::uint32_t> seen_; ///< per patch and direction
    float near_m_ = 0;                ///< radius of the moving surfaces that the patches suit; 0 = none were found
};

/// Bounds of triangles first..last - 1.
gi::Bounds bounds_of(gi::World const& world, std::size_t first, std::size_t last);

} // namespace ar
