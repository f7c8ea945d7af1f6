#pragma once
// Implementation of TracePaths; included by path_kernel.h.

namespace gi {

GI_FN inline TracePaths::State TracePaths::start(std::size_t pixel) const
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

GI_FN inline vec3 TracePaths::sky(State const& s) const
{
    if (s.scatterings == 0) return background_radiance(world, s.direction);
    if (world.environment_radiance.empty()) return vec3{0};
    return s.throughput * met_environment(world, s, s.direction);
}

/// Emission of a light hit by the camera or a walk.
GI_FN inline vec3 TracePaths::emission(State const& s, ShadingPoint const& at) const
{
    if (!s.counts_emission || !(max_component(at.emission) > 0)) return vec3{0};
    return s.throughput * met_emission(world, s, at, s.triangle, s.direction, s.distance);
}

GI_FN inline vec3 TracePaths::direct(State const& s, ShadingPoint const& at, vec3 wo, bool narrow,
                                     PathKernelCounts& local) const
{
    std::size_t k = 0;
    if (!chances.empty()) {
        double u = double(s.random.sample(s.dimension(PathDimension::light_point)));
        k = chances.sample(u);
    } else {
        k = s.random.turn(s.dimension(PathDimension::light_point)) % light_points.size();
    }
    LightPointView const& l = light_points[k];
    LightSample const light = sample_light(world, l.choice, at.position, l.u);
    // No walk from a narrow lobe finds a light.
    bool const alone = lit_alone(s, narrow) || (narrow && light.distance != kInf);
    auto const pdf = [narrow](BsdfValue const& bsdf, vec3 wi) {
        return narrow ? bsdf.pdf : glm::max(wi.z, 0.0f) * kInvPi;
    };
    vec3 const value = unshadowed_light(at, wo, light, alone, pdf);
    if (!(max_component(value) > 0)) return vec3{0};
    vec2 const u = s.random.noise2(s.dimension(PathDimension::shadow));
    ShadowPlace const in_map = shadow_detail::look(l.shadow, at.position, at.geometric_normal, u);
    ++local.shadow_lookups;
    bool const reached = shadow_detail::lit(l.shadow, in_map, world.surfaces, at.position, s.triangle);
    return reached ? s.throughput * value : vec3{0};
}

GI_FN inline bool TracePaths::leave(State& s, ShadingPoint const& at, vec3 wo, bool narrow,
                                    PathKernelCounts& local) const
{
    static_assert(kNoLayerHit == kNoPrimitive);
    if (narrow && takes_narrow_lobe(at.bsdf, wo, s.random.sample(s.dimension(PathDimension::lobe)))) {
        ++local.narrow_ends;
        return false;
    }
    if (!(wo.z > 0)) return false;
    // Beyond the last surface, only lights that walks can hit would contribute.
    if (s.scatterings == bounces &&
        (lit_alone(s, narrow) || (world.environment_radiance.empty() && world.emitter_pdf.empty())))
        return false;
    AxisSample const a = choice.sample(std::uint32_t(s.scatterings), at.frame.normal,
                                       s.random.sample(s.dimension(PathDimension::axis)));
    AxisView const& along = axes[a.axis];
    WalkOrigin origin;
    if (!scatter_along(s, at, wo, narrow, a, world.surfaces[s.triangle], s.triangle, along.grid().axis, origin))
        return false;
    auto const uniform = [&s] { return s.random.sample(s.dimension(PathDimension::roulette)); };
    if (!survives_roulette(s, roulette, uniform)) return false;
    LayerHit const hit = nearest_layer(along, world.surfaces, origin);
    ++local.queries;
    s.triangle = hit.triangle;
    s.distance = glm::length(hit.position - at.position);
    s.counts_emission = !narrow;
    s.position = hit.position;
    s.barycentric = vec2{1.0f / 3};
    s.direction = a.direction;
    ++s.scatterings;
    return true;
}

GI_FN inline void TracePaths::add_counts(PathKernelCounts const& local) const
{
    PathKernelCounts& all = counts[0];
    auto const more = [](std::uint64_t& sum, std::uint64_t n) {
        if (n > 0) atomic_add(sum, n);
    };
    more(all.queries, local.queries);
    more(all.shadow_lookups, local.shadow_lookups);
    more(all.narrow_ends, local.narrow_ends);
    more(all.cut_paths, local.cut_paths);
    more(all.invalid_paths, local.invalid_paths);
}

GI_FN inline void TracePaths::operator()(std::size_t i) const
{
    PathSample out;
    if (!hidden.empty() && hidden[i] != 0) {
        samples[i] = out;
        return;
    }
    PathKernelCounts local;
    State s = start(i);
    for (;;) {
        if (s.triangle == kNoPrimitive) {
            layer_of(out, s.scatterings) += sky(s);
            break;
        }
        Surface const& surface = world.surfaces[s.triangle];
        bool const first = s.scatterings == 0;
        if (!first && (surface.is(Surface::kSmooth) || surface.is(Surface::kVaries)))
            s.barycentric = barycentric_at(surface, s.position);
        ShadingPoint at = shading_point(world, s.triangle, s.barycentric, s.direction);
        if (first) {
            see_first_surface(out, at, camera);
        } else {
            at.position = s.position;
        }
        layer_of(out, s.scatterings) += emission(s, at);
        if (s.scatterings > bounces) break;
        if (s.scatterings == kLongestPath) {
            ++local.cut_paths;
            break;
        }
        vec3 const wo = at.frame.to_local(-s.direction);
        bool const narrow = has_narrow_lobe(at.bsdf);
        if (!light_points.empty() && !only_delta(at.bsdf))
            layer_of(out, s.scatterings + 1) += direct(s, at, wo, narrow, local);
        if (!leave(s, at, wo, narrow, local)) break;
    }
    local.invalid_paths += discard_invalid(out);
    samples[i] = out;
    add_counts(local);
}

} // namespace gi
