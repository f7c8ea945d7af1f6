#include "gi/methods/vpl/camera_paths.h"

#include "gi/render/shadow_rays.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>

namespace gi {
namespace {

bool has_delta_lobe(Bsdf const& b) { return b.clear > 0 || (b.f90.x > 0 && bsdf_detail::specular_is_delta(b)); }

} // namespace

CameraSubpath CameraPaths::start(int x, int y, std::uint32_t index) const
{
    CameraSubpath p;
    p.rng = Pcg32::for_path(seed, std::uint32_t(y) * std::uint32_t(width) + std::uint32_t(x), index);
    vec2 const place = vec2{float(x) + 0.5f, float(y) + 0.5f} + filter_offset(filter, p.rng.uniform2());
    p.ray = camera.has_lens() ? camera.at_lens(square_to_disk(p.rng.uniform2())).through(place)
                              : camera.through(place);
    return p;
}

/// @param share  fraction of the light that these paths contribute
void CameraPaths::aim_at_light(CameraSubpath& p, ShadingPoint const& at, vec3 wo, float share) const
{
    LightChoice const choice = choose_light(world, p.rng.uniform_double());
    LightSample const light = sample_light(world, choice, at.position, p.rng.uniform2());
    if (!(light.pdf > 0)) return;
    vec3 const wi = at.frame.to_local(light.direction);
    if ((wi.z > 0) != (glm::dot(light.direction, at.geometric_normal) > 0)) return;
    BsdfValue const bsdf = evaluate(at.bsdf, wo, wi);
    vec3 value = bsdf.f * light.radiance * (share * std::abs(wi.z) / light.pdf);
    if (!(max_component(value) > 0)) return;
    if (!light.delta) value *= power_heuristic(light.pdf, bsdf.pdf);
    p.shadow_radiance = p.throughput * value;
    p.shadow_bucket = p.scatterings + 1;
    p.shadow.ray = {leave(at, light.direction), light.direction};
    p.shadow.reach = light.distance;
    if (light.distance == kInf) return;
    // From the ray's start to just before the light, as in the reference.
    vec3 const way = at.position + light.distance * light.direction - p.shadow.ray.origin;
    float const length = glm::length(way);
    p.shadow.ray.direction = way * (1 / length);
    p.shadow.reach = length * (1 - 2e-5f) - at.clearance;
}

/// Advances from a hit to the next ray. Returns false if the path ends.
bool CameraPaths::advance(CameraSubpath& p, Hit const& hit, int surface, std::uint32_t index,
                          std::vector<Receiver>& receivers, PathCounts& counts) const
{
    p.shadow_radiance = vec3{0};
    vec3 const direction = p.ray.direction;
    if (hit.triangle == kNoTriangle) {
        if (surface == 0) {
            p.sample.radiance[0] = background_radiance(world, direction);
        } else if (!world.environment_radiance.empty()) {
            vec3 light = environment_radiance(world, direction);
            if (p.arrival_pdf > 0)
                light *= power_heuristic(p.arrival_pdf, environment_direction_pdf(world, direction));
            p.bucket(p.scatterings) += p.throughput * light;
        }
        return false;
    }
    ShadingPoint const at = shading_point(world, hit.triangle, hit.barycentric, direction);
    if (surface == 0) {
        p.sample.hit = true;
        p.sample.albedo = albedo(at.bsdf);
        p.sample.normal = at.frame.normal;
        p.sample.position = at.position;
        p.sample.depth = glm::dot(at.position - camera.origin, camera.forward);
    }
    float const cos_here = std::abs(glm::dot(direction, at.geometric_normal));
    if (max_component(at.emission) > 0) {
        vec3 light = at.emission;
        if (p.arrival_pdf > 0)
            light *=
                power_heuristic(p.arrival_pdf, emitter_direction_pdf(world, hit.triangle, hit.distance, cos_here));
        p.bucket(p.scatterings) += p.throughput * light;
    }
    if (surface == kLongestPath) {
        ++counts.cut_paths;
        return false;
    }

    vec3 const wo = at.frame.to_local(-direction);
    bool const last = p.scatterings > bounces; // mirrors and glass do not count as scatterings
    float share = 1;                           // fraction of these paths in non-delta outgoing light
    if (p.straight) {
        share = 1 - share_of_virtual_lights(bounded_term(p.value_x, cos_here, square(hit.distance)), bound);
        if (!(share > 0) && !has_delta_lobe(at.bsdf)) return false;
    }
    bool const scatters = !last && !only_delta(at.bsdf);
    if (scatters && p.scatterings == 0 && bounces > 0)
        receivers.push_back({.path = index,
                             .triangle = hit.triangle,
                             .throughput = p.throughput,
                             .position = at.position,
                             .geometric_normal = at.geometric_normal,
                             .frame = at.frame,
                             .bsdf = at.bsdf,
                             .wo = wo,
                             .clearance = at.clearance,
                             .front = at.front,
                             .matt = bsdf_detail::is_matt(at.bsdf)});
    if (scatters && share > 0 && !world.light_select.empty()) aim_at_light(p, at, wo, share);

    float const u_lobe = p.rng.uniform();
    BsdfSample const next = gi::sample(at.bsdf, wo, at.front, u_lobe, p.rng.uniform2());
    if (last && !next.delta) return false;
    p.throughput *= next.weight;
    float survival = max_component(p.throughput);
    if (!(survival > 0)) return false;
    if (!next.delta && share < 1) {
        // The fraction is used as the probability of continuing, so that throughputs are unchanged.
        if (p.rng.uniform() >= share) return false;
    }
    if (p.scatterings >= 3 && survival < 0.95f) {
        if (p.rng.uniform() >= survival) return false;
        p.throughput /= survival;
    }
    vec3 const leaves = at.frame.to_world(next.wi);
    // With a shading normal, a direction may pass through an opaque surface; such light is discarded.
    if ((glm::dot(leaves, at.geometric_normal) > 0) != (next.wi.z > 0)) return false;
    p.straight = !next.delta && p.scatterings == 0;
    if (p.straight) p.value_x = kPi * max_component(evaluate(at.bsdf, wo, next.wi).f) * std::abs(next.wi.z);
    p.ray = {leave(at, leaves), leaves};
    p.arrival_pdf = next.delta ? 0 : next.pdf;
    if (!next.delta) ++p.scatterings;
    return true;
}

void CameraPaths::trace(std::span<CameraSubpath> paths, std::vector<Receiver>& receivers, PathCounts& counts) const
{
    std::vector<CameraSubpath*> active;
    std::vector<RayQuery> queries;
    std::vector<Hit> hits;
    for (CameraSubpath& p : paths) active.push_back(&p);
    for (int surface = 0; !active.empty(); ++surface) {
        queries.clear();
        for (CameraSubpath* p : active) {
            queries.push_back({.ray = p->ray, .seed = p->rng.next()});
            if (surface == 0) queries.back().start = camera_clearance(p->ray.origin);
        }
        hits.resize(active.size());
        visibility.nearest(queries, hits);
        counts.nearest_rays += active.size();
        for (std::size_t k = 0; k < active.size(); ++k) {
            auto const index = std::uint32_t(active[k] - paths.data());
            active[k]->ended = !advance(*active[k], hits[k], surface, index, receivers, counts);
        }
        add_unshadowed(std::span<CameraSubpath* const>(active), visibility, counts);
        std::erase_if(active, [](CameraSubpath const* p) { return p->ended; });
    }
}

} // namespace gi
