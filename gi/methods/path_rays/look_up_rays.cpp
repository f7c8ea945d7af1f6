#include "gi/methods/path_rays/look_up_rays.h"

#include "gi/hit_buffers/query_batch.h"
#include "gi/scene/shading/shading_point.h"

namespace gi {

void LookUpRays::nearest(std::span<PathQuery> queries, std::span<Hit> hits) const
{
    constexpr float kGrazing = 0.02f; // cosine
    thread_local QueryBatch batch;
    thread_local std::vector<PathQuery> others;
    thread_local std::vector<std::uint32_t> walks, rays;
    thread_local std::vector<Hit> met;
    batch.resize(queries.size());
    others.clear();
    walks.clear();
    rays.clear();
    for (std::uint32_t i = 0; i < queries.size(); ++i) {
        PathQuery& q = queries[i];
        if (q.any_direction) {
            std::uint32_t const index = axes_.nearest(q.ray.ray.direction);
            StoredAxes::Direction const& d = axes_.direction(index);
            Surface const& s = world_.surfaces[q.triangle];
            vec3 const normal = glm::normalize(glm::cross(s.edge1, s.edge2));
            float const leaves = glm::dot(normal, q.ray.ray.direction), cosine = glm::dot(normal, d.along);
            if (leaves * cosine > 0 && std::abs(cosine) > kGrazing) {
                bool const up = index % 2 == 0;
                batch.set(walks.size(),
                          {.position = q.ray.ray.origin,
                           .triangle = q.triangle,
                           .along = (cosine > 0) == up,
                           .up = up,
                           .slope = slope_of(std::abs(cosine))},
                          index / 2);
                q.ray.ray.direction = d.along;
                walks.push_back(i);
                continue;
            }
        }
        others.push_back(q);
        rays.push_back(i);
    }
    batch.resize(walks.size());
    nearest_layers(axes_.pool(), world_.surfaces, batch);
    for (std::size_t k = 0; k < walks.size(); ++k) {
        Hit& hit = hits[walks[k]];
        hit = {};
        if (batch.hit[k] == kNoLayerHit) continue;
        Ray const& ray = queries[walks[k]].ray.ray;
        vec3 const at{batch.hit_x[k], batch.hit_y[k], batch.hit_z[k]};
        hit.triangle = batch.hit[k] & kPrimitiveMask;
        hit.barycentric = barycentric_at(world_.surfaces[hit.triangle], at);
        hit.distance = std::max(glm::dot(at - ray.origin, ray.direction), 0.0f);
    }
    if (rays.empty()) return;
    met.resize(rays.size());
    exact_.nearest(others, met);
    for (std::size_t k = 0; k < rays.size(); ++k) hits[rays[k]] = met[k];
}

} // namespace gi
