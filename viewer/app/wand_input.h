#pragma once
// Commands from a wand's buttons and axes, the same for flysticks, VRPN and OSC.

#include "viewer/displays/wand.h"
#include "viewer/engine/live/navigation.h"
#include "viewer/protocol/frame_command.h"

#include <cstdint>

namespace viewer {

struct WandState {
    std::optional<RoomPose> pose; ///< in the room; it points along -Z
    bool fresh = false;           ///< seen just now; without it nothing counts as held
    std::uint32_t buttons = 0;
    std::vector<double> axes;
};

struct WandStep {
    NavigationInput motion;          ///< relative to the room, as it is turned by navigation
    std::vector<WandAction> pressed; ///< since the last step, in the order of the buttons
    bool selects = false;            ///< a select button is held
    double scroll = 0;               ///< the axes' forward, -1 to 1
};

class WandInput {
public:
    explicit WandInput(WandSettings settings) : settings_(std::move(settings)) {}
    /// @param seconds  since the last step
    WandStep step(WandState const& now, double seconds);

private:
    WandSettings settings_;
    std::uint32_t held_ = 0;
};

} // namespace viewer
