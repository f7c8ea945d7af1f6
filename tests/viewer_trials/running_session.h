#pragma once
// `lightwell study run` as it runs: its process, its window, its markers and the experimenter's socket.

#include "study/journal/journal_file.h"
#include "tests/viewer_show/live_view.h"
#include "tests/viewer_show/x/x_window.h"

#include <arpa/inet.h>
#include <deque>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>

namespace viewer::test {

/// A UDP socket of this machine, on a free port.
class MarkerListener {
public:
    MarkerListener() : socket_(::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0))
    {
        sockaddr_in at{};
        at.sin_family = AF_INET;
        at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof at;
        if (::bind(socket_, reinterpret_cast<sockaddr*>(&at), size) != 0) throw std::runtime_error("no UDP port");
        ::getsockname(socket_, reinterpret_cast<sockaddr*>(&at), &size);
        port_ = ntohs(at.sin_port);
    }
    ~MarkerListener() { ::close(socket_); }
    MarkerListener(MarkerListener const&) = delete;
    MarkerListener& operator=(MarkerListener const&) = delete;

    int port() const { return port_; }
    /// The next marker of this kind; others before it are left out. Null after the limit.
    Json wait_for(std::string const& marker, std::chrono::milliseconds limit = std::chrono::seconds(60)) const
    {
        auto const end = std::chrono::steady_clock::now() + limit;
        while (std::chrono::steady_clock::now() < end) {
            pollfd p{socket_, POLLIN, 0};
            if (::poll(&p, 1, 20) <= 0) continue;
            char text[2048];
            ssize_t const n = ::recv(socket_, text, sizeof text, 0);
            if (n <= 0) continue;
            Json const m = Json::parse(text, text + n);
            if (m.at("marker") == marker) return m;
        }
        return nullptr;
    }

private:
    int socket_, port_ = 0;
};

class RunningSession {
public:
    /// Starts participant 1 of a script (its text) in a window of 240 x 180 pixels.
    RunningSession(TemporaryFolder const& folder, std::string const& script, std::string const& more = "")
        : folder_(folder), socket_(folder / "remote")
    {
        std::ofstream(folder / "x.yaml") << script;
        program_ = std::make_unique<Program>(
            words(fmt::format("study run x.yaml --participant 1 --dir data --size 240x180 --font 12 --threads 1 "
                              "--remote {} --marker-port {} {}",
                              socket_.string(), markers.port(), more)),
            folder.path());
    }
    MarkerListener markers;

    /// Its window, with the keys.
    XWindow& window()
    {
        if (!window_) {
            window_.emplace("Lightwell: ");
            window_->focus();
        }
        return *window_;
    }
    Program& program() { return *program_; }
    Json session(std::string const& action, std::string const& text = "")
    {
        if (!client_) client_.emplace(socket_);
        Json request{{"do", "session"}, {"action", action}};
        if (!text.empty()) request["text"] = text;
        Json const answer = client_->ask(request, std::chrono::seconds(20));
        EXPECT_TRUE(answer.contains("result")) << answer;
        return answer.value("result", Json::object());
    }
    /// Until the status says that it is at something that begins so.
    bool wait_until_at(std::string const& doing)
    {
        for (int i = 0; i < 1500 && program_->runs(); ++i) {
            try {
                if (session("status").value("doing", "").starts_with(doing)) return true;
            } catch (gi::InputError const&) { // it does not listen yet
                client_.reset();
            }
            sleep_ms(20);
        }
        return false;
    }
    Outcome wait() { return program_->wait(); }

    std::filesystem::path folder() const { return folder_ / "data/sub-P001/ses-01/beh"; }
    template <class Entry>
    std::vector<Entry> entries() const
    {
        std::vector<Entry> found;
        for (study::JournalEntry const& e : study::read_journal(folder() / "journal.jsonl").record.entries)
            if (auto const* const one = std::get_if<Entry>(&e)) found.push_back(*one);
        return found;
    }

    /// Why the last part ended, as the journal says.
    std::string reason() const
    {
        auto const ends = entries<study::SessionEnded>();
        return ends.empty() ? "none" : ends.back().reason;
    }

private:
    TemporaryFolder const& folder_;
    std::filesystem::path socket_;
    std::unique_ptr<Program> program_;
    std::optional<XWindow> window_;
    std::optional<RemoteClient> client_;
};

} // namespace viewer::test
