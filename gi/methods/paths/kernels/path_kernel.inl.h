#pragma once
// Implementation of the kernels of paths; included by path_kernel.h.

#include "gi/render/path_random.h"

#include <cstddef>

namespace gi {

template <FindBy by>
GI_FN typename StepPaths<by>::State StepPaths<by>::start(std::size_t pixel) const
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

template <FindBy by>
GI_FN vec3 StepPaths<by>::sky(State const& s) const
{
    if (s.vertex == 0) return background_radiance(world, s.direction);
    if (world.environment_radiance.empty()) return vec3{0};
    return s.throughput * met_environment(world, s, s.direction);
}

/// Emission of a light hit by the camera, a look-up or an exact ray.
template <FindBy by>
GI_FN vec3 StepPaths<by>::emission(State const& s, ShadingPoint const& at) const
{
    if (!(max_component(at.emission) > 0)) return vec3{0};
    return s.throughput * met_emission(world, s, at, s.triangle, s.direction, s.distance);
}

template <FindBy by>
GI_FN vec3 StepPaths<by>::direct(State& s, ShadingPoint const& at, vec3 wo, bool narrow,
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
        LitBy const found =
            shadow_detail::lit_by(l.shadow, in_map, world.surfaces, at.position, at.geometric_normal, s.triangle);
        if (found != LitBy::some) return found == LitBy::all ? s.throughput * value : vec3{0};
        RayQuery const ray = shadow_query(s, at, light);
        if (!(ray.reach > 0)) return s.throughput * value; // the light lies on the surface
        if (!all_finite(s.throughput * value)) {
            ++local.invalid_paths;
            return vec3{0};
        }
        ++local.doubtful_shadows;
        s.waiting = {ray, s.throughput * value, 0, s.scatterings + 1};
        return vec3{0};
    }
    bool const reached = shadow_detail::lit(l.shadow, in_map, world.surfaces, at.position, s.triangle);
    return reached ? s.throughput * value : vec3{0};
}

template <FindBy by>
GI_FN RayQuery StepPaths<by>::shadow_query(State const& s, ShadingPoint const& at, LightSample const& light) const
{
    RayQuery ray = shadow_ray(at.position, at.geometric_normal, at.clearance, light);
    ray.seed = hash_words(s.random.own_seed() + std::uint32_t(s.vertex), ~s.random.index);
    return ray;
}

template <FindBy by>
GI_FN vec3 StepPaths<by>::pooled(State& s, ShadingPoint const& at, vec3 wo, bool narrow,
                                 PathKernelCounts& local) const
{
    ChosenLight const chosen = pool.choose(at.position, at.frame.normal, s.number(PathDimension::light_point),
                                           s.number(PathDimension::light_sample_pick));
    if (chosen.light == nullptr) return vec3{0};
    LightSample const light = chosen.light->seen_from(world, at.position);
    auto const pdf = [narrow](BsdfValue const& bsdf, vec3 wi) {
        return narrow ? bsdf.pdf : glm::max(wi.z, 0.0f) * kInvPi;
    };
    vec3 const value = s.throughput * (chosen.weight * unshadowed_light(at, wo, light, lit_alone(s, narrow), pdf));
    if (!(max_component(value) > 0)) return vec3{0};
    RayQuery const ray = shadow_query(s, at, light);
    if (!(ray.reach > 0)) return value; // the light lies on the surface
    if (!all_finite(value)) {
        ++local.invalid_paths;
        return vec3{0};
    }
    ++local.shadow_rays;
    s.waiting = {ray, value, 0, s.scatterings + 1};
    return vec3{0};
}

template <FindBy by>
GI_FN bool StepPaths<by>::scatter_freely(State& s, ShadingPoint const& at, vec3 wo, bool narrow,
                                         PathKernelCounts& local) const
{
    if (is_last(s) || !(wo.z > 0)) return false;
    // Beyond the last surface, only light that a path can hit would contribute.
    if (s.scatterings == bounces && (!meets_light || lit_alone(s, narrow))) return false;
    vec3 const wi =
        square_to_cosine_hemisphere({s.number(PathDimension::lobe_u), s.number(PathDimension::lobe_v)});
    vec3 const direction = at.frame.to_world(wi);
    if (!(wi.z > 0) || !(glm::dot(direction, at.geometric_normal) > 0)) return false;
    if (!narrow) {
        s.arrival_pdf = wi.z * kInvPi;
        s.throughput *= at.bsdf.diffuse;
    } else {
        BsdfValue const value = evaluate(at.bsdf, wo, wi);
        s.arrival_pdf = value.pdf;
        if (!(s.arrival_pdf > 0)) return false;
        s.throughput *= value.f * (wi.z / s.arrival_pdf);
    }
    if (!survives(s)) return false;
    ++s.scatterings;
    ++s.vertex;
    return follow_ray(s, at, direction, local);
}

template <FindBy by>
GI_FN bool StepPaths<by>::scatter_by_ray(State& s, ShadingPoint const& at, vec3 wo, float u_lobe,
                                         PathKernelCounts& local) const
{
    vec2 const u{s.number(PathDimension::lobe_u), s.number(PathDimension::lobe_v)};
    BsdfSample const sampled = gi::sample(at.bsdf, wo, at.front, u_lobe, u);
    if (is_last(s) && !sampled.delta) return false;
    vec3 const direction = at.frame.to_world(sampled.wi);
    if (!is_on_one_side(at, direction, sampled.wi)) return false;
    s.throughput *= sampled.weight;
    s.medium = medium_beyond(world, s.medium, s.triangle, at, sampled);
    s.arrival_pdf = sampled.delta ? 0 : sampled.pdf;
    if (!survives(s)) return false;
    if (!sampled.delta) ++s.scatterings;
    ++s.vertex;
    return follow_ray(s, at, direction, local);
}

template <FindBy by>
GI_FN bool StepPaths<by>::follow_ray(State& s, ShadingPoint const& at, vec3 direction,
                                     PathKernelCounts& local) const
{
    std::uint32_t const ray_seed = hash_words(s.random.own_seed() + std::uint32_t(s.vertex), pass);
    s.query = RayQuery{.ray = {leave(at, direction), direction}, .seed = ray_seed};
    s.direction = direction;
    ++local.exact_rays;
    return true;
}

template <FindBy by>
GI_FN bool StepPaths<by>::scatter_by_look_up(State& s, ShadingPoint const& at, vec3 wo, bool narrow,
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

template <FindBy by>
GI_FN bool StepPaths<by>::scatter(State& s, ShadingPoint const& at, vec3 wo, bool narrow,
                                  PathKernelCounts& local) const
{
    if (by_rays && narrow)
        if (float const u_lobe = s.number(PathDimension::lobe); takes_narrow_lobe(at.bsdf, wo, u_lobe))
            return scatter_by_ray(s, at, wo, u_lobe, local);
    if constexpr (free)
        return scatter_freely(s, at, wo, narrow, local);
    else
        return scatter_by_look_up(s, at, wo, narrow, local);
}

template <FindBy by>
GI_FN void StepPaths<by>::add_counts(std::size_t item, PathKernelCounts const& local) const
{
    PathKernelCounts& all = counts[item % counts.size()];
    auto const more = [](std::uint64_t& sum, std::uint64_t n) {
        if (n > 0) atomic_add(sum, n);
    };
    more(all.queries, local.queries);
    more(all.exact_rays, local.exact_rays);
    more(all.shadow_lookups, local.shadow_lookups);
    more(all.shadow_rays, local.shadow_rays);
    more(all.cache_reads, local.cache_reads);
    more(all.doubtful_queries, local.doubtful_queries);
    more(all.doubtful_shadows, local.doubtful_shadows);
    more(all.cut_paths, local.cut_paths);
    more(all.invalid_paths, local.invalid_paths);
}

template <FindBy by>
GI_FN bool StepPaths<by>::step(State& s, PathSample& out, PathKernelCounts& local) const
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
    if (may_absorb(s.medium, at)) {
        float const way = s.vertex > 0 ? s.distance : glm::length(at.position - camera.origin);
        s.throughput *= left_by_medium(world, s.medium, s.triangle, at, way);
    }
    if (s.vertex == 0) see_first_surface(out, at, camera);
    if (free && s.note < cache.notes.count && is_directional(at.bsdf))
        cache.notes.set_word(s.note, offsetof(CacheNoteOnWay, directional) / sizeof(std::uint32_t), 1);
    add_light(out, s.scatterings, emission(s, at));
    if (!by_rays && is_last(s)) return false;
    if (s.vertex == kLongestPath) {
        ++local.cut_paths;
        return false;
    }
    vec3 const wo = at.frame.to_local(-s.direction);
    // Axes can only sample broad lobes; exact rays can sample any.
    bool const narrow = free ? !bsdf_detail::is_matt(at.bsdf) : by_rays && has_narrow_lobe(at.bsdf);
    bool const has_lights = free ? !pool.groups.empty() : !light_points.empty();
    if (!is_last(s) && has_lights && !only_delta(at.bsdf)) {
        if constexpr (free)
            add_light(out, s.scatterings + 1, pooled(s, at, wo, narrow, local));
        else
            add_light(out, s.scatterings + 1, direct(s, at, wo, narrow, local));
    }
    return scatter(s, at, wo, narrow, local);
}

template <FindBy by>
GI_FN void StepPaths<by>::meet(State& s, Hit const& hit)
{
    static_assert(kNoTriangle == kNoPrimitive);
    s.triangle = hit.triangle;
    s.barycentric = hit.barycentric;
    s.has_position = false;
    s.distance = hit.distance;
    s.query = no_query();
}

template <FindBy by>
GI_FN CacheKeys StepPaths<by>::keys_of(State const& s) const
{
    // After the last scattering, surfaces only contribute emission.
    if (s.triangle == kNoPrimitive || s.scatterings == 0 || s.scatterings > bounces || s.medium != kNoMedium)
        return {};
    Surface const& surface = world.surfaces[s.triangle];
    if (is_directional(world.bsdfs[surface.material]) ||
        (!world.emitter_pdf.empty() && world.emitter_pdf[s.triangle] > 0))
        return {};
    vec3 const& t = s.throughput;
    if (!(glm::min(t.x, glm::min(t.y, t.z)) > 1e-3f * max_component(t)))
        return {}; // no estimate from channels without throughput
    vec3 const position = shading_detail::SurfacePoint{surface, s.barycentric}.position();
    return cell_keys(surface, cache.shift, position, s.direction, s.footprint, bounces - s.scatterings);
}

template <FindBy by>
GI_FN bool StepPaths<by>::ends_in_cell(State& s, std::size_t pixel, vec3 indirect, PathSample& out) const
{
    s.note = kNoNote;
    // A cosine lobe (pdf up to 1 / pi) is about as wide as its distance.
    if (s.arrival_pdf > 0) s.footprint += s.distance * glm::min(1.0f, 1 / std::sqrt(kPi * s.arrival_pdf));
    CacheKeys const keys = keys_of(s);
    if (!keys.any()) return false;
    CachedRadiance const known =
        read_cells(keys, cache.least, [this](std::uint64_t key) { return cache.sums_of(key); });
    if (!(s.random.noise2(s.dimension(PathDimension::cache)).x < known.go_on)) {
        out.radiance[2] += s.throughput * known.radiance;
        return true;
    }
    CacheNoteOnWay note{};
    for (std::size_t l = 0; l < CacheKeys::kLevels; ++l) note.set_key(l, l < known.to_teach ? keys.level[l] : 0);
    note.throughput = s.throughput;
    note.before = indirect;
    note.weight = luminance(s.throughput) / known.go_on;
    note.pixel = std::uint32_t(pixel);
    s.note = cache.open(note);
    return false;
}

template <FindBy by>
GI_FN std::uint32_t StepPaths<by>::go_on(std::size_t pixel, State const& s) const
{
    std::uint32_t const k = atomic_add(next.count[0], 1);
    PathOnWay path; // by its members: nvcc 13 cannot read names in braces here
    path.state = s;
    path.footprint = s.footprint;
    path.pixel = std::uint32_t(pixel);
    path.vertex = s.vertex;
    path.triangle = s.triangle;
    path.distance = s.distance;
    path.position = s.position;
    path.direction = s.direction;
    next.paths.store(k, path);
    if (by_rays) next.queries.store(k, s.query);
    return k;
}

template <FindBy by>
GI_FN void StepPaths<by>::wait(std::size_t pixel, State const& s) const
{
    if (!by_rays || !(s.waiting.query.reach > 0)) return;
    std::uint32_t const k = atomic_add(waiting.count[0], 1);
    WaitingLight light = s.waiting;
    light.pixel = std::uint32_t(pixel);
    waiting.lights.store(k, light);
}

GI_FN inline void StartRays::operator()(std::size_t item) const
{
    constexpr std::uint32_t kLens = 0x1e450000; // as of PathsTracer
    std::size_t const i = pixel_of(item);
    if (i >= pixels) return;
    auto const id = std::uint32_t(i);
    if (!hidden.empty() && hidden[i] != 0) {
        samples[i] = {};
        return;
    }
    State s;
    s.random = pixel_stream(seed, id, width, pass);
    vec2 const at =
        vec2{float(id % width) + 0.5f, float(id / width) + 0.5f} + filter_offset(filter, s.random.sample2(0));
    Ray const ray = camera_ray(camera, at, [&] { return s.random.sample2(kLens); });
    s.query = {.ray = ray, .seed = s.random.own_seed() + pass, .start = camera_clearance(ray.origin)};
    s.direction = ray.direction;
    hits.store(go_on(i, s), rays.nearest(world, s.query));
}

template <FindBy by>
GI_FN void FirstSteps<by>::operator()(std::size_t item) const
{
    std::size_t const i = this->pixel_of(item);
    if (i >= this->pixels) return;
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

template <FindBy by, bool last>
GI_FN void FurtherSteps<by, last>::operator()(std::size_t i) const
{
    using Own = StepPaths<by>;
    if (i >= from.count[0]) return;
    PathKernelCounts local;
    PathOnWay const path = from.paths.load(i);
    typename Own::State s;
    static_cast<PathState&>(s) = path.state;
    s.random = pixel_stream(this->seed, path.pixel, this->width, this->pass);
    s.vertex = path.vertex;
    s.direction = path.direction;
    s.triangle = path.triangle;
    s.position = path.position;
    s.has_position = true;
    s.distance = path.distance;
    s.footprint = path.footprint;
    bool const is_first = path.vertex == 0; // of the path that a ray of the camera began
    if (Own::by_rays) {
        RayQuery const query = from.queries.load(i);
        if (query.reach > 0) this->meet(s, hits.load(i));
        if (is_first && s.triangle != kNoPrimitive) // as PathsTracer begins, whose rays find the triangle alone
            s.barycentric = barycentric_of(this->world.surfaces[s.triangle], query.ray);
    }
    PathSample out;
    auto const light_last = [&] {
        if (!Own::by_rays || !(s.waiting.query.reach > 0)) return;
        vec3 const left = rays.template transmittance<true>(this->world, s.waiting.query);
        if (left != vec3{0}) add_light(out, s.waiting.scatterings, left * s.waiting.light);
        s.waiting.query = no_query();
    };
    auto const step = [&] {
        if (Own::free && !this->cache.cells.empty() && s.vertex > 0) {
            vec3 const before = is_first ? vec3{0} : this->samples[path.pixel].radiance[2];
            if (this->ends_in_cell(s, path.pixel, before + out.radiance[2], out)) {
                ++local.cache_reads;
                return false;
            }
        }
        return this->step(s, out, local);
    };
    bool goes_on = step();
    while (last && goes_on) {
        if (Own::by_rays && s.query.reach > 0) this->meet(s, rays.nearest(this->world, s.query));
        light_last();
        goes_on = step();
    }
    if (last)
        light_last();
    else
        this->wait(path.pixel, s);
    PathSample& sum = this->samples[path.pixel];
    if (!is_first)
        for (std::size_t k = 0; k < out.radiance.size(); ++k) out.radiance[k] += sum.radiance[k];
    if (goes_on)
        this->go_on(path.pixel, s);
    else
        local.invalid_paths += discard_invalid(out);
    if (is_first)
        sum = out;
    else
        sum.radiance = out.radiance;
    this->add_counts(i, local);
}

} // namespace gi
