#include "viewer/app/user_tracking.h"

#include "gi/core/error.h"
#include "viewer/devices/tracking/display_tracker.h"

namespace viewer {

UserTracking::UserTracking(Display const& display) : display_(display)
{
    std::vector<TrackerSettings> settings;
    for (DisplayTracker const& t : display.trackers) {
        Source s;
        if (t.type == DisplayTrackerType::openxr) {
            s.headset = std::make_unique<HmdSession>(HmdOptions{});
        } else {
            s.in_hub = settings.size();
            settings.push_back(tracker_settings(t));
        }
        sources_.push_back(std::move(s));
    }
    if (!settings.empty()) hub_ = std::make_unique<TrackerHub>(settings, Polling::by_thread);
}

Tracked UserTracking::of(Source& source, double steady_s) const
{
    if (!source.headset) return hub_->of_tracker(source.in_hub, steady_s).tracked;
    source.headset->poll();
    auto const poses = source.headset->poses(steady_s);
    return poses ? poses->tracked : Tracked{};
}

std::vector<std::optional<RoomPose>> UserTracking::heads(double steady_s)
{
    std::vector<std::optional<RoomPose>> heads;
    for (User const& u : display_.users)
        heads.push_back(u.tracker < 0 ? std::nullopt : of(sources_[std::size_t(u.tracker)], steady_s).head);
    return heads;
}

Tracked UserTracking::bodies(std::size_t user, double steady_s)
{
    if (user >= display_.users.size() || display_.users[user].tracker < 0) return {};
    return of(sources_[std::size_t(display_.users[user].tracker)], steady_s);
}

std::vector<WandState> UserTracking::wands(double steady_s) const
{
    std::vector<WandState> all;
    for (std::size_t t = 0; t < sources_.size(); ++t) {
        if (!display_.trackers[t].wand) continue;
        BodiesAt const now = hub_->of_tracker(sources_[t].in_hub, steady_s); // its body is the hub's head
        bool const fresh = now.states[0] == TrackState::tracked;
        all.push_back({now.tracked.head, fresh, now.buttons[0], now.axes[0]});
    }
    return all;
}

std::optional<double> UserTracking::age_ms(double steady_s) const
{
    if (display_.users.empty() || display_.users[0].tracker < 0) return std::nullopt;
    Source const& s = sources_[std::size_t(display_.users[0].tracker)];
    if (s.headset) return std::nullopt;
    BodyReport const head = hub_->report(steady_s)[s.in_hub].bodies[0];
    return head.state != TrackState::never ? std::optional(1e3 * head.age_s) : std::nullopt;
}

nlohmann::json UserTracking::stats(double steady_s) const
{
    nlohmann::json all = nlohmann::json::object();
    if (!hub_) return all;
    for (TrackerReport const& r : hub_->report(steady_s)) {
        nlohmann::json& j = all[r.name] = {{"packets", r.counts.packets},
                                           {"malformed", r.counts.malformed},
                                           {"port", r.port},
                                           {"head_age_ms", 1e3 * r.bodies[0].age_s}};
        if (r.counts.connects + r.counts.disconnects > 0 || !r.fault.empty()) {
            j["connects"] = r.counts.connects;
            j["disconnects"] = r.counts.disconnects;
            j["fault"] = r.fault;
        }
        for (auto const& [what, value] : numbers(r.latency)) j[what] = value;
    }
    return all;
}

} // namespace viewer
