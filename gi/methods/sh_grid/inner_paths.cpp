#include "gi/methods/sh_grid/inner_paths.h"

#include "gi/core/rng.h"
#include "gi/light_paths/emission.h"
#include "gi/light_paths/focus.h"
#include "gi/methods/sh_grid/met_surface.h"
#include "gi/render/flush_denormals.h"
#include "gi/render/ray_path.h"

#include <tbb/parallel_for.h>

namespace gi {
namespace {

/// Part of the starts that is spread by area, as the rest may overlook something.
constexpr float kByArea = 0.1f;

} // namespace

InnerPaths::InnerPaths(std::span<PatchSample const> samples, std::vector<float> shown)
    : samples_(samples.begin(), samples.end()), shown_(std::move(shown))
{
    double area = 0, all_shown = 0;
    std::vector<float> area_of(shown_.size() / 2);
    for (PatchSample const& s : samples_) {
        area += double(s.area);
        area_of[s.patch] += s.area;
    }
    for (float const s : shown_) all_shown += double(s);
    std::vector<float> weights;
    for (PatchSample const& s : samples_) {
        double const seen = double(shown_[2 * s.patch] + shown_[2 * s.patch + 1]) / std::max(all_shown, 1.0);
        weights.push_back(float(double(kByArea) * double(s.area) / area +
                                (1 - double(kByArea)) * seen * double(s.area / area_of[s.patch])));
    }
    choice_ = make_alias_table(weights);
}

std::vector<InnerPaths::Start> InnerPaths::trace_block(InnerWorld const& world, LightPaths const& paths,
                                                       std::uint64_t stream, std::uint32_t first,
                                                       std::uint32_t last, PathCounts& counts) const
{
    std::vector<RayQuery> shadows, rays;
    std::vector<Start> lit, seeing;
    for (std::uint32_t i = first; i < last; ++i) {
        Pcg32 rng = Pcg32::for_path(paths.seed ^ stream, i, paths.pass);
        double u = (double(i) + rng.uniform_double()) / double(paths.count);
        std::uint32_t const k = view(choice_).sample(u);
        PatchSample const& s = samples_[k];
        // Every other one is lit by a sample of the lights.
        float const area = s.area / (view(choice_).probability(k) * 0.5f * float(paths.count));
        Surface const& surface = world.world.surfaces[s.triangle];
        vec2 const weights = barycentric_at(surface, s.point);
        if (i % 2 == 0) {
            LightChoice const light = choose_light(world.world, rng.uniform_double());
            LightSample const l = sample_light(world.world, light, s.point, rng.uniform2());
            float const cosine = glm::dot(l.direction, s.normal);
            if (!comes_from_afar(world.world, light) || !(l.pdf > 0) || cosine == 0) continue;
            vec3 const power = l.radiance * (std::abs(cosine) * area / l.pdf);
            if (!(max_component(power) > 0) || !all_finite(power)) continue;
            ShadingPoint const at = shading_point(world.world, s.triangle, weights, -l.direction);
            shadows.push_back(shadow_ray(at.position, at.geometric_normal, at.clearance, l));
            shadows.back().seed = rng.next();
            lit.push_back(
                {{{s.triangle, weights, l.distance}, -l.direction, power, i, 0}, k, cosine > 0 ? 0u : 1u});
        } else {
            float const front = shown_[2 * s.patch], both = front + shown_[2 * s.patch + 1];
            float const chance = both > 0 ? 0.05f + 0.9f * front / both : 0.5f;
            std::uint32_t const side = rng.uniform() < chance ? 0 : 1;
            Frame const about = Frame::about(side == 0 ? s.normal : -s.normal);
            vec3 const direction = about.to_world(square_to_cosine_hemisphere(rng.uniform2()));
            ShadingPoint const at = shading_point(world.world, s.triangle, weights, -direction);
            rays.push_back({.ray = {leave(at, direction), direction}, .seed = rng.next()});
            vec3 const power{kPi * area / (side == 0 ? chance : 1 - chance)}; // for a radiance of 1
            seeing.push_back({{{s.triangle, weights, 0}, -direction, power, i, 1}, k, side});
        }
    }
    std::vector<Start> out;
    std::vector<std::uint8_t> blocked(shadows.size());
    world.visibility.occluded(shadows, blocked);
    for (std::size_t k = 0; k < lit.size(); ++k)
        if (blocked[k] == 0) out.push_back(lit[k]);
    std::vector<Hit> hits(rays.size());
    world.visibility.nearest(rays, hits);
    for (std::size_t k = 0; k < seeing.size(); ++k) {
        Hit const& hit = hits[k];
        if (hit.triangle == kNoTriangle) continue; // the sky: by samples of the lights
        MetSurface const at = met_surface(world.world, hit.triangle, hit.barycentric, rays[k].ray.direction);
        if (world.is_inside(at.position, hit.triangle)) continue; // counted by paths that continue there
        std::uint32_t const patch = patch_at(world.coarse, world.coarse_patches, at.position, hit.triangle);
        if (patch == kNoCell) continue;
        Start& start = seeing[k];
        start.light.power *= world.coarse_light[patch].seen(at.front ? 0 : 1).radiance;
        start.light.hit.distance = hit.distance;
        if (max_component(start.light.power) > 0) out.push_back(start);
    }
    counts.shadow_rays += shadows.size();
    counts.nearest_rays += rays.size();
    return out;
}

std::vector<InnerPaths::Start> InnerPaths::trace_set(InnerWorld const& world, LightPaths const& paths,
                                                     std::uint64_t stream, PathCounts& counts) const
{
    constexpr std::uint32_t kTogether = 256;
    std::uint32_t const end = std::min(paths.count, paths.last);
    if (choice_.empty() || paths.first >= end) return {};
    std::uint32_t const blocks = (end - paths.first + kTogether - 1) / kTogether;
    std::vector<std::vector<Start>> found(blocks);
    std::vector<PathCounts> of_block(blocks);
    tbb::parallel_for(0u, blocks, [&](std::uint32_t block) {
        FlushDenormals const guard;
        if (paths.stop != nullptr && paths.stop->given_up()) throw Interrupted();
        std::uint32_t const first = paths.first + block * kTogether, last = std::min(end, first + kTogether);
        found[block] = trace_block(world, paths, stream, first, last, of_block[block]);
    });
    std::vector<Start> all;
    for (std::uint32_t b = 0; b < blocks; ++b) {
        all.insert(all.end(), found[b].begin(), found[b].end());
        counts += of_block[b];
    }
    return all;
}

void InnerPaths::learn(InnerWorld const& world, LightPaths const& paths, PathCounts& counts)
{
    std::vector<float> weights(samples_.size());
    double sum = 0;
    for (Start const& s : trace_set(world, paths, 0x1ea52, counts)) {
        // The root, as dim places need photons too.
        float const worth = std::sqrt(luminance(s.light.power) * shown_[2 * samples_[s.sample].patch + s.side]);
        weights[s.sample] += worth;
        sum += double(worth);
    }
    if (!(sum > 0)) return;
    for (std::uint32_t k = 0; k < weights.size(); ++k)
        weights[k] = float(double(weights[k]) / sum) + view(choice_).probability(k);
    choice_ = make_alias_table(weights);
}

std::vector<LightStart> InnerPaths::trace(InnerWorld const& world, LightPaths const& paths,
                                          PathCounts& counts) const
{
    std::vector<LightStart> out;
    for (Start const& s : trace_set(world, paths, 0x57a7, counts)) out.push_back(s.light);
    return out;
}

std::vector<float> count_shown_sides(World const& world, ExactVisibility const& visibility,
                                     std::span<FrameView const> views, CellsView<BlockVoxels> const& grid,
                                     PatchesView const& patches, std::size_t sides)
{
    std::vector<float> counts(sides);
    for (ShownPoint const& p : shown_surfaces(world, visibility, views, 64, 3)) {
        std::uint32_t const patch = patch_at(grid, patches, p.position, p.triangle);
        if (patch != kNoCell) counts[2 * patch + (p.front ? 0 : 1)] += 1;
    }
    return counts;
}

} // namespace gi
