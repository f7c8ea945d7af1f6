#include "gi/render/light_order.h"

#include <algorithm>

namespace gi {
namespace {

void add_up(AliasTable const& table, std::vector<double>& sums)
{
    sums.clear();
    double sum = 0;
    for (AliasEntry const& e : table.entries) sums.push_back(sum += double(e.probability));
}

/// Returns the entry whose interval contains u; u becomes the relative position in that interval.
std::uint32_t pick(std::vector<double> const& sums, double& u)
{
    double const at = u * sums.back();
    auto const i =
        std::min(std::size_t(std::upper_bound(sums.begin(), sums.end(), at) - sums.begin()), sums.size() - 1);
    double const before = i > 0 ? sums[i - 1] : 0.0;
    u = sums[i] > before ? glm::clamp((at - before) / (sums[i] - before), 0.0, 1 - 0x1p-53) : 0.0;
    return std::uint32_t(i);
}

} // namespace

LightSample distant_light(World const& world, LightChoice const& choice, vec2 u)
{
    LightSample const light = sample_light(view(world), choice, vec3{0}, u);
    return light.distance == kInf ? light : LightSample{};
}

void LightOrder::update(World const& world)
{
    world_ = &world;
    add_up(world.light_select, light_sums_);
    AliasTable const& texels = world.environment_select;
    if (texels.entries.size() == texel_sums_.size() && texels.total == texel_total_) return;
    add_up(texels, texel_sums_);
    texel_total_ = texels.total;
}

LightChoice LightOrder::choose(double u) const
{
    LightChoice c;
    if (light_sums_.empty()) return c;
    c.light = pick(light_sums_, u);
    c.probability = world_->light_select.entries[c.light].probability;
    if (c.light < world_->lights.size() + world_->emitters.size()) return c;
    c.texel = pick(texel_sums_, u);
    c.probability *= world_->environment_select.entries[c.texel].probability;
    return c;
}

} // namespace gi
