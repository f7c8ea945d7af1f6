#pragma once
// UDP sockets at a local address.

#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <sys/socket.h>
#include <vector>

namespace viewer {

struct Datagram {
    std::vector<unsigned char> bytes;
    double received_s = 0;             ///< steady clock, when the kernel received it
    bool cut = false;                  ///< truncated, because it was too long
    std::vector<unsigned char> from{}; ///< the sender's address, 4 or 16 bytes, without its port
};

/// The bytes of an address, without its port; empty if it is not of IP.
std::vector<unsigned char> address_bytes(sockaddr_storage const& address);

/// Receives packets at one address. Invariant: bound.
class UdpReceiver {
public:
    /// @param address "127.0.0.1", "::1", or the name of an interface ("eth0": its first IPv4 address, else IPv6).
    ///   Binds to all interfaces only for an explicit 0.0.0.0 or ::.
    /// @param port 0 = any free port. Throws InputError if it cannot be bound.
    UdpReceiver(std::string const& address, int port);
    ~UdpReceiver();
    UdpReceiver(UdpReceiver const&) = delete;
    UdpReceiver& operator=(UdpReceiver const&) = delete;

    /// The next packet, without waiting.
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

    /// False if the system rejected it (no listener, no route, too long).
    bool send(std::span<unsigned char const> bytes) const;

private:
    int socket_ = -1;
};

} // namespace viewer
