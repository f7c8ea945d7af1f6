#include "gi/methods/paths/tracer.h"

#include "gi/methods/paths/tracer_state.h"

#include <algorithm>
#include <chrono>

namespace gi {

namespace {

vec3 off_surface(Surface const& s, vec3 position, vec3 direction)
{
    vec3 const normal = shading_detail::triangle_normal(s);
    return position + (glm::dot(direction, normal) > 0 ? s.clearance : -s.clearance) * normal;
}

} // namespace

/// Processes look-ups axis by axis, so that the buffers of one axis stay in the cache. Doubtful ones become exact rays.
void PathsTracer::ask_axes(Pass const& pass, std::span<Vertex> vertices, PathsWork& counts) const
{
    thread_local std::vector<std::uint32_t> first, order;
    thread_local QueryBatch batch;
    AxisPool const& pool = pass.axes.pool();
    batch.watched = pass.first_watched != kNoPrimitive;
    batch.checked = pass.confirms;
    first.assign(pool.size() + 1, 0);
    std::size_t n = 0;
    for (Vertex& v : vertices) {
        v.near_moving = false;
        if (v.exact) continue;
        ++first[v.axis + 1];
        ++n;
    }
    counts.queries += n;
    if (n == 0) return;
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
            Vertex& v = vertices[order[k]];
            v.hit = {};
            if (batch.watched) v.near_moving = batch.near_moving[k - from] != 0;
            if (batch.checked && batch.doubtful[k - from] != 0) {
                vec3 const axis = pool.grids[v.axis].axis, direction = v.origin.up ? axis : -axis;
                v.exact = true;
                v.ray = {off_surface(world_.surfaces[v.origin.triangle], v.origin.position, direction), direction};
                ++counts.doubtful_queries;
                continue;
            }
            if (hit == kNoLayerHit) continue;
            v.hit = {hit & kPrimitiveMask,
                     {batch.hit_x[k - from], batch.hit_y[k - from], batch.hit_z[k - from]},
                     (hit & kAlongAxis) != 0};
            v.layer = batch.hit_layer[k - from];
            __builtin_prefetch(&world_.surfaces[v.hit.triangle]);
        }
    };
    constexpr std::size_t kWorthwhile = 64; // look-ups per axis
    if (n >= kWorthwhile * pool.size()) {
        std::size_t from = 0;
        for (std::size_t a = 0; a < pool.size(); ++a) { // by now, first[a] is the end of axis a
            answer(from, first[a], [&] { nearest_layers(pool, a, world_.surfaces, batch); });
            from = first[a];
        }
    } else {
        answer(0, n, [&] { nearest_layers(pool, world_.surfaces, batch); });
    }
}

void PathsTracer::add_exactly(Pass const& pass, std::span<Unshadowed const> direct) const
{
    thread_local std::vector<RayQuery> rays;
    thread_local std::vector<vec3> left;
    rays.clear();
    for (Unshadowed const& d : direct) {
        LightSample const light = sample_light(world_, d.light_point->choice, d.position, d.light_point->u);
        Surface const& surface = world_.surfaces[d.triangle];
        RayQuery ray = shadow_ray(d.position, shading_detail::triangle_normal(surface), surface.clearance, light);
        ray.seed = d.seed;
        rays.push_back(ray);
    }
    left.resize(rays.size());
    pass.exact->transmittance(rays, left, pass.exact_world);
    for (std::size_t k = 0; k < direct.size(); ++k) {
        if (!(rays[k].reach > 0)) left[k] = vec3{1}; // the light lies on the surface
        if (left[k] != vec3{0}) *direct[k].to += left[k] * direct[k].radiance;
        if (left[k] != vec3{1} && pass.first_watched != kNoPrimitive) direct[k].sample->near_moving = true;
    }
}

void PathsTracer::start_paths(Pass const& pass, std::span<PathStart const> starts, std::span<PathSample> samples,
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
            s.seen = false;
            s.scatterings = s.vertex = 1;
        } else if (start.triangle != kNoPrimitive) {
            s.barycentric = barycentric_of(world_.surfaces[start.triangle], start.ray);
        }
        states[k] = s;
        vertices[k].path = std::uint32_t(k);
    }
}

/// Generates random numbers and prefetches shading data of all vertices, in separate loops that vectorise and
/// overlap cache misses.
void PathsTracer::prepare_vertices(std::span<Vertex const> vertices, std::vector<State>& states) const
{
    for (Vertex const& v : vertices) {
        State& s = states[v.path];
        if (s.triangle == kNoPrimitive) continue;
        *s.u = VertexNumbers(s.random, std::uint32_t(s.vertex));
        prefetch_vertices(world_, world_.surfaces[s.triangle]);
    }
}

void PathsTracer::add_by_maps(Pass const& pass, std::vector<Unshadowed>& direct, PathsWork& counts) const
{
    bool const watches = pass.first_watched != kNoPrimitive;
    if (pass.confirms) {
        auto const doubtful = std::partition(direct.begin(), direct.end(), [&](Unshadowed const& d) {
            vec3 const normal = shading_detail::triangle_normal(world_.surfaces[d.triangle]);
            LitBy const by =
                d.light_point->shadow.lit_by(d.place, world_.surfaces, d.position, normal, d.triangle);
            if (by == LitBy::all) *d.to += d.radiance;
            if (watches && d.light_point->shadow.shows(d.position, normal, pass.first_watched))
                d.sample->near_moving = true;
            return by != LitBy::some;
        });
        counts.doubtful_shadows += std::size_t(direct.end() - doubtful);
        return add_exactly(pass, std::span(doubtful, direct.end()));
    }
    for (Unshadowed const& d : direct) {
        if (d.light_point->shadow.lit(d.place, world_.surfaces, d.position, d.triangle)) *d.to += d.radiance;
        std::uint32_t const caster = d.place.texel != nullptr ? d.place.texel->primitive : kNoPrimitive;
        if (caster != kNoPrimitive && caster >= pass.first_watched) d.sample->near_moving = true;
    }
}

void PathsTracer::add_lit(Pass const& pass, Direct& direct, PathsWork& counts) const
{
    counts.shadow_lookups += direct.maps.size();
    counts.shadow_rays += direct.rays.size();
    if (!direct.rays.empty()) {
        direct.queries.clear();
        for (ShadowRay const& r : direct.rays) direct.queries.push_back(r.query);
        direct.left.resize(direct.rays.size());
        pass.exact->transmittance(direct.queries, direct.left, pass.exact_world);
        for (std::size_t k = 0; k < direct.rays.size(); ++k)
            if (direct.left[k] != vec3{0}) *direct.rays[k].to += direct.left[k] * direct.rays[k].radiance;
    }
    if (pass.exact_shadows) {
        add_exactly(pass, direct.maps);
    } else {
        if (panes_) { // which block all light in maps
            std::span<Unshadowed> const lamps(std::partition(direct.maps.begin(), direct.maps.end(),
                                                             [](Unshadowed const& d) { return !d.of_lamp; }),
                                              direct.maps.end());
            if (!lamps.empty()) add_exactly(pass, lamps);
            counts.shadow_lookups -= lamps.size();
            counts.shadow_rays += lamps.size();
            direct.maps.erase(direct.maps.end() - std::ptrdiff_t(lamps.size()), direct.maps.end());
        }
        add_by_maps(pass, direct.maps, counts);
    }
    direct.maps.clear();
    direct.rays.clear();
}

/// True for the back of something shiny, such as a glass body: a path that has missed its front would stay in it.
bool PathsTracer::meets_inside(LayerHit const& hit, vec3 direction) const
{
    if (hit.triangle == kNoLayerHit) return false;
    Surface const& s = world_.surfaces[hit.triangle];
    return !bsdf_detail::is_matt(world_.bsdfs[s.material]) &&
           glm::dot(shading_detail::triangle_normal(s), direction) > 0;
}

/// Finds the next surfaces of all vertices, by look-ups and exact rays.
void PathsTracer::find_hits(Pass const& pass, std::span<Vertex> vertices, std::vector<State>& states,
                           PathsWork& counts) const
{
    thread_local std::vector<RayQuery> rays;
    thread_local std::vector<Hit> hits;
    if (!pass.look_ups) {
        for (Vertex& v : vertices) {
            v.near_moving = false;
            if (v.exact) continue;
            vec3 const direction = states[v.path].direction;
            if (pass.screen != nullptr) {
                v.hit = pass.screen->nearest(world_.surfaces, v.origin.position, v.origin.triangle, direction,
                                             pass.first_watched, v.near_moving);
                ++counts.queries;
                if (!meets_inside(v.hit, direction)) continue;
            }
            v.exact = true;
            v.ray = {off_surface(world_.surfaces[v.origin.triangle], v.origin.position, direction), direction};
        }
    }
    if (pass.look_ups || pass.screen == nullptr) ask_axes(pass, vertices, counts);
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
    for (Vertex& v : vertices) {
        State& s = states[v.path];
        s.has_position = !v.exact;
        if (v.exact) {
            s.triangle = hits[ray].triangle;
            if (s.triangle != kNoPrimitive) __builtin_prefetch(&world_.surfaces[s.triangle]);
            v.distance = hits[ray].distance;
            s.barycentric = hits[ray++].barycentric;
        } else {
            s.triangle = v.hit.triangle;
            s.position = v.hit.position;
            s.barycentric = vec2{1.0f / 3};
            v.distance = glm::length(s.position - v.origin.position);
        }
        if (v.near_moving) s.sample->near_moving = true;
    }
}

/// True if the path ends at a shared vertex here.
bool PathsTracer::ends_shared(State& s, Vertex const& v, SharedVertex& shared) const
{
    if (s.vertex != 1 || s.triangle == kNoPrimitive || !s.along_axis || v.exact || s.medium != kNoMedium ||
        !bsdf_detail::is_matt(world_.bsdfs[world_.surfaces[s.triangle].material]))
        return false;
    Surface const& surface = world_.surfaces[s.triangle];
    if (!s.has_position) s.position = shading_detail::SurfacePoint{surface, s.barycentric}.position();
    if (!world_.emitter_pdf.empty() && world_.emitter_pdf[s.triangle] > 0) { // its weight differs between paths
        ShadingPoint at = shading_point(world_, s.triangle, barycentric_at(surface, s.position), s.direction);
        at.position = s.position;
        add_emission(s, v, at);
    }
    shared = {s.triangle, v.layer, v.origin.up, s.position, s.direction, s.throughput};
    return true;
}

void PathsTracer::trace(Pass const& pass, std::span<PathStart const> starts, std::span<PathSample> samples,
                       std::span<SharedVertex> shared_vertices, std::vector<CacheNote>& notes, PathCounts& paths,
                       PathsWork& counts) const
{
    using Clock = std::chrono::steady_clock;
    auto const begun = Clock::now();
    auto turned = begun; // time at which direct light ended and indirect light began
    bool const from_camera = starts.empty() || !starts[0].on_layer;
    thread_local std::vector<State> states;
    thread_local std::vector<Vertex> vertices;
    thread_local Direct direct;
    thread_local std::vector<VertexNumbers> numbers;
    thread_local std::vector<Open> open;
    open.clear();
    numbers.resize(starts.size());
    start_paths(pass, starts, samples, states, vertices);
    for (std::size_t k = 0; k < states.size(); ++k) states[k].u = &numbers[k];
    for (SharedVertex& e : shared_vertices) e.triangle = kNoLayerHit;
    std::size_t active = starts.size();
    while (active > 0 && !pass.stop.given_up()) {
        std::size_t going = 0;
        prepare_vertices(std::span(vertices).first(active), states);
        for (std::size_t k = 0; k < active; ++k) {
            Vertex& v = vertices[k];
            if (!shade(pass, states[v.path], v, direct, open, paths)) continue;
            if (going != k) vertices[going] = v;
            ++going;
        }
        add_lit(pass, direct, counts);
        if (from_camera && turned == begun) turned = Clock::now();
        find_hits(pass, std::span(vertices).first(going), states, counts);
        active = going;
        if (pass.cache != nullptr) end_in_cells(pass, states, vertices, active, open, counts);
        if (shared_vertices.empty()) continue;
        active = 0;
        for (std::size_t k = 0; k < going; ++k) {
            Vertex const& v = vertices[k];
            if (!ends_shared(states[v.path], v, shared_vertices[v.path])) vertices[active++] = v;
        }
    }
    for (Open const& o : open)
        notes.push_back(
            {o.keys, (layer_of(samples[o.path], 2) - o.before) / o.throughput, o.weight, o.directional});
    counts.direct_s += std::chrono::duration<double>(turned - begun).count();
    counts.indirect_s += std::chrono::duration<double>(Clock::now() - turned).count();
    for (PathSample& s : samples) paths.invalid_paths += discard_invalid(s);
}

} // namespace gi
