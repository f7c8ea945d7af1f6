#pragma once
// Remote control of a running program. Requests arrive as lines of JSON from many clients and are
// passed to one handler, between frames and without blocking. A client cannot stop the program,
// whatever it sends or leaves unread.

#include "gi/core/report.h"
#include "viewer/protocol/remote/remote_token.h"
#include "viewer/protocol/remote/request.h"
#include "viewer/protocol/remote/socket.h"

#include <chrono>
#include <functional>
#include <map>
#include <optional>

namespace viewer {

struct RemoteLimits {
    std::size_t line_bytes = std::size_t(1) << 20;   ///< per request
    std::size_t output_bytes = std::size_t(4) << 20; ///< a client with more unread answers is dropped
    std::size_t clients = 64;                        ///< at once; further ones get an error and are closed
    std::size_t waiting = 64;                        ///< pending requests of one client
    std::size_t lines_per_poll = 32;                 ///< per client; the rest wait for the next poll
    std::chrono::milliseconds without_token{10000};  ///< after which a client that sends no token is closed
};

struct RemoteOptions {
    std::filesystem::path socket; ///< empty = none
    std::optional<int> port;      ///< of 127.0.0.1; 0 = any free port
    RemoteLimits limits{};
    bool open = false;             ///< every account of this machine may use the port, without a token
    std::filesystem::path token{}; ///< file for the port's token; empty = default_token_file
};

class RemoteServer {
public:
    /// Returns the result of a request; none = RemoteServer::answer follows later.
    /// Throws gi::InputError to reject the request.
    using Handler = std::function<std::optional<nlohmann::json>(RemoteRequest const&)>;

    /// Throws InputError if it cannot listen. @param report  receives dropped clients; must outlive this
    RemoteServer(RemoteOptions const& options, Handler handler, gi::Report& report);
    /// Closes all connections and removes the socket's file.
    ~RemoteServer();
    RemoteServer(RemoteServer const&) = delete;
    RemoteServer& operator=(RemoteServer const&) = delete;

    /// Accepts clients, reads requests, calls the handler and sends answers;
    /// waits at most `timeout` for the first event.
    void poll(std::chrono::milliseconds timeout = {});
    /// Answers a request whose handler returned no result. @return false if the client is gone or already answered
    bool answer(std::uint64_t token, nlohmann::json const& result);
    bool refuse(std::uint64_t token, std::string const& error);
    /// Adds a connected socket, e.g. one of a pair.
    void adopt(Socket connection) { adopt(std::move(connection), Trust::full); }

    int port() const { return port_; } ///< 0 = none
    /// Where clients of the port find its token; empty = none is needed.
    std::filesystem::path token_file() const { return token_ ? token_->file() : std::filesystem::path(); }
    std::size_t clients() const { return clients_.size(); }
    std::size_t waiting() const { return waiting_.size(); } ///< number of pending requests

private:
    enum class Trust { full, needs_token };
    using Clock = std::chrono::steady_clock;

    struct Client {
        Socket socket;
        Trust trust = Trust::full;
        Clock::time_point since = Clock::now();
        std::string in, out;
        std::size_t searched = 0; ///< bytes of `in` known to have no newline
        std::size_t waiting = 0;  ///< pending requests
        bool spoke = false;       ///< its first line was an object
        bool skipping = false;    ///< discarding the rest of a line that is too long
        bool ended = false;       ///< it has closed its sending side
        bool closing = false;     ///< close once `out` is sent
        bool dead = false;
    };
    struct Waiting {
        std::uint64_t client;
        nlohmann::json id;
    };

    void adopt(Socket connection, Trust trust);
    void accept_from(Socket const& listener, Trust trust);
    /// A line that holds a token and nothing else. @return false if the line is a request
    bool take_token(std::uint64_t number, Client& client, nlohmann::json const& line);
    void refuse_stranger(std::uint64_t number, Client& client, nlohmann::json const& id,
                         std::string const& problem);
    void receive(Client& client);
    void handle_lines(std::uint64_t number, Client& client);
    void handle_line(std::uint64_t number, Client& client, std::string_view line);
    void dispatch(std::uint64_t number, Client& client, nlohmann::json const& request);
    bool finish(std::uint64_t token, char const* kind, nlohmann::json const& value);
    void send(std::uint64_t number, Client& client, nlohmann::ordered_json const& answer);
    void send_error(std::uint64_t number, Client& client, nlohmann::json const& id, std::string const& error);
    void flush(Client& client);
    void forget_dead();
    static bool has_line(Client& client);

    RemoteLimits limits_;
    Handler handler_;
    gi::Report& report_;
    std::filesystem::path path_;
    std::uint64_t path_inode_ = 0;
    int port_ = 0;
    std::optional<TokenFile> token_;
    Socket at_path_, on_port_;
    std::map<std::uint64_t, Client> clients_;
    std::map<std::uint64_t, Waiting> waiting_;
    std::uint64_t next_client_ = 1, next_token_ = 1;
};

/// "remote control at 127.0.0.1:4242, token in FILE"
std::string describe_port(RemoteServer const& server);

} // namespace viewer
