// Any bytes from a client of the remote protocol, in pieces: every line gets an answer that is JSON, nothing else
// happens. The first byte says how the pieces are cut.

#include "viewer/protocol/remote/remote_server.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cstdlib>
#include <sys/socket.h>

namespace {

void expect_answers(std::string const& text)
{
    for (std::size_t at = 0; at < text.size();) {
        std::size_t const end = text.find('\n', at);
        if (end == std::string::npos) std::abort();
        auto const answer = nlohmann::json::parse(text.substr(at, end - at));
        if (!answer.contains("id") || answer.contains("result") == answer.contains("error")) std::abort();
        at = end + 1;
    }
}

} // namespace

extern "C" int LLVMFuzzerTestOneInput(unsigned char const* data, std::size_t size)
{
    if (size == 0) return 0;
    gi::Report report;
    std::vector<std::uint64_t> later;
    auto const handle = [&](viewer::RemoteRequest const& r) -> std::optional<nlohmann::json> {
        if (r.what == "quit") throw gi::InputError("no", "it is a test", "stay");
        if (r.what == "load") throw std::runtime_error("broken");
        if (r.what != "screenshot") return r.arguments;
        later.push_back(r.token);
        return {};
    };
    viewer::RemoteOptions options;
    options.limits.line_bytes = 200;
    options.limits.lines_per_poll = 3;
    options.limits.waiting = 2;
    viewer::RemoteServer server(options, handle, report);
    int ends[2];
    if (::socketpair(AF_UNIX, SOCK_STREAM, 0, ends) != 0) std::abort();
    server.adopt(viewer::Socket(ends[0]));
    viewer::Socket const mine(ends[1]);

    std::string got;
    char chunk[65536];
    auto const turn = [&] {
        server.poll();
        for (ssize_t n; (n = ::recv(mine.fd(), chunk, sizeof chunk, MSG_DONTWAIT)) > 0;)
            got.append(chunk, std::size_t(n));
    };
    std::size_t const piece = data[0] % 4 == 0 ? size : size / 8 + data[0] % 8;
    for (std::size_t at = 1; at < size; at += piece) {
        ::send(mine.fd(), data + at, std::min(piece, size - at), MSG_NOSIGNAL | MSG_DONTWAIT);
        turn();
        if (data[0] % 3 == 0)
            for (std::uint64_t const token : std::exchange(later, {})) server.answer(token, 1);
    }
    ::shutdown(mine.fd(), SHUT_WR);
    for (std::size_t i = 0; i < size + 10 && server.clients() > 0; ++i) {
        turn();
        for (std::uint64_t const token : std::exchange(later, {})) server.answer(token, 1);
    }
    turn();
    if (server.clients() > 0 || server.waiting() > 0) std::abort();
    expect_answers(got);
    return 0;
}
