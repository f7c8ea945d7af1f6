#include "viewer/engine/governor.h"

#include <algorithm>
#include <cmath>
#include <iterator>
#include <utility>

namespace viewer {
namespace {

constexpr double kBesides = 1.0; // k (governor.h), in paths
constexpr double kMargin = 0.85; // of the time between frames
/// Sizes of light, and the share of the wished rate that must hold with them: light at a quarter of the size is
/// further from the truth than pictures that come less often, since these follow the head anyway.
struct LightSize {
    double scale, rate;
};
// Steps of a quarter of the work below half the size.
constexpr LightSize kLightSizes[] = {{1, 1},        {0.75, 1},       {0.5, 1},
                                     {0.4375, 0.5}, {0.390625, 0.5}, {0.35, 0.5},
                                     {0.3125, 0.5}, {0.28, 0.5},     {Governor::kLeastScale, 0}};
constexpr double kSurfaceScales[] = {1, 0.75, 0.5};
constexpr int kMostPaths = 256;
constexpr double kLeast = 0.05; // of a frame's work that the next one gets
/// A larger picture must fit with this margin, because a change of size costs sharpness and reused light.
constexpr double kToGrow = 1.15;
/// Share of the time between frames for surfaces if they are larger than half the size:
/// antialiasing makes smaller ones nearly as sharp at the size of the view.
constexpr double kForSurfaces = 0.3;

/// Smooths times (0 = none yet): single slow frames count little, fast ones show what is possible.
double smoothed(double before, double now)
{
    return before > 0 ? before + (now < before ? 0.5 : 0.1) * (now - before) : now;
}

} // namespace

double Governor::surfaces_scale() const
{
    if (surface_s_ == 0) return surfaces_;
    for (double const scale : kSurfaceScales) {
        if (scale > surfaces_ && to_wait_ > 0) continue;
        // In smaller pictures, a larger share of the time does not depend on the size.
        double const expected_s = surface_s_ * std::pow(scale / surfaces_, scale > surfaces_ ? 1.3 : 2.0);
        if (expected_s * rate_hz_ <= kForSurfaces) return scale;
    }
    return kSurfaceScales[std::size(kSurfaceScales) - 1];
}

FrameBudget Governor::next(double pixels, bool still, FrameBudget fixed, bool own_surfaces) const
{
    double const frame_s = kMargin / rate_hz_,
                 free_s = std::max(frame_s - (own_surfaces ? surface_s_ : 0), kLeast * frame_s);
    FrameBudget b;
    for (LightSize const& size : kLightSizes) {
        b.scale = size.scale;
        double const grows = last_scale_ > 0 && size.scale > last_scale_ ? kToGrow : 1,
                     of_one_path = pixels * size.scale * size.scale * (1 + kBesides) * grows,
                     // Single slow frames must not change the size where the rate may fall anyway.
            needed_s = size.rate < 1 && work_s_ > 0 ? work_s_ * of_one_path : free_s * of_one_path / work_;
        if (size.rate * (needed_s + frame_s - free_s) <= frame_s) break;
    }
    if (still) b.scale = 1;
    if (fixed.scale > 0) b.scale = fixed.scale;
    b.paths = fixed.paths > 0 ? fixed.paths
                              : std::clamp(int(work_ / (pixels * b.scale * b.scale) - kBesides), 1, kMostPaths);
    b.surfaces = own_surfaces && !(fixed.scale > 0) ? std::max(b.scale, surfaces_scale()) : b.scale;
    return b;
}

void Governor::measured(FrameBudget const& budget, double pixels, double seconds, double rate_hz,
                        double surfaces_s)
{
    constexpr double kGrowth = 1.25;
    double const done = pixels * budget.scale * budget.scale * (budget.paths + kBesides);
    double const light_s = seconds - surfaces_s, free_s = std::max(kMargin / rate_hz - surfaces_s, 0.0);
    double const fits = free_s / light_s;
    if (!(done > 0) || !(light_s > 0)) return; // nothing was rendered, or in no time
    // Paths are whole numbers: the remainder accumulates until it allows one more.
    work_ = fits < 1 ? done * std::max(fits, kLeast) : std::min(kGrowth * std::max(work_, done), done * fits);
    work_s_ = smoothed(work_s_, light_s / done);
    last_scale_ = budget.scale;
    rate_hz_ = rate_hz;
    if (!(surfaces_s > 0)) return;
    if (++drawn_ <= kFirstFrames) return; // they build what lasts
    to_wait_ = std::max(0, to_wait_ - 1);
    if (budget.surfaces != surfaces_) {
        surface_s_ = 0;
        if (budget.surfaces < surfaces_) to_wait_ = std::exchange(wait_, std::min(2 * wait_, kLongestWait));
    }
    surfaces_ = budget.surfaces;
    surface_s_ = smoothed(surface_s_, surfaces_s);
}

} // namespace viewer
