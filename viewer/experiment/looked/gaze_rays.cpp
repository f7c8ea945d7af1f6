#include "viewer/experiment/looked/gaze_rays.h"

#include "gi/scene/shading/seen_mirror.h"
#include "gi/scene/shading/shading_point.h"

#include <numeric>

namespace viewer {

std::vector<GazeMeeting> GazeRays::meet(std::vector<gi::Ray> rays) const
{
    std::vector<GazeMeeting> met(rays.size());
    std::vector<std::size_t> on(rays.size()); // those that go on
    std::iota(on.begin(), on.end(), std::size_t(0));
    std::vector<gi::RayQuery> queries;
    std::vector<gi::Hit> hits;
    while (!on.empty()) {
        queries.clear();
        for (std::size_t const r : on) queries.push_back({rays[r], gi::RayQuery::kFar, std::uint32_t(r)});
        hits.resize(on.size());
        visibility_.nearest(queries, hits);
        std::vector<std::size_t> next;
        for (std::size_t i = 0; i < on.size(); ++i) {
            GazeMeeting& m = met[on[i]];
            gi::Ray& ray = rays[on[i]];
            m.triangle = hits[i].triangle;
            if (m.triangle == gi::kNoTriangle) continue;
            gi::ShadingPoint const at = gi::shading_point(view_, m.triangle, hits[i].barycentric, ray.direction);
            gi::BsdfSample lobes[3];
            if (gi::find_mirror(at, at.frame.to_local(-ray.direction), lobes) == 0) continue;
            if (m.mirrors == kMostGazeMirrors) {
                m.is_cut = true;
                continue;
            }
            ++m.mirrors;
            gi::vec3 const direction = at.frame.to_world(lobes[0].wi);
            ray = {gi::leave(at, direction), direction};
            next.push_back(on[i]);
        }
        on = std::move(next);
    }
    return met;
}

} // namespace viewer
