#pragma once
// All trackers of a session: polled by the caller or by the hub's own thread; poses can be requested for any time.

#include "viewer/devices/tracking/fake_tracker.h"
#include "viewer/devices/tracking/latency.h"
#include "viewer/devices/tracking/pose_track.h"
#include "viewer/devices/tracking/tracker_file.h"
#include "viewer/devices/tracking/tracker_to_room.h"
#include "viewer/devices/tracking/udp_tracker.h"

#include <memory>
#include <thread>

namespace viewer {

enum class TrackerType { osc, dtrack, vrpn, file, fake };
enum class Body { head, left_hand, right_hand, left_foot, right_foot };
inline constexpr std::size_t kBodies = kBodyMembers.size();

/// Assignment of a tracker's bodies. Empty: the tracker has none.
struct BodySettings {
    std::string id; ///< name used by the sender
    /// Pose of the midpoint between the eyes, the grip, or the sole relative to the marker; m.
    RoomPose sensor_from_body;
};

struct TrackerSettings {
    std::string name = "tracker"; ///< for messages and logs
    TrackerType type = TrackerType::osc;
    std::string address = "127.0.0.1"; ///< osc, dtrack: local address, or the name of an interface
    int port = -1;                     ///< -1: default of the type; 0: any free port
    std::vector<OscPattern> osc_patterns = default_osc_patterns();
    double frame_rate_hz = 0;   ///< osc, dtrack without time stamps: rate of the sender's counter; 0 = unknown
    std::string device;         ///< vrpn: Tracker0@host[:port]
    std::string controls;       ///< vrpn: device of the same server with buttons and analogs; empty = `device`'s
    std::filesystem::path file; ///< for type file: the file to play
    AtEnd at_end = AtEnd::stop;
    double speed = 1;
    BodySettings head{"head", {}}, left_hand{"left_hand", {}}, right_hand{"right_hand", {}};
    BodySettings left_foot{"left_foot", {}}, right_foot{"right_foot", {}};
    TrackerToRoom to_room;
    FilterSettings filter;
    PredictionSettings prediction;
};

/// Throws InputError that names an invalid setting.
void check(TrackerSettings const& settings);

struct BodyReport {
    bool configured = false;
    TrackState state = TrackState::never;
    double age_s = 0; ///< of its newest sample
    TrackCounts counts;
    std::uint64_t not_visible = 0;    ///< samples marked as not visible
    std::uint64_t clock_restarts = 0; ///< times the sender's clock was set
    std::uint64_t doubtful_times = 0; ///< samples rejected because of their time stamp
};

struct TrackerReport {
    std::string name, description;
    std::string fault; ///< why nothing is received now, if that is known
    int port = 0;      ///< 0 = none
    TrackerCounts counts;
    Latency latency;
    std::uint64_t other_samples = 0;       ///< of bodies that are not assigned
    std::vector<std::string> other_bodies; ///< their names, at most 32
    std::array<BodyReport, kBodies> bodies;
};

/// Body poses at one time.
struct BodiesAt {
    Tracked tracked;
    std::array<TrackState, kBodies> states{};
    std::array<std::uint32_t, kBodies> buttons{};
    std::array<std::vector<double>, kBodies> axes{}; ///< of joysticks; empty = the body has none
};

enum class Polling { by_caller, by_thread };

/// Safe to call from any thread. If several trackers have a body, the first with a pose of it is used.
class TrackerHub {
public:
    /// Binds sockets and reads files. Trackers of one protocol at one address and port
    /// share a socket. Throws InputError.
    TrackerHub(std::vector<TrackerSettings> const& settings, Polling polling);
    /// Uses given sources, one per settings entry (whose type, address and file are then ignored).
    TrackerHub(std::vector<TrackerSettings> const& settings, std::vector<std::unique_ptr<Tracker>> sources,
               Polling polling);
    ~TrackerHub();
    TrackerHub(TrackerHub const&) = delete;
    TrackerHub& operator=(TrackerHub const&) = delete;

    /// Processes received samples. Needed only if the caller polls. Optionally also returns the raw samples, in
    /// the tracker's frame.
    void poll(double now_s, std::vector<TrackerSample>* samples = nullptr);
    /// Poses predicted for a time of the steady clock (s), e.g. a picture's display time.
    BodiesAt at(double time_s) const;
    /// Poses from one tracker only; index in the settings, from 0.
    BodiesAt of_tracker(std::size_t tracker, double time_s) const;
    /// Statistics per tracker; counts include everything received on its port.
    /// @param now_s for the states and ages
    std::vector<TrackerReport> report(double now_s) const;

private:
    struct Source;

    TrackerHub(std::vector<TrackerSettings> const& settings, std::vector<std::shared_ptr<Tracker>> sources,
               Polling polling);
    void take(Tracker const& from, TrackerSample const& sample);
    static void add_bodies(Source const& source, double time_s, BodiesAt& to);
    void run(std::stop_token const& stop);

    mutable std::mutex mutex_;
    std::vector<std::unique_ptr<Source>> sources_;
    std::jthread thread_; ///< declared last, so that it ends first
};

} // namespace viewer
