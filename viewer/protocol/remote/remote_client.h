#pragma once
#include "viewer/protocol/remote/socket.h"

#include <chrono>
#include <nlohmann/json.hpp>

namespace viewer {

/// Client of a RemoteServer. Calls block, at most until the timeout.
class RemoteClient {
public:
    /// Sends the token of a port, if there is a file with it. @param where  a socket's path, or the digits of a
    /// local port  @param token_file  empty = default_token_file. Throws InputError if no server listens there, or
    /// if a file that was named holds no token.
    explicit RemoteClient(std::string const& where, std::filesystem::path const& token_file = {});
    /// Sends none.
    static RemoteClient without_token(std::string const& where) { return RemoteClient(connect_to(where)); }

    /// Sends a request, adding an id if it has none, and waits for its answer: {"id", "result"} or {"id",
    /// "error"}. Skips answers to earlier requests. Throws InputError on timeout, if the server closes the
    /// connection or refuses the token, or if the answer is not JSON.
    nlohmann::json ask(nlohmann::json request, std::chrono::milliseconds timeout = std::chrono::seconds(5));
    /// Sends the bytes unchanged. Throws InputError as ask does.
    void send(std::string_view bytes, std::chrono::milliseconds timeout = std::chrono::seconds(5));
    /// Returns the next line, without its newline.
    std::string receive(std::chrono::milliseconds timeout = std::chrono::seconds(5));

private:
    explicit RemoteClient(Socket socket) : socket_(std::move(socket)) {}
    std::string receive_line(std::chrono::milliseconds timeout);

    using Clock = std::chrono::steady_clock;
    void wait_for(short events, Clock::time_point until);

    Socket socket_;
    std::string in_;
    std::int64_t next_id_ = 1;
    bool sent_token_ = false; ///< whose answer has not come yet
};

} // namespace viewer
