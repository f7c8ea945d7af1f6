#pragma once
#include "viewer/protocol/remote/socket.h"

#include <chrono>
#include <nlohmann/json.hpp>

namespace viewer {

/// Client of a RemoteServer. Calls block, at most until the timeout.
class RemoteClient {
public:
    /// @param where  a socket's path, or the digits of a local port. Throws InputError if no server listens there.
    explicit RemoteClient(std::string const& where) : socket_(connect_to(where)) {}

    /// Sends a request, adding an id if it has none, and waits for its answer: {"id", "result"} or {"id",
    /// "error"}. Skips answers to earlier requests. Throws InputError on timeout, if the server closes the
    /// connection, or if the answer is not JSON.
    nlohmann::json ask(nlohmann::json request, std::chrono::milliseconds timeout = std::chrono::seconds(5));
    /// Sends the bytes unchanged. Throws InputError as ask does.
    void send(std::string_view bytes, std::chrono::milliseconds timeout = std::chrono::seconds(5));
    /// Returns the next line, without its newline.
    std::string receive(std::chrono::milliseconds timeout = std::chrono::seconds(5));

private:
    using Clock = std::chrono::steady_clock;
    void wait_for(short events, Clock::time_point until);

    Socket socket_;
    std::string in_;
    std::int64_t next_id_ = 1;
};

} // namespace viewer
