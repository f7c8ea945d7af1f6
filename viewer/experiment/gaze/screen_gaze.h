#pragma once
// Gaze that the screen itself reads: a headset's.

#include "viewer/experiment/gaze/gaze_source.h"
#include "viewer/experiment/screens/screen.h"

#include <functional>

namespace viewer {

class ScreenGaze : public GazeSource {
public:
    /// @param screen  the current one, which may be exchanged; must not be null
    explicit ScreenGaze(std::function<Screen&()> screen) : screen_(std::move(screen)) {}

    std::vector<study::GazeSample> take(GazePlace const&, double) override { return screen_().take_gaze(); }
    std::vector<std::pair<std::string, std::string>> about() const override { return screen_().gaze_about(); }

private:
    std::function<Screen&()> screen_;
};

} // namespace viewer
