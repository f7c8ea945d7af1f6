#pragma once
// All trackers of a session: polled by the caller or on a thread of its own, asked for the bodies at any time.

#include "viewer/devices/tracking/fake_tracker.h"
#include "viewer/devices/tracking/latency.h"
#include "viewer/devices/tracking/pose_track.h"
#include "viewer/devices/tracking/tracker_file.h"
#include "viewer/devices/tracking/tracker_to_room.h"
#include "viewer/devices/tracking/udp_tracker.h"

#include <memory>
#include <thread>

namespace viewer {

enum class TrackerType { osc, dtrack, file, fake };
enum class Body { head, left_hand, right_hand, left_foot, right_foot };
inline constexpr std::size_t kBodies = kBodyMembers.size();

/// Which body of a tracker is which. Empty: the tracker has none.
struct BodySettings {
    std::string id;            ///< as its sender names it
    RoomPose sensor_from_body; ///< the middle between the eyes, the grip, or the sole, seen from the marker; m
};

struct TrackerSettings {
    std::string name = "tracker"; ///< for messages and logs
    TrackerType type = TrackerType::osc;
    std::string address = "127.0.0.1"; ///< osc, dtrack: of this machine, or the name of an interface
    int port = -1;                     ///< -1: the usual one of the type; 0: any that is free
    std::vector<OscPattern> osc_patterns = default_osc_patterns();
    double frame_rate_hz = 0;   ///< osc, dtrack without time stamps: of the sender's counter; 0 = not known
    std::filesystem::path file; ///< file: what is played
    AtEnd at_end = AtEnd::stop;
    double speed = 1;
    BodySettings head{"head", {}}, left_hand{"left_hand", {}}, right_hand{"right_hand", {}};
    BodySettings left_foot{"left_foot", {}}, right_foot{"right_foot", {}};
    TrackerToRoom to_room;
    FilterSettings filter;
    PredictionSettings prediction;
};

/// Throws InputError that names the setting.
void check(TrackerSettings const& settings);

struct BodyReport {
    bool configured = false;
    TrackState state = TrackState::never;
    double age_s = 0; ///< of its newest sample
    TrackCounts counts;
    std::uint64_t not_visible = 0;    ///< samples that said so
    std::uint64_t clock_restarts = 0; ///< the sender's clock was set
    std::uint64_t doubtful_times = 0; ///< samples not used for their time stamp
};

struct TrackerReport {
    std::string name, description;
    int port = 0; ///< 0 = none
    TrackerCounts counts;
    Latency latency;
    std::uint64_t other_samples = 0;       ///< of bodies that are not asked for
    std::vector<std::string> other_bodies; ///< their names, at most 32
    std::array<BodyReport, kBodies> bodies;
};

/// Bodies at one time.
struct BodiesAt {
    Tracked tracked;
    std::array<TrackState, kBodies> states{};
    std::array<std::uint32_t, kBodies> buttons{};
};

enum class Polling { by_caller, by_thread };

/// Safe to call from any thread. Where several trackers have a body, the first that has a pose of it counts.
class TrackerHub {
public:
    /// Binds, reads files. Trackers of one protocol at one address and port share a socket. Throws InputError.
    TrackerHub(std::vector<TrackerSettings> const& settings, Polling polling);
    /// With sources made by others, one per settings (whose type, address and file then are not read).
    TrackerHub(std::vector<TrackerSettings> const& settings, std::vector<std::unique_ptr<Tracker>> sources,
               Polling polling);
    ~TrackerHub();
    TrackerHub(TrackerHub const&) = delete;
    TrackerHub& operator=(TrackerHub const&) = delete;

    /// Takes what has come. Needed where polling is by the caller. Samples are passed on as well, if asked for: as
    /// they came, in the tracker's frame.
    void poll(double now_s, std::vector<TrackerSample>* samples = nullptr);
    /// Poses expected at that time of the steady clock (s): of the display, for a picture.
    BodiesAt at(double time_s) const;
    /// Of one of the trackers alone, as they were given from 0.
    BodiesAt of_tracker(std::size_t tracker, double time_s) const;
    /// Per tracker; counts are of all that came to the port. @param now_s for the states and ages
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
    std::jthread thread_; ///< last: ends first
};

} // namespace viewer
