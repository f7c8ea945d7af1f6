#pragma once
#include "viewer/devices/tracking/tracker_hub.h"
#include "viewer/displays/display.h"

namespace viewer {

/// Hub settings for a tracker of a display; its body becomes the hub's head. Not for type openxr, whose poses come
/// from the headset's session.
TrackerSettings tracker_settings(DisplayTracker const& tracker);

} // namespace viewer
