#pragma once
// Static geometry for walking and collisions, with exact rays against it. It keeps no reference to the world, so
// that the input thread can trace rays while other threads render.

#include "gi/render/exact_visibility.h"

#include <memory>
#include <optional>

namespace viewer {

class Ground {
public:
    /// Copies the static triangles and builds a BVH. Cut-outs by textures are treated as solid.
    explicit Ground(gi::World const& world);

    struct Touch {
        double distance_m = 0;
        gi::dvec3 normal{0}; ///< unit, towards the ray's origin
    };
    /// Nearest surface on a ray. @param from  m, absolute  @param direction  unit  @param reach_m  > 0
    std::optional<Touch> touch(gi::dvec3 from, gi::dvec3 direction, double reach_m) const;

private:
    gi::World still_; ///< positions and triangles only
    std::unique_ptr<gi::ExactVisibility> rays_;
};

} // namespace viewer
