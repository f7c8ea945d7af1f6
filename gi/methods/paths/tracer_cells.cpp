// Paths reading from and teaching the radiance cache.

#include "gi/methods/paths/tracer_state.h"

#include <algorithm>

namespace gi {

/// Returns the keys of the surface at which a path has arrived; empty if the path must continue.
CacheKeys PathsTracer::cache_keys(Pass const& pass, State const& s) const
{
    // After the last scattering, surfaces only contribute emission.
    if (s.triangle == kNoPrimitive || s.scatterings == 0 || s.scatterings > bounces_ || s.medium != kNoMedium)
        return {};
    Surface const& surface = world_.surfaces[s.triangle];
    if (is_directional(world_.bsdfs[surface.material]) ||
        (!world_.emitter_pdf.empty() && world_.emitter_pdf[s.triangle] > 0))
        return {};
    vec3 const& t = s.throughput;
    if (!(std::min({t.x, t.y, t.z}) > 1e-3f * max_component(t)))
        return {}; // no estimate from channels without throughput
    vec3 const position =
        s.has_position ? s.position : shading_detail::SurfacePoint{surface, s.barycentric}.position();
    return pass.cache->keys(surface, position, s.direction, s.footprint, bounces_ - s.scatterings);
}

void PathsTracer::end_in_cells(Pass const& pass, std::span<State> states, std::vector<Vertex>& vertices,
                              std::size_t& active, std::vector<Open>& open, PathsWork& counts) const
{
    thread_local std::vector<CacheKeys> keys;
    keys.resize(active);
    for (std::size_t k = 0; k < active; ++k) {
        State& s = states[vertices[k].path];
        s.open = -1;
        // A cosine lobe (pdf up to 1 / pi) is about as wide as its distance.
        if (s.arrival_pdf > 0)
            s.footprint += vertices[k].distance * std::min(1.0f, 1 / std::sqrt(kPi * s.arrival_pdf));
        keys[k] = cache_keys(pass, s);
        if (keys[k].any()) pass.cache->prefetch(keys[k]);
    }
    std::size_t left = 0;
    for (std::size_t k = 0; k < active; ++k) {
        if (keys[k].any()) {
            std::uint32_t const path = vertices[k].path;
            State& s = states[path];
            CachedRadiance const known = pass.cache->find(keys[k]);
            if (!(s.random.noise2(s.dimension(PathDimension::cache)).x < known.go_on)) {
                layer_of(*s.sample, 2) += s.throughput * known.radiance;
                ++counts.cache_reads;
                continue;
            }
            std::fill(keys[k].level.begin() + std::ptrdiff_t(known.to_teach), keys[k].level.end(), 0);
            s.open = int(open.size());
            open.push_back(
                {path, keys[k], s.throughput, layer_of(*s.sample, 2), luminance(s.throughput) / known.go_on});
        }
        if (left != k) vertices[left] = vertices[k];
        ++left;
    }
    active = left;
}

} // namespace gi
