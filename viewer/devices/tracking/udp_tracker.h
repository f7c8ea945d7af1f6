#pragma once
// Trackers that send UDP packets: OSC and ART DTrack.

#include "viewer/devices/tracking/osc.h"
#include "viewer/devices/tracking/sequence.h"
#include "viewer/devices/tracking/tracker.h"
#include "viewer/devices/tracking/udp_socket.h"

#include <functional>
#include <map>

namespace viewer {

inline constexpr int kOscPort = 9000;
inline constexpr int kDTrackPort = 5000;

class UdpTracker : public Tracker {
public:
    using Parse = std::function<TrackerPacket(std::span<unsigned char const>)>;

    /// @param name  of the protocol, for messages
    /// @param frame_rate_hz  for senders that count frames but send no time:
    /// measured_s = frame / rate; 0 = unknown
    UdpTracker(std::string name, std::string const& address, int port, Parse parse, double frame_rate_hz = 0);

    void poll(double now_s, std::vector<TrackerSample>& samples) override;
    TrackerCounts counts() const override;
    int descriptor() const override { return socket_.descriptor(); }
    std::string description() const override;
    int port() const { return socket_.port(); }

    /// Processes one packet; called by poll.
    void take(std::span<unsigned char const> bytes, double received_s, std::vector<TrackerSample>& samples);

private:
    std::string name_;
    UdpReceiver socket_;
    Parse parse_;
    double frame_rate_hz_;
    TrackerCounts counts_;
    Sequence packets_;
    std::map<std::string, Sequence> bodies_; ///< by "body/parts"; at most kMostBodies
};

/// Throws InputError if a pattern is invalid or the address cannot be bound.
std::unique_ptr<UdpTracker> make_osc_tracker(std::string const& address, int port,
                                             std::vector<OscPattern> patterns = default_osc_patterns(),
                                             double frame_rate_hz = 0);
std::unique_ptr<UdpTracker> make_dtrack_tracker(std::string const& address, int port, double frame_rate_hz = 0);

} // namespace viewer
