#pragma once
// Messages of VRPN 07.xx (Taylor et al., VRST 2001; the layout is described in its Format_Of_Protocol.txt).
//
// Both sides of a TCP connection first send 24 bytes, "vrpn: ver. 07.38  0" and zeros; versions must agree up to
// the last period. Then messages follow, over TCP and in UDP packets, all numbers big-endian:
//
//   u32 length   of header (24) and payload, without padding
//   u32 s, us    time on the server's clock
//   i32 sender   a device; below 0 as type: see below
//   i32 type     >= 0: as named by the server; -1 names a sender, -2 a type, -3 asks for UDP packets
//   u32          sequence number, not read
//   payload, padded to a multiple of 8 bytes
//
// Payloads: vrpn_Tracker Pos_Quat: i32 sensor, i32 unused, f64 x y z (m), f64 qx qy qz qw; Velocity: the same and
// f64 dt; vrpn_Button Change: i32 button, i32 state; vrpn_Button States: i32 n, n x i32; vrpn_Analog Channel: f64
// n, n x f64. Names: i32 length with the final zero, then the text.

#include "viewer/devices/tracking/tracker_sample.h"

#include <map>
#include <span>

namespace viewer {

/// Devices whose messages are read; of one server.
struct VrpnDevices {
    std::string tracker;  ///< poses of its sensors, called "0", "1", ...
    std::string controls; ///< buttons and analogs; empty = those of `tracker`

    bool operator==(VrpnDevices const&) const = default;
};

/// Messages of a client: its greeting; names of sender 0 (the device) and type 0 (ping);
/// a request for UDP packets; a ping, which the device answers.
std::vector<unsigned char> vrpn_greeting();
std::vector<unsigned char> vrpn_introduction(std::string const& device);
std::vector<unsigned char> vrpn_udp_wish(std::string const& own_address, int own_port);
std::vector<unsigned char> vrpn_ping();

/// Reads what a server sends. Any bytes are accepted; samples are finite and rotations unit quaternions.
class VrpnReader {
public:
    explicit VrpnReader(VrpnDevices devices) : devices_(std::move(devices)) {}

    /// Bytes of the TCP connection, in any portions. @return false if they are not VRPN: nothing more can be read
    bool take_stream(std::span<unsigned char const> bytes, TrackerPacket& packet);
    /// One UDP packet, with any number of messages.
    void take_datagram(std::span<unsigned char const> bytes, TrackerPacket& packet);

    bool greeted() const { return greeted_; }           ///< the server's greeting was right
    std::string const& fault() const { return fault_; } ///< why the stream is not VRPN
    /// True once the tracker itself has sent something; a server names any device that clients ask for.
    bool hears_device() const { return hears_device_; }

private:
    /// Reads one whole message; returns its padded length, 0 if bytes are missing, -1 if the length is impossible.
    std::ptrdiff_t take_message(std::span<unsigned char const> bytes, TrackerPacket& packet);
    void take_name(std::map<std::int32_t, std::string>& names, std::int32_t id,
                   std::span<unsigned char const> text, TrackerPacket& packet);
    void take_payload(std::string const& sender, std::string const& type, double time_s,
                      std::span<unsigned char const> payload, TrackerPacket& packet);
    void add_buttons(double time_s, TrackerPacket& packet) const;

    VrpnDevices devices_;
    std::vector<unsigned char> pending_; ///< of an incomplete message
    std::map<std::int32_t, std::string> senders_, types_;
    std::uint32_t buttons_ = 0;
    bool greeted_ = false, hears_device_ = false;
    std::string fault_;
};

} // namespace viewer
