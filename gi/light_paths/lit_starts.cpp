#include "gi/light_paths/lit_starts.h"

#include "gi/render/flush_denormals.h"
#include "gi/render/ray_path.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {
namespace {

struct LitStart {
    LightStart light;
    RayQuery shadow; ///< nothing may be in its way
    std::uint32_t target;
};

/// A point of a target and a sample of the lights; no power without light.
LitStart start_on(WorldView const& world, StartTargets const& targets, LightPathSet const& set, StartLights lights,
                  std::uint32_t i)
{
    Pcg32 rng = Pcg32::for_path(set.seed, i, set.pass);
    double which = (double(i) + rng.uniform_double()) / double(set.count);
    std::uint32_t const k = view(targets.choice).sample(which), triangle = targets.triangles[k];
    vec2 const place = square_to_triangle(rng.uniform2());
    vec3 const position = shading_detail::SurfacePoint{world.surfaces[triangle], place}.position();
    LightChoice const choice = choose_light(world, rng.uniform_double());
    LightSample const light = sample_light(world, choice, position, rng.uniform2());
    LitStart out{{{triangle, place, light.distance}, -light.direction, vec3{0}, i, 0}, {}, k};
    if (!(light.pdf > 0) || (lights == StartLights::lamps && !light.delta)) return out;
    ShadingPoint const at = shading_point(world, triangle, place, -light.direction);
    float const area = 0.5f * glm::length(light_detail::area_vector(world.surfaces[triangle])) /
                       (view(targets.choice).probability(k) * float(set.count));
    vec3 const power = light.radiance * (std::abs(glm::dot(light.direction, at.geometric_normal)) / light.pdf) *
                       (area * coverage(world, triangle, place));
    out.shadow = shadow_ray(at.position, at.geometric_normal, at.clearance, light);
    out.shadow.seed = rng.next();
    if (out.shadow.reach > 0 && all_finite(power)) out.light.power = power;
    return out;
}

} // namespace

LitStarts start_on_surfaces(WorldView const& world, ExactVisibility const& visibility, StartTargets const& targets,
                            LightPathSet const& set, BuildStop const& stop, PathCounts& counts, StartLights lights)
{
    constexpr std::uint32_t kTogether = 1024; // bounds the time to a stop
    LitStarts out;
    if (targets.choice.empty() || world.light_select.empty()) return out;
    std::uint32_t const blocks = (set.count + kTogether - 1) / kTogether;
    std::vector<std::vector<LitStart>> found(blocks);
    std::vector<std::size_t> tested(blocks);
    tbb::parallel_for(0u, blocks, [&](std::uint32_t block) {
        FlushDenormals const guard;
        if (stop.given_up()) throw Interrupted();
        std::vector<LitStart>& starts = found[block];
        for (std::uint32_t i = block * kTogether; i < std::min(set.count, (block + 1) * kTogether); ++i) {
            LitStart const s = start_on(world, targets, set, lights, i);
            if (max_component(s.light.power) > 0) starts.push_back(s);
        }
        std::vector<RayQuery> shadows;
        for (LitStart const& s : starts) shadows.push_back(s.shadow);
        std::vector<std::uint8_t> blocked(shadows.size());
        visibility.occluded(shadows, blocked);
        tested[block] = shadows.size();
        std::size_t lit = 0;
        for (std::size_t k = 0; k < starts.size(); ++k)
            if (blocked[k] == 0) starts[lit++] = starts[k];
        starts.resize(lit);
    });
    for (std::uint32_t b = 0; b < blocks; ++b) {
        counts.shadow_rays += tested[b];
        for (LitStart const& s : found[b]) {
            out.starts.push_back(s.light);
            out.targets.push_back(s.target);
        }
    }
    return out;
}

bool learn_chances(std::span<float const> light, StartTargets& targets)
{
    double sum = 0;
    for (float const l : light) sum += double(l);
    if (!(sum > 0)) return false;
    std::vector<float> weights;
    for (std::uint32_t k = 0; k < light.size(); ++k)
        weights.push_back(float(double(light[k]) / sum) + view(targets.choice).probability(k));
    targets.choice = make_alias_table(weights);
    return true;
}

} // namespace gi
