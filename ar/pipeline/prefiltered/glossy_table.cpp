#include "ar/pipeline/prefiltered/glossy_table.h"

#include "gi/scene/shading/bsdf.h"

#include <cmath>
#include <tbb/parallel_for.h>

namespace ar {
namespace {

constexpr int kSides[] = {96, 96, 64, 40, 24};

float level_alpha(std::size_t level) { return std::ldexp(GlossyTable::kLeastAlpha, int(level)); }

} // namespace

GlossyLobe glossy_lobe_of(gi::Bsdf const& b, float cos_o)
{
    if (b.model == gi::MaterialModel::phong) return {std::sqrt(2 / (b.phong_exponent + 2)), b.phong_specular};
    if (!(b.f90.x > 0)) return {};
    return {b.alpha, gi::bsdf_detail::facets_albedo(b, cos_o).of(b.f0, b.f90)};
}

GlossyTable::GlossyTable()
{
    for (int const side : kSides) levels_.emplace_back(side);
}

void GlossyTable::update(EnvironmentTexels const& texels)
{
    for (std::size_t level = 0; level < levels_.size(); ++level) {
        float const alpha = level_alpha(level);
        // Where the density has fallen to 1/400: cos(2 theta) with tan(theta) = sqrt(19) alpha.
        float const squared = 19 * alpha * alpha, least = (1 - squared) / (1 + squared);
        NormalTable<gi::vec3>& table = levels_[level];
        tbb::parallel_for(0, table.nodes(), [&](int node) {
            gi::vec3 const n = table.direction(node);
            gi::vec3 light(0);
            float all = 0;
            for (auto const& t : texels.texels) {
                float const c = glm::dot(t.direction, n);
                if (!(c > std::max(least, 0.0f))) continue;
                float const h = 0.5f * (1 + c), s = 1 - h; // squared cosine and sine of the half vector
                float const w = c / gi::square(s / (alpha * alpha) + h);
                light += w * t.light;
                all += w * t.solid_angle_sr;
            }
            table[node] = all > 0 ? light / all : gi::vec3(0);
        });
    }
}

gi::vec3 GlossyTable::radiance(gi::vec3 direction, float alpha) const
{
    float const level = std::clamp(std::log2(alpha / kLeastAlpha), 0.0f, float(levels_.size() - 1));
    std::size_t const low = std::min(std::size_t(level), levels_.size() - 2);
    return glm::mix(levels_[low].at(direction), levels_[low + 1].at(direction), level - float(low));
}

} // namespace ar
