#pragma once
#include "viewer/devices/tracking/tracker_hub.h"
#include "viewer/displays/display.h"

namespace viewer {

/// A tracker of a display as the hub takes it; its body is the hub's head. Of type openxr there is none here: its
/// poses come from the headset's session.
TrackerSettings tracker_settings(DisplayTracker const& tracker);

} // namespace viewer
