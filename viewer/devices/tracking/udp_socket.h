#pragma once
// UDP at one address of this machine.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace viewer {

struct Datagram {
    std::vector<unsigned char> bytes;
    double received_s = 0; ///< steady clock, when the kernel had it
    bool cut = false;      ///< longer than what is accepted
};

/// Receives what comes to one address. Invariant: bound.
class UdpReceiver {
public:
    /// @param address "127.0.0.1", "::1", or the name of an interface ("eth0": its first IPv4 address, else IPv6).
    ///   All interfaces only where 0.0.0.0 or :: is written out.
    /// @param port 0 = any that is free. Throws InputError where it cannot be bound.
    UdpReceiver(std::string const& address, int port);
    ~UdpReceiver();
    UdpReceiver(UdpReceiver const&) = delete;
    UdpReceiver& operator=(UdpReceiver const&) = delete;

    /// The next one, without waiting.
    std::optional<Datagram> receive();
    int port() const { return port_; }
    std::string const& address() const { return address_; } ///< numeric
    int descriptor() const { return socket_; }
    std::uint64_t dropped_by_kernel() const { return dropped_; }

private:
    int socket_ = -1, port_ = 0;
    std::string address_;
    std::uint64_t dropped_ = 0;
    std::vector<unsigned char> buffer_;
};

/// Sends to one address.
class UdpSender {
public:
    /// @param address numeric. Throws InputError.
    UdpSender(std::string const& address, int port);
    ~UdpSender();
    UdpSender(UdpSender const&) = delete;
    UdpSender& operator=(UdpSender const&) = delete;

    /// False where the machine did not take it (nobody listens, no route, too long).
    bool send(std::span<unsigned char const> bytes) const;

private:
    int socket_ = -1;
};

} // namespace viewer
