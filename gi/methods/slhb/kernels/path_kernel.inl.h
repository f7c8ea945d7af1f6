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
    if (s.triangle == kNoPrimitive) return s;
    // The raster gives the triangle; the ray gives the point on its plane.
    Surface const& surface = world.surfaces[s.triangle];
    vec3 const normal = glm::cross(surface.edge1, surface.edge2);
    float const t = glm::dot(normal, surface.corner - ray.origin) / glm::dot(normal, ray.direction);
    if (std::isfinite(t)) s.barycentric = barycentric_at(surface, ray.origin + t * ray.direction);
    return s;
}

GI_FN inline vec3 TracePaths::sky(State const& s) const
{
    if (s.scatterings == 0) return background_radiance(world, s.direction);
    if (world.environment_radiance.empty()) return vec3{0};
    vec3 light = environment_radiance(world, s.direction);
    if (s.arrival_pdf > 0) light *= power_heuristic(s.arrival_pdf, environment_direction_pdf(world, s.direction));
    return s.throughput * light;
}

/// Emission of a light hit by the camera or a walk.
GI_FN inline vec3 TracePaths::emission(State const& s, ShadingPoint const& at) const
{
    if (s.scatterings == 0) return at.emission;
    if (!s.counts_emission || !(max_component(at.emission) > 0)) return vec3{0};
    float const cos_light = std::abs(glm::dot(s.direction, at.geometric_normal));
    float const pdf = emitter_direction_pdf(world, s.triangle, s.distance, cos_light);
    return s.throughput * at.emission * power_heuristic(s.arrival_pdf, pdf);
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
    if (!(light.pdf > 0)) return vec3{0};
    vec3 const wi = at.frame.to_local(light.direction);
    float const side = glm::dot(light.direction, at.geometric_normal);
    if ((wi.z > 0) != (side > 0)) return vec3{0};
    BsdfValue const bsdf = evaluate(at.bsdf, wo, wi);
    vec3 value = bsdf.f * light.radiance * (std::abs(wi.z) / light.pdf);
    if (!(max_component(value) > 0)) return vec3{0};
    // No walk from a narrow lobe finds a light.
    if (!light.delta && !lit_alone(s, narrow) && (light.distance == kInf || !narrow))
        value *= power_heuristic(light.pdf, narrow ? bsdf.pdf : glm::max(wi.z, 0.0f) * kInvPi);
    vec2 const u = s.random.noise2(s.dimension(PathDimension::shadow));
    ShadowPlace const at_lamp = shadow_detail::look(l.shadow, at.position, at.geometric_normal, u);
    ++local.shadow_lookups;
    bool const reached = shadow_detail::lit(l.shadow, at_lamp, world.surfaces, at.position, s.triangle);
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
    vec3 const wi = at.frame.to_local(a.direction);
    float const side = glm::dot(a.direction, at.geometric_normal);
    if (!(wi.z > 0) || !(side > 0)) return false;
    BsdfValue const value = evaluate(at.bsdf, wo, wi);
    float const pdf = narrow ? value.pdf : wi.z * kInvPi;
    if (!(pdf > 0)) return false;
    s.throughput *= value.f * (wi.z * a.weight / pdf);
    s.arrival_pdf = pdf;
    float const survival = max_component(s.throughput);
    if (!(survival > 0)) return false;
    float const keep = chance_to_go_on(survival, s.scatterings, roulette);
    if (keep < 1) {
        if (s.random.sample(s.dimension(PathDimension::roulette)) >= keep) return false;
        s.throughput /= keep;
    }
    AxisView const& along = axes[a.axis];
    Surface const& surface = world.surfaces[s.triangle];
    vec3 const normal = glm::cross(surface.edge1, surface.edge2), axis_direction = along.grid().axis;
    WalkOrigin const origin{at.position, s.triangle, glm::dot(normal, axis_direction) > 0,
                            glm::dot(a.direction, axis_direction) > 0,
                            std::sqrt(glm::max(0.0f, 1 - side * side)) / side};
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
            add(out, s.scatterings, sky(s));
            break;
        }
        Surface const& surface = world.surfaces[s.triangle];
        bool const first = s.scatterings == 0;
        if (!first && (surface.is(Surface::kSmooth) || surface.is(Surface::kVaries)))
            s.barycentric = barycentric_at(surface, s.position);
        ShadingPoint at = shading_point(world, s.triangle, s.barycentric, s.direction);
        if (first) {
            out.hit = true;
            out.albedo = albedo(at.bsdf);
            out.normal = at.frame.normal;
            out.position = at.position;
            out.depth = glm::dot(at.position - camera.origin, camera.forward);
        } else {
            at.position = s.position;
        }
        add(out, s.scatterings, emission(s, at));
        if (s.scatterings > bounces) break;
        if (s.scatterings == kLongestPath) {
            ++local.cut_paths;
            break;
        }
        vec3 const wo = at.frame.to_local(-s.direction);
        bool const narrow = has_narrow_lobe(at.bsdf);
        if (!light_points.empty() && !only_delta(at.bsdf))
            add(out, s.scatterings + 1, direct(s, at, wo, narrow, local));
        if (!leave(s, at, wo, narrow, local)) break;
    }
    for (int part = 0; part < 3; ++part)
        if (!all_finite(out.radiance[std::size_t(part)])) {
            out.radiance[std::size_t(part)] = vec3{0};
            ++local.invalid_paths;
        }
    samples[i] = out;
    add_counts(local);
}

} // namespace gi
