// Shading of a path vertex: its direct light and the sampling of the next direction.

#include "gi/methods/paths/tracer_state.h"

#include "gi/scene/shading/seen_mirror.h"

#include <utility>

namespace gi {
namespace {

/// Not inlined, so that all callers get the same rounding.
[[gnu::noinline]] SkyAlong look_at_sky(WorldView const& world, vec3 direction)
{
    return {environment_radiance(world, direction), environment_direction_pdf(world, direction)};
}

} // namespace

std::vector<SkyAlong> sky_along(AxisSet const& axes, World const& world)
{
    std::vector<SkyAlong> sky;
    if (world.environment_select.empty() && !world.environment) return sky;
    WorldView const w = view(world);
    for (std::size_t a = 0; a < axes.pool().size(); ++a)
        for (vec3 const direction : {-axes.axis(a), axes.axis(a)}) sky.push_back(look_at_sky(w, direction));
    return sky;
}

void PathsTracer::add_sky(Pass const& pass, State& s, Vertex const& last) const
{
    if (s.vertex == 0) {
        s.sample->radiance[0] = background_radiance(world_, s.direction);
        return;
    }
    if (world_.environment_radiance.empty() || s.emitted) return;
    SkyAlong const sky = s.along_axis && !pass.sky.empty() ? pass.sky[2 * last.axis + (last.origin.up ? 1 : 0)]
                                                           : look_at_sky(world_, s.direction);
    vec3 light = sky.radiance;
    if (s.arrival_pdf > 0) light *= power_heuristic(s.arrival_pdf, sky.pdf);
    layer_of(*s.sample, s.scatterings) += s.throughput * light;
}

vec3 PathsTracer::unshadowed(Leaving const& from, LightSample const& light) const
{
    ShadingPoint const& at = from.at;
    if (from.no_punctual && light.delta) return vec3{0};
    if (bsdf_detail::is_matt(at.bsdf)) { // the same with fewer operations
        if (!(light.pdf > 0)) return vec3{0};
        float const cosine = glm::dot(light.direction, at.frame.normal);
        if (!(cosine > 0) || !(from.wo.z > 0) || !(glm::dot(light.direction, at.geometric_normal) > 0))
            return vec3{0};
        vec3 const value = at.bsdf.diffuse * kInvPi * light.radiance * (cosine / light.pdf);
        return light.delta || from.alone ? value : value * power_heuristic(light.pdf, cosine * kInvPi);
    }
    auto const pdf = [&](BsdfValue const& bsdf, vec3 wi) { return from.pdf(bsdf, wi); };
    return unshadowed_light(at, from.wo, light, from.alone, pdf);
}

void PathsTracer::aim_at_light(Pass const& pass, State const& s, Leaving const& from,
                              std::vector<ShadowRay>& rays) const
{
    VertexNumbers const& u = *s.u;
    vec3 const normal = from.at.frame.normal;
    ChosenLight const chosen = pass.lights->choose(from.at.position, normal, u[PathDimension::light_point],
                                                   u[PathDimension::light_sample_pick]);
    if (chosen.light == nullptr) return;
    LightSample const light = chosen.light->seen_from(world_, from.at.position);
    vec3 const value = chosen.weight * unshadowed(from, light);
    if (!(max_component(value) > 0)) return;
    vec3* const to = &layer_of(*s.sample, s.scatterings + 1);
    RayQuery query = shadow_ray(from.at.position, from.at.geometric_normal, from.at.clearance, light);
    query.seed = s.shadow_seed();
    if (query.reach > 0)
        rays.push_back({query, s.throughput * value, to});
    else // the light lies on the surface
        *to += s.throughput * value;
}

void PathsTracer::add_direct(Pass const& pass, State const& s, Leaving const& from,
                            std::vector<Unshadowed>& direct) const
{
    ShadingPoint const& at = from.at;
    std::vector<LightPoint> const& light_points = pass.light_points.light_points();
    std::size_t k = 0;
    if (pass.light_points.fixed()) {
        double u = double((*s.u)[PathDimension::light_point]);
        k = pass.light_points.chances().sample(u);
    } else {
        // Light points with successive numbers are well distributed; a strided subset would not be.
        k = s.random.turn(s.dimension(PathDimension::light_point)) % light_points.size();
    }
    LightPoint const& l = light_points[k];
    LightSample const light = l.light.pdf > 0 ? l.light : sample_light(world_, l.choice, at.position, l.u);
    vec3 const value = unshadowed(from, light);
    if (!(max_component(value) > 0)) return;
    ShadowMap::Place const place =
        l.shadow.look(at.position, at.geometric_normal, s.random.noise2(s.dimension(PathDimension::shadow)));
    __builtin_prefetch(place.texel);
    direct.push_back({&l, place, at.position, s.triangle, s.throughput * value,
                      &layer_of(*s.sample, s.scatterings + 1), s.sample, light.delta, s.shadow_seed()});
}

void PathsTracer::add_emission(State const& s, Vertex const& last, ShadingPoint const& at) const
{
    float const distance = glm::length(at.position - (last.exact ? last.ray.origin : last.origin.position));
    layer_of(*s.sample, s.scatterings) +=
        s.throughput * met_emission(world_, s, at, s.triangle, s.direction, distance);
}

/// Scatters by a mirror, glass or a narrow lobe.
PathsTracer::Scattered PathsTracer::scatter_by_ray(State& s, Leaving const& from, float u_lobe, bool last) const
{
    ShadingPoint const& at = from.at;
    BsdfSample const sampled = gi::sample(at.bsdf, from.wo, at.front, u_lobe, s.u->pair(PathDimension::lobe_u));
    if (last && !sampled.delta) return Scattered::not_at_all;
    s.direction = at.frame.to_world(sampled.wi);
    if (!is_on_one_side(at, s.direction, sampled.wi)) return Scattered::not_at_all;
    s.throughput *= sampled.weight;
    s.medium = medium_beyond(world_, s.medium, s.triangle, at, sampled);
    s.arrival_pdf = sampled.delta ? 0 : sampled.pdf;
    return sampled.delta ? Scattered::by_delta_lobe : Scattered::widely;
}

/// Scatters into a cosine-distributed direction. Returns false if the path ends.
bool PathsTracer::scatter_freely(State& s, Leaving const& from, Vertex& next) const
{
    ShadingPoint const& at = from.at;
    vec3 const wi = square_to_cosine_hemisphere(s.u->pair(PathDimension::lobe_u));
    s.direction = at.frame.to_world(wi);
    if (!(wi.z > 0) || !(glm::dot(s.direction, at.geometric_normal) > 0)) return false;
    if (bsdf_detail::is_matt(at.bsdf)) {
        s.arrival_pdf = wi.z * kInvPi;
        s.throughput *= at.bsdf.diffuse;
    } else {
        BsdfValue const value = evaluate(at.bsdf, from.wo, wi);
        s.arrival_pdf = from.pdf(value, wi);
        if (!(s.arrival_pdf > 0)) return false;
        s.throughput *= value.f * (wi.z / s.arrival_pdf);
    }
    next.origin = {.position = at.position, .triangle = s.triangle, .along = false, .up = false};
    return true;
}

/// True if the path's pixel computes indirect light in this pass.
bool PathsTracer::starts_indirect(Pass const& pass, State& s) const
{
    if (s.vertex > 0 || interleaving_.n == 1) return true;
    std::uint32_t const share = interleaving_.share(s.pixel, std::uint32_t(width_), pass.index);
    s.sample->turn = share > 0 ? IndirectTurn::taken : IndirectTurn::waits;
    if (share == 0) return false;
    s.throughput *= float(share);
    s.random.index = pass.index / share;
    *s.u = VertexNumbers(s.random, std::uint32_t(s.vertex));
    return true;
}

AxisSample PathsTracer::choose_axis(Pass const& pass, State const& s, ShadingPoint const& at) const
{
    if (s.vertex == 0 && pass.gather_axis != kNoPrimitive) {
        vec3 const along = pass.axes.axis(pass.gather_axis);
        float const cosine = glm::dot(along, at.frame.normal);
        return {pass.gather_axis, cosine < 0 ? -along : along,
                std::abs(cosine) * pass.axes.solid_angle(pass.gather_axis) * float(pass.axes.first_bounce_axes()) *
                    kInvPi};
    }
    return pass.axes.sample(std::uint32_t(s.scatterings), at.frame.normal, (*s.u)[PathDimension::axis]);
}

/// Returns false if the path ends.
bool PathsTracer::scatter_along_axis(Pass const& pass, State& s, Leaving const& from, Vertex& next) const
{
    ShadingPoint const& at = from.at;
    AxisSample const a = choose_axis(pass, s, at);
    s.direction = a.direction;
    next.axis = pass.axes.slot(a.axis, at.position);
    if (!scatter_along(s, at, from.wo, from.narrow, a, world_.surfaces[s.triangle], s.triangle,
                       pass.axes.axis(a.axis), next.origin))
        return false;
    if (cone_ > 0) {
        float const side = glm::dot(s.direction, at.geometric_normal);
        RasterGrid const& grid = pass.axes.pool().grids[next.axis];
        vec2 const off = cone_ * grid.texel * square_to_disk(s.random.noise2(s.dimension(PathDimension::cone)));
        vec3 const shift = off.x * grid.right + off.y * grid.up;
        // Moved along the axis to stay on the surface's plane.
        next.origin.position += shift - (glm::dot(at.geometric_normal, shift) / side) * s.direction;
        next.axis = pass.axes.slot(a.axis, next.origin.position);
    }
    return true;
}

/// Returns false if the path ends.
bool PathsTracer::shade(Pass const& pass, State& s, Vertex& next, Direct& direct, std::span<Open> open,
                       PathCounts& paths) const
{
    if (s.triangle == kNoPrimitive) {
        add_sky(pass, s, next);
        return false;
    }
    if (s.triangle >= pass.first_watched) s.sample->near_moving = true;
    Surface const& surface = world_.surfaces[s.triangle];
    bool const last = s.scatterings > bounces_; // mirrors and glass do not count as scatterings
    if (last && bsdf_detail::is_matt(world_.bsdfs[surface.material]) &&
        (world_.emitter_pdf.empty() || !(world_.emitter_pdf[s.triangle] > 0)))
        return false;
    if (s.has_position && (surface.is(Surface::kSmooth) || surface.is(Surface::kVaries)))
        s.barycentric = barycentric_at(surface, s.position);
    ShadingPoint at = shading_point(world_, s.triangle, s.barycentric, s.direction);
    if (s.has_position) at.position = s.position;
    if (may_absorb(s.medium, at)) {
        float const way = s.vertex > 0 ? next.distance : glm::length(at.position - camera_.origin);
        s.throughput *= left_by_medium(world_, s.medium, s.triangle, at, way);
    }
    if (s.open >= 0) open[std::size_t(s.open)].directional = is_directional(at.bsdf);
    if (s.vertex == 0) see_first_surface(*s.sample, at, camera_);
    if (!std::exchange(s.emitted, false) && max_component(at.emission) > 0) add_emission(s, next, at);
    if (s.vertex == kLongestPath) {
        ++paths.cut_paths;
        return false;
    }

    vec3 const wo = at.frame.to_local(-s.direction);
    // Axes can only sample broad lobes; exact rays can sample any.
    bool const narrow = free_ ? !bsdf_detail::is_matt(at.bsdf) : pass.exact != nullptr && has_narrow_lobe(at.bsdf);
    // Light samples must account for all direct light at the last surface (except with narrow lobes, or if
    // mirrors or glass exist), at first surfaces whose pixels wait for indirect light, and where paths do not meet
    // what lies beside the view.
    bool const waits = s.vertex == 0 && pass.spread && interleaving_.n > 1 && bounces_ > 0;
    bool const alone = waits ? !has_narrow_lobe(at.bsdf)
                             : !narrow && ((s.scatterings == bounces_ && !pass.smooth) || pass.screen != nullptr);
    BsdfSample mirror[3];
    bool const seen = pass.no_punctual && s.seen;
    bool const shows_other = seen && s.vertex < kMostMirrors && find_mirror(at, wo, mirror) > 0;
    Leaving const from{at, wo, narrow, alone, seen && !shows_other};
    if (!last && !world_.light_select.empty() && !only_delta(at.bsdf)) {
        if (pass.lights != nullptr)
            aim_at_light(pass, s, from, direct.rays);
        else
            add_direct(pass, s, from, direct.maps);
        if (pass.caustics != nullptr)
            layer_of(*s.sample, s.scatterings + 1) += s.throughput * pass.caustics->radiance(at, wo, false);
    }

    float const u_lobe = narrow ? (*s.u)[PathDimension::lobe] : 1;
    Scattered scattered = Scattered::widely;
    next.exact = narrow && takes_narrow_lobe(at.bsdf, wo, u_lobe);
    if (next.exact) {
        if (waits && alone && !starts_indirect(pass, s)) return false;
        s.emitted = waits && alone;
        scattered = scatter_by_ray(s, from, u_lobe, last);
        if (scattered == Scattered::not_at_all) return false;
    } else {
        if (last || !(wo.z > 0)) return false;
        // Beyond the last surface, only light that a path can hit would contribute.
        if (s.scatterings == bounces_ && (!meets_light_ || from.alone)) return false;
        if (!starts_indirect(pass, s)) return false;
        s.emitted = from.alone;
        if (!(free_ ? scatter_freely(s, from, next) : scatter_along_axis(pass, s, from, next))) return false;
    }
    if (!survives_roulette(s, roulette_, [&] { return (*s.u)[PathDimension::roulette]; })) return false;
    if (next.exact) next.ray = {leave(at, s.direction), s.direction};
    s.along_axis = !next.exact;
    if (seen)
        s.seen = shows_other && scattered == Scattered::by_delta_lobe &&
                 (glm::dot(s.direction, at.geometric_normal) > 0) == (mirror[0].wi.z > 0);
    if (scattered == Scattered::widely) ++s.scatterings;
    ++s.vertex;
    return true;
}

} // namespace gi
