#include "ar/pipeline/prefiltered/glossy_table.h"

#include "gi/scene/shading/fresnel.h"
#include "gi/scene/shading/ggx.h"

#include <array>
#include <cmath>
#include <tbb/parallel_for.h>

namespace ar {
namespace {

constexpr int kSides[] = {96, 96, 64, 40, 24};

float level_alpha(std::size_t level) { return std::ldexp(GlossyTable::kLeastAlpha, int(level)); }

/// Reflectance of uniform light by GGX lobes: f0 times the first plus f90 times the second, for Schlick's Fresnel
/// term. Rows by the root of alpha, columns by the cosine.
class ReflectanceTable {
public:
    ReflectanceTable()
    {
        for (int r = 0; r < kSide; ++r)
            for (int c = 0; c < kSide; ++c)
                shares_[std::size_t(r * kSide + c)] = share(gi::square(node(r)), node(c));
    }
    glm::vec2 at(float alpha, float cosine) const
    {
        glm::vec2 const p = glm::clamp(glm::vec2(cosine, std::sqrt(alpha)), 0.0f, 1.0f) * float(kSide - 1);
        int const x = std::min(int(p.x), kSide - 2), y = std::min(int(p.y), kSide - 2);
        float const u = p.x - float(x), v = p.y - float(y);
        glm::vec2 const* const s = &shares_[std::size_t(y * kSide + x)];
        return glm::mix(glm::mix(s[0], s[1], u), glm::mix(s[kSide], s[kSide + 1], u), v);
    }

private:
    static constexpr int kSide = 17, kStrata = 24;

    static float node(int k) { return std::max(float(k) / float(kSide - 1), 0.02f); }
    static glm::vec2 share(float alpha, float cosine)
    {
        gi::vec3 const wo(std::sqrt(1 - cosine * cosine), 0, cosine);
        glm::dvec2 sum(0);
        for (int j = 0; j < kStrata; ++j)
            for (int i = 0; i < kStrata; ++i) {
                gi::vec2 const u((float(i) + 0.5f) / kStrata, (float(j) + 0.5f) / kStrata);
                gi::vec3 const h = gi::sample_ggx_normal(wo, alpha, u), wi = glm::reflect(-wo, h);
                if (!(wi.z > 0)) continue;
                float const normals = gi::ggx_normals(h, alpha);
                float const weight = normals * gi::ggx_visibility(cosine, wi.z, alpha) * wi.z /
                                     gi::ggx_reflection_pdf(wo, normals, alpha);
                float const grazing = gi::schlick_weight(glm::dot(wo, h));
                sum += double(weight) * glm::dvec2(1 - grazing, grazing);
            }
        return glm::vec2(sum / double(kStrata * kStrata));
    }

    std::array<glm::vec2, kSide * kSide> shares_;
};

} // namespace

GlossyLobe glossy_lobe_of(gi::Bsdf const& b, float cos_o)
{
    if (b.model == gi::MaterialModel::phong) return {std::sqrt(2 / (b.phong_exponent + 2)), b.phong_specular};
    if (!(b.f90.x > 0)) return {};
    static ReflectanceTable const table;
    glm::vec2 const share = table.at(b.alpha, cos_o);
    return {b.alpha, b.f0 * share.x + b.f90 * share.y};
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
