#pragma once
// Holds the rate of frames: how many paths, and pictures of what size, there is time for.
//
// Work is counted in paths: s^2 N (p + k), N pixels of all views at full size, s the scale of their sides, p paths
// per pixel, k what a pixel costs besides its paths (G-buffer, reuse, filter, upload). A frame that took too long
// is followed by one with as much less work; work grows slowly. So what a frame costs besides needs no model.

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
    FrameBudget next(double pixels, bool still, FrameBudget fixed = {0, 0}) const;
    /// What a frame of that budget took.
    void measured(FrameBudget const& budget, double pixels, double seconds, double rate_hz);

private:
    double work_ = 1e5; ///< of the next frame
    double last_scale_ = 0;
};

} // namespace viewer
