#pragma once
// An environment map filtered with GGX lobes of several widths, and the share of it that a glossy surface
// reflects: the split sum of Karis ("Real Shading in Unreal Engine 4", 2013). Lobes are as seen along the normal:
// at grazing angles they are too round.

#include "ar/pipeline/prefiltered/environment_cells.h"
#include "gi/core/math.h"
#include "gi/scene/shading/bsdf.h"

#include <cstddef>
#include <vector>

namespace ar {

/// Values by direction: an octahedral table (Meyer et al. 2010) with bilinear interpolation.
/// Nodes lie on the square's border, so that no read crosses it.
template <class T>
class NormalTable {
public:
    explicit NormalTable(int side) : side_(side), values_(std::size_t(side) * std::size_t(side)) {}

    int nodes() const { return side_ * side_; }
    T& operator[](int node) { return values_[std::size_t(node)]; }
    /// Unit direction of a node.
    gi::vec3 direction(int node) const
    {
        gi::vec2 const p = 2.0f / float(side_ - 1) * gi::vec2(float(node % side_), float(node / side_)) - 1.0f;
        gi::vec3 d(p.x, p.y, 1 - std::abs(p.x) - std::abs(p.y));
        if (d.z < 0) {
            gi::vec2 const folded = 1.0f - glm::abs(gi::vec2(d.y, d.x));
            d.x = std::copysign(folded.x, p.x);
            d.y = std::copysign(folded.y, p.y);
        }
        return glm::normalize(d);
    }
    /// @param d  unit
    T at(gi::vec3 d) const
    {
        gi::vec3 const a = glm::abs(d);
        gi::vec2 p = gi::vec2(d.x, d.y) / (a.x + a.y + a.z);
        if (d.z < 0) {
            gi::vec2 const folded = 1.0f - glm::abs(gi::vec2(p.y, p.x));
            p = {std::copysign(folded.x, p.x), std::copysign(folded.y, p.y)};
        }
        gi::vec2 const s = glm::clamp(0.5f * (p + 1.0f), 0.0f, 1.0f) * float(side_ - 1);
        int const x = glm::min(int(s.x), side_ - 2), y = glm::min(int(s.y), side_ - 2);
        float const u = s.x - float(x), v = s.y - float(y);
        T const* const t = &values_[std::size_t(y * side_ + x)];
        return (1 - v) * ((1 - u) * t[0] + u * t[1]) + v * ((1 - u) * t[side_] + u * t[side_ + 1]);
    }

private:
    int side_;
    std::vector<T> values_;
};

/// The glossy lobe of a surface.
struct GlossyLobe {
    float alpha = 1;         ///< GGX width
    gi::vec3 reflectance{0}; ///< of uniform light; 0 = there is no lobe
};

/// @param cos_o  cosine between normal and viewer
GlossyLobe glossy_lobe_of(gi::Bsdf const& bsdf, float cos_o);

class GlossyTable {
public:
    /// Narrowest lobe: nearer to a mirror, reflections need rays.
    static constexpr float kLeastAlpha = 0.05f;

    GlossyTable();
    void update(EnvironmentTexels const& texels);
    /// Mean radiance over a lobe. @param direction  unit, of the mirror
    gi::vec3 radiance(gi::vec3 direction, float alpha) const;

private:
    std::vector<NormalTable<gi::vec3>> levels_; ///< each twice as wide as the one before
};

} // namespace ar
