#pragma once
#include "gi/render/exact_visibility.h"
#include "gi/render/path_sample.h"

#include <vector>

namespace gi {

/// Traces the shadow rays of many paths together and adds the light of the unblocked ones.
/// @param paths  each with its `shadow` (RayQuery), `shadow_radiance` (0 = no shadow ray), `shadow_bucket`,
///   `bucket(i)` and `rng`
template <class Path, class Visibility>
void add_unshadowed(std::span<Path* const> paths, Visibility const& visibility, PathCounts& counts)
{
    std::vector<Path*> waiting;
    std::vector<RayQuery> queries;
    for (Path* p : paths) {
        if (!(max_component(p->shadow_radiance) > 0)) continue;
        if (!(p->shadow.reach > 0)) { // the light lies on the surface
            p->bucket(p->shadow_bucket) += p->shadow_radiance;
            continue;
        }
        p->shadow.seed = p->rng.next();
        waiting.push_back(p);
        queries.push_back(p->shadow);
    }
    counts.shadow_rays += waiting.size();
    std::vector<std::uint8_t> blocked(waiting.size());
    visibility.occluded(queries, blocked);
    for (std::size_t i = 0; i < waiting.size(); ++i)
        if (blocked[i] == 0) waiting[i]->bucket(waiting[i]->shadow_bucket) += waiting[i]->shadow_radiance;
}

} // namespace gi
