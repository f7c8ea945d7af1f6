#include "viewer/engine/governor.h"

#include <algorithm>
#include <cmath>
#include <iterator>

namespace viewer {
namespace {

constexpr double kBesides = 1.0; // k (governor.h), in paths
constexpr double kMargin = 0.85; // of the time between frames
constexpr double kScales[] = {1, 0.75, 0.5, 0.375, 0.25};
constexpr int kMostPaths = 256;
/// A larger picture must fit with this margin, because a change of size discards the temporally reused light.
constexpr double kToGrow = 1.15;

} // namespace

FrameBudget Governor::next(double pixels, bool still, FrameBudget fixed) const
{
    auto const paths_at = [&](double scale) { return work_ / (pixels * scale * scale) - kBesides; };
    FrameBudget b;
    b.scale = kScales[std::size(kScales) - 1];
    for (double const scale : kScales) {
        double const needed = last_scale_ > 0 && scale > last_scale_ ? kToGrow * (1 + kBesides) - kBesides : 1;
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

void Governor::measured(FrameBudget const& budget, double pixels, double seconds, double rate_hz)
{
    constexpr double kLeast = 0.05, kGrowth = 1.25;
    double const done = pixels * budget.scale * budget.scale * (budget.paths + kBesides);
    double const fits = kMargin / rate_hz / seconds;
    if (!(done > 0) || !(fits > 0)) return; // nothing was rendered, or in no time
    // Paths are whole numbers: the remainder accumulates until it allows one more.
    work_ = fits < 1 ? done * std::max(fits, kLeast) : std::min(kGrowth * std::max(work_, done), done * fits);
    last_scale_ = budget.scale;
}

} // namespace viewer
