#pragma once
// Moves Monado's head, eyes and hands: its remote driver (r_interface.h of Monado 25, header "mndrmt3") takes
// packets of 376 bytes over TCP, little-endian.

#include <arpa/inet.h>
#include <array>
#include <cstring>
#include <netinet/in.h>
#include <stdexcept>
#include <sys/socket.h>
#include <unistd.h>

namespace viewer::test {

struct RemotePose {
    std::array<float, 4> rotation{0, 0, 0, 1}; ///< x, y, z, w
    std::array<float, 3> position{};
};

struct RemoteEye {
    std::array<float, 4> fov_rad{}; ///< left, right, up, down
    RemotePose from_head;
};

/// A TCP port of the loopback that nobody listens to.
inline int free_port()
{
    int const s = socket(AF_INET, SOCK_STREAM, 0);
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    bool const good = bind(s, reinterpret_cast<sockaddr*>(&at), size) == 0 &&
                      getsockname(s, reinterpret_cast<sockaddr*>(&at), &size) == 0;
    close(s);
    if (!good) throw std::runtime_error("no free port");
    return ntohs(at.sin_port);
}

class RemoteDriver {
public:
    explicit RemoteDriver(int port) : socket_(socket(AF_INET, SOCK_STREAM, 0))
    {
        sockaddr_in at{};
        at.sin_family = AF_INET;
        at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        at.sin_port = htons(static_cast<std::uint16_t>(port));
        if (connect(socket_, reinterpret_cast<sockaddr*>(&at), sizeof at) != 0)
            throw std::runtime_error("Monado's remote driver does not answer");
        for (int packet = 0; packet < 2; ++packet) // where it begins, and where it is
            for (std::size_t have = 0; have < bytes_.size();) {
                ssize_t const got = recv(socket_, bytes_.data() + have, bytes_.size() - have, 0);
                if (got <= 0) throw std::runtime_error("Monado's remote driver hung up");
                have += std::size_t(got);
            }
    }
    ~RemoteDriver() { close(socket_); }
    RemoteDriver(RemoteDriver const&) = delete;
    RemoteDriver& operator=(RemoteDriver const&) = delete;

    void set_head(RemotePose const& pose) { put(104, pose); }
    void set_eyes(std::array<RemoteEye, 2> const& eyes)
    {
        for (std::size_t e = 0; e < 2; ++e) {
            put(8 + 48 * e, eyes[e].fov_rad);
            put(24 + 48 * e, eyes[e].from_head);
        }
        put(132, true);
    }
    /// A controller of Valve's Index: pose, thumb stick, button A.
    void set_hand(std::size_t hand, RemotePose const& pose, std::array<float, 2> const& stick, bool a_pressed)
    {
        std::size_t const at = 136 + 120 * hand;
        put(at, pose);
        put(at + 84, stick);
        put(at + 105, true); // it is there
        put(at + 108, a_pressed);
    }
    void send_all() const
    {
        if (send(socket_, bytes_.data(), bytes_.size(), MSG_NOSIGNAL) != ssize_t(bytes_.size()))
            throw std::runtime_error("Monado's remote driver takes nothing");
    }

private:
    template <class T>
    void put(std::size_t at, T const& value)
    {
        std::memcpy(bytes_.data() + at, &value, sizeof value);
    }

    int socket_;
    std::array<unsigned char, 376> bytes_{};
};

static_assert(sizeof(RemotePose) == 28 && sizeof(RemoteEye) == 44);

} // namespace viewer::test
