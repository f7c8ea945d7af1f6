#include "viewer/protocol/remote/socket.h"

#include "gi/core/error.h"
#include "gi/core/text.h"

#include <arpa/inet.h>
#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <sys/un.h>
#include <unistd.h>

namespace viewer {
namespace {

constexpr int kBacklog = 128;

sockaddr_un address_of(std::filesystem::path const& path)
{
    sockaddr_un address{};
    address.sun_family = AF_UNIX;
    std::string const text = path.string();
    if (text.empty() || text.size() >= sizeof address.sun_path)
        throw gi::InputError(
            "'" + text + "' cannot be a socket",
            fmt::format("its path has {} bytes, 1 to {} are allowed", text.size(), sizeof address.sun_path - 1),
            "choose a shorter one");
    std::memcpy(address.sun_path, text.c_str(), text.size() + 1);
    return address;
}

sockaddr_in loopback(int port)
{
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    address.sin_port = htons(std::uint16_t(port));
    return address;
}

Socket make_socket(int family, int flags)
{
    Socket s(::socket(family, SOCK_STREAM | SOCK_CLOEXEC | flags, 0));
    if (!s.is_open())
        throw gi::InputError("no socket can be made", std::strerror(errno), "check the limits of this machine");
    return s;
}

template <class Address>
int bind_to(Socket const& s, Address const& address)
{
    return ::bind(s.fd(), reinterpret_cast<sockaddr const*>(&address), sizeof address) == 0 ? 0 : errno;
}

template <class Address>
int connect_with(Socket const& s, Address const& address)
{
    return ::connect(s.fd(), reinterpret_cast<sockaddr const*>(&address), sizeof address) == 0 ? 0 : errno;
}

/// Removes a stale socket at the path.
void remove_stale(std::filesystem::path const& path, sockaddr_un const& address)
{
    struct stat about {};
    if (::lstat(path.c_str(), &about) != 0) return;
    if (!S_ISSOCK(about.st_mode))
        throw gi::InputError("'" + path.string() + "' cannot be a socket", "the path exists and is not a socket",
                             "choose another path");
    Socket const probe = make_socket(AF_UNIX, SOCK_NONBLOCK);
    int const error = connect_with(probe, address);
    if (error == 0 || error == EAGAIN)
        throw gi::InputError("'" + path.string() + "' cannot be used", "another program listens there",
                             "choose another path, or end that program");
    if (error != ECONNREFUSED)
        throw gi::InputError("'" + path.string() + "' cannot be used", std::strerror(error),
                             "choose another path");
    ::unlink(path.c_str());
}

} // namespace

Socket::~Socket()
{
    if (fd_ >= 0) ::close(fd_);
}

Socket listen_at(std::filesystem::path const& path)
{
    sockaddr_un const address = address_of(path);
    remove_stale(path, address);
    Socket s = make_socket(AF_UNIX, SOCK_NONBLOCK);
    int error = bind_to(s, address);
    // No client can connect before listen(), so the socket is never open with wider permissions.
    if (error == 0 && (::chmod(path.c_str(), 0600) != 0 || ::listen(s.fd(), kBacklog) != 0)) error = errno;
    if (error != 0)
        throw gi::InputError("cannot listen at '" + path.string() + "'", std::strerror(error),
                             "choose another path");
    return s;
}

Socket listen_on_loopback(int& port)
{
    if (port < 0 || port > 65535)
        throw gi::InputError(fmt::format("port {} cannot be", port), "ports are 1 to 65535, 0 = a free one",
                             "choose another");
    Socket s = make_socket(AF_INET, SOCK_NONBLOCK);
    int const yes = 1;
    ::setsockopt(s.fd(), SOL_SOCKET, SO_REUSEADDR, &yes, sizeof yes);
    int error = bind_to(s, loopback(port));
    if (error == 0 && ::listen(s.fd(), kBacklog) != 0) error = errno;
    sockaddr_in bound{};
    socklen_t size = sizeof bound;
    if (error == 0 && ::getsockname(s.fd(), reinterpret_cast<sockaddr*>(&bound), &size) != 0) error = errno;
    if (error != 0)
        throw gi::InputError(fmt::format("cannot listen on port {}", port), std::strerror(error),
                             "choose another port, or 0");
    port = ntohs(bound.sin_port);
    return s;
}

Socket connect_to(std::string const& where)
{
    auto const port = gi::parse_number<int>(where);
    if (port && (*port < 1 || *port > 65535))
        throw gi::InputError("cannot connect to port " + where, "ports are 1 to 65535",
                             "use the port that the viewer printed");
    Socket s = make_socket(port ? AF_INET : AF_UNIX, 0);
    int const error = port ? connect_with(s, loopback(*port)) : connect_with(s, address_of(where));
    if (error != 0)
        throw gi::InputError("cannot connect to '" + where + "'", std::strerror(error),
                             "start lightwell view with --remote first");
    int const yes = 1;
    if (port) ::setsockopt(s.fd(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
    return s;
}

} // namespace viewer
