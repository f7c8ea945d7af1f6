#pragma once
// Light propagation volumes (Kaplanyan and Dachsbacher 2010, "Cascaded Light Propagation Volumes for Real-Time
// Indirect Illumination"; Noren and Sjolin, sec. 4): surface points that light has reached scatter it as virtual
// lights into the cells of a lattice; from there it moves from cell to cell, and surfaces in between block it.
// Nested lattices, finer near the camera or what it shows, each with light of its own virtual lights, and what
// comes in over its border from the coarser one.
//
// A cell keeps the sum over all steps of the intensity of its point light, W/sr. What is asked is a radiance. The
// factors between them, for cells of side s:
//   irradiance of a normal n = flux that propagation would send through a face of the cell with that normal / s^2
// So the net flux through a plane along the grid is that of the propagation, and the walls of a closed room take
// all light. In coefficients, degree 0 counts by 2/3 and degree 1 by 0.831 of intensity / s^2 (what a beam along
// an axis leaves in a cell). 2/3 is also the mean over all directions of the ratio of a straight way
// to one from cell to cell.
//
// Known errors (tests/photons/light_propagation_test.cpp): a surface in free space, four and more cells away from
// a light, gets within a tenth of the right irradiance in the mean over the directions, but light loses its
// direction: the other side of a room gets a quarter of the irradiance of a small patch with 16 cells, a seventh
// with 32, and the surfaces beside the light the rest. So coarse lattices are better. Surfaces that are not along
// the lattice block and let through by turns: in a sphere, about half of the light is lost.
//
// Unlike the paper: surfaces block by their projected areas along the three axes, not by spherical harmonics:
// of a surface with two sides four coefficients know its area alone, and floors would block light along them.

#include "gi/core/progress.h"
#include "gi/light_paths/photon.h"
#include "gi/light_paths/settings.h"
#include "gi/methods/photons/propagation_kernels.h"

namespace gi {

struct PropagationSettings {
    static constexpr int kMostCells = 128, kMostCascades = 8;

    int cells = 16;   ///< of each lattice along the scene's longest side, 8 to kMostCells
    int cascades = 0; ///< nested lattices about the camera, up to kMostCascades; 0 = about what is shown
    int steps = 0;    ///< from cell to cell; 0 = twice the cells
    Reprojection by = Reprojection::beams;
    int glossy_cells = 4; ///< looked up along a glossy direction
};

/// A virtual light: light that leaves a surface in a cosine lobe.
struct ReflectedLight {
    vec3 position, normal; ///< m; unit, on the lit side
    vec3 flux;             ///< W, reflected
    GI_FN void add_to(ShColor& cell) const { cell.add_cosine_lobe(flux, normal); }
};
/// Light that photons reflect diffusely.
std::vector<ReflectedLight> reflected_lights(std::span<Photon const> photons);

enum class Geometry : std::uint8_t { same, changed };

class LightPropagation {
public:
    /// Throws InputError for settings out of range.
    explicit LightPropagation(PropagationSettings const& settings);

    /// Propagates the light of these photons. Keeps the earlier light if it throws Interrupted.
    /// @param world  its bounds may be empty
    /// @param geometry  since the last call
    /// @param focus  what cameras show, if the world is much larger; else empty
    void update(World const& world, Geometry geometry, std::span<Photon const> photons, vec3 camera,
                Bounds const& focus = {}, BuildStop const& stop = BuildStop(nullptr));
    /// Irradiance of a surface, W/m^2. @param normal  unit, on the side asked for
    vec3 irradiance(vec3 position, vec3 normal) const;
    /// Radiance that comes from a direction, W/(m^2 sr): the mean over some cells along it, as far as surfaces let
    /// light through (the paper's sec. 5.1). @param direction  unit
    vec3 radiance(vec3 position, vec3 direction) const;

    struct Cascade {
        GridFrame frame, corners;
        std::vector<Blocker> blocked; ///< per corner, see OpenFaces
        std::vector<vec3> open;
        std::vector<ShColor> total;
        double injected_w = 0, outside_w = 0; ///< sums over channels, virtual lights in it and beyond it
        DenseView<ShColor> view() const { return {frame, total}; }
    };
    std::vector<Cascade> const& cascades() const { return cascades_; }
    /// Memory of lattices that update() would make for a world.
    static std::uint64_t bytes(PropagationSettings const& settings, Bounds const& bounds);

    /// For tests: without a scene. Frames finest first.
    void propagate(std::span<GridFrame const> frames, std::span<ReflectedLight const> lights);

private:
    void place(std::span<GridFrame const> frames);
    void propagate(Cascade& cascade, Cascade const* coarser, std::span<ReflectedLight const> lights,
                   BuildStop const& stop);

    PropagationSettings settings_;
    std::vector<Cascade> cascades_;
};

} // namespace gi
