#include "viewer/devices/tracking/vrpn_tracker.h"

#include "gi/core/error.h"

#include <arpa/inet.h>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <netdb.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/epoll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace viewer {
namespace {

constexpr double kTryAgain_s = 1;     ///< after a failed or lost connection
constexpr double kLongestStart_s = 5; ///< for the connection, and for the server's greeting
constexpr double kPing_s = 2;         ///< of silence, after which the device is asked for a sign of life
constexpr double kSilence_s = 8;      ///< after which the server counts as gone
constexpr int kMostReads = 256;       ///< per poll, so that a flood does not block the frame

std::vector<unsigned char> find_server(VrpnAddress const& a)
{
    addrinfo wanted{};
    wanted.ai_socktype = SOCK_STREAM;
    wanted.ai_flags = AI_NUMERICSERV;
    addrinfo* found = nullptr;
    int const failure = getaddrinfo(a.host.c_str(), std::to_string(a.port).c_str(), &wanted, &found);
    if (failure != 0 || found == nullptr)
        throw gi::InputError("there is no host '" + a.host + "'", gai_strerror(failure),
                             "correct the device: Tracker0@host:3883");
    auto const* const bytes = reinterpret_cast<unsigned char const*>(found->ai_addr);
    std::vector<unsigned char> server(bytes, bytes + found->ai_addrlen);
    freeaddrinfo(found);
    return server;
}

/// The address from which a socket reaches its server.
std::string own_address(int socket)
{
    sockaddr_storage own{};
    socklen_t size = sizeof own;
    if (getsockname(socket, reinterpret_cast<sockaddr*>(&own), &size) != 0) return {};
    char text[INET6_ADDRSTRLEN] = "";
    void const* const from = own.ss_family == AF_INET
                                 ? static_cast<void const*>(&reinterpret_cast<sockaddr_in const&>(own).sin_addr)
                                 : &reinterpret_cast<sockaddr_in6 const&>(own).sin6_addr;
    inet_ntop(own.ss_family, from, text, sizeof text);
    return text;
}

/// The address of the server that a socket is connected to.
std::vector<unsigned char> server_of(int socket)
{
    sockaddr_storage server{};
    socklen_t size = sizeof server;
    if (getpeername(socket, reinterpret_cast<sockaddr*>(&server), &size) != 0) return {};
    return address_bytes(server);
}

void watch(int wakes, int descriptor, std::uint32_t events)
{
    epoll_event event{};
    event.events = events;
    epoll_ctl(wakes, EPOLL_CTL_DEL, descriptor, nullptr);
    epoll_ctl(wakes, EPOLL_CTL_ADD, descriptor, &event);
}

} // namespace

VrpnTracker::VrpnTracker(VrpnAddress const& address, std::string controls)
    : address_(address),
      devices_{address.device, std::move(controls)},
      server_(find_server(address)),
      wakes_(epoll_create1(EPOLL_CLOEXEC)),
      reader_(devices_)
{
}

VrpnTracker::~VrpnTracker()
{
    if (socket_ >= 0) close(socket_);
    if (wakes_ >= 0) close(wakes_);
}

void VrpnTracker::start_connecting(double now_s)
{
    auto const* const to = reinterpret_cast<sockaddr const*>(server_.data());
    socket_ = socket(to->sa_family, SOCK_STREAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    if (socket_ < 0) return drop(now_s, std::strerror(errno));
    int const on = 1;
    setsockopt(socket_, IPPROTO_TCP, TCP_NODELAY, &on, sizeof on);
    state_ = State::connecting;
    begun_s_ = now_s;
    if (connect(socket_, to, socklen_t(server_.size())) == 0) return connected(now_s);
    if (errno != EINPROGRESS) return drop(now_s, std::strerror(errno));
    watch(wakes_, socket_, EPOLLOUT);
}

void VrpnTracker::connected(double now_s)
{
    state_ = State::connected;
    begun_s_ = heard_s_ = pinged_s_ = now_s;
    reader_ = VrpnReader(devices_);
    watch(wakes_, socket_, EPOLLIN);
    send(vrpn_greeting(), now_s);
}

void VrpnTracker::send(std::vector<unsigned char> const& bytes, double now_s)
{
    if (socket_ < 0) return;
    // A few hundred bytes fit into any socket's buffer; one that takes less belongs
    // to a server that reads nothing.
    if (::send(socket_, bytes.data(), bytes.size(), MSG_NOSIGNAL) != ssize_t(bytes.size()))
        drop(now_s, "the server does not take requests");
}

void VrpnTracker::drop(double now_s, std::string why)
{
    if (state_ == State::connected && reader_.greeted()) ++counts_.disconnects;
    if (socket_ >= 0) close(socket_);
    socket_ = -1;
    if (datagrams_) dropped_before_ += datagrams_->dropped_by_kernel();
    datagrams_.reset();
    state_ = State::waiting;
    next_try_s_ = now_s + kTryAgain_s;
    fault_ = std::move(why);
}

void VrpnTracker::poll(double now_s, std::vector<TrackerSample>& samples)
{
    if (state_ == State::waiting && now_s >= next_try_s_) start_connecting(now_s);
    if (state_ == State::connecting) {
        int failure = 0;
        socklen_t size = sizeof failure;
        epoll_event event;
        if (epoll_wait(wakes_, &event, 1, 0) > 0) {
            getsockopt(socket_, SOL_SOCKET, SO_ERROR, &failure, &size);
            if (failure != 0) return drop(now_s, std::strerror(failure));
            connected(now_s);
        } else if (now_s > begun_s_ + kLongestStart_s) {
            return drop(now_s, "the host does not answer");
        }
    }
    if (state_ != State::connected) return;
    read_datagrams(samples);
    read_stream(now_s, samples);
    if (state_ != State::connected) return;
    if (!reader_.greeted() && now_s > begun_s_ + kLongestStart_s)
        drop(now_s, "the server sends no greeting");
    else if (now_s > heard_s_ + kSilence_s)
        drop(now_s, "the server is silent");
    else if (reader_.greeted() && now_s > std::max(heard_s_, pinged_s_) + kPing_s) {
        pinged_s_ = now_s;
        send(vrpn_ping(), now_s);
    }
}

void VrpnTracker::read_stream(double now_s, std::vector<TrackerSample>& samples)
{
    unsigned char bytes[4096];
    for (int i = 0; i < kMostReads && socket_ >= 0; ++i) {
        ssize_t const n = recv(socket_, bytes, sizeof bytes, 0);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0 && (errno == EAGAIN || errno == EWOULDBLOCK)) return;
        if (n <= 0) return drop(now_s, n == 0 ? "the server closed the connection" : std::strerror(errno));
        heard_s_ = now_s;
        bool const was_greeted = reader_.greeted();
        TrackerPacket packet;
        bool const good = reader_.take_stream({bytes, std::size_t(n)}, packet);
        take(packet, steady_seconds(), samples);
        if (!good) return drop(now_s, reader_.fault());
        if (!was_greeted && reader_.greeted()) {
            ++counts_.connects;
            if (std::string const own = own_address(socket_); !own.empty() && !address_.tcp_only) try {
                    datagrams_ = std::make_unique<UdpReceiver>(own, 0);
                    watch(wakes_, datagrams_->descriptor(), EPOLLIN);
                    send(vrpn_udp_wish(own, datagrams_->port()), now_s);
                } catch (gi::InputError const&) { // then all messages come by TCP
                    datagrams_.reset();
                }
            send(vrpn_introduction(devices_.tracker), now_s);
            send(vrpn_ping(), now_s);
        }
        if (reader_.greeted())
            fault_ = reader_.hears_device()
                         ? ""
                         : "the server has no device '" + devices_.tracker + "', or it is silent";
    }
}

void VrpnTracker::read_datagrams(std::vector<TrackerSample>& samples)
{
    for (int i = 0; datagrams_ && i < kMostReads; ++i) {
        auto const datagram = datagrams_->receive();
        if (!datagram) return;
        if (datagram->from != server_of(socket_)) { // anybody could send poses
            ++counts_.ignored;
            continue;
        }
        heard_s_ = std::max(heard_s_, datagram->received_s);
        TrackerPacket packet;
        reader_.take_datagram(datagram->bytes, packet);
        if (reader_.hears_device()) fault_.clear();
        take(packet, datagram->received_s, samples);
    }
}

void VrpnTracker::take(TrackerPacket& packet, double received_s, std::vector<TrackerSample>& samples)
{
    ++counts_.packets;
    counts_.malformed += packet.malformed;
    counts_.ignored += packet.ignored;
    counts_.samples += packet.samples.size();
    for (TrackerSample& s : packet.samples) {
        s.received_s = received_s;
        samples.push_back(std::move(s));
    }
}

TrackerCounts VrpnTracker::counts() const
{
    TrackerCounts c = counts_;
    c.dropped_by_kernel = dropped_before_ + (datagrams_ ? datagrams_->dropped_by_kernel() : 0);
    return c;
}

std::string VrpnTracker::description() const
{
    return fmt::format("vrpn {}@{}:{}", address_.device, address_.host, address_.port);
}

} // namespace viewer
