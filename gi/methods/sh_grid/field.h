#pragma once
// The spherical-harmonics field (Chang, Park and Ihm, sec. 3.4): around the surfaces, the indirect light that
// arrives at the centres of grid cells, and how far the surfaces are from there, by direction.

#include "gi/methods/sh_grid/radiance_grid.h"
#include "gi/scene/shading/spherical_harmonics.h"

namespace gi {

struct FieldSettings {
    int degree = 2;          ///< of the spherical harmonics, 1 to 4
    bool multilevel = false; ///< read coarser grids of radiance where directions are sparse (sec. 3.4.3)
    bool sky_shines = false;
    bool patches = true; ///< rays know the patches that they meet
    RadianceBy by = RadianceBy::normal;
    float farthest = 2; ///< larger distances count as this one in the distance function, cells
};

struct FieldCell {
    static constexpr std::size_t kMost = (kMostHarmonicsDegree + 1) * (kMostHarmonicsDegree + 1);
    static constexpr int kNear = 8;        ///< texels a side of the octahedral maps of distance
    static constexpr float kNearReach = 2; ///< larger distances count as this one there, cells
    vec3 radiance[kMost] = {};             ///< coefficients at index l^2 + l + m
    float distance[kMost] = {};            ///< coefficients, in cells
    vec2 near[kNear * kNear] = {};         ///< distance and its square, about the directions of texels, in cells
    /// Share of directions that end at a side which light can reach, or in a sky that shines:
    /// 0 inside of something closed.
    float open = 1;
};

struct Field {
    SparseCells<FieldCell> cells;
    int degree = 2;
};

/// A direction of rays from cells, and its harmonics.
struct FieldDirection {
    vec3 direction;
    float harmonics[FieldCell::kMost];
};

/// The directions of all cells, and their weights in the texels of FieldCell::near.
struct FieldDirections {
    struct Weight {
        std::uint32_t direction;
        float weight;
    };
    std::vector<FieldDirection> all; ///< spherical Fibonacci
    std::vector<Weight> weights;     ///< of texel k: firsts[k] to firsts[k + 1] - 1; sum 1
    std::vector<std::uint32_t> firsts;

    /// @param count  N_sh  @param turned  which of many rotations; 0 = none
    FieldDirections(int count, int degree, std::uint32_t turned);
};

/// A factor of light, each channel of 8 bits with an exponent that they share (Ward 1991).
struct PackedTint {
    std::uint8_t mantissa[3] = {128, 128, 128}; ///< 1, exactly
    std::int8_t exponent = -7;

    GI_FN vec3 unpacked() const
    {
        return std::ldexp(1.0f, exponent) * vec3{float(mantissa[0]), float(mantissa[1]), float(mantissa[2])};
    }
};
/// @param tint  >= 0; below 1e-30 and above 1e30 it is cut off
PackedTint packed(vec3 tint);

/// Hit of a ray from a cell's centre, after mirrors and glass.
struct FieldHit {
    static constexpr std::uint32_t kSky = 0xffffffffu, kNothing = 0xfffffffeu; ///< kNothing: all is dark
    std::uint32_t what;     ///< kSky, kNothing, or 2 x patch + side; of a walk through voxels the place of a cell
    std::uint8_t level;     ///< of the grid
    std::int8_t towards[3]; ///< normal that the ray meets, or that against it, times 127
    float distance;  ///< m, of the first mirror or glass that is not a pane, else of what is met; kInf = sky
    PackedTint tint; ///< of light from there
};

/// Indices of the cells with surfaces and their 26 neighbours, ascending.
std::vector<std::uint32_t> cells_near_surfaces(SparseCells<BlockVoxels> const& blocks);

} // namespace gi
