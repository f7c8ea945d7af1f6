#include "gi/scene/model/spectrum.h"

#include <algorithm>

namespace gi {
namespace {

double lobe(double x, double mean, double left, double right)
{
    double const t = (x - mean) / (x < mean ? left : right);
    return std::exp(-0.5 * t * t);
}

} // namespace

dvec3 cie_observer(double nm)
{
    return {1.056 * lobe(nm, 599.8, 37.9, 31.0) + 0.362 * lobe(nm, 442.0, 16.0, 26.7) -
                0.065 * lobe(nm, 501.1, 20.4, 26.2),
            0.821 * lobe(nm, 568.8, 46.9, 40.5) + 0.286 * lobe(nm, 530.9, 16.3, 31.1),
            1.217 * lobe(nm, 437.0, 11.8, 36.0) + 0.681 * lobe(nm, 459.0, 26.0, 13.8)};
}

dvec3 xyz_to_rec709(dvec3 c)
{
    return {3.2404542 * c.x - 1.5371385 * c.y - 0.4985314 * c.z,
            -0.9692660 * c.x + 1.8760108 * c.y + 0.0415560 * c.z,
            0.0556434 * c.x - 0.2040259 * c.y + 1.0572252 * c.z};
}

double Spectrum::at(double nm) const
{
    double const x = std::clamp((nm - first_nm) / step_nm, 0.0, double(values.size() - 1));
    auto const i = std::min(std::size_t(x), values.size() - 1);
    return glm::mix(values[i], values[std::min(i + 1, values.size() - 1)], x - double(i));
}

vec3 to_rgb(Spectrum const& spectrum)
{
    dvec3 sum{0}, white{0};
    for (double nm = 380; nm <= 780; nm += 1) {
        sum += spectrum.at(nm) * cie_observer(nm);
        white += cie_observer(nm);
    }
    return glm::max(vec3(xyz_to_rec709(sum) / xyz_to_rec709(white)), vec3{0});
}

} // namespace gi
