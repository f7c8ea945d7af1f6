#pragma once
// Photons as the radiance grids store them (Chang, Park and Ihm, sec. 3.2): where light leaves a surface after a
// reflection, and in which direction.

#include "gi/light_paths/light_paths.h"
#include "gi/methods/sh_grid/patches.h"

#include <span>

namespace gi {

struct ReflectedPhoton {
    vec3 position;
    vec3 normal;    ///< unit, geometric, on the side that the light leaves
    vec3 direction; ///< unit, in which it leaves
    vec3 flux;      ///< W
    std::uint32_t triangle;
    bool front;   ///< it leaves the counter-clockwise side
    vec2 weights; ///< of corners 1 and 2 of the triangle
};

/// The sides of surfaces that light has reached, by cell: bit side_index() of them.
struct ReachedSides {
    /// 0 to 11. @param normal  on the side that is lit or seen  @param front  it is the counter-clockwise one
    static std::uint32_t side_index(vec3 normal, bool front) { return 2 * main_axis(normal) + (front ? 0 : 1); }

    GridFrame frame;
    std::vector<std::uint16_t> of_cell;

    explicit ReachedSides(GridFrame const& f) : frame(f), of_cell(f.cells()) {}
    void add(std::span<LightVertex const> vertices);
    ReachedSides& operator|=(ReachedSides const& o); ///< of the same frame
};

/// Photons by the sides of patches that they leave.
struct SortedPhotons {
    std::vector<std::uint32_t> order;  ///< indices, those of no patch last
    std::vector<std::uint32_t> firsts; ///< per side (2 x patch, + 1: back) in `order`, and one more

    std::uint32_t count(std::size_t side) const { return firsts[side + 1] - firsts[side]; }
    bool hit(std::size_t side) const { return count(side) > 0; }
};
SortedPhotons sort_photons(SparseCells<BlockVoxels> const& blocks, Patches const& patches,
                           std::span<ReflectedPhoton const> photons);

/// Moves photons with the triangles from first_moving on, to where these are now.
void move_photons(WorldView const& world, std::size_t first_moving, std::span<ReflectedPhoton> photons);

/// Reflects each vertex of light paths once, in a random direction, and appends the photons.
/// @param world  of the vertices  @param seed  of the directions
void reflect_photons(WorldView const& world, std::span<LightVertex const> vertices, std::uint64_t seed,
                     std::vector<ReflectedPhoton>& out);

} // namespace gi
