#pragma once
// Direct light by the area formulation (Yu 2012, eq. 5.3): in every pass a few points on lamps (or directions to
// the sky) are chosen by power, each gets a shadow map, and all paths of the pass are lit by them. Neighbouring
// pixels take different ones (interleaved sampling), other passes others.

#include "gi/slhb/shadow_map.h"

#include <functional>

namespace gi {

struct Lamp {
    LightChoice choice;
    vec2 u{0}; ///< where on the light
    ShadowView view;
    ShadowMap shadow;
};

class Lamps {
public:
    /// @param count per pass; where all lights are points or parallel and no more than this, all of them, and they
    /// keep their maps from pass to pass
    /// @param elsewhere where it is not empty, shadow maps only get their grids here and are drawn there; with a
    /// seed for the cut-outs
    using DrawElsewhere = std::function<void(std::vector<Lamp> const&, std::uint32_t)>;
    Lamps(World const& world, TriangleSoup const& soup, CutOuts const& cut_outs, std::uint32_t count,
          std::uint32_t resolution, std::uint64_t seed, DrawElsewhere elsewhere = {});

    /// New points and shadow maps.
    void refresh(std::uint32_t pass);
    std::vector<Lamp> const& lamps() const { return lamps_; }
    bool none() const { return lamps_.empty(); }
    /// Probability of picking lamp k for a path vertex; their sum is 1.
    AliasTableView chances() const { return view(chances_); }
    bool fixed() const { return fixed_; }
    std::uint64_t maps_built() const { return built_; }

private:
    void build(std::uint32_t pass);
    LightChoice choose(double u) const;

    World const& world_;
    ShadowMapBuilder builder_;
    std::uint64_t seed_;
    DrawElsewhere elsewhere_;
    bool fixed_ = false;
    std::vector<Lamp> lamps_;
    AliasTable chances_; ///< where they are fixed
    /// Sums of probabilities, where they are not fixed. Neighbouring numbers find neighbouring lights and texels,
    /// so that every pass has its share of a small sun; an alias table would leave that to chance.
    std::vector<double> light_sums_, texel_sums_;
    double texel_total_ = 0; ///< of the table that they belong to
    std::uint64_t built_ = 0;
};

} // namespace gi
