#pragma once
// How far off a pose is likely to be.

#include "ar/pose/estimate.h"

namespace ar {

/// A pose whose expected error is a larger share of the camera's distance is in doubt.
inline constexpr double kDoubtfulErrorShare = 0.05;

/// Expected distance of the estimated from the true position, m: root of the trace of the position's covariance and
/// of the mirrored pose's squared distance, weighted by its likelihood. Nothing for estimates that failed or have no
/// covariance (poses of trackers and files).
std::optional<double> expected_error(PoseEstimate const& estimate);

} // namespace ar
