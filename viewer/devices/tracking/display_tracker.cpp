#include "viewer/devices/tracking/display_tracker.h"

#include <algorithm>
#include <array>
#include <utility>

namespace viewer {

TrackerSettings tracker_settings(DisplayTracker const& t)
{
    TrackerSettings s;
    s.name = t.name;
    s.type = t.type == DisplayTrackerType::osc      ? TrackerType::osc
             : t.type == DisplayTrackerType::dtrack ? TrackerType::dtrack
             : t.type == DisplayTrackerType::vrpn   ? TrackerType::vrpn
             : t.type == DisplayTrackerType::file   ? TrackerType::file
                                                    : TrackerType::fake;
    s.address = t.address;
    s.port = t.port > 0 ? t.port : -1;
    s.device = t.device;
    s.controls = t.controls;
    s.file = t.file;
    s.at_end = AtEnd::begin_again;
    auto const name = [](BodySettings& body, std::string const& id) {
        if (!id.empty()) body.id = body_name(id);
    };
    name(s.head, t.body);
    name(s.left_hand, t.left_hand_body);
    name(s.right_hand, t.right_hand_body);
    name(s.left_foot, t.left_foot_body);
    name(s.right_foot, t.right_foot_body);
    // A name that the display file assigns to one body is not used as the default of another.
    std::array const limbs{
        std::pair{&s.left_hand, &t.left_hand_body}, std::pair{&s.right_hand, &t.right_hand_body},
        std::pair{&s.left_foot, &t.left_foot_body}, std::pair{&s.right_foot, &t.right_foot_body}};
    for (auto const& [limb, stated] : limbs) {
        if (!stated->empty()) continue;
        bool const is_given = std::ranges::any_of(limbs, [&id = limb->id](auto const& other) {
            return !other.second->empty() && other.first->id == id;
        });
        if (is_given || limb->id == s.head.id) limb->id.clear();
    }
    s.to_room.room_from_tracker = pose_of(t.room_from_tracker);
    s.prediction.latency_s = 1e-3 * t.latency_ms;
    s.filter.enabled = t.filter.type == FilterType::one_euro;
    if (s.filter.enabled) {
        s.filter.position.min_cutoff_hz = t.filter.min_cutoff_hz;
        s.filter.position.beta = t.filter.beta_per_m;
    }
    return s;
}

} // namespace viewer
