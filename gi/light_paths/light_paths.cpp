#include "gi/light_paths/light_paths.h"

#include "gi/light_paths/light_path_step.h"
#include "gi/render/flush_denormals.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Number of paths that advance together, so that rays are traced in packets.
constexpr std::uint32_t kPathsTogether = 64;

/// A path and what it has left.
struct TracedPath : LightPath {
    std::vector<LightVertex> left;
};

/// Advances from a hit to the next ray. Returns false if the path ends.
bool advance(WorldView const& world, LightPaths const& s, TracedPath& p, Hit const& hit)
{
    auto const keep = [&](vec3 position, std::uint32_t triangle) {
        if (!s.grid_side) return true;
        GridSide const side = s.grid_side(position, triangle);
        if (p.from_outside && p.straight && side == GridSide::inside_still) return false;
        p.from_outside = side == GridSide::outside;
        return true;
    };
    LightVertex vertex;
    bool has_vertex = false;
    bool const goes_on = advance(world, {s.bounces, s.delta_only}, p, hit, keep, vertex, has_vertex);
    if (has_vertex) p.left.push_back(vertex);
    return goes_on;
}

/// Makes a ray of the sky or of a parallel light go through the sphere around the focus, or miss it.
void focus_light(LightPaths const& s, Bounds const& bounds, bool through, LightPath& p)
{
    EmittedLight& light = p.light;
    light.power *= 2;
    p.area *= 2; // half of the paths go either way
    vec3 const travels = light.ray.direction, center = s.focus.center();
    float const radius = 1.001f * s.focus.radius(); // as the disk of emit_light()
    vec3 const beside = light.ray.origin - center;
    bool const hits = glm::length(beside - glm::dot(beside, travels) * travels) < radius;
    if (!through) {
        if (hits) light.power = vec3{0};
        return;
    }
    Frame const frame = Frame::about(travels);
    vec2 const on_disk = radius * square_to_disk(p.place);
    float const back = 1.001f * bounds.radius() + glm::length(center - bounds.center());
    light.ray.origin = center - back * travels + on_disk.x * frame.tangent + on_disk.y * frame.bitangent;
    float const share = square(radius / (1.001f * bounds.radius()));
    light.power *= share;
    p.area *= share;
}

void trace(WorldView const& world, PathRays const& rays, LightPaths const& s, std::vector<TracedPath>& paths,
           PathCounts& counts)
{
    std::vector<TracedPath*> active;
    for (TracedPath& p : paths)
        if (max_component(p.light.power) > 0) active.push_back(&p);
    std::vector<PathQuery> queries;
    std::vector<Hit> hits;
    for (int surface = 0; !active.empty(); ++surface) {
        if (surface == kLongestPath) {
            counts.cut_paths += active.size();
            return;
        }
        queries.clear();
        for (TracedPath* p : active)
            queries.push_back({{.ray = p->light.ray, .seed = p->rng.next()},
                               p->triangle != kNoTriangle ? p->triangle : p->light.triangle,
                               p->triangle != kNoTriangle && !p->by_delta && !p->narrow});
        hits.resize(active.size());
        rays.nearest(queries, hits);
        counts.nearest_rays += active.size();
        std::size_t left = 0;
        for (std::size_t k = 0; k < active.size(); ++k) active[k]->light.ray = queries[k].ray.ray;
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
        std::vector<TracedPath> paths(last - begin);
        for (std::uint32_t i = begin; i < last; ++i) start(i, paths[i - begin]);
        trace(world, rays, s, paths, of_block[block]);
        for (TracedPath const& p : paths) found[block].insert(found[block].end(), p.left.begin(), p.left.end());
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
    return trace_blocks(
        world, rays, s, s.first, std::min(s.count, s.last), counts, [&](std::uint32_t i, TracedPath& p) {
            LightChoice const choice = start_at_light(world, bounds, {s.count, s.seed, s.pass}, i, p);
            p.from_outside = comes_from_afar(world, choice);
            if (!s.focus.empty() && p.from_outside)
                focus_light(s, bounds, p.rng.uniform() < 0.5f, p);
        });
}

std::vector<LightVertex> trace_onwards(WorldView const& world, PathRays const& rays,
                                       std::span<LightPath const> paths, LightPaths const& s, PathCounts& counts)
{
    return trace_blocks(world, rays, s, 0, std::uint32_t(paths.size()), counts,
                        [&](std::uint32_t i, TracedPath& p) { static_cast<LightPath&>(p) = paths[i]; });
}

std::vector<LightVertex> trace_from_surfaces(WorldView const& world, PathRays const& rays,
                                             std::span<LightStart const> starts, LightPaths const& s,
                                             PathCounts& counts)
{
    if (s.bounces < 1) return {};
    return trace_blocks(world, rays, s, 0, std::uint32_t(starts.size()), counts,
                        [&](std::uint32_t i, TracedPath& p) {
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
