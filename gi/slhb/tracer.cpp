#include "gi/slhb/tracer.h"

#include "gi/scene/shading_point.h"
#include "gi/scene/warp.h"
#include "gi/slhb/narrow_lobes.h"
#include "gi/slhb/path_random.h"
#include "gi/transport/sampling.h"

#include <algorithm>
#include <chrono>
#include <utility>

namespace gi {

/// One path on its way: how it arrived at a surface.
struct SlhbTracer::State {
    RqmcStream random;
    std::uint32_t triangle, pixel;
    vec2 barycentric;
    vec3 position; ///< only read where has_position
    bool has_position = false;
    vec3 direction; ///< of arrival
    vec3 throughput{1};
    float arrival_pdf = 0;   ///< of the direction, 1/sr; 0 = camera or delta lobe
    bool along_axis = false; ///< came by a broad lobe: along an axis, where there are look-ups
    bool emitted = false;    ///< what its surface emits has been added
    int scatterings = 0, vertex = 0;
    PathSample* sample;

    VertexNumbers* u = nullptr; ///< of its vertex

    std::uint32_t dimension(PathDimension d) const { return dimension_of(std::uint32_t(vertex), d); }
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
    bool near_moving; ///< see QueryBatch
};

/// Direct light that waits for its shadow ray.
struct SlhbTracer::ShadowRay {
    RayQuery query;
    vec3 radiance;
    vec3* to;
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

/// Direct light of a block of paths that waits for what is in its way.
struct SlhbTracer::Direct {
    std::vector<Unshadowed> maps;
    std::vector<ShadowRay> rays;
    std::vector<RayQuery> queries; ///< of the rays
    std::vector<std::uint8_t> blocked;
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
    SkyAlong const sky = s.along_axis && !pass.sky.empty() ? pass.sky[2 * last.axis + (last.origin.up ? 1 : 0)]
                                                           : look_at_sky(world_, s.direction);
    vec3 light = sky.radiance;
    if (s.arrival_pdf > 0) light *= power_heuristic(s.arrival_pdf, sky.pdf);
    s.bucket(s.scatterings) += s.throughput * light;
}

namespace {

/// From a surface to just before a lamp; its reach is not positive where that lies on the surface.
RayQuery shadow_ray(vec3 position, vec3 normal, float clearance, LightSample const& light, std::uint32_t seed)
{
    float const side = glm::dot(light.direction, normal) > 0 ? clearance : -clearance;
    RayQuery q{.ray = {position + side * normal, light.direction}, .reach = light.distance, .seed = seed};
    if (light.distance == kInf) return q;
    // As the reference aims: from where the ray starts to short of the lamp by more than the rounding of both
    // ends.
    vec3 const way = position + light.distance * light.direction - q.ray.origin;
    float const length = glm::length(way);
    q.ray.direction = way / length;
    q.reach = length * (1 - 2e-5f) - clearance;
    return q;
}

} // namespace

/// A surface that a path leaves.
struct SlhbTracer::Leaving {
    ShadingPoint const& at;
    vec3 wo;     ///< local
    bool narrow; ///< some lobe is for exact rays
    bool alone;  ///< light samples have to find all light: no path goes on to meet it

    /// Density with which paths leave along wi, 1/sr. @param bsdf  of wi, see evaluate
    float pdf(BsdfValue const& bsdf, vec3 wi) const { return narrow ? bsdf.pdf : std::max(wi.z, 0.0f) * kInvPi; }
};

vec3 SlhbTracer::unshadowed(Leaving const& from, LightSample const& light) const
{
    if (!(light.pdf > 0)) return vec3{0};
    ShadingPoint const& at = from.at;
    if (bsdf_detail::is_matt(at.bsdf)) { // the same in fewer steps
        float const cosine = glm::dot(light.direction, at.frame.normal);
        if (!(cosine > 0) || !(from.wo.z > 0) || !(glm::dot(light.direction, at.geometric_normal) > 0))
            return vec3{0};
        vec3 const value = at.bsdf.diffuse * kInvPi * light.radiance * (cosine / light.pdf);
        return light.delta || from.alone ? value : value * power_heuristic(light.pdf, cosine * kInvPi);
    }
    vec3 const wi = at.frame.to_local(light.direction);
    if ((wi.z > 0) != (glm::dot(light.direction, at.geometric_normal) > 0)) return vec3{0};
    BsdfValue const bsdf = evaluate(at.bsdf, from.wo, wi);
    vec3 value = bsdf.f * light.radiance * (std::abs(wi.z) / light.pdf);
    if (!(max_component(value) > 0)) return vec3{0};
    if (!light.delta && !from.alone) value *= power_heuristic(light.pdf, from.pdf(bsdf, wi));
    return value;
}

void SlhbTracer::aim_at_light(Pass const& pass, State const& s, Leaving const& from,
                              std::vector<ShadowRay>& rays) const
{
    VertexNumbers const& u = *s.u;
    vec3 const normal = from.at.frame.normal;
    ChosenLight const chosen =
        pass.lights->choose(from.at.position, normal, u[PathDimension::lamp], u[PathDimension::lamp_pick]);
    if (chosen.light == nullptr) return;
    LightSample const light = chosen.light->seen_from(world_, from.at.position);
    vec3 const value = chosen.weight * unshadowed(from, light);
    if (!(max_component(value) > 0)) return;
    vec3* const to = &s.bucket(s.scatterings + 1);
    RayQuery const query = shadow_ray(from.at.position, from.at.geometric_normal, from.at.clearance, light,
                                      hash_words(s.random.own_seed() + std::uint32_t(s.vertex), ~s.random.index));
    if (query.reach > 0)
        rays.push_back({query, s.throughput * value, to});
    else // the lamp lies on the surface
        *to += s.throughput * value;
}

void SlhbTracer::add_direct(Pass const& pass, State const& s, Leaving const& from,
                            std::vector<Unshadowed>& direct) const
{
    ShadingPoint const& at = from.at;
    std::vector<Lamp> const& lamps = pass.lamps.lamps();
    std::size_t k = 0;
    if (pass.lamps.fixed()) {
        double u = double((*s.u)[PathDimension::lamp]);
        k = pass.lamps.chances().sample(u);
    } else {
        // Lamps of successive numbers are spread well, and those that a strided choice would find are not.
        k = s.random.turn(s.dimension(PathDimension::lamp)) % lamps.size();
    }
    Lamp const& l = lamps[k];
    LightSample const light = l.light.pdf > 0 ? l.light : sample_light(world_, l.choice, at.position, l.u);
    vec3 const value = unshadowed(from, light);
    if (!(max_component(value) > 0)) return;
    ShadowMap::Place const place =
        l.shadow.look(at.position, at.geometric_normal, s.random.noise2(s.dimension(PathDimension::shadow)));
    __builtin_prefetch(place.texel);
    direct.push_back(
        {&l, place, at.position, s.triangle, s.throughput * value, &s.bucket(s.scatterings + 1), s.sample});
}

void SlhbTracer::add_emission(State const& s, Vertex const& last, ShadingPoint const& at) const
{
    vec3 light = at.emission;
    if (s.arrival_pdf > 0) {
        float const cos_light = std::abs(glm::dot(s.direction, at.geometric_normal));
        float const distance = glm::length(at.position - (last.exact ? last.ray.origin : last.origin.position));
        light *= power_heuristic(s.arrival_pdf, emitter_direction_pdf(world_, s.triangle, distance, cos_light));
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
SlhbTracer::Scattered SlhbTracer::scatter_by_ray(State& s, Leaving const& from, float u_lobe, bool last) const
{
    ShadingPoint const& at = from.at;
    BsdfSample const sampled = gi::sample(at.bsdf, from.wo, at.front, u_lobe, s.u->pair(PathDimension::lobe_u));
    if (last && !sampled.delta) return Scattered::not_at_all;
    s.direction = at.frame.to_world(sampled.wi);
    if ((glm::dot(s.direction, at.geometric_normal) > 0) != (sampled.wi.z > 0)) return Scattered::not_at_all;
    s.throughput *= sampled.weight;
    s.arrival_pdf = sampled.delta ? 0 : sampled.pdf;
    return sampled.delta ? Scattered::by_delta_lobe : Scattered::widely;
}

/// In a direction of its own, by the cosine. False where the path ends.
bool SlhbTracer::scatter_freely(State& s, Leaving const& from, Vertex& next) const
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

/// Whether its pixel takes indirect light in this pass.
bool SlhbTracer::starts_indirect(Pass const& pass, State& s) const
{
    if (s.vertex > 0 || interleave_ == 1) return true;
    std::uint32_t const share = indirect_share(s.pixel, pass.index);
    if (share == 0) return false;
    s.throughput *= float(share);
    s.random.index = pass.index / share;
    *s.u = VertexNumbers(s.random, std::uint32_t(s.vertex));
    return true;
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
    return pass.axes.sample(std::uint32_t(s.scatterings), at.frame.normal, (*s.u)[PathDimension::axis]);
}

/// False where the path ends.
bool SlhbTracer::scatter_along_axis(Pass const& pass, State& s, Leaving const& from, Vertex& next) const
{
    ShadingPoint const& at = from.at;
    AxisSample const a = choose_axis(pass, s, at);
    s.direction = a.direction;
    vec3 const wi = at.frame.to_local(s.direction);
    float const side = glm::dot(s.direction, at.geometric_normal);
    if (!(wi.z > 0) || !(side > 0)) return false;
    BsdfValue const value = evaluate(at.bsdf, from.wo, wi);
    float const pdf = from.pdf(value, wi);
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
        vec2 const off = cone_ * grid.texel * square_to_disk(s.random.noise2(s.dimension(PathDimension::cone)));
        vec3 const shift = off.x * grid.right + off.y * grid.up;
        // Along the axis as the surface goes.
        next.origin.position += shift - (glm::dot(at.geometric_normal, shift) / side) * s.direction;
    }
    return true;
}

/// False where the path ends.
bool SlhbTracer::shade(Pass const& pass, State& s, Vertex& next, Direct& direct, PathCounts& paths) const
{
    if (s.triangle == kNoPrimitive) {
        add_sky(pass, s, next);
        return false;
    }
    if (s.triangle >= pass.first_watched) s.sample->near_moving = true;
    Surface const& surface = world_.surfaces[s.triangle];
    bool const last = s.scatterings > bounces_; // mirrors and glass do not count
    if (last && bsdf_detail::is_matt(world_.bsdfs[surface.material]) &&
        (world_.emitter_pdf.empty() || !(world_.emitter_pdf[s.triangle] > 0)))
        return false;
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
    if (!std::exchange(s.emitted, false) && max_component(at.emission) > 0) add_emission(s, next, at);
    if (s.vertex == kLongestPath) {
        ++paths.cut_paths;
        return false;
    }

    vec3 const wo = at.frame.to_local(-s.direction);
    // A set of axes carries broad lobes; rays carry any.
    bool const narrow = free_ ? !bsdf_detail::is_matt(at.bsdf) : pass.exact != nullptr && has_narrow_lobe(at.bsdf);
    // Light samples find all light that the last surface gets, but for narrow lobes, and by mirrors and glass.
    Leaving const from{at, wo, narrow, s.scatterings == bounces_ && !narrow && !pass.smooth};
    if (!last && !world_.light_select.empty() && !only_delta(at.bsdf)) {
        if (pass.lights != nullptr)
            aim_at_light(pass, s, from, direct.rays);
        else
            add_direct(pass, s, from, direct.maps);
    }

    float const u_lobe = narrow ? (*s.u)[PathDimension::lobe] : 1;
    Scattered scattered = Scattered::widely;
    next.exact = narrow && takes_narrow_lobe(at.bsdf, wo, u_lobe);
    if (next.exact) {
        scattered = scatter_by_ray(s, from, u_lobe, last);
        if (scattered == Scattered::not_at_all) return false;
    } else {
        if (last || !(wo.z > 0)) return false;
        // The last surface would only bring light that a path can meet.
        if (s.scatterings == bounces_ && (!meets_light_ || from.alone)) return false;
        if (!starts_indirect(pass, s)) return false;
        if (!(free_ ? scatter_freely(s, from, next) : scatter_along_axis(pass, s, from, next))) return false;
    }
    float const survival = max_component(s.throughput);
    if (!(survival > 0)) return false;
    float const keep = chance_to_go_on(survival, s.scatterings, roulette_);
    if (keep < 1) {
        if ((*s.u)[PathDimension::roulette] >= keep) return false;
        s.throughput /= keep;
    }
    if (next.exact) {
        float const offset = glm::dot(s.direction, at.geometric_normal) > 0 ? at.clearance : -at.clearance;
        next.ray = {at.position + offset * at.geometric_normal, s.direction};
    }
    s.along_axis = !next.exact;
    if (scattered == Scattered::widely) ++s.scatterings;
    ++s.vertex;
    return true;
}

/// Axis after axis, so that the buffers of one stay in the cache.
std::size_t SlhbTracer::ask_axes(Pass const& pass, std::span<Vertex> vertices) const
{
    thread_local std::vector<std::uint32_t> first, order;
    thread_local QueryBatch batch;
    AxisPool const& pool = pass.axes.pool();
    batch.watched = pass.first_watched != kNoPrimitive;
    first.assign(pool.size() + 1, 0);
    std::size_t n = 0;
    for (Vertex& v : vertices) {
        v.near_moving = false;
        if (v.exact) continue;
        ++first[v.axis + 1];
        ++n;
    }
    if (n == 0) return 0;
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
    return n;
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
        rays.push_back(shadow_ray(d.position, shading_detail::triangle_normal(surface), surface.clearance, light,
                                  hash_words(hash_words(pass.index, d.triangle), std::uint32_t(rays.size()))));
    }
    blocked.resize(rays.size());
    pass.exact->occluded(rays, blocked);
    for (std::size_t k = 0; k < direct.size(); ++k)
        if (blocked[k] == 0 || !(rays[k].reach > 0)) *direct[k].to += direct[k].radiance;
}

void SlhbTracer::start_paths(Pass const& pass, std::span<PathStart const> starts, std::span<PathSample> samples,
                             std::vector<State>& states, std::vector<Vertex>& vertices) const
{
    states.resize(starts.size());
    vertices.resize(starts.size());
    std::uint32_t const key = random_key(seed_);
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
            s.has_position = s.along_axis = s.emitted = true;
            s.scatterings = s.vertex = 1;
        } else if (start.triangle != kNoPrimitive) {
            // The raster says which triangle; the ray says where on its plane.
            s.barycentric = barycentric_of(world_.surfaces[start.triangle], start.ray);
        }
        states[k] = s;
        vertices[k].path = std::uint32_t(k);
    }
}

/// Random numbers of all, and what shading will read: in loops of their own, so that they are vectors and
/// cache misses overlap.
void SlhbTracer::prepare_vertices(std::span<Vertex const> vertices, std::vector<State>& states) const
{
    for (Vertex const& v : vertices) {
        State& s = states[v.path];
        if (s.triangle == kNoPrimitive) continue;
        *s.u = VertexNumbers(s.random, std::uint32_t(s.vertex));
        Surface const& surface = world_.surfaces[s.triangle];
        for (int k = 0; k < 3; ++k) {
            if (surface.is(Surface::kSmooth)) __builtin_prefetch(&world_.normals[surface.vertex[k]]);
            if (surface.is(Surface::kVaries) && !world_.uv0.empty())
                __builtin_prefetch(&world_.uv0[surface.vertex[k]]);
        }
    }
}

void SlhbTracer::add_lit(Pass const& pass, Direct& direct, SlhbCounts& counts) const
{
    counts.shadow_lookups += direct.maps.size();
    counts.shadow_rays += direct.rays.size();
    if (!direct.rays.empty()) {
        direct.queries.clear();
        for (ShadowRay const& r : direct.rays) direct.queries.push_back(r.query);
        direct.blocked.resize(direct.rays.size());
        pass.exact->occluded(direct.queries, direct.blocked, pass.exact_world);
        for (std::size_t k = 0; k < direct.rays.size(); ++k)
            if (direct.blocked[k] == 0) *direct.rays[k].to += direct.rays[k].radiance;
    }
    if (parts_.shadows) {
        add_exactly(pass, direct.maps);
    } else {
        for (Unshadowed const& d : direct.maps) {
            if (d.lamp->shadow.lit(d.place, world_.surfaces, d.position, d.triangle)) *d.to += d.radiance;
            std::uint32_t const caster = d.place.texel != nullptr ? d.place.texel->primitive : kNoPrimitive;
            if (caster != kNoPrimitive && caster >= pass.first_watched) d.sample->near_moving = true;
        }
    }
    direct.maps.clear();
    direct.rays.clear();
}

/// Finds where all of them go, by look-ups and exact rays.
void SlhbTracer::find_hits(Pass const& pass, std::span<Vertex> vertices, std::vector<State>& states,
                           SlhbCounts& counts) const
{
    thread_local std::vector<RayQuery> rays;
    thread_local std::vector<Hit> hits;
    if (!pass.look_ups)
        for (Vertex& v : vertices)
            if (!v.exact) {
                v.exact = true;
                vec3 const direction = states[v.path].direction;
                v.ray = {off_surface(world_.surfaces[v.origin.triangle], v.origin.position, direction), direction};
            }
    counts.queries += ask_axes(pass, vertices);
    rays.clear();
    for (Vertex const& v : vertices)
        if (v.exact)
            rays.push_back(
                {.ray = v.ray,
                 .seed = hash_words(states[v.path].random.own_seed() + std::uint32_t(states[v.path].vertex),
                                    pass.index)});
    hits.resize(rays.size());
    if (!rays.empty()) pass.exact->nearest(rays, hits, pass.exact_world);
    counts.exact_rays += rays.size();
    std::size_t ray = 0;
    for (Vertex const& v : vertices) {
        State& s = states[v.path];
        s.has_position = !v.exact;
        if (v.exact) {
            s.triangle = hits[ray].triangle;
            if (s.triangle != kNoPrimitive) __builtin_prefetch(&world_.surfaces[s.triangle]);
            s.barycentric = hits[ray++].barycentric;
        } else {
            s.triangle = v.hit.triangle;
            s.position = v.hit.position;
            s.barycentric = vec2{1.0f / 3};
            if (v.near_moving) s.sample->near_moving = true;
        }
    }
}

/// Whether it ends here, to share what is sent on from there.
bool SlhbTracer::ends_shared(State& s, Vertex const& v, Ending& ending) const
{
    if (s.vertex != 1 || s.triangle == kNoPrimitive || !s.along_axis ||
        !bsdf_detail::is_matt(world_.bsdfs[world_.surfaces[s.triangle].material]))
        return false;
    Surface const& surface = world_.surfaces[s.triangle];
    if (!s.has_position) s.position = shading_detail::SurfacePoint{surface, s.barycentric}.position();
    if (!world_.emitter_pdf.empty() && world_.emitter_pdf[s.triangle] > 0) { // which differs from path to path
        ShadingPoint at = shading_point(world_, s.triangle, barycentric_at(surface, s.position), s.direction);
        at.position = s.position;
        add_emission(s, v, at);
    }
    ending = {s.triangle, v.exact ? kNoLayerHit : v.layer, v.origin.up, s.position, s.direction, s.throughput};
    return true;
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
    thread_local Direct direct;
    thread_local std::vector<VertexNumbers> numbers;
    numbers.resize(starts.size());
    start_paths(pass, starts, samples, states, vertices);
    for (std::size_t k = 0; k < states.size(); ++k) states[k].u = &numbers[k];
    for (Ending& e : endings) e.triangle = kNoLayerHit;
    std::size_t active = starts.size();
    while (active > 0) {
        std::size_t going = 0;
        prepare_vertices(std::span(vertices).first(active), states);
        for (std::size_t k = 0; k < active; ++k) {
            Vertex& v = vertices[k];
            if (!shade(pass, states[v.path], v, direct, paths)) continue;
            if (going != k) vertices[going] = v;
            ++going;
        }
        add_lit(pass, direct, counts);
        if (from_camera && turned == begun) turned = Clock::now();
        find_hits(pass, std::span(vertices).first(going), states, counts);
        active = going;
        if (endings.empty()) continue;
        active = 0;
        for (std::size_t k = 0; k < going; ++k) {
            Vertex const& v = vertices[k];
            if (!ends_shared(states[v.path], v, endings[v.path])) vertices[active++] = v;
        }
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
