#pragma once
// What finds the next surface of a light path. Exact rays are one way; look-ups and distance impostors are others.

#include "gi/render/exact_visibility.h"

namespace gi {

/// A ray of a light path.
struct PathQuery {
    RayQuery ray;
    std::uint32_t triangle = kNoTriangle; ///< that it leaves
    bool any_direction = false;           ///< a direction nearby would do as well: none of a mirror or a lens
};

class PathRays {
public:
    virtual ~PathRays() = default;
    /// The nearest surface along each ray, as far as this way of finding it knows; may replace directions that
    /// allow it. hits.size() == queries.size(); safe for concurrent calls.
    virtual void nearest(std::span<PathQuery> queries, std::span<Hit> hits) const = 0;
};

class ExactPathRays : public PathRays {
public:
    /// @param visibility  must outlive it
    explicit ExactPathRays(ExactVisibility const& visibility) : visibility_(visibility) {}
    void nearest(std::span<PathQuery> queries, std::span<Hit> hits) const override
    {
        thread_local std::vector<RayQuery> rays;
        rays.clear();
        for (PathQuery const& q : queries) rays.push_back(q.ray);
        visibility_.nearest(rays, hits);
    }

private:
    ExactVisibility const& visibility_;
};

} // namespace gi
