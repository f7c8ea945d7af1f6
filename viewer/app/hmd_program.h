#pragma once
#include "viewer/app/view_program.h"
#include "viewer/devices/xr/session.h"

namespace viewer {

/// `lightwell view --hmd`: the same session in a headset. The runtime sets the display rate; pictures are rendered
/// as fast as possible, and the newest is reprojected to the current head pose. If the headset is lost, waits for
/// it. Throws InputError if there is no runtime.
ViewRunSummary run_hmd(ViewOptions const& options, HmdOptions const& headset, gi::StopRequest const& stop,
                       gi::Report& report);

} // namespace viewer
