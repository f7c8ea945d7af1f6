#include "viewer/protocol/remote/remote_client.h"

#include "gi/core/error.h"
#include "gi/core/text.h"
#include "viewer/protocol/bytes.h"
#include "viewer/protocol/json_text.h"
#include "viewer/protocol/remote/remote_token.h"

#include <cerrno>
#include <cstring>
#include <poll.h>
#include <sys/socket.h>

namespace viewer {
namespace {

gi::InputError no_answer(std::string const& why)
{
    return gi::InputError("no answer to a remote request", why, "check whether the viewer runs");
}

} // namespace

RemoteClient::RemoteClient(std::string const& where, std::filesystem::path const& token_file)
    : socket_(connect_to(where))
{
    auto const port = gi::parse_number<int>(where);
    if (!port) return;
    std::optional<std::string> const token =
        read_token(token_file.empty() ? default_token_file(*port) : token_file);
    if (!token && !token_file.empty())
        throw gi::InputError("there is no file '" + token_file.string() + "'", "it would hold the port's token",
                             "name the file that the viewer printed");
    if (!token) return; // the port may be open
    send(json_line({{"id", "token"}, {"token", *token}}) + "\n");
    sent_token_ = true;
}

std::string RemoteClient::receive(std::chrono::milliseconds timeout)
{
    auto const until = Clock::now() + timeout;
    std::string line = receive_line(timeout);
    if (!std::exchange(sent_token_, false)) return line;
    nlohmann::json const answer = nlohmann::json::parse(line, nullptr, false);
    if (answer.is_object() && answer.contains("error"))
        throw gi::InputError("the viewer refuses this client", answer["error"].dump(),
                             "name the file of its token with --token");
    return receive_line(std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now()));
}

void RemoteClient::wait_for(short events, Clock::time_point until)
{
    for (;;) {
        auto const left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
        if (left.count() <= 0) throw no_answer("the timeout passed");
        pollfd fd{socket_.fd(), events, 0};
        if (::poll(&fd, 1, int(std::min<std::int64_t>(left.count(), 60000))) > 0) return;
    }
}

void RemoteClient::send(std::string_view bytes, std::chrono::milliseconds timeout)
{
    auto const until = Clock::now() + timeout;
    while (!bytes.empty()) {
        wait_for(POLLOUT, until);
        ssize_t const n = ::send(socket_.fd(), bytes.data(), bytes.size(), MSG_NOSIGNAL | MSG_DONTWAIT);
        if (n < 0 && errno != EAGAIN && errno != EINTR) throw no_answer(std::strerror(errno));
        if (n > 0) bytes.remove_prefix(std::size_t(n));
    }
}

std::string RemoteClient::receive_line(std::chrono::milliseconds timeout)
{
    auto const until = Clock::now() + timeout;
    for (std::size_t searched = 0;;) {
        if (std::size_t const end = in_.find('\n', searched); end != std::string::npos) {
            std::string line = in_.substr(0, end);
            in_.erase(0, end + 1);
            return line;
        }
        searched = in_.size();
        wait_for(POLLIN, until);
        char chunk[65536];
        ssize_t const n = ::recv(socket_.fd(), chunk, sizeof chunk, MSG_DONTWAIT);
        if (n == 0) throw no_answer("the connection was closed");
        if (n < 0 && errno != EAGAIN && errno != EINTR) throw no_answer(std::strerror(errno));
        if (n > 0) in_.append(chunk, std::size_t(n));
    }
}

nlohmann::json RemoteClient::ask(nlohmann::json request, std::chrono::milliseconds timeout)
{
    if (request.is_object() && !request.contains("id")) request["id"] = next_id_++;
    auto const until = Clock::now() + timeout;
    send(json_line(request) + "\n", timeout);
    for (;;) {
        auto const left = std::chrono::ceil<std::chrono::milliseconds>(until - Clock::now());
        try {
            nlohmann::json answer = parse_json(receive(left));
            if (!request.is_object() || answer.value("id", nlohmann::json()) == request["id"]) return answer;
            if (answer.value("id", nlohmann::json()).is_null() && answer.contains("error")) return answer;
        } catch (BadBytes const& e) {
            throw no_answer(std::string("the answer is not JSON: ") + e.what());
        }
    }
}

} // namespace viewer
