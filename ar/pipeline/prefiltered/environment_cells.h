#pragma once
// An environment map as a fixed set of parallel lights: the sphere is cut into parts of equal weight, a mixture of
// light and solid angle (median cut, Debevec 2005, with a share of even parts for what the parts do not see of the
// sky but of other surfaces). Without random numbers, so that the same map gives the same lights.

#include "gi/scene/model/world.h"

#include <vector>

namespace ar {

/// The map in texels of at most 128 x 64; each keeps its light and where it comes from.
struct EnvironmentTexels {
    int width = 0, height = 0;
    struct Texel {
        gi::vec3 direction{0}; ///< unit, mean by luminance; world
        gi::vec3 light{0};     ///< integral of radiance, W/m^2
        float solid_angle_sr = 0;
    };
    std::vector<Texel> texels; ///< by rows of the map
};

/// Empty for a world without environment.
EnvironmentTexels environment_texels(gi::World const& world);

struct CellSettings {
    int cells = 128;
    double even_share = 0.5;    ///< of a cell's weight that goes by solid angle instead of light
    double smallest_sr = 0.002; ///< cells are not cut further: a sun is one
};

/// A part of the sphere.
struct EnvironmentCell {
    gi::vec3 direction{0, 1, 0}; ///< unit, towards the light, mean by weight; world
    gi::vec3 light{0};           ///< irradiance of a face turned to it, W/m^2
    float solid_angle_sr = 0;
    float share = 0; ///< of all light, by luminance
};

class EnvironmentCells {
public:
    explicit EnvironmentCells(CellSettings const& settings = {}) : settings_(settings) {}

    /// Updates the parts with the light of a new map of the same size. Divides the map again only if a part would
    /// have more than three times its share of the weight.  @return true if it was divided again
    bool update(EnvironmentTexels const& texels);
    std::vector<EnvironmentCell> const& cells() const { return cells_; }

private:
    /// Texels [x0, x1) x [y0, y1).
    struct Part {
        int x0, y0, x1, y1;
    };
    bool can_be_cut(Part const& part, double sr) const;
    void cut(EnvironmentTexels const& texels, std::vector<double> const& weight);
    void measure(EnvironmentTexels const& texels, std::vector<double> const& weight, bool keep_directions);

    CellSettings settings_;
    int width_ = 0, height_ = 0;
    std::vector<Part> parts_;
    std::vector<EnvironmentCell> cells_;
};

} // namespace ar
