#pragma once
// One world in terms of another: a tracker's room and the world of the markers.

#include "ar/base/pose.h"

#include <optional>
#include <span>
#include <vector>

namespace ar {

enum class Scale { fixed, free };

struct Alignment {
    Pose to_from; ///< to = scale * rotation * from + position
    double scale = 1;
    std::vector<double> residual_m;   ///< of each point, or of each pose's position
    std::vector<double> residual_deg; ///< of poses
    double rms_m = 0;
    std::size_t worst = 0; ///< index of the largest residual
};

glm::dvec3 apply(Alignment const& a, glm::dvec3 from);
Pose apply(Alignment const& a, Pose const& from);

/// Umeyama 1991 (with Scale::fixed: Kabsch 1976), least squares, never a reflection.
/// @throws InputError fewer than 3 points, as many of one as of the other not given, not finite, or all on a line
Alignment align(std::span<glm::dvec3 const> from, std::span<glm::dvec3 const> to, Scale scale = Scale::fixed);
/// Of the same body (or rigidly mounted bodies with the same origin and axes) seen in both worlds at the same
/// times: positions, and axes as points at the distance at which both weigh alike (the spread of the positions, at
/// least 0.1 m). One pose is enough. The offset between a tracker's body and the camera is not solved for.
Alignment align(std::span<Pose const> from, std::span<Pose const> to);

} // namespace ar
