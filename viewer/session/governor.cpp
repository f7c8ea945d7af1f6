#include "viewer/session/governor.h"

#include <algorithm>
#include <cmath>

namespace viewer {
namespace {

constexpr double kBesides = 1.0; // k, in paths
constexpr double kMargin = 0.85; // of the time between frames
constexpr double kScales[] = {1, 0.75, 0.5, 0.375, 0.25};
constexpr int kMostPaths = 256;
/// A larger picture has to fit by so much: a change of size costs the light that was reused.
constexpr double kToGrow = 1.3;

} // namespace

FrameBudget Governor::next(double rate_hz, double pixels, bool still, FrameBudget fixed) const
{
    double const time_s = kMargin / rate_hz;
    auto const paths_at = [&](double scale) {
        return time_s / (per_pixel_path_s_ * pixels * scale * scale) - kBesides;
    };
    FrameBudget b;
    b.scale = kScales[std::size(kScales) - 1];
    for (double const scale : kScales) {
        double const needed = scale > last_scale_ ? kToGrow * (1 + kBesides) - kBesides : 1;
        if (paths_at(scale) >= needed) {
            b.scale = scale;
            break;
        }
    }
    if (still) b.scale = 1;
    if (fixed.scale > 0) b.scale = fixed.scale;
    b.paths = fixed.paths > 0 ? fixed.paths : std::clamp(int(paths_at(b.scale)), 1, kMostPaths);
    return b;
}

void Governor::measured(FrameBudget const& budget, double pixels, double seconds)
{
    double const now = seconds / (pixels * budget.scale * budget.scale * (budget.paths + kBesides));
    if (!(now > 0) || !std::isfinite(now)) return;
    constexpr double kSlowly = 0.1;
    per_pixel_path_s_ =
        !known_ || now > per_pixel_path_s_ ? now : per_pixel_path_s_ + kSlowly * (now - per_pixel_path_s_);
    known_ = true;
    last_scale_ = budget.scale;
}

} // namespace viewer
