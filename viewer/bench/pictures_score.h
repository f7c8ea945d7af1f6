#pragma once
// Scores of one picture against its reference, and statistics over several renders.

#include "viewer/bench/sweep_reference.h"
#include "viewer/report/table.h"

#include <array>

namespace viewer {

/// All light, direct light (L1), indirect light (L2).
inline constexpr std::array<char const*, 3> kJudgedLayers{"color", "L1", "L2"};

struct PictureScore {
    double relmse = 0; ///< without the part caused by the reference's noise
    double flip = 0;
    std::array<double, 3> bias{}; ///< mean / mean of the reference, for kJudgedLayers; NaN if unknown
    double neighbour_correlation = 0;
};

PictureScore score(gi::Picture const& picture, SweepReference const& reference);

/// Standard errors of the bias caused by the reference's noise, for kJudgedLayers. Those of direct and indirect
/// light are overestimated: the noise of all light is used for them.
std::array<double, 3> bias_errors(gi::Picture const& reference);

/// A mean with its standard error.
struct MeanOf {
    Cell value, error;
};
/// @param other_error  further error, independent of these values
/// The error is empty with fewer than two values.
MeanOf mean_of(std::vector<double> const& values, double other_error);

/// Time of a render by part.
struct RenderSeconds {
    double structures = 0; ///< hit buffers, shadow maps, BVHs, virtual lights
    double paths = 0;      ///< paths and first surfaces
};
RenderSeconds seconds_by_part(gi::Report const& report);

} // namespace viewer
