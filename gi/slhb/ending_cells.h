#pragma once
// Cells of space for paths that end near each other: as wide as a share of their distance from the eye, so that
// their number depends on what there is around it and neither on how many pixels look nor on the size of the
// scene. Every pass has other cells, so that no border is seen.

#include "gi/slhb/tracer.h"

namespace gi {

class EndingCells {
public:
    /// @param eye  m, in the coordinates of the world  @param pass  decides where borders are
    EndingCells(World const& world, vec3 eye, std::uint32_t pass);

    /// The same for endings on the same material, facing the same way, in the same cell.
    std::uint64_t key(Ending const& e) const;

private:
    WorldView world_;
    vec3 eye_;
    float near_; ///< m
    vec3 shift_; ///< in cells
};

} // namespace gi
