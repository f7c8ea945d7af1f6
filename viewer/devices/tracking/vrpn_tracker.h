#pragma once
// A VRPN server as a tracker: connects by TCP, asks for UDP packets, connects again when the server is gone. Never
// waits: everything happens in poll, on sockets that do not block.

#include "viewer/devices/tracking/tracker.h"
#include "viewer/devices/tracking/udp_socket.h"
#include "viewer/devices/tracking/vrpn_messages.h"
#include "viewer/displays/vrpn_address.h"

#include <memory>

namespace viewer {

class VrpnTracker : public Tracker {
public:
    /// Finds the host (which may take as long as its name's look-up); the server need not run yet.
    /// @param controls  device of the same server whose buttons and analogs are read; empty = the tracker's own
    /// Throws InputError if the host has no address.
    VrpnTracker(VrpnAddress const& address, std::string controls);
    ~VrpnTracker() override;
    VrpnTracker(VrpnTracker const&) = delete;
    VrpnTracker& operator=(VrpnTracker const&) = delete;

    void poll(double now_s, std::vector<TrackerSample>& samples) override;
    TrackerCounts counts() const override;
    int descriptor() const override { return wakes_; }
    std::string description() const override;
    std::string fault() const override { return fault_; }

private:
    enum class State { waiting, connecting, connected };

    void start_connecting(double now_s);
    void connected(double now_s);
    void read_stream(double now_s, std::vector<TrackerSample>& samples);
    void read_datagrams(std::vector<TrackerSample>& samples);
    void take(TrackerPacket& packet, double received_s, std::vector<TrackerSample>& samples);
    void send(std::vector<unsigned char> const& bytes, double now_s);
    void drop(double now_s, std::string why);

    VrpnAddress address_;
    VrpnDevices devices_;
    std::vector<unsigned char> server_; ///< sockaddr
    int wakes_ = -1, socket_ = -1;      ///< an epoll of all sockets; the connection
    std::unique_ptr<UdpReceiver> datagrams_;
    VrpnReader reader_;
    State state_ = State::waiting;
    double next_try_s_ = 0, begun_s_ = 0, heard_s_ = 0, pinged_s_ = 0;
    std::string fault_ = "not connected yet";
    TrackerCounts counts_;
    std::uint64_t dropped_before_ = 0; ///< by the kernel, on earlier connections
};

} // namespace viewer
