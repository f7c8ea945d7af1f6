#include "viewer/engine/update_governor.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>

namespace viewer {
namespace {

constexpr int kLevels[] = {0, 32, 16, 8};         // axes per bounce, 0 = all
constexpr double kMost[] = {0.2, 0.2, 0.35, 1e9}; // share of the time between frames, per level
constexpr double kShareToGrow = 0.6, kAtOnce = 0.5;
constexpr int kFramesToGrow = 8, kFramesKept = 3, kQuiet = 8;

/// Number of parts that the set of axes is divided into; each bounce updates one part per frame.
int parts_of(int updated, int stored) { return updated == 0 ? 1 : std::max(1, stored / updated); }

/// Expected number of different axes updated by all bounces, which choose their parts independently.
double axes_of(int updated, gi::DynamicUpdate const& f)
{
    return f.stored * (1 - std::pow(1 - 1.0 / parts_of(updated, f.stored), f.bounces));
}

} // namespace

double UpdateGovernor::share(std::size_t level) const
{
    if (axis_s_.empty()) return 0;
    return std::ranges::min(axis_s_) * axes_of(kLevels[level], dynamic_update_) / frame_s_;
}

double UpdateGovernor::share_of_all() const { return share(0); }

void UpdateGovernor::measured(Frame const& f)
{
    quiet_ = f.moved || !may_move_ ? 0 : quiet_ + 1;
    if (!f.moved || !(f.dynamic_update.seconds >= 0) || !(f.rate_hz > 0) || f.dynamic_update.axes < 1) return;
    dynamic_update_ = f.dynamic_update;
    frame_s_ = 1 / f.rate_hz;
    bool const at_once = dynamic_update_.seconds > kAtOnce * frame_s_;
    if (at_once) axis_s_.clear();
    axis_s_.push_back(dynamic_update_.seconds / dynamic_update_.axes);
    if (axis_s_.size() > kFramesKept) axis_s_.pop_front();
    if (!at_once && axis_s_.size() < kFramesKept) return;
    while (level_ + 1 < std::size(kLevels) && share(level_) > kMost[level_]) ++level_;
    calm_ = level_ > 0 && share(level_ - 1) < kShareToGrow * kMost[level_ - 1] ? calm_ + 1 : 0;
    if (calm_ < kFramesToGrow) return;
    --level_;
    calm_ = 0;
}

int UpdateGovernor::next(bool may_move)
{
    may_move_ = may_move;
    if (may_move && quiet_ < kQuiet)
        shown_ = level_;
    else if (shown_ > 0)
        --shown_;
    return kLevels[shown_];
}

std::string schedule_sentence(std::string const& schedule, int updated, int stored, double share_of_all)
{
    if (schedule != "auto") return schedule + ", as it was set";
    if (stored == 0) return {};
    std::string const share = fmt::format("{:.0f} % of the time between frames", 100 * share_of_all);
    if (!(share_of_all > 0)) return fmt::format("stored: all {} directions; nothing has moved so far", stored);
    int const parts = parts_of(updated, stored);
    if (parts == 1)
        return fmt::format("stored: all {} directions are updated for dynamic geometry, which takes {}", stored,
                           share);
    return fmt::format(
        "stored: {} of {} directions per bounce are updated per frame, round-robin, because updating all would "
        "take {}",
        stored / parts, stored, share);
}

} // namespace viewer
