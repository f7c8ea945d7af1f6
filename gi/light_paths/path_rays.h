#pragma once
// What finds the next surface of a light path. Exact rays are one way; look-ups and distance impostors are others.

#include "gi/render/exact_visibility.h"

namespace gi {

class PathRays {
public:
    virtual ~PathRays() = default;
    /// The nearest surface along each ray, as far as this way of finding it knows. hits.size() == queries.size();
    /// safe for concurrent calls.
    virtual void nearest(std::span<RayQuery const> queries, std::span<Hit> hits) const = 0;
};

class ExactPathRays : public PathRays {
public:
    /// @param visibility  must outlive it
    explicit ExactPathRays(ExactVisibility const& visibility) : visibility_(visibility) {}
    void nearest(std::span<RayQuery const> queries, std::span<Hit> hits) const override
    {
        visibility_.nearest(queries, hits);
    }

private:
    ExactVisibility const& visibility_;
};

} // namespace gi
