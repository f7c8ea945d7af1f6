#pragma once
// Sockets of this machine only: a path, or a port of 127.0.0.1.

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

/// Only its owner may connect (permissions 600). A socket left by a program that is gone is replaced; throws
/// InputError where one listens, where something else lies, or on a path that is too long.
Socket listen_at(std::filesystem::path const& path);
/// Port 0 = one that is free; `port` becomes the one chosen. Throws InputError if it is taken.
Socket listen_on_loopback(int& port);
/// `where` is a path, or the digits of a port. Throws InputError if nobody listens.
Socket connect_to(std::string const& where);

} // namespace viewer
