#include "study/script/read.h"

namespace study {
namespace {

bool is_none(gi::Yaml const& y) { return y.is_text() && y.text() == "none"; }

/// Sets a number if the key is there.
void take_number(gi::Yaml const& y, char const* key, double low, double high, double& value)
{
    if (y.has(key)) value = y.at(key).number(low, high);
}

} // namespace

void read_gaze(gi::Yaml const& y, GazeRules& gaze)
{
    constexpr double kMost_deg = 60, kMinute_ms = 60000;
    check_keys(y, "gaze");
    if (y.has("start")) {
        gi::Yaml const start = y.at("start");
        gaze.start.reset();
        if (!is_none(start)) {
            check_keys(start, "gaze_start");
            GazeFixation& f = gaze.start.emplace();
            take_number(start, "within_deg", 0.01, kMost_deg, f.within_deg);
            take_number(start, "for_ms", 1, kMinute_ms, f.for_ms);
            take_number(start, "timeout_ms", 1, 10 * kMinute_ms, f.timeout_ms);
            if (f.timeout_ms <= f.for_ms)
                throw start.error("a timeout before the fixation could be long enough", "no trial would begin",
                                  "raise timeout_ms above for_ms");
        }
    }
    if (y.has("hold")) {
        gi::Yaml const hold = y.at("hold");
        gaze.hold.reset();
        if (!is_none(hold)) {
            check_keys(hold, "gaze_hold");
            GazeHold& h = gaze.hold.emplace();
            take_number(hold, "within_deg", 0.01, kMost_deg, h.within_deg);
            take_number(hold, "grace_ms", 0, kMinute_ms, h.grace_ms);
        }
    }
    if (!y.has("follow")) return;
    gi::Yaml const follow = y.at("follow");
    gaze.moving.reset();
    if (is_none(follow)) return;
    check_keys(follow, "gaze_follow");
    GazeCircleRule& m = gaze.moving.emplace();
    if (follow.has("show"))
        m.kind = GazeFollow(follow.at("show").one_of({"window", "mask"}, "thing that follows gaze"));
    take_number(follow, "radius_deg", 0.01, kMost_deg, m.radius_deg);
    take_number(follow, "edge_deg", 0, kMost_deg, m.edge_deg);
}

} // namespace study
