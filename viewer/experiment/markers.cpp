#include "viewer/experiment/markers.h"

#include "gi/core/error.h"
#include "viewer/experiment/lsl_library.h"

#include <arpa/inet.h>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <fmt/format.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <thread>
#include <unistd.h>

namespace viewer {

struct Markers::Stream {
    std::shared_ptr<LslLibrary const> lsl;
    LslLibrary::Info info = nullptr;
    void* outlet = nullptr;
    double clock_offset_s = 0;

    bool open(MarkerSession const& session)
    {
        lsl = LslLibrary::open();
        if (!lsl) return false;
        constexpr int kBuffered_s = 360;
        // The source's name stays the same when a session is resumed, so that recorders continue its stream.
        std::string const source =
            fmt::format("lightwell-{}-{}-{:02}", session.experiment, session.participant, session.session);
        info = lsl->create_streaminfo("Lightwell", "Markers", 1, 0, LslLibrary::kStringFormat, source.c_str());
        if (info == nullptr) return false;
        LslLibrary::Xml const desc = lsl->get_desc(info);
        lsl->append_child_value(desc, "manufacturer", "Lightwell");
        lsl->append_child_value(desc, "experiment", session.experiment.c_str());
        lsl->append_child_value(desc, "participant", session.participant.c_str());
        lsl->append_child_value(desc, "session", std::to_string(session.session).c_str());
        LslLibrary::Xml const channel = lsl->append_child(lsl->append_child(desc, "channels"), "channel");
        lsl->append_child_value(channel, "label", "event");
        lsl->append_child_value(channel, "type", "JSON");
        outlet = lsl->create_outlet(info, 0, kBuffered_s);
        clock_offset_s = lsl->clock_offset_s();
        return outlet != nullptr;
    }
    ~Stream()
    {
        if (outlet != nullptr) {
            // liblsl drops what it has not sent yet, and does not tell when it has.
            if (lsl->have_consumers(outlet) != 0) std::this_thread::sleep_for(std::chrono::milliseconds(500));
            lsl->destroy_outlet(outlet);
        }
        if (info != nullptr) lsl->destroy_streaminfo(info);
    }
};

Markers::Markers(std::vector<std::string> const& wanted, int port, MarkerSession const& session,
                 gi::Report& report)
    : port_(port), report_(report)
{
    for (std::string const& w : wanted) {
        if (w == "udp") {
            socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
            if (socket_ < 0)
                throw gi::InputError("no socket for markers", std::strerror(errno), "leave out record.markers");
        } else if (w == "lsl") {
            stream_ = std::make_unique<Stream>();
            if (stream_->open(session)) continue;
            stream_.reset();
            report.lose("marker streams that could not be opened: liblsl is not installed");
        } else {
            throw gi::InputError("record.markers: " + w, "there is no such kind of marker", "choose udp or lsl");
        }
    }
}

std::vector<std::pair<std::string, std::string>> Markers::about() const
{
    if (!stream_) return {};
    return {{"lsl", stream_->lsl->version()},
            {"lsl_clock_offset_s", fmt::format("{:.9f}", stream_->clock_offset_s)}};
}

Markers::~Markers()
{
    if (socket_ >= 0) ::close(socket_);
}

void Markers::send(double time_s, std::string const& what, nlohmann::ordered_json about)
{
    if (socket_ < 0 && !stream_) return;
    nlohmann::ordered_json line{{"marker", what}, {"time_s", time_s}};
    line.update(about);
    std::string const text = line.dump();
    if (socket_ >= 0) {
        sockaddr_in to{};
        to.sin_family = AF_INET;
        to.sin_port = htons(std::uint16_t(port_));
        to.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        // A missing listener is not an error, but the system may report it with the next packet.
        ssize_t const sent =
            ::sendto(socket_, text.data(), text.size(), 0, reinterpret_cast<sockaddr*>(&to), sizeof to);
        if (sent < 0 && errno != ECONNREFUSED)
            report_.lose("markers that could not be sent", 1, std::strerror(errno));
    }
    if (stream_) {
        char const* sample = text.c_str();
        if (stream_->lsl->push_sample_strt(stream_->outlet, &sample, time_s + stream_->clock_offset_s) != 0)
            report_.lose("markers that could not be sent", 1, "liblsl");
    }
}

} // namespace viewer
