#pragma once
// One picture against its reference, and what several renders of it give together.

#include "viewer/bench/sweep_reference.h"
#include "viewer/report/table.h"

#include <array>

namespace viewer {

/// All light, direct light (L1), indirect light (L2).
inline constexpr std::array<char const*, 3> kJudgedLayers{"color", "L1", "L2"};

struct PictureScore {
    double relmse = 0; ///< less what the reference's own noise adds
    double flip = 0;
    std::array<double, 3> bias{}; ///< mean / mean of the reference, of kJudgedLayers; NaN where that is unknown
    double neighbour_correlation = 0;
};

PictureScore score(gi::Picture const& picture, SweepReference const& reference);

/// Standard errors of the bias that the reference's own noise causes, of kJudgedLayers. Its direct and indirect
/// light count as uncertain as all of its light: larger than they are.
std::array<double, 3> bias_errors(gi::Picture const& reference);

/// A mean with its standard error.
struct MeanOf {
    Cell value, error;
};
/// @param other_error  that is independent of these values
/// The error is empty with fewer than two values.
MeanOf mean_of(std::vector<double> const& values, double other_error);

/// Where the time of a render went.
struct RenderSeconds {
    double structures = 0; ///< hit buffers, shadow maps, BVHs, virtual lights
    double paths = 0;      ///< and first surfaces
};
RenderSeconds seconds_by_part(gi::Report const& report);

} // namespace viewer
