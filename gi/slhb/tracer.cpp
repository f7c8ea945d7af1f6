#include "gi/slhb/tracer.h"

#include "gi/scene/shading_point.h"
#include "gi/scene/warp.h"
#include "gi/slhb/narrow_lobes.h"
#include "gi/slhb/path_random.h"
#include "gi/transport/sampling.h"

#include <algorithm>
#include <chrono>

namespace gi {
namespace {

/// Random numbers of one path: dimensions of vertex v start at v * kPerVertex + 2 (the camera has two).
enum Dimension : std::uint32_t { axis, lobe, lobe_u, lobe_v, roulette, lamp, shadow, cone, kPerVertex };

} // namespace

/// One path on its way: how it arrived at a surface.
struct SlhbTracer::State {
    RqmcStream random;
    std::uint32_t triangle, pixel;
    vec2 barycentric;
    vec3 position; ///< only read where has_position
    bool has_position = false;
    vec3 direction; ///< of arrival
    vec3 throughput{1};
    float arrival_pdf = 0; ///< of the direction, for the sky; 0 = camera or delta lobe
    float exact_pdf = 0;   ///< of the direction among exact rays, for lamps; 0 as above
    bool by_axis = false;  ///< came by a query: lamps do not count
    int scatterings = 0, vertex = 0;
    PathSample* sample;

    std::uint32_t dimension(Dimension d) const { return std::uint32_t(vertex) * kPerVertex + 2 + d; }
    vec3& bucket(int scattered) const { return sample->radiance[std::size_t(std::min(scattered, 2))]; }
};

/// Where a path wants to go from its surface.
struct SlhbTracer::Vertex {
    std::uint32_t path;
    bool exact;
    Ray ray;           ///< exact
    WalkOrigin origin; ///< else
    std::uint32_t axis;
    LayerHit hit; ///< answer of a query
    std::uint32_t layer;
    bool near_moving = false; ///< see QueryBatch
};

/// Direct light that waits for its shadow map.
struct SlhbTracer::Unshadowed {
    Lamp const* lamp;
    ShadowMap::Place place;
    vec3 position;
    std::uint32_t triangle;
    vec3 radiance;
    vec3* to;
    PathSample* sample;
};

namespace {

/// One function for all, so that it rounds in one way.
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

void SlhbTracer::add_sky(Pass const& pass, State& s, Vertex const& last) const
{
    if (s.vertex == 0) {
        s.sample->radiance[0] = background_radiance(world_, s.direction);
        return;
    }
    if (world_.environment_radiance.empty()) return;
    SkyAlong const sky = s.by_axis && !pass.sky.empty() ? pass.sky[2 * last.axis + (last.origin.up ? 1 : 0)]
                                                        : look_at_sky(world_, s.direction);
    vec3 light = sky.radiance;
    if (s.arrival_pdf > 0) light *= power_heuristic(s.arrival_pdf, sky.pdf);
    s.bucket(s.scatterings) += s.throughput * light;
}

void SlhbTracer::add_direct(Pass const& pass, State const& s, ShadingPoint const& at, vec3 wo, bool narrow,
                            std::vector<Unshadowed>& direct) const
{
    std::vector<Lamp> const& lamps = pass.lamps.lamps();
    std::size_t k = 0;
    if (pass.lamps.fixed()) {
        double u = double(s.random.sample(s.dimension(lamp)));
        k = pass.lamps.chances().sample(u);
    } else {
        // Lamps of successive numbers are spread well, and those that a strided choice would find are not.
        k = s.random.turn(s.dimension(lamp)) % lamps.size();
    }
    Lamp const& l = lamps[k];
    LightSample const light = l.light.pdf > 0 ? l.light : sample_light(world_, l.choice, at.position, l.u);
    if (!(light.pdf > 0)) return;
    vec3 const wi = at.frame.to_local(light.direction);
    float const side = glm::dot(light.direction, at.geometric_normal);
    if ((wi.z > 0) != (side > 0)) return;
    BsdfValue const bsdf = evaluate(at.bsdf, wo, wi);
    vec3 value = bsdf.f * light.radiance * (std::abs(wi.z) / light.pdf);
    if (!(max_component(value) > 0)) return;
    if (!light.delta && light.distance == kInf)
        value *= power_heuristic(light.pdf, narrow ? bsdf.pdf : std::abs(wi.z) * kInvPi);
    else if (!light.delta && narrow)
        value *= power_heuristic(light.pdf, narrow_pdf(at.bsdf, wo, wi, bsdf.pdf));
    ShadowMap::Place const place =
        l.shadow.look(at.position, at.geometric_normal, s.random.noise2(s.dimension(shadow)));
    __builtin_prefetch(place.texel);
    direct.push_back(
        {&l, place, at.position, s.triangle, s.throughput * value, &s.bucket(s.scatterings + 1), s.sample});
}

void SlhbTracer::add_emission(State const& s, Vertex const& last, ShadingPoint const& at) const
{
    vec3 light = at.emission;
    if (s.exact_pdf > 0) {
        float const cos_light = std::abs(glm::dot(s.direction, at.geometric_normal));
        float const distance = glm::length(at.position - last.ray.origin);
        light *= power_heuristic(s.exact_pdf, emitter_direction_pdf(world_, s.triangle, distance, cos_light));
    }
    s.bucket(s.scatterings) += s.throughput * light;
}

std::uint32_t SlhbTracer::indirect_share(std::uint32_t pixel, std::uint32_t pass) const
{
    std::uint32_t const all = interleave_ * interleave_, width = std::uint32_t(width_);
    std::uint32_t const own = pixel % width % interleave_ + pixel / width % interleave_ * interleave_;
    constexpr std::uint32_t kStride = 17; // a prime above every interleaving: all turns come
    return (own + pass * kStride) % all == 0 ? all : 0;
}

/// By a mirror, glass or a narrow lobe.
SlhbTracer::Scattered SlhbTracer::scatter_by_ray(State& s, ShadingPoint const& at, vec3 wo, float u_lobe,
                                                 bool last) const
{
    BsdfSample const sampled = gi::sample(at.bsdf, wo, at.front, u_lobe, s.random.sample2(s.dimension(lobe_u)));
    if (last && !sampled.delta) return Scattered::not_at_all;
    s.throughput *= sampled.weight;
    s.direction = at.frame.to_world(sampled.wi);
    if ((glm::dot(s.direction, at.geometric_normal) > 0) != (sampled.wi.z > 0)) return Scattered::not_at_all;
    s.arrival_pdf = sampled.delta ? 0 : sampled.pdf;
    s.exact_pdf = sampled.delta ? 0 : narrow_pdf(at.bsdf, wo, sampled.wi, sampled.pdf);
    return sampled.delta ? Scattered::by_delta_lobe : Scattered::widely;
}

AxisSample SlhbTracer::choose_axis(Pass const& pass, State const& s, ShadingPoint const& at) const
{
    if (s.vertex == 0 && pass.gather_axis != kNoPrimitive) {
        vec3 const along = pass.axes.axis(pass.gather_axis);
        float const cosine = glm::dot(along, at.frame.normal);
        return {pass.gather_axis, cosine < 0 ? -along : along,
                std::abs(cosine) * pass.axes.solid_angle(pass.gather_axis) * float(pass.axes.first_bounce_axes()) *
                    kInvPi};
    }
    if (parts_.directions)
        return {0, at.frame.to_world(square_to_cosine_hemisphere(s.random.sample2(s.dimension(lobe_u)))), 1};
    return pass.axes.sample(std::uint32_t(s.scatterings), at.frame.normal, s.random.sample(s.dimension(axis)));
}

/// False where the path ends.
bool SlhbTracer::scatter_along_axis(Pass const& pass, State& s, ShadingPoint const& at, vec3 wo, bool narrow,
                                    Vertex& next) const
{
    if (s.vertex == 0 && interleave_ > 1) {
        std::uint32_t const share = indirect_share(s.pixel, pass.index);
        if (share == 0) return false;
        s.throughput *= float(share);
        s.random.index = pass.index / share;
    }
    AxisSample const a = choose_axis(pass, s, at);
    s.direction = a.direction;
    vec3 const wi = at.frame.to_local(s.direction);
    float const side = glm::dot(s.direction, at.geometric_normal);
    if (!(wi.z > 0) || !(side > 0)) return false;
    BsdfValue const value = evaluate(at.bsdf, wo, wi);
    float const pdf = narrow ? value.pdf : wi.z * kInvPi;
    if (!(pdf > 0)) return false;
    s.throughput *= value.f * (wi.z * a.weight / pdf);
    s.arrival_pdf = pdf;
    next.axis = a.axis;
    Surface const& surface = world_.surfaces[s.triangle];
    vec3 const normal = glm::cross(surface.edge1, surface.edge2);
    vec3 const along_axis = pass.axes.axis(a.axis);
    next.origin = {at.position, s.triangle, glm::dot(normal, along_axis) > 0,
                   glm::dot(s.direction, along_axis) > 0, std::sqrt(std::max(0.0f, 1 - side * side)) / side};
    if (cone_ > 0) {
        RasterGrid const& grid = pass.axes.pool().grids[a.axis];
        vec2 const off = cone_ * grid.texel * square_to_disk(s.random.noise2(s.dimension(cone)));
        vec3 const shift = off.x * grid.right + off.y * grid.up;
        // Along the axis as the surface goes.
        next.origin.position += shift - (glm::dot(at.geometric_normal, shift) / side) * s.direction;
    }
    return true;
}

/// False where the path ends.
bool SlhbTracer::shade(Pass const& pass, State& s, Vertex& next, std::vector<Unshadowed>& direct,
                       PathCounts& paths) const
{
    if (s.triangle == kNoPrimitive) {
        add_sky(pass, s, next);
        return false;
    }
    if (s.triangle >= pass.first_watched) s.sample->near_moving = true;
    Surface const& surface = world_.surfaces[s.triangle];
    if (s.has_position && (surface.is(Surface::kSmooth) || surface.is(Surface::kVaries)))
        s.barycentric = barycentric_at(surface, s.position);
    ShadingPoint at = shading_point(world_, s.triangle, s.barycentric, s.direction);
    if (s.has_position) at.position = s.position;
    if (s.vertex == 0) {
        s.sample->hit = true;
        s.sample->albedo = albedo(at.bsdf);
        s.sample->normal = at.frame.normal;
        s.sample->position = at.position;
        s.sample->depth = glm::dot(at.position - camera_.origin, camera_.forward);
    }
    if (!s.by_axis && max_component(at.emission) > 0) add_emission(s, next, at);
    if (s.vertex == kLongestPath) {
        ++paths.cut_paths;
        return false;
    }

    vec3 const wo = at.frame.to_local(-s.direction);
    bool const last = s.scatterings > bounces_; // mirrors and glass do not count
    bool const narrow = pass.exact != nullptr && has_narrow_lobe(at.bsdf);
    if (!last && !pass.lamps.none() && !only_delta(at.bsdf)) add_direct(pass, s, at, wo, narrow, direct);

    float const u_lobe = narrow ? s.random.sample(s.dimension(lobe)) : 1;
    Scattered scattered = Scattered::widely;
    next.exact = narrow && takes_narrow_lobe(at.bsdf, wo, u_lobe);
    if (next.exact) {
        scattered = scatter_by_ray(s, at, wo, u_lobe, last);
        if (scattered == Scattered::not_at_all) return false;
    } else {
        if (last || !(wo.z > 0)) return false;
        // The last surface would only bring light that exact rays or the sky can bring.
        if (s.scatterings == bounces_ && pass.exact == nullptr && world_.environment_radiance.empty())
            return false;
        if (!scatter_along_axis(pass, s, at, wo, narrow, next)) return false;
    }
    float const survival = max_component(s.throughput);
    if (!(survival > 0)) return false;
    if (s.scatterings >= 3 && survival < 0.95f) {
        if (s.random.sample(s.dimension(roulette)) >= survival) return false;
        s.throughput /= survival;
    }
    if (next.exact) {
        float const offset = glm::dot(s.direction, at.geometric_normal) > 0 ? at.clearance : -at.clearance;
        next.ray = {at.position + offset * at.geometric_normal, s.direction};
    }
    s.by_axis = !next.exact;
    if (scattered == Scattered::widely) ++s.scatterings;
    ++s.vertex;
    return true;
}

/// Axis after axis, so that the buffers of one stay in the cache.
void SlhbTracer::ask_axes(Pass const& pass, std::span<Vertex> vertices) const
{
    thread_local std::vector<std::uint32_t> first, order;
    thread_local QueryBatch batch;
    AxisPool const& pool = pass.axes.pool();
    batch.watched = pass.first_watched != kNoPrimitive;
    first.assign(pool.size() + 1, 0);
    std::size_t n = 0;
    for (Vertex const& v : vertices)
        if (!v.exact) {
            ++first[v.axis + 1];
            ++n;
        }
    for (std::size_t a = 0; a < pool.size(); ++a) first[a + 1] += first[a];
    order.resize(n);
    for (std::uint32_t k = 0; k < vertices.size(); ++k)
        if (!vertices[k].exact) order[first[vertices[k].axis]++] = k;
    auto const answer = [&](std::size_t from, std::size_t to, auto const& ask) {
        batch.resize(to - from);
        for (std::size_t k = from; k < to; ++k)
            batch.set(k - from, vertices[order[k]].origin, vertices[order[k]].axis);
        ask();
        for (std::size_t k = from; k < to; ++k) {
            std::uint32_t const hit = batch.hit[k - from];
            LayerHit& to_fill = vertices[order[k]].hit;
            to_fill = {};
            if (batch.watched) vertices[order[k]].near_moving = batch.near_moving[k - from] != 0;
            if (hit == kNoLayerHit) continue;
            to_fill = {hit & kPrimitiveMask,
                       {batch.hit_x[k - from], batch.hit_y[k - from], batch.hit_z[k - from]},
                       (hit & kAlongAxis) != 0};
            vertices[order[k]].layer = batch.hit_layer[k - from];
            __builtin_prefetch(&world_.surfaces[to_fill.triangle]);
        }
    };
    constexpr std::size_t kWorthwhile = 64; // queries of one axis
    if (n >= kWorthwhile * pool.size()) {
        std::size_t from = 0;
        for (std::size_t a = 0; a < pool.size(); ++a) { // first[a] has become the end of a
            answer(from, first[a], [&] { nearest_layers(pool, a, world_.surfaces, batch); });
            from = first[a];
        }
    } else {
        answer(0, n, [&] { nearest_layers(pool, world_.surfaces, batch); });
    }
}

namespace {

vec3 off_surface(Surface const& s, vec3 position, vec3 direction)
{
    vec3 const normal = shading_detail::triangle_normal(s);
    return position + (glm::dot(direction, normal) > 0 ? s.clearance : -s.clearance) * normal;
}

} // namespace

void SlhbTracer::add_exactly(Pass const& pass, std::span<Unshadowed const> direct) const
{
    thread_local std::vector<RayQuery> rays;
    thread_local std::vector<std::uint8_t> blocked;
    rays.clear();
    for (Unshadowed const& d : direct) {
        LightSample const light = sample_light(world_, d.lamp->choice, d.position, d.lamp->u);
        Surface const& surface = world_.surfaces[d.triangle];
        RayQuery q{.ray = {off_surface(surface, d.position, light.direction), light.direction},
                   .reach = light.distance,
                   .seed = hash_words(hash_words(pass.index, d.triangle), std::uint32_t(rays.size()))};
        if (light.distance != kInf) {
            // As the reference aims: from where the ray starts to just before the lamp.
            vec3 const way = d.position + light.distance * light.direction - q.ray.origin;
            float const length = glm::length(way);
            q.ray.direction = way / length;
            q.reach = length * (1 - 2e-5f) - surface.clearance;
        }
        rays.push_back(q);
    }
    blocked.resize(rays.size());
    pass.judge->occluded(rays, blocked);
    for (std::size_t k = 0; k < direct.size(); ++k)
        if (blocked[k] == 0 || !(rays[k].reach > 0)) *direct[k].to += direct[k].radiance;
}

void SlhbTracer::trace(Pass const& pass, std::span<PathStart const> starts, std::span<PathSample> samples,
                       std::span<Ending> endings, PathCounts& paths, SlhbCounts& counts) const
{
    using Clock = std::chrono::steady_clock;
    auto const begun = Clock::now();
    auto turned = begun; // from direct to indirect light
    bool const from_camera = starts.empty() || !starts[0].on_layer;
    thread_local std::vector<State> states;
    thread_local std::vector<Vertex> vertices;
    thread_local std::vector<RayQuery> rays;
    thread_local std::vector<Hit> ray_hits;
    thread_local std::vector<Unshadowed> direct;
    states.resize(starts.size());
    vertices.resize(starts.size());
    std::uint32_t const key = std::uint32_t(seed_) ^ std::uint32_t(seed_ >> 32);
    for (std::size_t k = 0; k < starts.size(); ++k) {
        PathStart const& start = starts[k];
        State s;
        samples[k] = {};
        s.sample = &samples[k];
        s.random = start.on_layer ? RqmcStream(hash_words(key, start.stream), pass.index)
                                  : pixel_stream(key, start.stream, std::uint32_t(width_), pass.index);
        s.triangle = start.triangle;
        s.pixel = start.stream;
        s.direction = start.ray.direction;
        if (start.on_layer) {
            s.position = start.ray.origin;
            s.has_position = s.by_axis = true;
            s.scatterings = s.vertex = 1;
        } else if (start.triangle != kNoPrimitive) {
            // The raster says which triangle; the ray says where on its plane.
            s.barycentric = barycentric_of(world_.surfaces[start.triangle], start.ray);
        }
        states[k] = s;
        vertices[k].path = std::uint32_t(k);
    }
    for (Ending& e : endings) e.layer = kNoLayerHit;
    std::size_t active = starts.size();
    while (active > 0) {
        std::size_t going = 0;
        for (std::size_t k = 0; k < active; ++k) {
            Vertex v = vertices[k];
            if (shade(pass, states[v.path], v, direct, paths)) vertices[going++] = v;
        }
        counts.shadow_lookups += direct.size();
        if (parts_.shadows) {
            add_exactly(pass, direct);
        } else {
            for (Unshadowed const& d : direct) {
                if (d.lamp->shadow.lit(d.place, world_.surfaces, d.position, d.triangle)) *d.to += d.radiance;
                std::uint32_t const caster = d.place.texel != nullptr ? d.place.texel->primitive : kNoPrimitive;
                if (caster != kNoPrimitive && caster >= pass.first_watched) d.sample->near_moving = true;
            }
        }
        direct.clear();
        if (from_camera && turned == begun) turned = Clock::now();
        active = going;
        std::span<Vertex> const now(vertices.data(), active);
        if (parts_.queries)
            for (Vertex& v : now)
                if (!v.exact) {
                    v.exact = true;
                    vec3 const direction = states[v.path].direction;
                    v.ray = {off_surface(world_.surfaces[v.origin.triangle], v.origin.position, direction),
                             direction};
                }
        rays.clear();
        for (Vertex const& v : now)
            if (v.exact)
                rays.push_back(
                    {.ray = v.ray,
                     .seed = hash_words(states[v.path].random.own_seed() + std::uint32_t(states[v.path].vertex),
                                        pass.index)});
        if (rays.size() < active) ask_axes(pass, now);
        ray_hits.resize(rays.size());
        if (!rays.empty()) (parts_.queries ? pass.judge : pass.exact)->nearest(rays, ray_hits, pass.exact_world);
        counts.exact_rays += rays.size();
        counts.queries += active - rays.size();
        std::size_t ray = 0, left = 0;
        for (Vertex const& v : now) {
            State& s = states[v.path];
            s.has_position = !v.exact;
            if (v.near_moving && !v.exact) s.sample->near_moving = true;
            if (!endings.empty() && !v.exact && s.vertex == 1 && v.hit.triangle != kNoLayerHit &&
                bsdf_detail::is_matt(world_.bsdfs[world_.surfaces[v.hit.triangle].material])) {
                endings[v.path] = {v.layer, v.axis, v.hit.triangle, v.origin.up, v.hit.position, s.throughput};
                continue;
            }
            vertices[left++] = v;
            if (v.exact) {
                s.triangle = ray_hits[ray].triangle;
                s.barycentric = ray_hits[ray++].barycentric;
            } else {
                s.triangle = v.hit.triangle;
                s.position = v.hit.position;
                s.barycentric = vec2{1.0f / 3};
            }
        }
        active = left;
    }
    counts.direct_s += std::chrono::duration<double>(turned - begun).count();
    counts.indirect_s += std::chrono::duration<double>(Clock::now() - turned).count();
    for (PathSample& s : samples)
        for (vec3& part : s.radiance)
            if (!all_finite(part)) {
                part = vec3{0};
                ++paths.invalid_paths;
            }
}

} // namespace gi
