#pragma once
#include "viewer/app/view_program.h"
#include "viewer/devices/xr/session.h"

namespace viewer {

/// `lightwell view --hmd`: the same session in a headset. Its runtime sets the pace of what is shown; pictures
/// come as fast as they are rendered, and the last one is shown as seen from where the head is now. A lost headset
/// is waited for. Throws InputError where there is no runtime.
ViewRunSummary run_hmd(ViewOptions const& options, HmdOptions const& headset, gi::StopRequest const& stop,
                       gi::Report& report);

} // namespace viewer
