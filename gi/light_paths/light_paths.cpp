#include "gi/light_paths/light_paths.h"

#include "gi/core/rng.h"
#include "gi/light_paths/emission.h"
#include "gi/render/flush_denormals.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>
#include <tbb/parallel_for.h>
#include <utility>

namespace gi {
namespace {

/// Number of paths that advance together, so that rays are traced in packets.
constexpr std::uint32_t kPathsTogether = 64;

struct LightPath {
    Pcg32 rng{0, 0};
    EmittedLight light;
    int scatterings = 0;      ///< non-delta, so far
    std::uint32_t number = 0; ///< see LightVertex::path
    bool from_light = true, from_surface = false;
    bool from_outside = false, straight = true; ///< see LightPaths::grid_side
    bool by_delta = false;                      ///< since the last vertex
    float paths = 1;                            ///< of this kind that are expected to come so far
    float area = 0, solid_angle = 0;            ///< over which one of them is spread where it left, m^2, sr
    float length = 0;                           ///< since then, m
    std::vector<LightVertex> left;              ///< left along the path
};

/// Chooses one of the delta lobes by how much each reflects or transmits.
BsdfSample sample_delta_lobe(ShadingPoint const& at, vec3 arrived, float u)
{
    BsdfSample lobes[3];
    int const n = delta_lobes(at.bsdf, arrived, at.front, lobes);
    float sum = 0;
    for (int k = 0; k < n; ++k) sum += max_component(lobes[k].weight);
    float left = u * sum;
    for (int k = 0; k < n; ++k) {
        float const share = max_component(lobes[k].weight);
        if (left < share) {
            lobes[k].weight *= sum / share;
            return lobes[k];
        }
        left -= share;
    }
    return {};
}

/// Advances from a hit to the next ray. Returns false if the path ends.
bool advance(WorldView const& world, LightPaths const& s, LightPath& p, Hit const& hit)
{
    if (hit.triangle == kNoTriangle) return false;
    vec3 const direction = p.light.ray.direction;
    ShadingPoint const at = shading_point(world, hit.triangle, hit.barycentric, direction);
    if (p.from_light && p.light.range > 0) {
        Light window;
        window.range = p.light.range;
        p.light.power *= light_detail::distance_attenuation(window, hit.distance) * square(hit.distance);
    }
    p.from_light = false;
    vec3 const arrived = at.frame.to_local(-direction);
    float const cos_arrived = std::abs(glm::dot(direction, at.geometric_normal));
    if (!(arrived.z > 0) || !(cos_arrived > 0)) return false;
    vec3 const power = p.light.power * (arrived.z / cos_arrived);
    if (!all_finite(power) || !(max_component(power) > 0)) return false;
    p.length += hit.distance;
    float const footprint = (p.area + p.solid_angle * square(p.length)) / cos_arrived;
    bool const starts = std::exchange(p.from_surface, false);
    if (!only_delta(at.bsdf) && !(starts && s.delta_only)) {
        if (s.grid_side) {
            GridSide const side = s.grid_side(at.position, hit.triangle);
            if (p.from_outside && p.straight && side == GridSide::inside_still) return false;
            p.from_outside = side == GridSide::outside;
        }
        p.left.push_back({.position = at.position,
                          .normal = at.geometric_normal,
                          .triangle = hit.triangle,
                          .clearance = at.clearance,
                          .front = at.front,
                          .power = power,
                          .bsdf = at.bsdf,
                          .frame = at.frame,
                          .arrived = arrived,
                          .matt = bsdf_detail::is_matt(at.bsdf),
                          .by_delta = p.by_delta,
                          .scatterings = p.scatterings,
                          .footprint = footprint,
                          .path = p.number});
    }
    float const u_lobe = p.rng.uniform();
    BsdfSample const next = s.delta_only ? sample_delta_lobe(at, arrived, u_lobe)
                                         : sample(at.bsdf, arrived, at.front, u_lobe, p.rng.uniform2());
    p.straight = !next.delta;
    if (!next.delta && ++p.scatterings >= s.bounces) return false;
    vec3 const leaves = at.frame.to_world(next.wi);
    float const cos_leaves = glm::dot(leaves, at.geometric_normal);
    if ((cos_leaves > 0) != (next.wi.z > 0) || next.wi.z == 0) return false;
    // The sampled weight is that of a camera path: it contains the cosine with the shading normal on this side.
    vec3 weight = next.weight * std::abs(cos_leaves / next.wi.z);
    // Refraction scales radiance, but not power.
    if (next.transmitted && !at.bsdf.thin) weight *= square(at.front ? at.bsdf.ior : 1 / at.bsdf.ior);
    float const survival = std::min(1.0f, max_component(weight));
    if (!(survival > 0) || p.rng.uniform() >= survival) return false;
    p.light.power = power * weight / survival;
    p.by_delta = next.delta;
    p.paths *= survival;
    if (next.delta) {
        p.area /= survival;
        p.solid_angle /= survival;
    } else {
        p.area = footprint / survival;
        p.solid_angle = 1 / (next.pdf * p.paths);
        p.length = 0;
    }
    p.light.ray = {leave(at, leaves), leaves};
    return true;
}

/// Sends a ray from the sky, or of a parallel light, through the sphere around the focus, or lets it pass beside.
void focus_light(LightPaths const& s, Bounds const& bounds, bool through, vec2 place, EmittedLight& light)
{
    light.power *= 2;
    vec3 const travels = light.ray.direction, center = s.focus.center();
    float const radius = 1.001f * s.focus.radius(); // as the disk of emit_light()
    vec3 const beside = light.ray.origin - center;
    bool const hits = glm::length(beside - glm::dot(beside, travels) * travels) < radius;
    if (!through) {
        if (hits) light.power = vec3{0};
        return;
    }
    Frame const frame = Frame::about(travels);
    vec2 const on_disk = radius * square_to_disk(place);
    float const back = 1.001f * bounds.radius() + glm::length(center - bounds.center());
    light.ray.origin = center - back * travels + on_disk.x * frame.tangent + on_disk.y * frame.bitangent;
    light.power *= square(radius / (1.001f * bounds.radius()));
}

void trace(WorldView const& world, PathRays const& rays, LightPaths const& s, std::vector<LightPath>& paths,
           PathCounts& counts)
{
    std::vector<LightPath*> active;
    for (LightPath& p : paths)
        if (max_component(p.light.power) > 0) active.push_back(&p);
    std::vector<RayQuery> queries;
    std::vector<Hit> hits;
    for (int surface = 0; !active.empty(); ++surface) {
        if (surface == kLongestPath) {
            counts.cut_paths += active.size();
            return;
        }
        queries.clear();
        for (LightPath* p : active) queries.push_back({.ray = p->light.ray, .seed = p->rng.next()});
        hits.resize(active.size());
        rays.nearest(queries, hits);
        counts.nearest_rays += active.size();
        std::size_t left = 0;
        for (std::size_t k = 0; k < active.size(); ++k)
            if (advance(world, s, *active[k], hits[k])) active[left++] = active[k];
        active.resize(left);
    }
}

/// Traces blocks of paths. @param start  (index, path) -> whether there is one
template <class Start>
std::vector<LightVertex> trace_blocks(WorldView const& world, PathRays const& rays, LightPaths const& s,
                                      std::uint32_t first, std::uint32_t end, PathCounts& counts,
                                      Start const& start)
{
    if (first >= end) return {};
    std::uint32_t const blocks = (end - first + kPathsTogether - 1) / kPathsTogether;
    std::vector<std::vector<LightVertex>> found(blocks);
    std::vector<PathCounts> of_block(blocks);
    tbb::parallel_for(0u, blocks, [&](std::uint32_t block) {
        FlushDenormals const guard;
        if (s.stop != nullptr && s.stop->given_up()) throw Interrupted();
        std::uint32_t const begin = first + block * kPathsTogether, last = std::min(end, begin + kPathsTogether);
        std::vector<LightPath> paths(last - begin);
        for (std::uint32_t i = begin; i < last; ++i) start(i, paths[i - begin]);
        trace(world, rays, s, paths, of_block[block]);
        for (LightPath const& p : paths) found[block].insert(found[block].end(), p.left.begin(), p.left.end());
    });
    std::vector<LightVertex> all;
    for (std::uint32_t b = 0; b < blocks; ++b) {
        all.insert(all.end(), found[b].begin(), found[b].end());
        counts += of_block[b];
    }
    return all;
}

} // namespace

std::vector<LightVertex> trace_light_paths(WorldView const& world, Bounds const& bounds, PathRays const& rays,
                                           LightPaths const& s, PathCounts& counts)
{
    if (s.bounces < 1 || world.light_select.empty()) return {};
    return trace_blocks(world, rays, s, s.first, std::min(s.count, s.last), counts,
                        [&](std::uint32_t i, LightPath& p) {
                            p.number = i;
                            p.rng = Pcg32::for_path(s.seed ^ 0x7619, i, s.pass);
                            // Stratified over the lights, so that every light gets its share of the paths in each
                            // pass.
                            double const u = (double(i) + p.rng.uniform_double()) / double(s.count);
                            LightChoice const choice = choose_light(world, u);
                            vec2 const place = p.rng.uniform2(), direction = p.rng.uniform2();
                            p.light = emit_light(world, choice, bounds, place, direction, p.rng.uniform());
                            p.light.power /= float(s.count);
                            p.paths = float(s.count) * world.light_select.probability(choice.light);
                            p.area = p.light.area / p.paths;
                            p.solid_angle = p.light.solid_angle / p.paths;
                            p.from_outside = comes_from_afar(world, choice);
                            if (!s.focus.empty() && p.from_outside)
                                focus_light(s, bounds, p.rng.uniform() < 0.5f, place, p.light);
                        });
}

std::vector<LightVertex> trace_from_surfaces(WorldView const& world, PathRays const& rays,
                                             std::span<LightStart const> starts, LightPaths const& s,
                                             PathCounts& counts)
{
    if (s.bounces < 1) return {};
    return trace_blocks(world, rays, s, 0, std::uint32_t(starts.size()), counts,
                        [&](std::uint32_t i, LightPath& p) {
                            LightStart const& start = starts[i];
                            p.number = i;
                            p.from_surface = true;
                            p.rng = Pcg32::for_path(s.seed ^ 0x57a8, start.number, s.pass);
                            p.light.ray.direction = start.direction;
                            if (start.scatterings >= s.bounces) return;
                            p.scatterings = start.scatterings;
                            p.light.power = start.power;
                            p.paths = float(s.count);
                            if (!advance(world, s, p, start.hit)) p.light.power = vec3{0};
                        });
}

} // namespace gi
