#pragma once
// What people walk on and against: the triangles of a world that never move, and exact rays among them. It keeps
// nothing of the world, so that the thread that takes input can ask while others render.

#include "gi/render/exact_visibility.h"

#include <memory>
#include <optional>

namespace viewer {

class Ground {
public:
    /// Copies what stays, builds a BVH. Holes that textures cut are solid.
    explicit Ground(gi::World const& world);

    struct Touch {
        double distance_m = 0;
        gi::dvec3 normal{0}; ///< unit, towards where the ray came from
    };
    /// The nearest surface on a ray. @param from  m, absolute  @param direction  unit  @param reach_m  > 0
    std::optional<Touch> touch(gi::dvec3 from, gi::dvec3 direction, double reach_m) const;

private:
    gi::World still_; ///< positions and triangles only
    std::unique_ptr<gi::ExactVisibility> rays_;
};

} // namespace viewer
