#include "study/script/read.h"

namespace study {
namespace {

constexpr double kMost_deg = 60, kMinute_ms = 60000;

bool is_none(gi::Yaml const& y) { return y.is_text() && y.text() == "none"; }

/// Sets a number if the key is there.
void take_number(gi::Yaml const& y, char const* key, double low, double high, double& value, Mistakes& m)
{
    m.take(y, key, [&](gi::Yaml const& v) { value = v.number(low, high); });
}

/// Removes the rule for `none`, else reads it.
template <class Rule, class Read>
void take_rule(gi::Yaml const& y, char const* key, std::optional<Rule>& rule, Mistakes& m, Read const& read)
{
    m.take(y, key, [&](gi::Yaml const& v) {
        rule.reset();
        if (is_none(v)) return;
        m.check_keys(v, ("gaze_" + std::string(key)).c_str());
        read(v, rule.emplace());
    });
}

void read_start(gi::Yaml const& y, GazeFixation& f, Mistakes& m)
{
    take_number(y, "within_deg", 0.01, kMost_deg, f.within_deg, m);
    take_number(y, "for_ms", 1, kMinute_ms, f.for_ms, m);
    take_number(y, "timeout_ms", 1, 10 * kMinute_ms, f.timeout_ms, m);
    if (f.timeout_ms <= f.for_ms)
        throw y.error("a timeout before the fixation could be long enough", "no trial would begin",
                      "raise timeout_ms above for_ms");
}

void read_hold(gi::Yaml const& y, GazeHold& h, Mistakes& m)
{
    take_number(y, "within_deg", 0.01, kMost_deg, h.within_deg, m);
    take_number(y, "grace_ms", 0, kMinute_ms, h.grace_ms, m);
}

void read_follow(gi::Yaml const& y, GazeCircleRule& f, Mistakes& m)
{
    m.take(y, "show", [&](gi::Yaml const& v) {
        f.kind = GazeFollow(v.one_of({"window", "mask"}, "thing that follows gaze"));
    });
    take_number(y, "radius_deg", 0.01, kMost_deg, f.radius_deg, m);
    take_number(y, "edge_deg", 0, kMost_deg, f.edge_deg, m);
}

} // namespace

void read_gaze(gi::Yaml const& y, GazeRules& gaze, Mistakes& m)
{
    m.check_keys(y, "gaze");
    take_rule(y, "start", gaze.start, m, [&](auto const& v, auto& rule) { read_start(v, rule, m); });
    take_rule(y, "hold", gaze.hold, m, [&](auto const& v, auto& rule) { read_hold(v, rule, m); });
    take_rule(y, "follow", gaze.moving, m, [&](auto const& v, auto& rule) { read_follow(v, rule, m); });
}

} // namespace study
