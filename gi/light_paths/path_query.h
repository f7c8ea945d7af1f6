#pragma once
// What light paths ask, for CPU and CUDA.

#include "gi/render/ray_query.h"

namespace gi {

/// A ray of a light path.
struct PathQuery {
    RayQuery ray;
    std::uint32_t triangle = kNoTriangle; ///< that it leaves
    bool any_direction = false;           ///< a direction nearby would do as well: it comes from a broad lobe
};

} // namespace gi
