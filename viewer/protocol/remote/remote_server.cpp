#include "viewer/protocol/remote/remote_server.h"

#include "gi/core/error.h"
#include "viewer/protocol/json_text.h"

#include <cerrno>
#include <cstring>
#include <fmt/format.h>
#include <netinet/in.h>
#include <netinet/tcp.h>
#include <poll.h>
#include <sys/socket.h>
#include <sys/stat.h>
#include <unistd.h>

namespace viewer {
namespace {

constexpr std::size_t kMostStrangers = 8; // clients that have not sent a token yet
constexpr std::size_t kReadAtOnce = 65536;
constexpr int kAcceptAtOnce = 256;
constexpr std::size_t kLongestTokenLine = 4096;

std::uint64_t inode_of(std::filesystem::path const& path)
{
    struct stat about {};
    return ::lstat(path.c_str(), &about) == 0 ? about.st_ino : 0;
}

nlohmann::ordered_json error_answer(nlohmann::json const& id, std::string const& error)
{
    return {{"id", id}, {"error", error}};
}

} // namespace

RemoteServer::RemoteServer(RemoteOptions const& options, Handler handler, gi::Report& report)
    : limits_(options.limits), handler_(std::move(handler)), report_(report)
{
    if (options.port) {
        port_ = *options.port;
        on_port_ = listen_on_loopback(port_);
        if (!options.open) token_.emplace(options.token.empty() ? default_token_file(port_) : options.token);
    }
    if (!options.socket.empty()) {
        at_path_ = listen_at(options.socket);
        path_ = std::filesystem::absolute(options.socket);
        path_inode_ = inode_of(path_);
    }
}

RemoteServer::~RemoteServer()
{
    if (path_inode_ != 0 && inode_of(path_) == path_inode_) ::unlink(path_.c_str());
}

void RemoteServer::adopt(Socket connection, Trust trust)
{
    Client& client = clients_[next_client_++];
    client.trust = trust;
    client.socket = std::move(connection);
    int const yes = 1; // fails on Unix sockets, which do not need it
    ::setsockopt(client.socket.fd(), IPPROTO_TCP, TCP_NODELAY, &yes, sizeof yes);
}

void RemoteServer::accept_from(Socket const& listener, Trust trust)
{
    for (int i = 0; i < kAcceptAtOnce; ++i) {
        Socket connection(::accept4(listener.fd(), nullptr, nullptr, SOCK_NONBLOCK | SOCK_CLOEXEC));
        if (!connection.is_open()) {
            if (errno == EINTR || errno == ECONNABORTED) continue;
            if (errno != EAGAIN) report_.lose("remote clients not accepted", 1, std::strerror(errno));
            return;
        }
        if (trust == Trust::needs_token) { // strangers never fill the places of others
            std::size_t strangers = 0;
            auto oldest = clients_.end();
            for (auto c = clients_.begin(); c != clients_.end(); ++c) {
                if (c->second.trust != Trust::needs_token || c->second.closing) continue;
                ++strangers;
                if (oldest == clients_.end() || c->second.since < oldest->second.since) oldest = c;
            }
            if (strangers >= kMostStrangers)
                refuse_stranger(oldest->first, oldest->second, nullptr, "too many clients without a token");
        }
        if (clients_.size() < limits_.clients) {
            adopt(std::move(connection), trust);
            continue;
        }
        std::string const line =
            json_line(error_answer(
                nullptr, fmt::format("no place is left ({} clients are connected) close one", clients_.size()))) +
            "\n";
        ::send(connection.fd(), line.data(), line.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        report_.lose("remote clients not accepted", 1, "there were too many at once");
    }
}

void RemoteServer::poll(std::chrono::milliseconds timeout)
{
    std::vector<pollfd> fds;
    std::vector<std::uint64_t> numbers; // client numbers for fds[2] and following
    fds.push_back({at_path_.fd(), POLLIN, 0});
    fds.push_back({on_port_.fd(), POLLIN, 0}); // poll ignores -1
    bool is_busy = false;
    for (auto& [number, client] : clients_) {
        bool const may_read = !client.ended && !client.closing && !has_line(client);
        is_busy = is_busy || has_line(client);
        fds.push_back(
            {client.socket.fd(), short((may_read ? POLLIN : 0) | (client.out.empty() ? 0 : POLLOUT)), 0});
        numbers.push_back(number);
    }
    if (::poll(fds.data(), nfds_t(fds.size()), is_busy ? 0 : int(timeout.count())) < 0) return; // a signal
    for (std::size_t i = 0; i < numbers.size(); ++i) {
        Client& client = clients_.at(numbers[i]);
        pollfd const& fd = fds[i + 2];
        if ((fd.revents & POLLOUT) != 0) flush(client);
        if ((fd.events & POLLIN) != 0 && fd.revents != 0) receive(client);
        handle_lines(numbers[i], client);
        bool const is_stranger = client.trust == Trust::needs_token && !client.closing && !client.dead;
        if (is_stranger && Clock::now() - client.since > limits_.without_token)
            refuse_stranger(numbers[i], client, nullptr, "no token came in time");
        else if (is_stranger && client.in.size() > kLongestTokenLine)
            refuse_stranger(numbers[i], client, nullptr, "the first line is no token");
        // Hung up: no reader is left.
        if ((fd.revents & (POLLHUP | POLLERR)) != 0 && (fd.events & POLLIN) == 0 && !has_line(client))
            client.dead = true;
    }
    forget_dead();
    if ((fds[0].revents & POLLIN) != 0) accept_from(at_path_, Trust::full);
    if ((fds[1].revents & POLLIN) != 0) accept_from(on_port_, token_ ? Trust::needs_token : Trust::full);
}

void RemoteServer::receive(Client& client)
{
    char chunk[kReadAtOnce];
    ssize_t const n = ::recv(client.socket.fd(), chunk, sizeof chunk, MSG_DONTWAIT);
    if (n > 0)
        client.in.append(chunk, std::size_t(n));
    else if (n == 0)
        client.ended = true;
    else if (errno != EAGAIN && errno != EINTR)
        client.dead = true;
}

bool RemoteServer::has_line(Client& client)
{
    if (client.closing || client.dead) return false;
    std::size_t const end = client.in.find('\n', client.searched);
    client.searched = end == std::string::npos ? client.in.size() : end;
    return end != std::string::npos;
}

void RemoteServer::handle_lines(std::uint64_t number, Client& client)
{
    std::size_t done = 0;
    for (std::size_t i = 0; i < limits_.lines_per_poll && has_line(client); ++i) {
        std::size_t const end = client.searched;
        std::string_view const line(client.in.data() + done, end - done);
        if (client.skipping)
            client.skipping = false;
        else
            handle_line(number, client, line);
        done = client.searched = end + 1;
    }
    client.in.erase(0, done);
    client.searched -= done;
    if (client.closing) return;
    if (client.in.size() > limits_.line_bytes && !has_line(client)) {
        if (!client.skipping)
            send_error(
                number, client, nullptr,
                fmt::format("the line is too long (at most {} bytes) send less at once", limits_.line_bytes));
        client.skipping = true;
        client.in.clear();
        client.searched = 0;
    }
    if (!client.ended || has_line(client)) return;
    // The last line may lack its newline, but must be complete otherwise.
    if (!client.skipping && nlohmann::json::accept(client.in))
        handle_line(number, client, client.in);
    else if (!client.in.empty() && !client.skipping)
        report_.lose("remote requests that end within their line", 1, fmt::format("client {}", number));
    client.in.clear();
    client.searched = 0;
    client.closing = client.waiting == 0;
}

void RemoteServer::handle_line(std::uint64_t number, Client& client, std::string_view line)
{
    if (line.size() > limits_.line_bytes)
        return send_error(
            number, client, nullptr,
            fmt::format("the line is too long (at most {} bytes) send less at once", limits_.line_bytes));
    if (line.ends_with('\r')) line.remove_suffix(1);
    if (line.find_first_not_of(" \t") == std::string_view::npos) return;
    nlohmann::json request;
    try {
        request = parse_request(line);
        client.spoke = true;
    } catch (gi::InputError const& e) {
        send_error(number, client, nullptr, e.what());
        // Security: a web page can make a browser send chosen lines to a port, but never as the first lines.
        if (!client.spoke) client.closing = true;
        return;
    }
    if (!take_token(number, client, request)) dispatch(number, client, request);
}

bool RemoteServer::take_token(std::uint64_t number, Client& client, nlohmann::json const& line)
{
    bool const is_token_line = line.contains("token") && !line.contains("do");
    if (client.trust == Trust::full) {
        if (is_token_line) send(number, client, {{"id", id_of(line)}, {"result", nlohmann::json::object()}});
        return is_token_line; // this client needs no token, but may send one
    }
    if (!is_token_line || !line["token"].is_string()) {
        refuse_stranger(number, client, id_of(line), "the first line is no token");
    } else if (!is_token(line["token"].get_ref<std::string const&>(), token_->token())) {
        refuse_stranger(number, client, id_of(line), "the token is wrong");
    } else {
        client.trust = Trust::full;
        send(number, client, {{"id", id_of(line)}, {"result", nlohmann::json::object()}});
    }
    return true;
}

void RemoteServer::refuse_stranger(std::uint64_t number, Client& client, nlohmann::json const& id,
                                   std::string const& problem)
{
    report_.lose("remote clients without the port's token", 1, fmt::format("client {}: {}", number, problem));
    send_error(number, client, id,
               problem +
                   " (only who can read it may use this port) begin with {\"token\": ...} from the file that "
                   "the viewer printed");
    client.closing = true;
    client.in.clear();
    client.searched = 0;
}

void RemoteServer::dispatch(std::uint64_t number, Client& client, nlohmann::json const& json)
{
    RemoteRequest request;
    try {
        request = check_request(json);
    } catch (gi::InputError const& e) {
        return send_error(number, client, id_of(json), e.what());
    }
    if (client.waiting >= limits_.waiting)
        return send_error(
            number, client, request.id,
            fmt::format("too many requests wait ({} have no answer yet) wait for those", client.waiting));
    request.token = next_token_++;
    waiting_[request.token] = {number, request.id};
    ++client.waiting;
    try {
        if (auto const result = handler_(request)) answer(request.token, *result);
    } catch (gi::InputError const& e) {
        refuse(request.token, e.what());
    } catch (std::exception const& e) {
        refuse(request.token, fmt::format("internal error: {}", e.what()));
    }
}

bool RemoteServer::answer(std::uint64_t token, nlohmann::json const& result)
{
    return finish(token, "result", result);
}
bool RemoteServer::refuse(std::uint64_t token, std::string const& error) { return finish(token, "error", error); }

bool RemoteServer::finish(std::uint64_t token, char const* kind, nlohmann::json const& value)
{
    auto const found = waiting_.find(token);
    if (found == waiting_.end()) return false;
    Waiting const waiting = found->second;
    waiting_.erase(found);
    Client& client = clients_.at(waiting.client);
    --client.waiting;
    send(waiting.client, client, {{"id", waiting.id}, {kind, value}});
    return !client.dead;
}

void RemoteServer::send_error(std::uint64_t number, Client& client, nlohmann::json const& id,
                              std::string const& error)
{
    send(number, client, error_answer(id, error));
}

void RemoteServer::send(std::uint64_t number, Client& client, nlohmann::ordered_json const& answer)
{
    if (client.dead) return;
    client.out += json_line(answer) + "\n";
    flush(client);
    if (client.out.size() <= limits_.output_bytes) return;
    report_.lose("remote clients dropped", 1,
                 fmt::format("client {} left {} bytes of answers unread, limit {}", number, client.out.size(),
                             limits_.output_bytes));
    client.dead = true;
}

void RemoteServer::flush(Client& client)
{
    std::size_t sent = 0;
    while (sent < client.out.size()) {
        ssize_t const n = ::send(client.socket.fd(), client.out.data() + sent, client.out.size() - sent,
                                 MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n < 0 && errno == EINTR) continue;
        if (n < 0) {
            if (errno != EAGAIN) client.dead = true;
            break;
        }
        sent += std::size_t(n);
    }
    client.out.erase(0, sent);
}

void RemoteServer::forget_dead()
{
    for (auto at = clients_.begin(); at != clients_.end();) {
        Client& client = at->second;
        // Answers since its last request.
        bool const is_done = client.ended && client.waiting == 0 && client.in.empty();
        if (!client.dead && !((client.closing || is_done) && client.out.empty())) {
            ++at;
            continue;
        }
        if (client.waiting > 0)
            std::erase_if(waiting_, [&](auto const& w) { return w.second.client == at->first; });
        at = clients_.erase(at);
    }
}

std::string describe_port(RemoteServer const& server)
{
    return fmt::format("remote control at 127.0.0.1:{}, {}", server.port(),
                       server.token_file().empty() ? "open to every account of this machine"
                                                   : "token in " + server.token_file().string());
}

} // namespace viewer
