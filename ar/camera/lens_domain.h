#pragma once
// How far from its axis a lens model is one-to-one. Fitted polynomials describe a lens only as far as there were
// points: further out a rational model may have a pole, and any may fold back, so that two rays share a pixel.

#include "ar/camera/camera_model.h"

namespace ar {

enum class DomainEnd {
    none, ///< it ends nowhere
    pole, ///< the denominator of a rational model is 0, or nearly
    fold  ///< the radius in the picture no longer grows
};

struct LensDomain {
    /// On the plane z = 1 (the tangent of the angle to the axis); of a fisheye the angle, rad. At most 1e3, pi.
    double radius = 0;
    DomainEnd end = DomainEnd::none;

    friend bool operator==(LensDomain const&, LensDomain const&) = default;
};

/// The exact first pole or fold of the radial terms. Kept for the last lens of each thread.
LensDomain domain_of(CameraModel const& camera);

/// Which part of its picture a lens model has rays for.
struct LensReach {
    double share = 0;      ///< of the picture, on a grid of 33 x 33 points with its corners
    double widest_deg = 0; ///< largest angle of these rays to the axis
    double share_wide = 0; ///< of the picture: kWide_deg or more off the axis, where no pinhole picture shows it
};
inline constexpr double kWide_deg = 80;
LensReach reach_of(CameraModel const& camera);

/// "holds over 83 % of the picture, up to 95.1 degrees off its axis".
std::string describe(LensReach const& reach);

} // namespace ar
