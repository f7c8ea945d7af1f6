#pragma once
// How much of the sides of surfaces light can reach, by coarse cells and directions of their normals. Light that
// arrives in a cell is spread over this area alone: not over the inside of walls and furniture, nor over a floor
// below a table's foot.
//
// A side of a surface counts as reached if one of a few rays from it meets a side that light has reached, mirrors
// or glass; or the sky, if that shines or light has reached the side itself (see sh_grid's exposure.h).

#include "gi/light_paths/photon.h"
#include "gi/methods/photons/sh_lattice.h"
#include "gi/methods/sh_grid/exposure.h"

namespace gi {

class ExposedSides {
public:
    ExposedSides() = default;
    /// Sends the rays. Throws Interrupted. @param frame  its sizes are multiples of 4
    /// @param first_moving  index of the first triangle that may move
    ExposedSides(World const& world, GridFrame const& frame, std::size_t first_moving,
                 ExactVisibility const& visibility, BuildStop const& stop);
    /// Traces the rays of triangles that may move again; the results of the others are kept. Throws Interrupted.
    void moved(World const& world, std::size_t first_moving, ExactVisibility const& visibility,
               BuildStop const& stop);

    /// Adds what light has reached. Returns true if shares have changed. Throws Interrupted;
    /// shares are then those from before.
    bool add(std::span<Photon const> photons, bool sky_shines, BuildStop const& stop = BuildStop(nullptr));
    GridFrame const& frame() const { return frame_; }
    /// Share of the area of sides in a cell, 0 to 1. @param side  see ReachedSides::side_index()
    float share(std::uint32_t cell, std::uint32_t side) const { return shares_[12 * std::size_t(cell) + side]; }
    /// Of both sides, m^2; shares apply to parts of it.
    double hidden_m2() const { return hidden_m2_; }

private:
    void sample(World const& world, std::size_t first, std::size_t last, ExactVisibility const& visibility,
                BuildStop const& stop);

    GridFrame frame_;
    std::vector<PatchSample> samples_;
    std::size_t still_ = 0; ///< samples of triangles that do not move; the others follow
    ReachedSides reached_{GridFrame{}};
    std::vector<float> shares_; ///< 12 per cell
    double hidden_m2_ = 0;
};

/// Grids of 48 cells along the longest side for nested lattices of a world, finest first.
std::vector<GridFrame> exposure_frames(Bounds const& bounds, vec3 center, int cascades);

} // namespace gi
