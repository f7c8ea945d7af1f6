#pragma once
// A VRPN server for tests: its bytes are written here by the protocol's description, not by our own encoder.

#include <arpa/inet.h>
#include <bit>
#include <chrono>
#include <cstdint>
#include <cstring>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <poll.h>
#include <string>
#include <sys/socket.h>
#include <unistd.h>
#include <vector>

namespace viewer::test {

using VrpnBytes = std::vector<unsigned char>;

inline void put_big(VrpnBytes& out, std::uint64_t v, int size)
{
    for (int k = size - 1; k >= 0; --k) out.push_back((unsigned char)(v >> (8 * k)));
}
inline void put_little(VrpnBytes& out, std::uint64_t v, int size)
{
    for (int k = 0; k < size; ++k) out.push_back((unsigned char)(v >> (8 * k)));
}
inline void put_double(VrpnBytes& out, double v) { put_big(out, std::bit_cast<std::uint64_t>(v), 8); }

inline VrpnBytes vrpn_hello(std::string const& version = "vrpn: ver. 07.35")
{
    VrpnBytes b(24, 0);
    std::string const text = version + "  0";
    std::memcpy(b.data(), text.data(), text.size());
    return b;
}

inline VrpnBytes vrpn_message(std::int32_t type, std::int32_t sender, VrpnBytes const& payload,
                              double time_s = 1000)
{
    VrpnBytes b;
    put_big(b, 24 + payload.size(), 4);
    put_big(b, std::uint64_t(time_s), 4);
    put_big(b, std::uint64_t((time_s - std::uint64_t(time_s)) * 1e6 + 0.5), 4);
    put_big(b, std::uint32_t(sender), 4);
    put_big(b, std::uint32_t(type), 4);
    put_big(b, 77, 4); // a sequence number
    b.insert(b.end(), payload.begin(), payload.end());
    while (b.size() % 8 != 0) b.push_back(0xAA); // padding may hold anything
    return b;
}

inline VrpnBytes vrpn_name(std::string const& name)
{
    VrpnBytes b;
    put_big(b, name.size() + 1, 4);
    for (char const c : name) b.push_back((unsigned char)c);
    b.push_back(0);
    return b;
}

/// Types 0 to 4: pose, velocity, button, buttons, analogs. Sender 0 is Tracker0, 1 is Button0.
inline VrpnBytes vrpn_names()
{
    VrpnBytes all;
    auto const add = [&all](VrpnBytes const& b) { all.insert(all.end(), b.begin(), b.end()); };
    add(vrpn_message(-1, 0, vrpn_name("Tracker0")));
    add(vrpn_message(-1, 1, vrpn_name("Button0")));
    char const* const types[] = {"vrpn_Tracker Pos_Quat", "vrpn_Tracker Velocity", "vrpn_Button Change",
                                 "vrpn_Button States", "vrpn_Analog Channel"};
    for (std::int32_t k = 0; k < 5; ++k) add(vrpn_message(-2, k, vrpn_name(types[k])));
    return all;
}

inline VrpnBytes vrpn_pose(std::int32_t sensor, std::vector<double> const& numbers)
{
    VrpnBytes b;
    put_big(b, std::uint32_t(sensor), 4);
    put_big(b, 0, 4);
    for (double const v : numbers) put_double(b, v);
    return b;
}

inline VrpnBytes vrpn_integers(std::vector<std::int32_t> const& numbers)
{
    VrpnBytes b;
    for (std::int32_t const v : numbers) put_big(b, std::uint32_t(v), 4);
    return b;
}

inline VrpnBytes vrpn_analogs(std::vector<double> const& numbers)
{
    VrpnBytes b;
    put_double(b, double(numbers.size()));
    for (double const v : numbers) put_double(b, v);
    return b;
}

/// Listens on the loopback; one client at a time.
class VrpnServer {
public:
    /// @param port  0 = any
    explicit VrpnServer(int port = 0)
    {
        listener_ = socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0);
        int const on = 1;
        setsockopt(listener_, SOL_SOCKET, SO_REUSEADDR, &on, sizeof on);
        sockaddr_in a{};
        a.sin_family = AF_INET;
        a.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        a.sin_port = htons(std::uint16_t(port));
        EXPECT_EQ(bind(listener_, reinterpret_cast<sockaddr*>(&a), sizeof a), 0) << std::strerror(errno);
        EXPECT_EQ(listen(listener_, 4), 0);
        socklen_t size = sizeof a;
        getsockname(listener_, reinterpret_cast<sockaddr*>(&a), &size);
        port_ = ntohs(a.sin_port);
    }
    ~VrpnServer()
    {
        hang_up();
        close(listener_);
    }
    VrpnServer(VrpnServer const&) = delete;
    VrpnServer& operator=(VrpnServer const&) = delete;

    int port() const { return port_; }
    bool accept_client(int wait_ms = 2000)
    {
        pollfd p{listener_, POLLIN, 0};
        if (::poll(&p, 1, wait_ms) <= 0) return false;
        client_ = accept(listener_, nullptr, nullptr);
        return client_ >= 0;
    }
    void send(VrpnBytes const& bytes) const
    {
        EXPECT_EQ(::send(client_, bytes.data(), bytes.size(), MSG_NOSIGNAL), ssize_t(bytes.size()));
    }
    /// The bytes that the client has sent until it is silent for 50 ms.
    VrpnBytes received() const
    {
        VrpnBytes all;
        pollfd p{client_, POLLIN, 0};
        unsigned char bytes[4096];
        while (::poll(&p, 1, 50) > 0) {
            ssize_t const n = recv(client_, bytes, sizeof bytes, 0);
            if (n <= 0) break;
            all.insert(all.end(), bytes, bytes + n);
        }
        return all;
    }
    void hang_up()
    {
        if (client_ >= 0) close(client_);
        client_ = -1;
    }

private:
    int listener_ = -1, client_ = -1, port_ = 0;
};

} // namespace viewer::test
