#pragma once
// Settings of the field of sh_grid.

#include "gi/core/option.h"
#include <cstdint>

namespace gi {

/// What the rays of the field go through.
enum class FieldRays : std::uint8_t { exact, voxels };

/// How sh_grid divides the light of a cell's surfaces.
enum class RadianceBy : std::uint8_t {
    normal,   ///< by the normals of the surfaces, which keeps apart what faces away from each other
    direction ///< by the directions of photons, as the paper does
};

/// Settings of the method sh_grid, see gi/methods/sh_grid.
struct ShGridSettings {
    static constexpr int kMostVoxels = 1024;
    int voxels = 128;          ///< along the longest side; the field has a quarter of them
    int degree = 2;            ///< of the spherical harmonics
    int directions = 400;      ///< per cell of the field
    int gather_directions = 0; ///< samples of the diffuse lobe; 0 = convolution in closed form
    int glossy_directions = 8; ///< samples of glossy lobes
    float obscurance_m = 0;    ///< surfaces nearer than this darken diffuse light; 0 = off
    int field_shadow_rays = 4; ///< from a surface to cells of the field; 0 = none, weights alone
    int field_passes = 3;      ///< passes over which the field follows a change of the scene
    FieldRays field_rays = FieldRays::exact;
    RadianceBy radiance_by = RadianceBy::normal;
    Switch multilevel = Switch::off; ///< read coarser grids of radiance where directions are sparse
    /// Weigh cells by the probability that nothing lies between them and the surface.
    Switch leak_weights = Switch::on;
    Switch field_glyphs = Switch::off; ///< draw the field's cells
};

} // namespace gi
