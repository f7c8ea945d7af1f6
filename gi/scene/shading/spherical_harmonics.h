#pragma once
// Real spherical harmonics as polynomials, degrees 0 to 4. Polar axis +Y, azimuth from +Z towards +X; orthonormal,
// without the phase (-1)^m; see environment_harmonics.h. Index of Y_lm: l^2 + l + m.

#include "gi/core/math.h"

namespace gi {

inline constexpr int kMostHarmonicsDegree = 4;

/// All Y_lm up to a degree. @param d  unit  @param degree  0 to 4  @param y  (degree + 1)^2 values
template <class T>
GI_FN void spherical_harmonics(glm::vec<3, T> d, int degree, T* y)
{
    T const a = d.z, b = d.x, c = d.y, aa = a * a, bb = b * b, cc = c * c;
    y[0] = T(0.28209479177387814);
    if (degree < 1) return;
    y[1] = T(0.4886025119029199) * b;
    y[2] = T(0.4886025119029199) * c;
    y[3] = T(0.4886025119029199) * a;
    if (degree < 2) return;
    y[4] = T(1.0925484305920792) * a * b;
    y[5] = T(1.0925484305920792) * b * c;
    y[6] = T(0.31539156525252005) * (3 * cc - 1);
    y[7] = T(1.0925484305920792) * a * c;
    y[8] = T(0.5462742152960396) * (aa - bb);
    if (degree < 3) return;
    y[9] = T(0.5900435899266435) * b * (3 * aa - bb);
    y[10] = T(2.890611442640554) * a * b * c;
    y[11] = T(0.4570457994644658) * b * (5 * cc - 1);
    y[12] = T(0.3731763325901154) * c * (5 * cc - 3);
    y[13] = T(0.4570457994644658) * a * (5 * cc - 1);
    y[14] = T(1.445305721320277) * c * (aa - bb);
    y[15] = T(0.5900435899266435) * a * (aa - 3 * bb);
    if (degree < 4) return;
    y[16] = T(2.5033429417967046) * a * b * (aa - bb);
    y[17] = T(1.7701307697799307) * b * c * (3 * aa - bb);
    y[18] = T(0.9461746957575601) * a * b * (7 * cc - 1);
    y[19] = T(0.6690465435572892) * b * c * (7 * cc - 3);
    y[20] = T(0.10578554691520431) * (35 * cc * cc - 30 * cc + 3);
    y[21] = T(0.6690465435572892) * a * c * (7 * cc - 3);
    y[22] = T(0.47308734787878004) * (aa - bb) * (7 * cc - 1);
    y[23] = T(1.7701307697799307) * a * c * (aa - 3 * bb);
    y[24] = T(0.6258357354491761) * (aa * (aa - 3 * bb) - bb * (3 * aa - bb));
}

} // namespace gi
