#pragma once
// An order of all lights for samples that are drawn once per pass and shared by many paths.

#include "gi/scene/shading/light_sampling.h"

namespace gi {

/// All lights of a world in an order that keeps neighbours together, so that well-distributed numbers choose
/// well-distributed lights (and sky texels): every pass gets its share of a small sun. Alias tables do not
/// preserve the distribution.
class LightOrder {
public:
    /// Rebuilds the order for the current world, which must outlive this object.
    void update(World const& world);
    /// @param u  in [0, 1), with all 53 bits used
    LightChoice choose(double u) const;

private:
    World const* world_ = nullptr;
    std::vector<double> light_sums_, texel_sums_; ///< cumulative probabilities
    double texel_total_ = 0;                      ///< of the table from which they were computed
};

/// Returns the light sample if it is the same for all lit points; else pdf = 0.
LightSample distant_light(World const& world, LightChoice const& choice, vec2 u);

} // namespace gi
