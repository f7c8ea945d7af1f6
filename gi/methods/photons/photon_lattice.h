#pragma once
// Photons in lattices (Noren and Sjolin, "Image Space Light Lattice Photon Mapping", sec. 5.3 and 5.4): light that
// arrives at surfaces, as spherical harmonics of degree 1 by the cells of lattices of three resolutions: diffuse
// light of two and more scatterings in the coarsest, of one in the middle one, caustics in the finest.
//
// The paper projects flux by its directions and reads the sum at the normal; it does not say what of. We divide by
// area, in one of two ways (IrradianceBy). Let photons p of a cell have flux F_p, come from directions w_p and lie
// on surfaces of normal m_p; the cell's exposed surfaces have areas A_j and normals n_j.
//   directions: each photon is a beam of radiance F_p / P(w_p), P(w) = sum_j A_j (1/4 + n_j . w / 2),
//     the projected area to degree 1; irradiance is its convolution with the cosine, likewise to degree 1:
//       E(n) = sum_p F_p (1/4 + n . w_p / 2) / P(w_p)
//     As both have the same kernel, E is exact for flat surfaces, whatever comes from where, and sum_j A_j E(n_j)
//     is the flux of the photons.
//   normals: photons count by how near their surface's normal is, as the areas do:
//       E(n) = sum_p F_p (1 + n . m_p) / sum_j A_j (1 + n . n_j)
//     The two sides of a thin wall do not mix at all.
// Sums over cells (smoothing, trilinear look-up) add numerators and denominators,
// so that cells count by their area.
//
// Of nested lattices, a finer one counts by the photons that its cell is expected to hold, by its area and the
// photons of the coarser one: few photons in the corner of a cell would be a bright dot.
//
// Memory: per cell with surfaces 120 bytes, twice with smoothing; per piece of a surface in a cell 20 bytes.

#include "gi/light_paths/memory_limit.h"
#include "gi/light_paths/settings.h"
#include "gi/methods/photons/exposed_sides.h"
#include "gi/methods/photons/sh_lattice.h"
#include "gi/render/render_settings.h"

#include <array>

namespace gi {

enum class Frequency : std::uint8_t { low, middle, high };

struct PhotonLatticeSettings {
    static constexpr int kMostCells = 512, kMostCascades = 8;
    /// Smaller areas in a cell, of that of its face, count as this:
    /// one photon in its corner would be a bright dot.
    static constexpr float kLeastArea = 0.01f;

    std::array<int, 3> cells{64, 128, 128}; ///< by Frequency, along the scene's longest side, 4 to kMostCells
    std::array<bool, 3> smooth{true, true, false}; ///< over 3 x 3 x 3 cells
    int gathers = 0;                               ///< steps of gathering from six neighbours, of diffuse light
    /// Nested lattices of each frequency about the camera, up to kMostCascades; 0 = about what is shown, as many
    /// as needed so that the finest just holds it.
    int cascades = 0;
    IrradianceBy by = IrradianceBy::normals;
};

struct PhotonCell {
    ShColor arrived;  ///< radiance by the direction from which it comes, times area.x; W/sr
    ShColor received; ///< flux by the normals of the surfaces, W
    vec4 area{0};     ///< m^2; sums of A_j and of A_j n_j
    float photons = 0;

    GI_FN PhotonCell& operator+=(PhotonCell const& o)
    {
        arrived += o.arrived;
        received += o.received;
        area += o.area;
        photons += o.photons;
        return *this;
    }
};
GI_FN inline PhotonCell operator*(float by, PhotonCell c)
{
    c.arrived *= vec3{by};
    c.received *= vec3{by};
    c.area *= by;
    c.photons *= by;
    return c;
}

/// A photon, as lattices store it.
struct LatticePhoton {
    vec3 flux;      ///< W
    vec3 direction; ///< unit, from which it comes
    vec3 normal;    ///< unit, geometric, on the side where it arrives
    float weight;   ///< area.x / P(direction) of its cell
    GI_FN void add_to(PhotonCell& cell) const
    {
        cell.arrived.add_beam(weight * flux, direction);
        cell.received.add_beam(flux, normal);
        cell.photons += 1;
    }
};

/// Irradiance, W/m^2, not below 0. @param cell  a sum over cells with any weights
GI_FN inline vec3 cell_irradiance(PhotonCell const& cell, vec3 normal, IrradianceBy by)
{
    vec3 const along{cell.area.y, cell.area.z, cell.area.w};
    float const area = cell.area.x;
    if (!(area > 0)) return vec3{0};
    if (by == IrradianceBy::directions) return glm::max(irradiance(cell.arrived, normal) / area, vec3{0});
    float const facing = area + glm::dot(along, normal);
    if (!(facing > 1e-3f * area)) return vec3{0};
    vec3 const flux = cell.received.c[0] / ShColor::kY0 + cell.received.along(normal) / ShColor::kY1;
    return glm::max(flux, vec3{0}) / facing;
}

/// Where nested lattices are.
struct LatticePlace {
    vec3 camera{0};                             ///< m
    Bounds focus{};                             ///< what cameras show, if the world is much larger; else empty
    std::size_t first_moving = ~std::size_t(0); ///< index of the first triangle that may move
    bool only_moved = false; ///< since the call before nothing has changed but triangles that may move
};

class PhotonLattices {
public:
    /// Throws InputError for settings out of range.
    explicit PhotonLattices(PhotonLatticeSettings const& settings);

    /// To be called before the first update(), and when surfaces have changed or nested lattices shall lie
    /// elsewhere. Throws Interrupted, and is then to be called again without `only_moved`.
    void place(World const& world, ExactVisibility const& visibility, LatticePlace const& where,
               BuildStop const& stop = BuildStop(nullptr));
    /// Replaces light of one and more scatterings. What light has reached is remembered. @param photons  of all
    /// scatterings. Throws Interrupted, and is then to be called again.
    void update(std::span<Photon const> photons, BuildStop const& stop = BuildStop(nullptr));
    /// Replaces the caustics: those of the photons that have come by mirrors and glass alone. To be called after
    /// update(), and again when that was. Throws Interrupted, and is then to be called again.
    void update_caustics(std::span<Photon const> photons, BuildStop const& stop = BuildStop(nullptr));

    /// Of a lattice, W/m^2. @param normal  unit, on the side asked for
    vec3 irradiance(Frequency of, vec3 position, vec3 normal) const;
    /// Radiance that comes from a direction. @param direction  unit
    vec3 radiance(Frequency of, vec3 position, vec3 direction) const;
    /// Of light of one and more scatterings, not of caustics.
    vec3 irradiance(vec3 position, vec3 normal) const
    {
        return irradiance(Frequency::low, position, normal) + irradiance(Frequency::middle, position, normal);
    }
    vec3 radiance(vec3 position, vec3 direction) const
    {
        return radiance(Frequency::low, position, direction) + radiance(Frequency::middle, position, direction);
    }

    struct Cascade {
        GridFrame frame;
        SparseCells<PhotonCell> cells;
        /// The part of a surface in a cell.
        struct Piece {
            std::uint32_t place, exposure_cell;
            vec3 area; ///< m^2, times the normal of the front
        };
        std::vector<Piece> pieces;
        std::size_t still_pieces = 0, still_cells = 0; ///< of triangles that do not move; the others follow
        std::vector<vec4> areas;                       ///< per cell, see PhotonCell; empty = not yet known
    };
    std::span<Cascade const> cascades(Frequency f) const { return cascades_[std::size_t(f)]; }
    /// Sums over channels, with the caustics'.
    double injected_w() const { return diffuse_.injected_w + caustics_.injected_w; }
    double lost_w() const { return diffuse_.lost_w + caustics_.lost_w; } ///< of photons where no surface was found
    double dimmed_w() const { return diffuse_.dimmed_w + caustics_.dimmed_w; } ///< left out for kLeastArea
    double hidden_m2() const { return exposed_.empty() ? 0 : exposed_.back().hidden_m2(); }
    /// With the number of cascades that place() makes. @param focus  see LatticePlace
    static PhotonLatticeSettings placed(PhotonLatticeSettings settings, World const& world, Bounds const& focus);
    /// Upper bound of the memory that place() and update() take. @param area_m2  of all triangles
    static std::uint64_t bytes(PhotonLatticeSettings const& settings, Bounds const& bounds, double area_m2);

private:
    /// Calls of(cell, weight) for the nested lattices at a point.
    template <class Function>
    void for_cells_at(Frequency f, vec3 position, Function const& of) const;
    void place_anew(World const& world, std::size_t first_moving,
                    std::array<std::vector<GridFrame>, 3> const& frames, BuildStop const& stop);
    struct Flux {
        double injected_w = 0, lost_w = 0, dimmed_w = 0; ///< sums over channels, in the coarsest lattice
    };
    void see_photons(std::span<Photon const> photons, BuildStop const& stop);
    void inject(Frequency f, std::span<Photon const* const> photons, Flux& sums, BuildStop const& stop);
    static void inject(Cascade& cascade, ExposedSides const& exposed, std::span<Photon const* const> photons,
                       bool last, Flux& sums, BuildStop const& stop);
    void spread(Cascade& cascade, Frequency f, BuildStop const& stop);
    static void dim_small_areas(Cascade& cascade, bool last, Flux& sums);
    float cells_together(Frequency f) const;

    PhotonLatticeSettings settings_;
    std::vector<ExposedSides> exposed_; ///< per nested lattice, finest first
    bool sky_shines_ = false;
    std::array<std::vector<Cascade>, 3> cascades_; ///< finest first
    Flux diffuse_, caustics_;
};

/// Area of a world's triangles, m^2.
double surface_area(World const& world);

} // namespace gi
