#pragma once
// Automatic exposure of what is shown. The exposure is the setting `exposure`, changed as a user would change it:
// so recordings and ranks have it, and it is one for both eyes and all walls.

#include "viewer/engine/live/live_renderer.h"

#include <optional>

namespace viewer {

/// Exposure, stops, that puts the light of the pictures in the middle of the tone curve:
/// the geometric mean of the luminance of their pixels, without the darkest and brightest twentieth,
/// becomes 0.18 (Reinhard et al. 2002). In -16..16.
/// @return nothing if the pictures are black
std::optional<double> metered_exposure_ev(std::vector<ViewPicture> const& views);

class AutoExposure {
public:
    /// @param ev  the current exposure, stops   @param time_s  of this frame, on any clock
    /// @return the exposure from now on: it approaches that of the frame by a factor e each 0.4 s, and rests when
    /// it is closer than a tenth of a stop. A first frame is exposed at once.
    std::optional<double> see(std::vector<ViewPicture> const& views, double ev, double time_s);
    /// Another scene, or automatic exposure begins: the next frame is exposed at once.
    void begin() { first_ = true; }

private:
    bool first_ = true, moves_ = false;
    double seen_s_ = 0;
};

} // namespace viewer
