#pragma once
// What finds the next surface of a light path. Exact rays are one way; look-ups and distance impostors are others.

#include "gi/light_paths/path_query.h"
#include "gi/render/exact_visibility.h"

namespace gi {

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
