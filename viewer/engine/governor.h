#pragma once
// Holds the frame rate by choosing the paths per pixel and the sizes of the pictures: that of light, and that of
// the surfaces which it falls on.
//
// Work on light is counted in paths: s^2 N (p + k), with N the pixels of all views at full size, s the scale of
// the sides of the pictures of light, p the paths per pixel, and k the other cost of such a pixel in paths
// (G-buffer, reuse, filter). After a frame that took too long, the next one gets proportionally less work; work
// grows slowly. So a frame's fixed costs need no model. Surfaces are larger than half the size while
// they take at most three tenths of the time.

namespace viewer {

struct FrameBudget {
    int paths = 1;       ///< per pixel of the pictures of light
    double scale = 1;    ///< side of the pictures of light over full-size side
    double surfaces = 1; ///< side of the pictures of surfaces over full-size side; at least scale

    bool operator==(FrameBudget const&) const = default;
};

class Governor {
public:
    static constexpr double kLeastScale = 0.25; ///< of light

    /// Returns the budget of the next frame.
    /// @param pixels  of all views at full size
    /// @param still  nothing moves: full size whatever the rate, because the picture refines
    /// @param fixed  values that the user set: paths > 0, scale > 0; 0 = free
    /// @param own_surfaces  surfaces have a size of their own; otherwise that of the pictures of light
    FrameBudget next(double pixels, bool still, FrameBudget fixed = {0, 0, 0}, bool own_surfaces = false) const;
    /// Records the time that a frame with this budget took.
    /// @param surfaces_s  the part of it spent on surfaces of another size than light, 0 = there were none
    void measured(FrameBudget const& budget, double pixels, double seconds, double rate_hz, double surfaces_s = 0);

private:
    double surfaces_scale() const;

    double work_ = 1e5; ///< of the next frame, in paths
    double work_s_ = 0; ///< per path, smoothed; 0 = unknown
    double last_scale_ = 0;
    double surface_s_ = 0;  ///< per frame at the scale surfaces_, smoothed; 0 = unknown
    double surfaces_ = 0.5; ///< scale of the last frame's; small until their time is known
    int drawn_ = 0;         ///< frames with such surfaces
    static constexpr int kFirstFrames = 3;
    int to_wait_ = 0, wait_ = kFirstWait; ///< frames until surfaces may grow; the same after they shrank next
    static constexpr int kFirstWait = 16, kLongestWait = 512;
    double rate_hz_ = 20; ///< of the last frame
};

} // namespace viewer
