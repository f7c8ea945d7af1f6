#pragma once
// Coloured functions of a direction as real spherical harmonics of degree 1: four coefficients a colour. Basis and
// order are those of spherical_harmonics.h: 1, x, y, z. So c[1..3] are a vector.

#include "gi/core/math.h"

namespace gi {

struct ShColor {
    static constexpr float kY0 = 0.28209479177387814f; ///< Y_00
    static constexpr float kY1 = 0.4886025119029199f;  ///< Y_1m for x, y or z of 1

    vec3 c[4] = {};

    GI_FN ShColor& operator+=(ShColor const& o)
    {
        for (int k = 0; k < 4; ++k) c[k] += o.c[k];
        return *this;
    }
    GI_FN ShColor& operator*=(vec3 by)
    {
        for (vec3& k : c) k *= by;
        return *this;
    }
    /// Adds a beam of a flux along a direction: its projection (Noren and Sjolin, sec. 5.3). @param d  unit
    GI_FN void add_beam(vec3 flux, vec3 d)
    {
        c[0] += kY0 * flux;
        for (int k = 0; k < 3; ++k) c[k + 1] += kY1 * d[k] * flux;
    }
    /// Adds intensity flux / pi max(cos, 0) about a normal, whose integral is the flux (zonal coefficients of the
    /// clamped cosine: Ramamoorthi and Hanrahan 2001, eq. 8). @param n  unit
    GI_FN void add_cosine_lobe(vec3 flux, vec3 n)
    {
        c[0] += kY0 * flux;
        for (int k = 0; k < 3; ++k) c[k + 1] += (2.0f / 3 * kY1) * n[k] * flux;
    }
    GI_FN vec3 along(vec3 d) const { return d.x * c[1] + d.y * c[2] + d.z * c[3]; }
    GI_FN vec3 integral() const { return c[0] / kY0; } ///< over the sphere
};

GI_FN inline ShColor operator*(float by, ShColor of) { return of *= vec3{by}; }

/// Value in a direction; below 0 where four coefficients do not suffice. @param d  unit
GI_FN inline vec3 evaluate(ShColor const& of, vec3 d)
{
    return ShColor::kY0 * of.c[0] + ShColor::kY1 * of.along(d);
}

/// Irradiance of a surface by a radiance, W/m^2: its convolution with the clamped cosine. @param of  radiance by
/// the direction from which it comes, W/(m^2 sr)
GI_FN inline vec3 irradiance(ShColor const& of, vec3 normal)
{
    return kPi * ShColor::kY0 * of.c[0] + (2 * kPi / 3 * ShColor::kY1) * of.along(normal);
}

} // namespace gi
