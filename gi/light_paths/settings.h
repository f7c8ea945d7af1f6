#pragma once
// Settings of light paths and photons.

#include "gi/core/option.h"
#include <cstdint>
#include <string>

namespace gi {

/// How the surfaces that photons hit are found.
enum class PhotonRays : std::uint8_t { exact, look_ups, impostors };
/// How the light of lamps finds its first surfaces.
enum class FirstBounce : std::uint8_t { rays, map };
/// What the size of photons' kernels follows.
enum class KernelBy : std::uint8_t { density, footprint };
/// How flux through a face of a cell becomes light of the cell behind it, see propagation_kernels.h.
enum class Reprojection : std::uint8_t { beams, cosine_lobes };
/// What shows caustics at surfaces: a fine lattice, or kernels of photons.
enum class CausticsBy : std::uint8_t { lattice, kernels };
/// How irradiance follows from photons in a cell, see photon_lattice.h.
enum class IrradianceBy : std::uint8_t { normals, directions };
/// How rays are followed through distance impostors, see gi/light_paths/impostor_search.h.
enum class ImpostorSearch : std::uint8_t {
    first_guess, ///< iteration in the nearest impostor
    all,         ///< iteration in every impostor; the one of least energy counts
    cascaded,    ///< guess by the fan of the nearest impostor, then iteration in that nearest to the guess
    /// Along the ray through the texels of an impostor, and of other impostors where the ray is hidden from it.
    walk
};

/// Settings of light paths and photons: sh_grid and the methods of gi/methods/photons.
struct PhotonSettings {
    static constexpr int kMostPaths = 1 << 24;
    int paths = 262144;         ///< light paths per set of photons
    int caustic_paths = 65536;  ///< light paths per pass that begin on mirrors and glass; 0 = no caustics
    float caustic_radius_m = 0; ///< of the first kernels of caustics; 0 = by their density
    int reflections = 64;       ///< of a photon, at most
    PhotonRays rays = PhotonRays::exact;
    FirstBounce first_bounce = FirstBounce::rays;
    Switch frozen = Switch::off; ///< light is computed once and kept, whatever changes
    KernelBy kernel_by = KernelBy::density;
    float kernel_size = 1;        ///< factor of kernels' radii
    int propagation_cells = 16;   ///< of each lattice of lpv, along the scene's longest side
    int propagation_cascades = 0; ///< nested lattices of lpv; 0 = by what is shown
    int propagation_steps = 0;    ///< from cell to cell; 0 = twice the cells
    Reprojection reprojection = Reprojection::beams;
    int low_cells = 64, middle_cells = 128, high_cells = 128; ///< of the lattices of isllpm
    int lattice_cascades = 0; ///< nested ones of each of them, and of multi_image; 0 = by what is shown
    Switch lattice_smoothing = Switch::on; ///< of the low and the middle one
    IrradianceBy irradiance_by = IrradianceBy::normals;
    CausticsBy caustics_by = CausticsBy::lattice; ///< of isllpm
    int impostors = 32;                           ///< distance impostors, at most
    std::string impostor_places; ///< "x,y,z;x,y,z", m in the scene's coordinates; empty = automatic
    int impostor_texels = 128;   ///< along an edge of a face, rounded up to a multiple of 8
    ImpostorSearch impostor_search = ImpostorSearch::walk;
    int volume_cells = 64;  ///< of the light gathering volume of multi_image, along the scene's longest side
    int volume_gathers = 2; ///< steps that spread light over neighbouring cells of that volume
    int screen_gathers = 8; ///< steps that spread caustics over the pixels of multi_image
};

} // namespace gi
