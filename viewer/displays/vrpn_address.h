#pragma once
// Addresses of VRPN trackers.

#include <optional>
#include <string>
#include <string_view>

namespace viewer {

inline constexpr int kVrpnPort = 3883;

/// A tracker's address as VRPN writes it: Tracker0@host, Tracker0@host:3883, Tracker0@tcp://host:3883 (no UDP
/// packets); IPv6 addresses in brackets.
struct VrpnAddress {
    std::string device, host;
    int port = kVrpnPort;
    bool tcp_only = false;
};
/// Empty if the text has another form.
std::optional<VrpnAddress> parse_vrpn_address(std::string_view text);

} // namespace viewer
