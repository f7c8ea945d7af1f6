#pragma once
#include "viewer/protocol/remote/socket.h"

#include <chrono>
#include <nlohmann/json.hpp>

namespace viewer {

/// Asks a RemoteServer. Blocks, but never beyond the timeout.
class RemoteClient {
public:
    /// @param where a path, or the digits of a port of this machine. Throws InputError if nobody listens.
    explicit RemoteClient(std::string const& where) : socket_(connect_to(where)) {}

    /// Sends a request, with an id of its own if it has none, and waits for the answer to it: {"id", "result"} or
    /// {"id", "error"}. Answers to earlier requests that come meanwhile are skipped. Throws InputError after the
    /// timeout, if the server closes, or if it answers with what is no JSON.
    nlohmann::json ask(nlohmann::json request, std::chrono::milliseconds timeout = std::chrono::seconds(5));
    /// Bytes as they are; throws InputError as ask.
    void send(std::string_view bytes, std::chrono::milliseconds timeout = std::chrono::seconds(5));
    /// The next line, without its end.
    std::string receive(std::chrono::milliseconds timeout = std::chrono::seconds(5));

private:
    using Clock = std::chrono::steady_clock;
    void wait_for(short events, Clock::time_point until);

    Socket socket_;
    std::string in_;
    std::int64_t next_id_ = 1;
};

} // namespace viewer
