#include "gi/methods/whitted/tree_tracer.h"

#include "gi/scene/shading/narrow_lobes.h"

#include <algorithm>

namespace gi {
namespace {

bool has_narrow_glossy_lobe(Bsdf const& b)
{
    bool const delta = b.model == MaterialModel::metal_rough && bsdf_detail::specular_is_delta(b);
    return has_narrow_lobe(glossy_lobe(b)) && !delta;
}

} // namespace

/// Stratified samples of all lights; only a ray of the glossy lobe could hit them, too.
void TreeTracer::aim_at_lights(TreeRay& r, ShadingPoint const& at, vec3 wo, int generation, bool glossy_traced,
                               std::vector<ShadowRay>& shadows) const
{
    int const n = generation == 0 ? settings.light_samples : 1;
    auto const pdf = [](BsdfValue const& bsdf, vec3) { return bsdf.pdf; };
    float const share = 1.0f / float(n);
    std::optional<ShadingPoint> glossy;
    if (glossy_traced) {
        glossy = at;
        glossy->bsdf = glossy_lobe(at.bsdf);
    }
    for (int k = 0; k < n; ++k) {
        LightChoice const choice = choose_light(world, (double(k) + r.rng.uniform_double()) / double(n));
        LightSample const sampled = sample_light(world, choice, at.position, r.rng.uniform2());
        vec3 value = unshadowed_light(at, wo, sampled, true, pdf, share);
        if (glossy) // the rest of the lobe's part: by the ray
            value = glm::max(value - unshadowed_light(*glossy, wo, sampled, true, pdf, share), vec3{0}) +
                    unshadowed_light(*glossy, wo, sampled, false, pdf, share);
        if (!(max_component(value) > 0)) continue;
        RayQuery query = shadow_ray(at.position, at.geometric_normal, at.clearance, sampled);
        query.seed = r.rng.next();
        if (panes_by_photons) query.to_lamp = 0;
        if (query.reach > 0)
            shadows.push_back({query, r.state.throughput * value, r.state.scatterings + 1, r.sample});
        else // the light lies on the surface
            layer_of(*r.sample, r.state.scatterings + 1) += r.state.throughput * value;
    }
}

/// Continues along a random direction of the glossy lobe.
void TreeTracer::reflect_glossy(TreeRay& r, ShadingPoint const& at, vec3 wo, std::vector<TreeRay>& next) const
{
    // Rays that contribute less than this share of the light are traced by Russian roulette.
    constexpr float kRoulette = 0.1f;
    TreeRay child = r;
    child.rng = Pcg32::for_path(std::uint64_t(r.rng.next()) << 32 | r.rng.next(), 3, 0);
    vec3 const wi = bsdf_detail::sample_specular(at.bsdf, wo, child.rng.uniform2());
    BsdfValue const value = evaluate(glossy_lobe(at.bsdf), wo, wi);
    vec3 const direction = at.frame.to_world(wi);
    if (!(wi.z > 0) || !(value.pdf > 0) || !is_on_one_side(at, direction, wi)) return;
    child.state.throughput *= value.f * (wi.z / value.pdf);
    float const largest = max_component(child.state.throughput);
    float const survival = std::min(1.0f, largest / kRoulette);
    if (!(largest > 0) || child.rng.uniform() >= survival) return;
    child.state.throughput /= survival;
    child.state.arrival_pdf = value.pdf;
    ++child.state.scatterings;
    child.ray = {leave(at, direction), direction};
    next.push_back(child);
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
            layer_of(*r.sample, r.state.scatterings) +=
                r.state.throughput * met_environment(world, r.state, arrival);
        return;
    }
    ShadingPoint const at = shading_point(world, hit.triangle, hit.barycentric, arrival);
    r.state.throughput *= left_by_medium(world, r.state.medium, hit.triangle, at, hit.distance);
    if (generation == 0) see_first_surface(*r.sample, at, camera);
    if (max_component(at.emission) > 0)
        layer_of(*r.sample, r.state.scatterings) +=
            r.state.throughput * met_emission(world, r.state, at, hit.triangle, arrival, hit.distance);
    vec3 const wo = at.frame.to_local(-arrival);
    if (!only_delta(at.bsdf)) {
        bool const glossy = light != nullptr && r.state.scatterings == 0 && wo.z > 0 &&
                            generation < settings.recursion && has_narrow_glossy_lobe(at.bsdf);
        int const scatterings = r.state.scatterings;
        if (!world.light_select.empty() && scatterings <= bounces)
            aim_at_lights(r, at, wo, generation, glossy, shadows);
        if (light != nullptr && (scatterings == 0 || scatterings < bounces)) {
            Pcg32 const rng = Pcg32::for_path(r.rng.next(), 0, 0);
            points.push_back({at, wo, rng, generation == 0, glossy, scatterings, r.state.throughput, r.sample});
        }
        if (glossy) reflect_glossy(r, at, wo, next);
    }
    BsdfSample lobes[3];
    int const n = delta_lobes(at.bsdf, wo, at.front, lobes);
    for (int k = 0; k < n; ++k) {
        TreeRay child = r;
        child.state.throughput *= lobes[k].weight;
        child.state.arrival_pdf = 0;
        child.state.medium = medium_beyond(world, r.state.medium, hit.triangle, at, lobes[k]);
        vec3 const direction = at.frame.to_world(lobes[k].wi);
        float const largest = max_component(child.state.throughput);
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
    std::vector<vec3> left;
    std::vector<TreePoint> points;
    std::vector<vec3> indirect;
    for (std::size_t k = 0; k < pixels.size(); ++k) {
        RayPath start;
        start_path(start, camera, filter, seed, pixels[k], width, index);
        samples[k] = {};
        rays.push_back({start.rng, start.ray, {}, &samples[k]});
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
        left.resize(queries.size());
        visibility.transmittance(queries, left);
        counts.paths.shadow_rays += queries.size();
        for (std::size_t k = 0; k < shadows.size(); ++k)
            if (left[k] != vec3{0})
                layer_of(*shadows[k].sample, shadows[k].scatterings) += left[k] * shadows[k].radiance;
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
