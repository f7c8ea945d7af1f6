#pragma once
// What of a run's results is in doubt, though it ended well: poses that are likely far off, lost frames with a cause
// that the pictures show, virtual objects that were never seen.

#include "ar/runtime/runner.h"

namespace ar {

/// Counts each kind as a loss whose name begins with "in doubt: ".
void report_doubts(RunSummary const& summary, gi::Report& report);

/// What the pictures and the map say about why the camera was not found: identifiers, the size at which markers appear,
/// the focal length. Empty: nothing. @param true_poses  say how large the markers are in the frames; empty: unknown
std::string hint_of(RunSummary const& summary, std::vector<TimedPose> const& true_poses = {});

} // namespace ar
