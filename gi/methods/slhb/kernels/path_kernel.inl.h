#pragma once
// Implementation of the kernels of paths; included by path_kernel.h.

#include "gi/render/path_random.h"

namespace gi {

template <bool by_rays>
GI_FN typename StepPaths<by_rays>::State StepPaths<by_rays>::start(std::size_t pixel) const
{
    auto const id = std::uint32_t(pixel);
    Ray const ray = camera.through(vec2{float(id % width), float(id / width)} + place);
    State s;
    s.random = pixel_stream(seed, id, width, pass);
    s.triangle = primary[pixel].primitive;
    s.direction = ray.direction;
    if (s.triangle != kNoPrimitive) s.barycentric = barycentric_of(world.surfaces[s.triangle], ray);
    return s;
}

template <bool by_rays>
GI_FN vec3 StepPaths<by_rays>::sky(State const& s) const
{
    if (s.vertex == 0) return background_radiance(world, s.direction);
    if (world.environment_radiance.empty()) return vec3{0};
    return s.throughput * met_environment(world, s, s.direction);
}

/// Emission of a light hit by the camera, a look-up or an exact ray.
template <bool by_rays>
GI_FN vec3 StepPaths<by_rays>::emission(State const& s, ShadingPoint const& at) const
{
    if (!(max_component(at.emission) > 0)) return vec3{0};
    return s.throughput * met_emission(world, s, at, s.triangle, s.direction, s.distance);
}

template <bool by_rays>
GI_FN vec3 StepPaths<by_rays>::direct(State& s, ShadingPoint const& at, vec3 wo, bool narrow,
                                      PathKernelCounts& local) const
{
    std::size_t k = 0;
    if (!chances.empty()) {
        double u = double(s.number(PathDimension::light_point));
        k = chances.sample(u);
    } else {
        k = s.random.turn(s.dimension(PathDimension::light_point)) % light_points.size();
    }
    LightPointView const& l = light_points[k];
    LightSample const light = sample_light(world, l.choice, at.position, l.u);
    auto const pdf = [narrow](BsdfValue const& bsdf, vec3 wi) {
        return narrow ? bsdf.pdf : glm::max(wi.z, 0.0f) * kInvPi;
    };
    vec3 const value = unshadowed_light(at, wo, light, lit_alone(s, narrow), pdf);
    if (!(max_component(value) > 0)) return vec3{0};
    vec2 const u = s.random.noise2(s.dimension(PathDimension::shadow));
    ShadowPlace const in_map = shadow_detail::look(l.shadow, at.position, at.geometric_normal, u);
    ++local.shadow_lookups;
    if (by_rays && confirms) {
        LitBy const by =
            shadow_detail::lit_by(l.shadow, in_map, world.surfaces, at.position, at.geometric_normal, s.triangle);
        if (by != LitBy::some) return by == LitBy::all ? s.throughput * value : vec3{0};
        RayQuery ray = shadow_ray(at.position, at.geometric_normal, at.clearance, light);
        if (!(ray.reach > 0)) return s.throughput * value; // the light lies on the surface
        ray.seed = hash_words(s.random.own_seed() + std::uint32_t(s.vertex), ~s.random.index);
        if (!all_finite(s.throughput * value)) {
            ++local.invalid_paths;
            return vec3{0};
        }
        ++local.doubtful_shadows;
        s.doubtful = {ray, s.throughput * value, 0, s.scatterings + 1};
        return vec3{0};
    }
    bool const reached = shadow_detail::lit(l.shadow, in_map, world.surfaces, at.position, s.triangle);
    return reached ? s.throughput * value : vec3{0};
}

template <bool by_rays>
GI_FN bool StepPaths<by_rays>::scatter_by_ray(State& s, ShadingPoint const& at, vec3 wo, float u_lobe,
                                              PathKernelCounts& local) const
{
    vec2 const u{s.number(PathDimension::lobe_u), s.number(PathDimension::lobe_v)};
    BsdfSample const sampled = gi::sample(at.bsdf, wo, at.front, u_lobe, u);
    if (is_last(s) && !sampled.delta) return false;
    vec3 const direction = at.frame.to_world(sampled.wi);
    if (!is_on_one_side(at, direction, sampled.wi)) return false;
    s.throughput *= sampled.weight;
    s.arrival_pdf = sampled.delta ? 0 : sampled.pdf;
    if (!survives(s)) return false;
    if (!sampled.delta) ++s.scatterings;
    ++s.vertex;
    return follow_ray(s, at, direction, local);
}

template <bool by_rays>
GI_FN bool StepPaths<by_rays>::follow_ray(State& s, ShadingPoint const& at, vec3 direction,
                                          PathKernelCounts& local) const
{
    std::uint32_t const ray_seed = hash_words(s.random.own_seed() + std::uint32_t(s.vertex), pass);
    s.query = RayQuery{.ray = {leave(at, direction), direction}, .seed = ray_seed};
    s.direction = direction;
    ++local.exact_rays;
    return true;
}

template <bool by_rays>
GI_FN bool StepPaths<by_rays>::scatter_by_look_up(State& s, ShadingPoint const& at, vec3 wo, bool narrow,
                                                  PathKernelCounts& local) const
{
    static_assert(kNoLayerHit == kNoPrimitive);
    if (is_last(s) || !(wo.z > 0)) return false;
    // Beyond the last surface, only lights that walks can hit would contribute.
    if (s.scatterings == bounces &&
        (lit_alone(s, narrow) || (world.environment_radiance.empty() && world.emitter_pdf.empty())))
        return false;
    AxisSample const a =
        choice.sample(std::uint32_t(s.scatterings), at.frame.normal, s.number(PathDimension::axis));
    AxisView const& along =
        axes[finest_slot(a.axis, axes_of_level, axes.size() / axes_of_level, at.position,
                         [this](std::uint32_t k) -> RasterGrid const& { return axes[k].grid(); })];
    WalkOrigin origin;
    if (!scatter_along(s, at, wo, narrow, a, world.surfaces[s.triangle], s.triangle, along.grid().axis, origin))
        return false;
    if (!survives(s)) return false;
    LayerHit const hit = nearest_layer(along, world.surfaces, origin);
    ++local.queries;
    if (by_rays && confirms && is_doubtful(along, world.surfaces, origin, hit)) {
        ++local.doubtful_queries;
        ++s.scatterings;
        ++s.vertex;
        return follow_ray(s, at, a.direction, local);
    }
    s.triangle = hit.triangle;
    s.distance = glm::length(hit.position - at.position);
    s.position = hit.position;
    s.has_position = true;
    s.barycentric = vec2{1.0f / 3};
    s.direction = a.direction;
    ++s.scatterings;
    ++s.vertex;
    return true;
}

template <bool by_rays>
GI_FN bool StepPaths<by_rays>::scatter(State& s, ShadingPoint const& at, vec3 wo, bool narrow,
                                       PathKernelCounts& local) const
{
    if (by_rays && narrow)
        if (float const u_lobe = s.number(PathDimension::lobe); takes_narrow_lobe(at.bsdf, wo, u_lobe))
            return scatter_by_ray(s, at, wo, u_lobe, local);
    return scatter_by_look_up(s, at, wo, narrow, local);
}

template <bool by_rays>
GI_FN void StepPaths<by_rays>::add_counts(std::size_t item, PathKernelCounts const& local) const
{
    PathKernelCounts& all = counts[item % counts.size()];
    auto const more = [](std::uint64_t& sum, std::uint64_t n) {
        if (n > 0) atomic_add(sum, n);
    };
    more(all.queries, local.queries);
    more(all.exact_rays, local.exact_rays);
    more(all.shadow_lookups, local.shadow_lookups);
    more(all.doubtful_queries, local.doubtful_queries);
    more(all.doubtful_shadows, local.doubtful_shadows);
    more(all.cut_paths, local.cut_paths);
    more(all.invalid_paths, local.invalid_paths);
}

template <bool by_rays>
GI_FN bool StepPaths<by_rays>::step(State& s, PathSample& out, PathKernelCounts& local) const
{
    if (s.triangle == kNoPrimitive) {
        add_light(out, s.scatterings, sky(s));
        return false;
    }
    Surface const& surface = world.surfaces[s.triangle];
    if (s.has_position && (surface.is(Surface::kSmooth) || surface.is(Surface::kVaries)))
        s.barycentric = barycentric_at(surface, s.position);
    ShadingPoint at = shading_point(world, s.triangle, s.barycentric, s.direction);
    if (s.has_position) at.position = s.position;
    if (s.vertex == 0) see_first_surface(out, at, camera);
    add_light(out, s.scatterings, emission(s, at));
    if (!by_rays && is_last(s)) return false;
    if (s.vertex == kLongestPath) {
        ++local.cut_paths;
        return false;
    }
    vec3 const wo = at.frame.to_local(-s.direction);
    bool const narrow = by_rays && has_narrow_lobe(at.bsdf);
    if (!is_last(s) && !light_points.empty() && !only_delta(at.bsdf))
        add_light(out, s.scatterings + 1, direct(s, at, wo, narrow, local));
    return scatter(s, at, wo, narrow, local);
}

template <bool by_rays>
GI_FN void StepPaths<by_rays>::meet(State& s, Hit const& hit)
{
    static_assert(kNoTriangle == kNoPrimitive);
    s.triangle = hit.triangle;
    s.barycentric = hit.barycentric;
    s.has_position = false;
    s.distance = hit.distance;
    s.query = no_query();
}

template <bool by_rays>
GI_FN void StepPaths<by_rays>::go_on(std::size_t pixel, State const& s) const
{
    std::uint32_t const k = atomic_add(next.count[0], 1);
    next.paths.store(k, {.state = s,
                         .pixel = std::uint32_t(pixel),
                         .vertex = s.vertex,
                         .triangle = s.triangle,
                         .distance = s.distance,
                         .position = s.position,
                         .direction = s.direction});
    if (by_rays) next.queries.store(k, s.query);
}

template <bool by_rays>
GI_FN void StepPaths<by_rays>::wait(std::size_t pixel, State const& s) const
{
    if (!by_rays || !(s.doubtful.query.reach > 0)) return;
    std::uint32_t const k = atomic_add(doubtful.count[0], 1);
    DoubtfulLight light = s.doubtful;
    light.pixel = std::uint32_t(pixel);
    doubtful.lights.store(k, light);
}

template <bool by_rays>
GI_FN void FirstSteps<by_rays>::operator()(std::size_t item) const
{
    std::size_t const i = this->first + item;
    PathKernelCounts local;
    PathSample out;
    if (this->hidden.empty() || this->hidden[i] == 0) {
        auto s = this->start(i);
        if (this->step(s, out, local))
            this->go_on(i, s);
        else
            local.invalid_paths += discard_invalid(out);
        this->wait(i, s);
        this->add_counts(i, local);
    }
    this->samples[i] = out;
}

template <bool by_rays, bool last>
GI_FN void FurtherSteps<by_rays, last>::operator()(std::size_t i) const
{
    if (i >= from.count[0]) return;
    PathKernelCounts local;
    PathOnWay const path = from.paths.load(i);
    typename StepPaths<by_rays>::State s;
    static_cast<PathState&>(s) = path.state;
    s.random = pixel_stream(this->seed, path.pixel, this->width, this->pass);
    s.vertex = path.vertex;
    s.direction = path.direction;
    s.triangle = path.triangle;
    s.position = path.position;
    s.has_position = true;
    s.distance = path.distance;
    if (by_rays && from.queries.load(i).reach > 0) this->meet(s, hits.load(i));
    PathSample out;
    auto const light_last = [&] {
        if (!by_rays || !(s.doubtful.query.reach > 0)) return;
        if (!rays.occluded(this->world, s.doubtful.query))
            add_light(out, s.doubtful.scatterings, s.doubtful.light);
        s.doubtful.query = no_query();
    };
    bool goes_on = this->step(s, out, local);
    while (last && goes_on) {
        if (by_rays && s.query.reach > 0) this->meet(s, rays.nearest(this->world, s.query));
        light_last();
        goes_on = this->step(s, out, local);
    }
    if (last)
        light_last();
    else
        this->wait(path.pixel, s);
    PathSample& sum = this->samples[path.pixel];
    for (std::size_t k = 0; k < out.radiance.size(); ++k) out.radiance[k] += sum.radiance[k];
    if (goes_on)
        this->go_on(path.pixel, s);
    else
        local.invalid_paths += discard_invalid(out);
    sum.radiance = out.radiance;
    this->add_counts(i, local);
}

} // namespace gi
