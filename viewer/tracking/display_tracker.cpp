#include "viewer/tracking/display_tracker.h"

namespace viewer {

TrackerSettings tracker_settings(DisplayTracker const& t)
{
    TrackerSettings s;
    s.name = t.name;
    s.type = t.type == DisplayTrackerType::osc      ? TrackerType::osc
             : t.type == DisplayTrackerType::dtrack ? TrackerType::dtrack
             : t.type == DisplayTrackerType::file   ? TrackerType::file
                                                    : TrackerType::fake;
    s.address = t.address;
    s.port = t.port > 0 ? t.port : -1;
    s.file = t.file;
    s.at_end = AtEnd::begin_again;
    std::string body = t.body;
    if (!body.empty() && body[0] == '/') body.erase(0, 1); // of OSC, the display has a path
    if (!body.empty()) s.head.id = body;
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
