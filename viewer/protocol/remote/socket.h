#pragma once
// Local sockets only: a Unix socket (path), or a port of 127.0.0.1.

#include <filesystem>
#include <string>
#include <utility>

namespace viewer {

/// A file descriptor that closes itself.
class Socket {
public:
    Socket() = default;
    explicit Socket(int fd) : fd_(fd) {}
    Socket(Socket&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}
    Socket& operator=(Socket&& other) noexcept
    {
        std::swap(fd_, other.fd_);
        return *this;
    }
    ~Socket();

    int fd() const { return fd_; }
    bool is_open() const { return fd_ >= 0; }

private:
    int fd_ = -1;
};

/// Listens at a path; only the owner may connect (permissions 600). Replaces a stale socket. Throws InputError if
/// a program listens there, the path is something else, or is too long.
Socket listen_at(std::filesystem::path const& path);
/// Listens on a port; 0 = any free port. `port` is set to the port in use. Throws InputError if it is taken.
Socket listen_on_loopback(int& port);
/// Connects to a path, or to a port given by its digits. Throws InputError if no program listens there.
Socket connect_to(std::string const& where);

} // namespace viewer
