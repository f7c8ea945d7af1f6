#include "viewer/devices/tracking/udp_socket.h"

#include "gi/core/error.h"
#include "viewer/devices/tracking/tracker_sample.h"

#include <algorithm>
#include <arpa/inet.h>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fmt/format.h>
#include <ifaddrs.h>
#include <memory>
#include <net/if.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace viewer {
namespace {

constexpr std::size_t kLargestDatagram = 65536;
constexpr int kReceiveBuffer = 1 << 20;

struct Address {
    sockaddr_storage storage{};
    socklen_t size = 0;

    sockaddr* get() { return reinterpret_cast<sockaddr*>(&storage); }
    int family() const { return storage.ss_family; }
};

std::optional<Address> numeric(std::string const& text, int port)
{
    Address a;
    auto& v4 = reinterpret_cast<sockaddr_in&>(a.storage);
    auto& v6 = reinterpret_cast<sockaddr_in6&>(a.storage);
    if (inet_pton(AF_INET, text.c_str(), &v4.sin_addr) == 1) {
        v4.sin_family = AF_INET;
        v4.sin_port = htons(std::uint16_t(port));
        a.size = sizeof v4;
        return a;
    }
    if (inet_pton(AF_INET6, text.c_str(), &v6.sin6_addr) == 1) {
        v6.sin6_family = AF_INET6;
        v6.sin6_port = htons(std::uint16_t(port));
        a.size = sizeof v6;
        return a;
    }
    return std::nullopt;
}

std::string to_text(Address const& a)
{
    char text[INET6_ADDRSTRLEN] = "";
    void const* const from =
        a.family() == AF_INET ? static_cast<void const*>(&reinterpret_cast<sockaddr_in const&>(a.storage).sin_addr)
                              : &reinterpret_cast<sockaddr_in6 const&>(a.storage).sin6_addr;
    inet_ntop(a.family(), from, text, sizeof text);
    return text;
}

std::optional<Address> of_interface(std::string const& name, int port)
{
    ifaddrs* list = nullptr;
    if (getifaddrs(&list) != 0) return std::nullopt;
    std::unique_ptr<ifaddrs, decltype(&freeifaddrs)> const guard(list, &freeifaddrs);
    for (int const family : {AF_INET, AF_INET6})
        for (ifaddrs const* i = list; i != nullptr; i = i->ifa_next) {
            if (i->ifa_addr == nullptr || i->ifa_addr->sa_family != family || name != i->ifa_name) continue;
            Address a;
            a.size = family == AF_INET ? sizeof(sockaddr_in) : sizeof(sockaddr_in6);
            std::memcpy(&a.storage, i->ifa_addr, a.size);
            if (family == AF_INET)
                reinterpret_cast<sockaddr_in&>(a.storage).sin_port = htons(std::uint16_t(port));
            else
                reinterpret_cast<sockaddr_in6&>(a.storage).sin6_port = htons(std::uint16_t(port));
            return a;
        }
    return std::nullopt;
}

void check_port(int port, int lowest)
{
    if (port < lowest || port > 65535)
        throw gi::InputError(fmt::format("port {} does not exist", port),
                             fmt::format("ports are {} to 65535", lowest), "choose another");
}

double seconds(timespec const& t) { return double(t.tv_sec) + 1e-9 * double(t.tv_nsec); }

/// Converts a recent wall-clock time to the steady clock.
double steady_at(double wall_s)
{
    timespec wall{};
    clock_gettime(CLOCK_REALTIME, &wall);
    double const now = steady_seconds(), age = seconds(wall) - wall_s;
    return age >= 0 && age < 10 ? now - age : now; // otherwise the wall clock was set meanwhile
}

} // namespace

double steady_seconds()
{
    return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
}

UdpReceiver::UdpReceiver(std::string const& address, int port) : buffer_(kLargestDatagram)
{
    check_port(port, 0);
    std::string const where = fmt::format("{} port {}", address, port);
    std::optional<Address> a = numeric(address, port);
    if (!a) a = of_interface(address, port);
    if (!a)
        throw gi::InputError("cannot receive at " + where,
                             "it is neither an address nor an interface with an address",
                             "write 127.0.0.1, or the name of a network interface (ip addr lists them)");
    socket_ = socket(a->family(), SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    int const on = 1;
    if (socket_ >= 0) {
        setsockopt(socket_, SOL_SOCKET, SO_TIMESTAMPNS, &on, sizeof on);
        setsockopt(socket_, SOL_SOCKET, SO_RXQ_OVFL, &on, sizeof on);
        setsockopt(socket_, SOL_SOCKET, SO_RCVBUF, &kReceiveBuffer, sizeof kReceiveBuffer);
        if (a->family() == AF_INET6) setsockopt(socket_, IPPROTO_IPV6, IPV6_V6ONLY, &on, sizeof on);
    }
    if (socket_ < 0 || bind(socket_, a->get(), a->size) != 0) {
        std::string const why = std::strerror(errno);
        if (socket_ >= 0) close(socket_);
        throw gi::InputError("cannot receive at " + where, why, "choose another port or address of this machine");
    }
    Address bound;
    bound.size = sizeof bound.storage;
    getsockname(socket_, bound.get(), &bound.size);
    address_ = to_text(bound);
    port_ = ntohs(bound.family() == AF_INET ? reinterpret_cast<sockaddr_in&>(bound.storage).sin_port
                                            : reinterpret_cast<sockaddr_in6&>(bound.storage).sin6_port);
}

std::vector<unsigned char> address_bytes(sockaddr_storage const& a)
{
    auto const bytes = [](auto const& address) {
        auto const* const first = reinterpret_cast<unsigned char const*>(&address);
        return std::vector<unsigned char>(first, first + sizeof address);
    };
    if (a.ss_family == AF_INET) return bytes(reinterpret_cast<sockaddr_in const&>(a).sin_addr);
    return a.ss_family == AF_INET6 ? bytes(reinterpret_cast<sockaddr_in6 const&>(a).sin6_addr)
                                   : std::vector<unsigned char>();
}

UdpReceiver::~UdpReceiver() { close(socket_); }

std::optional<Datagram> UdpReceiver::receive()
{
    iovec data{buffer_.data(), buffer_.size()};
    alignas(cmsghdr) char control[256];
    msghdr message{};
    message.msg_iov = &data;
    message.msg_iovlen = 1;
    sockaddr_storage from{};
    message.msg_name = &from;
    message.msg_namelen = sizeof from;
    message.msg_control = control;
    message.msg_controllen = sizeof control;
    ssize_t n = -1;
    do n = recvmsg(socket_, &message, MSG_DONTWAIT);
    while (n < 0 && errno == EINTR);
    if (n < 0) return std::nullopt;
    Datagram d;
    d.bytes.assign(buffer_.begin(), buffer_.begin() + n);
    d.from = address_bytes(from);
    d.cut = (message.msg_flags & MSG_TRUNC) != 0;
    d.received_s = steady_seconds();
    for (cmsghdr* c = CMSG_FIRSTHDR(&message); c != nullptr; c = CMSG_NXTHDR(&message, c)) {
        if (c->cmsg_level != SOL_SOCKET) continue;
        if (c->cmsg_type == SCM_TIMESTAMPNS) {
            timespec t{};
            std::memcpy(&t, CMSG_DATA(c), sizeof t);
            d.received_s = steady_at(seconds(t));
        } else if (c->cmsg_type == SO_RXQ_OVFL) {
            std::uint32_t dropped = 0;
            std::memcpy(&dropped, CMSG_DATA(c), sizeof dropped);
            dropped_ = dropped;
        }
    }
    return d;
}

UdpSender::UdpSender(std::string const& address, int port)
{
    check_port(port, 1);
    std::optional<Address> a = numeric(address, port);
    if (a) socket_ = socket(a->family(), SOCK_DGRAM | SOCK_CLOEXEC, 0);
    if (!a || socket_ < 0 || connect(socket_, a->get(), a->size) != 0) {
        std::string const why = a ? std::strerror(errno) : "it is not a numeric address";
        if (socket_ >= 0) close(socket_);
        throw gi::InputError(fmt::format("cannot send to {} port {}", address, port), why, "write 127.0.0.1");
    }
}

UdpSender::~UdpSender() { close(socket_); }

bool UdpSender::send(std::span<unsigned char const> bytes) const
{
    return ::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) == ssize_t(bytes.size());
}

} // namespace viewer
