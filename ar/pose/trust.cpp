#include "ar/pose/trust.h"

#include <algorithm>
#include <cmath>

namespace ar {
namespace {

constexpr double kSameTime_s = 1e-6; ///< rounding of frame times

} // namespace

std::string name_of(PoseState state)
{
    constexpr std::array<char const*, kPoseStates> names{"tracked", "predicted", "held",
                                                         "fading",  "uncertain", "lost"};
    return names[std::size_t(state)];
}

UsedPose PoseTrust::next(double time_s, OfferedPose const& offered)
{
    double const now_s = std::isfinite(time_s) ? std::max(time_s, last_s_.value_or(time_s)) : last_s_.value_or(0);
    UsedPose const used = decided(now_s, last_s_ ? now_s - *last_s_ : 0, offered);
    last_s_ = now_s;
    shown_ = used.shown;
    ++counts_[std::size_t(used.state)];
    return used;
}

UsedPose PoseTrust::decided(double time_s, double passed_s, OfferedPose const& offered)
{
    if (offered.trusted) {
        bool const at_once = settings_.fade_s <= 0 || !last_s_; // the first frame has nothing to fade from
        double const shown = at_once ? 1 : std::min(1.0, shown_ + passed_s / settings_.fade_s);
        trusted_s_ = time_s;
        pose_ = *offered.trusted;
        return {PoseState::tracked, pose_, shown, 0};
    }
    if (trusted_s_) {
        double const age_s = time_s - *trusted_s_;
        if (offered.predicted && shown_ > 0) {
            pose_ = *offered.predicted;
            return {PoseState::predicted, pose_, shown_, age_s};
        }
        double const over_s = age_s - settings_.hold_s;
        if (over_s <= kSameTime_s && shown_ > 0) return {PoseState::held, pose_, shown_, age_s};
        double const shown = settings_.fade_s > 0 ? shown_ - std::min(passed_s, over_s) / settings_.fade_s : 0;
        if (shown > kSameTime_s) return {PoseState::fading, pose_, shown, age_s};
    }
    UsedPose none;
    none.state = offered.is_estimated ? PoseState::uncertain : PoseState::lost;
    none.age_s = trusted_s_ ? time_s - *trusted_s_ : 0;
    return none;
}

} // namespace ar
