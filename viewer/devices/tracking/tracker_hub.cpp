#include "viewer/devices/tracking/tracker_hub.h"

#include "gi/core/error.h"
#include "gi/core/pose.h"
#include "viewer/devices/tracking/arrival_clock.h"
#include "viewer/devices/tracking/clock_offset.h"
#include "viewer/devices/tracking/vrpn_tracker.h"
#include "viewer/displays/display.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <iterator>
#include <poll.h>

namespace viewer {
namespace {

constexpr std::size_t kMostOtherBodies = 32;
constexpr int kLookAgain_ms = 2;   ///< polling interval if a source has no descriptor to wait on
constexpr int kLookAtStop_ms = 50; ///< otherwise

int port_of(TrackerSettings const& s)
{
    if (s.port >= 0) return s.port;
    return s.type == TrackerType::osc ? kOscPort : kDTrackPort;
}

std::shared_ptr<Tracker> make_source(TrackerSettings const& s)
{
    switch (s.type) {
    case TrackerType::osc:
        return make_osc_tracker(s.address, port_of(s), s.osc_patterns, s.frame_rate_hz);
    case TrackerType::dtrack:
        return make_dtrack_tracker(s.address, port_of(s), s.frame_rate_hz);
    case TrackerType::vrpn:
        return std::make_unique<VrpnTracker>(*parse_vrpn_address(s.device), s.controls);
    case TrackerType::file:
        return std::make_unique<FileTracker>(read_tracker_file(s.file), s.file.string(), s.at_end, s.speed);
    case TrackerType::fake:
        break;
    }
    return std::make_unique<FakeTracker>();
}

bool share_a_port(TrackerSettings const& a, TrackerSettings const& b)
{
    auto const has_port = [](TrackerSettings const& s) {
        return (s.type == TrackerType::osc || s.type == TrackerType::dtrack) && port_of(s) != 0;
    };
    return has_port(a) && has_port(b) && a.address == b.address && port_of(a) == port_of(b);
}

void check_packets_fit(TrackerSettings const& a, TrackerSettings const& b)
{
    auto const fault = [&](char const* why, char const* suggestion) {
        throw gi::InputError(
            fmt::format("trackers '{}' and '{}' share {} port {}", a.name, b.name, a.address, port_of(a)), why,
            suggestion);
    };
    if (a.type != b.type) fault("one speaks OSC, the other DTrack", "give each a port of its own");
    if (a.osc_patterns != b.osc_patterns || a.frame_rate_hz != b.frame_rate_hz)
        fault("they interpret its packets differently", "give both the same patterns and frame rate");
}

/// One source per settings entry; trackers at one port share a source.
std::vector<std::shared_ptr<Tracker>> make_sources(std::vector<TrackerSettings> const& settings)
{
    std::vector<std::shared_ptr<Tracker>> sources;
    for (TrackerSettings const& s : settings) {
        check(s);
        auto const first = std::find_if(settings.begin(), settings.end(),
                                        [&s](TrackerSettings const& o) { return &o == &s || share_a_port(o, s); });
        if (&*first == &s) {
            sources.push_back(make_source(s));
        } else {
            check_packets_fit(*first, s);
            sources.push_back(sources[std::size_t(first - settings.begin())]);
        }
    }
    return sources;
}

/// One body of one tracker.
struct BodyTrack {
    BodySettings settings;
    PoseTrack track;
    OneWayClockOffset clock; ///< for senders with time stamps
    ArrivalClock arrivals;   ///< for senders without
    bool on_sender_clock = false;
    double latency_s = 0;
    SampleParts clocked = SampleParts::pose; ///< parts received when the arrival clock was last updated
    RoomPose last;                           ///< in the tracker's frame; completes partial samples
    std::uint32_t buttons = 0;
    std::vector<double> axes;
    std::uint64_t not_visible = 0;

    double to_track(double local_s) const
    {
        return (on_sender_clock ? clock.to_sender(local_s) : local_s) + latency_s;
    }

    TrackedPose at(double local_s) const
    {
        TrackedPose p = track.at(to_track(local_s));
        p.age_s -= latency_s;
        return p;
    }

    /// A position and its matching rotation get the same time.
    double arrival(TrackerSample const& s)
    {
        bool const other_part = s.parts != SampleParts::pose && clocked != SampleParts::pose && s.parts != clocked;
        clocked = other_part ? SampleParts::pose : s.parts;
        return other_part ? arrivals.last_s() : arrivals.note(s.received_s);
    }

    ClockNote take(TrackerSample const& s, TrackerToRoom const& transform)
    {
        if (s.buttons) buttons = *s.buttons;
        if (!s.axes.empty()) axes = s.axes;
        not_visible += !s.visible;
        if (!s.visible || s.parts == SampleParts::buttons) return ClockNote::fits;
        if (s.parts != SampleParts::rotation) last.position = s.pose.position;
        if (s.parts != SampleParts::position) last.rotation = s.pose.rotation;
        std::optional<RoomPose> const before = at(s.received_s).pose;
        ClockNote const note = s.measured_s ? clock.note(*s.measured_s, s.received_s) : ClockNote::fits;
        if (note == ClockNote::doubtful) return note;
        if (s.measured_s.has_value() != on_sender_clock || note == ClockNote::was_set) track.restart(before);
        on_sender_clock = s.measured_s.has_value();
        RoomPose const pose = to_room(transform, last, settings.sensor_from_body);
        double const time_s = s.measured_s ? *s.measured_s : arrival(s);
        track.trust_velocity(s.measured_s ? 1 : arrivals.trust());
        track.add(time_s, pose, to_track(s.received_s));
        return note;
    }
};

std::array<BodySettings, kBodies> bodies_of(TrackerSettings const& s)
{
    return {s.head, s.left_hand, s.right_hand, s.left_foot, s.right_foot};
}

[[noreturn]] void refuse(TrackerSettings const& s, std::string const& problem, std::string const& why,
                         std::string const& suggestion)
{
    throw gi::InputError("tracker '" + s.name + "': " + problem, why, suggestion);
}

void check_filter(TrackerSettings const& s, gi::OneEuroSettings const& f, char const* what)
{
    auto const is_cutoff = [](double hz) { return hz > 0 && hz <= 1e4; };
    bool const good = is_cutoff(f.min_cutoff_hz) && is_cutoff(f.speed_cutoff_hz) &&
                      is_cutoff(f.velocity_min_cutoff_hz) && f.beta >= 0 && f.beta <= 1e4 &&
                      f.velocity_beta >= 0 && f.velocity_beta <= 1e4;
    if (!good)
        refuse(s, std::string("the filter of its ") + what + " is invalid",
               "cutoffs are above 0 and up to 10000 Hz, beta 0 to 10000", "leave the defaults");
}

void check_rigid(TrackerSettings const& s, RoomPose const& p, char const* what)
{
    if (!is_finite(p) || std::abs(glm::length(p.rotation) - 1) > 1e-3 || glm::length(p.position) > 1e6)
        refuse(s, std::string(what) + " is no rigid transform",
               "positions are finite, within 1000 km, and rotations unit quaternions", "correct it");
}

} // namespace

void check(TrackerSettings const& s)
{
    if (s.type == TrackerType::vrpn && !parse_vrpn_address(s.device))
        refuse(s, "'" + s.device.substr(0, 128) + "' is no device of VRPN",
               "it needs the device's name and its server", "write Tracker0@host, or Tracker0@host:3883");
    if (s.port < -1 || s.port > 65535)
        refuse(s, fmt::format("port {} does not exist", s.port), "ports are 1 to 65535, 0 = any",
               "choose another");
    if (!(s.frame_rate_hz >= 0 && s.frame_rate_hz <= 1e5))
        refuse(s, "its frame rate is invalid", "the range is 0 (unknown) to 100000 Hz", "write 60");
    for (BodySettings const& b : bodies_of(s)) check_rigid(s, b.sensor_from_body, "sensor_from_body");
    check_rigid(s, s.to_room.room_from_tracker, "room_from_tracker");
    if (!(s.to_room.metres_per_unit > 0 && s.to_room.metres_per_unit <= 1e6))
        refuse(s, "its unit is invalid", "it must be above 0 and at most 1e6 m", "write 0.01 for cm");
    std::vector<std::string> ids;
    for (BodySettings const& b : bodies_of(s))
        if (!b.id.empty()) ids.push_back(body_name(b.id));
    std::sort(ids.begin(), ids.end());
    if (ids.empty())
        refuse(s, "it has no body", "it would have no effect", "name the id of head, left or right hand or foot");
    if (auto const twice = std::adjacent_find(ids.begin(), ids.end()); twice != ids.end())
        refuse(s, "body '" + *twice + "' is asked for twice", "it cannot be two parts of a body at once",
               "give each its own");
    check_filter(s, s.filter.position, "positions");
    check_filter(s, s.filter.rotation, "rotations");
    PredictionSettings const& p = s.prediction;
    if (!(p.latency_s >= 0 && p.latency_s <= 1 && p.horizon_s >= 0 && p.horizon_s <= 1 && p.smooth_s >= 0 &&
          p.smooth_s <= 1 && p.recover_s >= 0 && p.recover_s <= 10 && p.lost_after_s >= dropout_after_s(p) &&
          p.lost_after_s <= 1e6))
        refuse(s, "its prediction is invalid",
               "latency, horizon and smoothing are 0 to 1 s, recovery 0 to 10 s, lost_after at least 0.1 s and "
               "two horizons",
               "leave the defaults");
}

struct TrackerHub::Source {
    TrackerSettings settings;
    std::shared_ptr<Tracker> tracker;
    std::array<BodyTrack, kBodies> bodies;
    LatencyMeter latency;
    double last_received_s = -1;
    std::uint64_t other_samples = 0;
    std::vector<std::string> other_bodies;

    Source(TrackerSettings const& s, std::shared_ptr<Tracker> t) : settings(s), tracker(std::move(t))
    {
        std::array<BodySettings, kBodies> const of = bodies_of(s);
        for (std::size_t b = 0; b < kBodies; ++b) {
            bodies[b].settings = of[b];
            bodies[b].settings.id = body_name(of[b].id);
            bodies[b].track = PoseTrack(s.filter, s.prediction);
            bodies[b].latency_s = s.prediction.latency_s;
        }
    }

    /// @return true if it belongs to an assigned body
    bool take(TrackerSample const& s)
    {
        if (s.received_s != last_received_s) { // all samples of a packet have the same time
            if (s.measured_s)
                latency.note(s.received_s, *s.measured_s);
            else
                latency.note(s.received_s);
            last_received_s = s.received_s;
        }
        bool known = false;
        std::string const name = body_name(s.body);
        for (BodyTrack& b : bodies)
            if (!b.settings.id.empty() && (b.settings.id == name || s.body == kDeviceControls)) {
                known = true;
                if (b.take(s, settings.to_room) == ClockNote::was_set) latency.forget_delays();
            }
        return known;
    }

    void note_other(std::string const& body)
    {
        ++other_samples;
        if (other_bodies.size() < kMostOtherBodies &&
            std::find(other_bodies.begin(), other_bodies.end(), body) == other_bodies.end())
            other_bodies.push_back(body);
    }
};

TrackerHub::TrackerHub(std::vector<TrackerSettings> const& settings, Polling polling)
    : TrackerHub(settings, make_sources(settings), polling)
{
}

TrackerHub::TrackerHub(std::vector<TrackerSettings> const& settings, std::vector<std::unique_ptr<Tracker>> sources,
                       Polling polling)
    : TrackerHub(settings,
                 std::vector<std::shared_ptr<Tracker>>(std::move_iterator(sources.begin()),
                                                       std::move_iterator(sources.end())),
                 polling)
{
}

TrackerHub::TrackerHub(std::vector<TrackerSettings> const& settings, std::vector<std::shared_ptr<Tracker>> sources,
                       Polling polling)
{
    for (std::size_t i = 0; i < settings.size(); ++i) {
        check(settings[i]);
        sources_.push_back(std::make_unique<Source>(settings[i], std::move(sources[i])));
    }
    if (polling == Polling::by_thread) thread_ = std::jthread([this](std::stop_token const& stop) { run(stop); });
}

TrackerHub::~TrackerHub() = default;

void TrackerHub::poll(double now_s, std::vector<TrackerSample>* samples)
{
    std::lock_guard const lock(mutex_);
    std::vector<TrackerSample> fresh;
    for (auto source = sources_.begin(); source != sources_.end(); ++source) {
        Tracker* const tracker = (*source)->tracker.get();
        auto const has_it = [tracker](auto const& s) { return s->tracker.get() == tracker; };
        if (std::any_of(sources_.begin(), source, has_it)) continue;
        fresh.clear();
        tracker->poll(now_s, fresh);
        for (TrackerSample const& s : fresh) take(*tracker, s);
        if (samples != nullptr) samples->insert(samples->end(), fresh.begin(), fresh.end());
    }
}

void TrackerHub::take(Tracker const& from, TrackerSample const& s)
{
    bool known = false;
    for (auto const& source : sources_)
        if (source->tracker.get() == &from) known |= source->take(s);
    if (known) return;
    for (auto const& source : sources_)
        if (source->tracker.get() == &from) source->note_other(s.body);
}

void TrackerHub::add_bodies(Source const& source, double time_s, BodiesAt& to)
{
    for (std::size_t b = 0; b < kBodies; ++b) {
        BodyTrack const& body = source.bodies[b];
        std::optional<RoomPose>& pose = to.tracked.*kBodyMembers[b];
        if (body.settings.id.empty() || pose) continue;
        TrackedPose const p = body.at(time_s);
        pose = p.pose;
        if (p.state != TrackState::never) to.states[b] = p.state;
        to.buttons[b] = body.buttons;
        to.axes[b] = body.axes;
    }
}

BodiesAt TrackerHub::at(double time_s) const
{
    std::lock_guard const lock(mutex_);
    BodiesAt result;
    for (auto const& source : sources_) add_bodies(*source, time_s, result);
    return result;
}

BodiesAt TrackerHub::of_tracker(std::size_t tracker, double time_s) const
{
    std::lock_guard const lock(mutex_);
    BodiesAt result;
    add_bodies(*sources_[tracker], time_s, result);
    return result;
}

std::vector<TrackerReport> TrackerHub::report(double now_s) const
{
    std::lock_guard const lock(mutex_);
    std::vector<TrackerReport> reports;
    for (auto const& source : sources_) {
        TrackerReport r;
        r.name = source->settings.name;
        r.description = source->tracker->description();
        if (auto const* udp = dynamic_cast<UdpTracker const*>(source->tracker.get())) r.port = udp->port();
        r.fault = source->tracker->fault();
        r.counts = source->tracker->counts();
        r.latency = source->latency.estimate();
        r.other_samples = source->other_samples;
        r.other_bodies = source->other_bodies;
        for (std::size_t b = 0; b < kBodies; ++b) {
            BodyTrack const& body = source->bodies[b];
            TrackedPose const p = body.at(now_s);
            r.bodies[b] = {!body.settings.id.empty(), p.state,          p.age_s,
                           body.track.counts(),       body.not_visible, body.clock.restarts(),
                           body.clock.doubtful()};
        }
        reports.push_back(std::move(r));
    }
    return reports;
}

void TrackerHub::run(std::stop_token const& stop)
{
    std::vector<pollfd> waits;
    bool all = true;
    for (auto const& source : sources_)
        if (int const d = source->tracker->descriptor(); d >= 0)
            waits.push_back({d, POLLIN, 0});
        else
            all = false;
    while (!stop.stop_requested()) {
        ::poll(waits.data(), nfds_t(waits.size()), all ? kLookAtStop_ms : kLookAgain_ms);
        poll(steady_seconds());
    }
}

} // namespace viewer
