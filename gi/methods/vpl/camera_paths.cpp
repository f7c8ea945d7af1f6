#include "gi/methods/vpl/camera_paths.h"

namespace gi {
namespace {

bool has_delta_lobe(Bsdf const& b) { return b.clear > 0 || (b.f90.x > 0 && bsdf_detail::specular_is_delta(b)); }

} // namespace

CameraSubpath CameraPaths::start(int x, int y, std::uint32_t index) const
{
    CameraSubpath p;
    start_path(p, camera, filter, seed, {x, y}, width, index);
    return p;
}

/// Advances from a hit to the next ray. Returns false if the path ends.
bool CameraPaths::advance(CameraSubpath& p, Hit const& hit, int surface, std::uint32_t index,
                          std::vector<Receiver>& receivers, PathCounts& counts) const
{
    if (hit.triangle == kNoTriangle) {
        add_environment(world, p, surface);
        return false;
    }
    vec3 const direction = p.ray.direction;
    ShadingPoint const at = shading_point(world, hit.triangle, hit.barycentric, direction);
    p.throughput *= left_by_medium(world, p.medium, hit.triangle, at, hit.distance);
    if (surface == 0) {
        see_first_surface(p.sample, at, camera);
        p.first = {hit.triangle, hit.barycentric};
    }
    if (max_component(at.emission) > 0)
        layer_of(p.sample, p.scatterings) +=
            p.throughput * met_emission(world, p, at, hit.triangle, direction, hit.distance);
    if (surface == kLongestPath) {
        ++counts.cut_paths;
        return false;
    }

    vec3 const wo = at.frame.to_local(-direction);
    bool const last = p.scatterings > bounces; // mirrors and glass do not count as scatterings
    float share = 1;                           // fraction of these paths in non-delta outgoing light
    if (p.straight) {
        float const cos_here = std::abs(glm::dot(direction, at.geometric_normal));
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
    if (scatters && share > 0 && !world.light_select.empty()) {
        LightChoice const choice = choose_light(world, p.rng.uniform_double());
        LightSample const light = sample_light(world, choice, at.position, p.rng.uniform2());
        auto const pdf = [](BsdfValue const& bsdf, vec3) { return bsdf.pdf; };
        aim_at_light(p, at, light, unshadowed_light(at, wo, light, false, pdf, share));
    }

    float const u_lobe = p.rng.uniform();
    BsdfSample const next = gi::sample(at.bsdf, wo, at.front, u_lobe, p.rng.uniform2());
    if (last && !next.delta) return false;
    p.throughput *= next.weight;
    p.medium = medium_beyond(world, p.medium, hit.triangle, at, next);
    if (!(max_component(p.throughput) > 0)) return false;
    // The fraction is used as the probability of continuing, so that throughputs are unchanged.
    if (!next.delta && share < 1 && p.rng.uniform() >= share) return false;
    p.straight = !next.delta && p.scatterings == 0;
    if (p.straight) p.value_x = kPi * max_component(evaluate(at.bsdf, wo, next.wi).f) * std::abs(next.wi.z);
    return continue_path(p, at, next);
}

void CameraPaths::trace(std::span<CameraSubpath> paths, std::vector<Receiver>& receivers, PathCounts& counts) const
{
    trace_together(
        paths, world, visibility, counts, [](auto, auto) {},
        [&](CameraSubpath& p, Hit const& hit, int surface) {
            return advance(p, hit, surface, std::uint32_t(&p - paths.data()), receivers, counts);
        });
}

} // namespace gi
