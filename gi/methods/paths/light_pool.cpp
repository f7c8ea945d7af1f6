#include "gi/methods/paths/light_pool.h"

#include "gi/core/rqmc.h"
#include "gi/scene/shading/warp.h"

#include <algorithm>
#include <tbb/parallel_for.h>

namespace gi {

std::uint32_t LightPool::groups_for(std::size_t pixels, World const& world)
{
    constexpr std::size_t kPixelsOfGroup = 32, kLeast = 64, kUsual = 256, kMost = 4096;
    std::size_t const for_pixels = std::clamp(pixels / kPixelsOfGroup, kLeast, kUsual),
                      for_lights = 2 * world.light_select.entries.size() / kCandidates;
    return std::uint32_t(std::min(std::max(for_pixels, for_lights), kMost));
}

void LightPool::fill(LightOrder const& order, World const& world, std::uint32_t groups, std::uint64_t seed,
                     std::uint32_t pass)
{
    lights_.clear();
    groups_.clear();
    if (world.light_select.empty()) return;
    WorldView const w = view(world);
    std::uint32_t const count = groups * kCandidates;
    lights_.resize(count);
    rounds_ = world.light_select.entries.size() > kManyLights ? std::min(kMostRounds, groups) : 1;
    groups_.resize(groups);
    auto const draw = [&](std::uint32_t k) {
        std::uint32_t const part = k % kCandidates, g = k / kCandidates;
        RqmcStream const stream{std::uint32_t(mix_bits(seed ^ 0x9001)), pass * count + k};
        vec4 const u = stream.sample_together(0);
        PooledLight& p = lights_[k];
        p.choice = order.choose((part * groups + g + double(u.x)) / count);
        p.u = {u.y, u.z};
        p.light = distant_light(world, p.choice, p.u);
        LightGroup& to = groups_[g];
        vec3 at = p.light.direction, facing{0};
        float near = 0, power = p.light.pdf > 0 ? luminance(p.light.radiance) / p.light.pdf : 0, back = 0;
        if (p.light.pdf > 0 || !(p.choice.probability > 0)) {
        } else if (p.choice.light < world.lights.size()) {
            Light const& light = world.lights[p.choice.light];
            at = light.position;
            near = 1;
            power = luminance(light.intensity) / p.choice.probability;
        } else if (!light_detail::is_environment(w, p.choice)) {
            Surface const& s = world.surfaces[world.emitters[p.choice.light - world.lights.size()]];
            vec3 const area = light_detail::area_vector(s);
            float const doubled = glm::length(area);
            facing = area / doubled;
            at = shading_detail::SurfacePoint{s, square_to_triangle(p.u)}.position();
            near = 1;
            back = s.is(Surface::kDoubleSided) ? 1 : 0;
            // Its radiance towards a point in front of it.
            LightSample const seen = sample_light(w, p.choice, at + std::sqrt(doubled) * facing, p.u);
            power = luminance(seen.radiance) * 0.5f * doubled / p.choice.probability;
            p.position = at;
            p.facing = facing;
            p.radiance = seen.radiance;
            p.density = 2 * p.choice.probability / doubled;
            p.both_sides = back > 0;
        }
        to.x[part] = at.x;
        to.y[part] = at.y;
        to.z[part] = at.z;
        to.near[part] = near;
        to.power[part] = power < kInf ? power : 0;
        to.facing_x[part] = facing.x;
        to.facing_y[part] = facing.y;
        to.facing_z[part] = facing.z;
        to.everywhere[part] = facing == vec3{0} ? 1 : 0;
        to.back[part] = back;
    };
    tbb::parallel_for(std::uint32_t(0), groups, [&](std::uint32_t g) {
        for (std::uint32_t k = 0; k < kCandidates; ++k) draw(g * kCandidates + k);
    });
}

ChosenLight LightPool::choose(vec3 position, vec3 normal, float u, float pick) const
{
    alignas(32) std::array<float, kMostRounds * kCandidates> weight;
    std::array<std::size_t, kMostRounds> group;
    std::size_t const groups = groups_.size();
    for (std::uint32_t r = 0; r < rounds_; ++r) {
        group[r] = (std::min(std::size_t(u * float(groups)), groups - 1) + r * groups / rounds_) % groups;
        for (std::uint32_t k = 0; k < kCandidates; ++k)
            weight[r * kCandidates + k] = groups_[group[r]].weight(k, position, normal);
    }
    std::uint32_t const count = rounds_ * kCandidates;
    float sum = 0;
    for (std::uint32_t k = 0; k < count; ++k) sum += weight[k];
    if (!(sum > 0)) return {};
    float const wanted = pick * sum;
    float up_to = 0;
    std::uint32_t chosen = 0;
    for (std::uint32_t k = 0; k + 1 < count; ++k) {
        up_to += weight[k];
        chosen += up_to <= wanted ? 1 : 0;
    }
    while (chosen > 0 && !(weight[chosen] > 0)) --chosen; // only because of rounding
    if (!(weight[chosen] > 0)) return {};
    return {&lights_[group[chosen / kCandidates] * kCandidates + chosen % kCandidates],
            sum / (weight[chosen] * float(count))};
}

} // namespace gi
