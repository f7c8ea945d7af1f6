#include "gi/methods/whitted/tree_tracer.h"

namespace gi {

/// Stratified samples of all lights, as no ray continues by a lobe that could hit them.
void TreeTracer::aim_at_lights(TreeRay& r, ShadingPoint const& at, vec3 wo, int generation,
                               std::vector<ShadowRay>& shadows) const
{
    int const n = generation == 0 ? settings.light_samples : 1;
    auto const pdf = [](BsdfValue const& bsdf, vec3) { return bsdf.pdf; };
    for (int k = 0; k < n; ++k) {
        LightChoice const choice = choose_light(world, (double(k) + r.rng.uniform_double()) / double(n));
        LightSample const sampled = sample_light(world, choice, at.position, r.rng.uniform2());
        vec3 const value = unshadowed_light(at, wo, sampled, true, pdf, 1.0f / float(n));
        if (!(max_component(value) > 0)) continue;
        RayQuery query = shadow_ray(at.position, at.geometric_normal, at.clearance, sampled);
        query.seed = r.rng.next();
        if (query.reach > 0)
            shadows.push_back({query, r.throughput * value, r.sample});
        else // the light lies on the surface
            layer_of(*r.sample, 1) += r.throughput * value;
    }
}

/// Returns true if a glyph hides what the ray from the camera has hit.
bool TreeTracer::draw_glyph(TreeRay const& r, Hit const& hit) const
{
    std::optional<Glyph> const g = light != nullptr ? light->glyph(r.ray, hit.distance) : std::nullopt;
    if (!g) return false;
    PathSample& s = *r.sample;
    s.hit = true;
    s.albedo = vec3{1};
    s.normal = g->normal;
    s.position = r.ray.origin + g->distance * r.ray.direction;
    s.depth = glm::dot(s.position - camera.origin, camera.forward);
    layer_of(s, 2) += g->radiance;
    return true;
}

void TreeTracer::shade(TreeRay& r, Hit const& hit, int generation, std::vector<TreeRay>& next,
                       std::vector<ShadowRay>& shadows, std::vector<TreePoint>& points, TreeCounts& counts) const
{
    vec3 const arrival = r.ray.direction;
    if (hit.triangle == kNoTriangle) {
        if (generation == 0)
            r.sample->radiance[0] = background_radiance(world, arrival);
        else if (!world.environment_radiance.empty())
            layer_of(*r.sample, 0) += r.throughput * environment_radiance(world, arrival);
        return;
    }
    ShadingPoint const at = shading_point(world, hit.triangle, hit.barycentric, arrival);
    if (generation == 0) see_first_surface(*r.sample, at, camera);
    layer_of(*r.sample, 0) += r.throughput * at.emission;
    vec3 const wo = at.frame.to_local(-arrival);
    if (!only_delta(at.bsdf)) {
        if (!world.light_select.empty()) aim_at_lights(r, at, wo, generation, shadows);
        if (light != nullptr) {
            Pcg32 const rng = Pcg32::for_path(r.rng.next(), 0, 0);
            points.push_back({at, wo, rng, generation == 0, r.throughput, r.sample});
        }
    }
    BsdfSample lobes[3];
    int const n = delta_lobes(at.bsdf, wo, at.front, lobes);
    for (int k = 0; k < n; ++k) {
        TreeRay child = r;
        child.throughput *= lobes[k].weight;
        vec3 const direction = at.frame.to_world(lobes[k].wi);
        float const largest = max_component(child.throughput);
        if (!(largest > 0) || !is_on_one_side(at, direction, lobes[k].wi)) continue;
        if (generation >= settings.recursion || largest < settings.cutoff) {
            ++counts.cut_rays;
            counts.cut_weight += double(largest);
            continue;
        }
        child.rng = Pcg32::for_path(std::uint64_t(r.rng.next()) << 32 | r.rng.next(), std::uint32_t(k), 0);
        child.ray = {leave(at, direction), direction};
        next.push_back(child);
    }
}

void TreeTracer::trace(std::span<glm::ivec2 const> pixels, std::uint32_t index, std::span<PathSample> samples,
                       std::span<FirstHit> first, TreeCounts& counts) const
{
    std::vector<TreeRay> rays, next;
    std::vector<ShadowRay> shadows;
    std::vector<RayQuery> queries;
    std::vector<Hit> hits;
    std::vector<std::uint8_t> blocked;
    std::vector<TreePoint> points;
    std::vector<vec3> indirect;
    for (std::size_t k = 0; k < pixels.size(); ++k) {
        RayPath start;
        start_path(start, camera, filter, seed, pixels[k], width, index);
        samples[k] = {};
        rays.push_back({start.rng, start.ray, vec3{1}, &samples[k]});
    }
    for (int generation = 0; !rays.empty(); ++generation) {
        queries.clear();
        next.clear();
        shadows.clear();
        points.clear();
        for (TreeRay& r : rays) {
            queries.push_back({.ray = r.ray, .seed = r.rng.next()});
            if (generation == 0) queries.back().start = camera_clearance(r.ray.origin);
        }
        hits.resize(rays.size());
        visibility.nearest(queries, hits);
        counts.paths.nearest_rays += rays.size();
        for (std::size_t k = 0; k < rays.size(); ++k) {
            if (generation == 0 && draw_glyph(rays[k], hits[k])) {
                first[k] = {};
                continue;
            }
            if (generation == 0) first[k] = {hits[k].triangle, hits[k].barycentric};
            shade(rays[k], hits[k], generation, next, shadows, points, counts);
        }
        queries.clear();
        for (ShadowRay const& s : shadows) queries.push_back(s.query);
        blocked.resize(queries.size());
        visibility.occluded(queries, blocked);
        counts.paths.shadow_rays += queries.size();
        for (std::size_t k = 0; k < shadows.size(); ++k)
            if (blocked[k] == 0) layer_of(*shadows[k].sample, 1) += shadows[k].radiance;
        if (!points.empty()) {
            indirect.resize(points.size());
            light->indirect(points, indirect, counts.paths);
            for (std::size_t k = 0; k < points.size(); ++k)
                layer_of(*points[k].sample, 2) += points[k].throughput * indirect[k];
        }
        std::swap(rays, next);
    }
    for (PathSample& s : samples) counts.paths.invalid_paths += discard_invalid(s);
}

} // namespace gi
