#pragma once
// Holds the rate of frames: how many paths, and pictures of what size, there is time for.
//
// A frame is taken to cost u s^2 N (p + k): N pixels of all views at full size, s the scale of their sides, p
// paths per pixel, k what a pixel costs besides its paths (G-buffer, reuse, filter, upload), in paths. u is
// measured: its increases count at once, so that one slow frame is followed by a smaller one, its decreases
// slowly.

namespace viewer {

struct FrameBudget {
    int paths = 1;    ///< per pixel
    double scale = 1; ///< of the sides of the pictures

    bool operator==(FrameBudget const&) const = default;
};

class Governor {
public:
    /// @param pixels  of all views at full size   @param still  nothing moves: the full size, whatever the rate,
    /// as the picture refines
    /// @param fixed  what the user holds fixed: paths > 0, scale > 0
    FrameBudget next(double rate_hz, double pixels, bool still, FrameBudget fixed = {0, 0}) const;
    /// What a frame of that budget took.
    void measured(FrameBudget const& budget, double pixels, double seconds);

private:
    double per_pixel_path_s_ = 1e-6;
    bool known_ = false;
    double last_scale_ = 1;
};

} // namespace viewer
