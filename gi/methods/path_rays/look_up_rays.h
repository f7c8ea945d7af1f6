#pragma once
// Light paths through layered hit buffers (gi/methods/slhb): a ray that leaves a surface by a broad lobe follows
// the nearest of a set of stored directions and is a look-up. Rays from lights, by mirrors and by glass are exact,
// and those whose direction leaves their surface edge-on.

#include "gi/light_paths/path_rays.h"
#include "gi/hit_buffers/directions/stored_axes.h"

namespace gi {

class LookUpRays : public PathRays {
public:
    /// All arguments must outlive it.
    LookUpRays(World const& world, StoredAxes const& axes, ExactVisibility const& exact)
        : world_(world), axes_(axes), exact_(exact)
    {
    }
    void nearest(std::span<PathQuery> queries, std::span<Hit> hits) const override;

private:
    World const& world_;
    StoredAxes const& axes_;
    ExactPathRays exact_;
};

} // namespace gi
