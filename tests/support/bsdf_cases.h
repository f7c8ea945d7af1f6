#pragma once
// The materials that every test of scattering goes through, and directions to look at them from.

#include "gi/scene/shading/bsdf.h"

#include <string>
#include <vector>

namespace gi::test {

struct BsdfCase {
    std::string name;
    Material material;
};

/// Materials with at least one lobe that is not delta.
std::vector<BsdfCase> scattering_materials();
/// Perfect mirrors, smooth glass, thin sheets.
std::vector<BsdfCase> delta_materials();

/// A direction above the surface at that angle from the normal.
vec3 seen_at(double degrees, double azimuth_degrees = 35);
/// 0, 30, 60, 80 and 89.5 degrees.
std::vector<double> const& view_angles();

} // namespace gi::test
