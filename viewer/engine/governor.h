#pragma once
// Holds the frame rate by choosing the paths per pixel and the size of the pictures.
//
// Work is counted in paths: s^2 N (p + k), with N the pixels of all views at full size, s the scale of their
// sides, p the paths per pixel, and k the other cost of a pixel in paths (G-buffer, reuse, filter, upload). After
// a frame that took too long, the next one gets proportionally less work; work grows slowly. So a frame's fixed
// costs need no model.

namespace viewer {

struct FrameBudget {
    int paths = 1;    ///< per pixel
    double scale = 1; ///< picture side over full-size side

    bool operator==(FrameBudget const&) const = default;
};

class Governor {
public:
    /// Returns the budget of the next frame.
    /// @param pixels  of all views at full size
    /// @param still  nothing moves: full size whatever the rate, because the picture refines
    /// @param fixed  values that the user set: paths > 0, scale > 0; 0 = free
    FrameBudget next(double pixels, bool still, FrameBudget fixed = {0, 0}) const;
    /// Records the time that a frame with this budget took.
    void measured(FrameBudget const& budget, double pixels, double seconds, double rate_hz);

private:
    double work_ = 1e5; ///< of the next frame, in paths
    double last_scale_ = 0;
};

} // namespace viewer
