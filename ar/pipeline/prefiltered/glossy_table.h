#pragma once
// An environment map filtered with GGX lobes of several widths, and the share of it that a glossy surface
// reflects: the split sum of Karis ("Real Shading in Unreal Engine 4", 2013). Lobes are as seen along the normal:
// at grazing angles they are too round.

#include "ar/pipeline/prefiltered/environment_cells.h"
#include "ar/pipeline/prefiltered/normal_table.h"
#include "gi/scene/shading/bsdf.h"

#include <vector>

namespace ar {

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
