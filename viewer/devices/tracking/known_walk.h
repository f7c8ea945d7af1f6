#pragma once
// A walk in closed form, as ground truth for testing trackers.

#include "viewer/devices/tracking/tracker_sample.h"

namespace viewer {

/// Walk at 1.2 m/s on a circle of 1.5 m about the room's centre, with steps (1.9 Hz, 3 cm), sway and head turns of
/// 40 degrees to either side, up to 130 degrees/s; hands swing. Bodies: head, left hand, right hand.
Tracked known_walk(double time_s);

/// Samples of a tracker that observes it: bodies "head", "left_hand", "right_hand" with measured_s from 0.
std::vector<TrackerSample> known_walk_samples(double seconds, double rate_hz);

} // namespace viewer
