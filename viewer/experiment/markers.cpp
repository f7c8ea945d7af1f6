#include "viewer/experiment/markers.h"

#include "gi/core/error.h"

#include <arpa/inet.h>
#include <cerrno>
#include <cstring>
#include <dlfcn.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

namespace viewer {

/// The required functions of liblsl (lsl_c.h of version 1.16), loaded at run time because few systems package
/// it.
struct Markers::Lsl {
    using Info = void* (*)(char const*, char const*, int, double, int, char const*);
    using Outlet = void* (*)(void*, int, int);
    using Push = int (*)(void*, char const**, double);
    using Destroy = void (*)(void*);
    static constexpr int kStringFormat = 3;

    void* library = nullptr;
    void *info = nullptr, *outlet = nullptr;
    Push push = nullptr;
    Destroy destroy_outlet = nullptr, destroy_info = nullptr;

    template <class Function>
    Function find(char const* name) const
    {
        return reinterpret_cast<Function>(dlsym(library, name));
    }
    bool open(std::string const& experiment)
    {
        for (char const* const name : {"liblsl.so.2", "liblsl.so", "liblsl64.so"})
            if ((library = dlopen(name, RTLD_NOW | RTLD_LOCAL)) != nullptr) break;
        if (library == nullptr) return false;
        auto const make_info = find<Info>("lsl_create_streaminfo");
        auto const make_outlet = find<Outlet>("lsl_create_outlet");
        push = find<Push>("lsl_push_sample_strt");
        destroy_outlet = find<Destroy>("lsl_destroy_outlet");
        destroy_info = find<Destroy>("lsl_destroy_streaminfo");
        if (!make_info || !make_outlet || !push || !destroy_outlet || !destroy_info) return false;
        std::string const source = "lightwell-" + experiment;
        info = make_info("Lightwell", "Markers", 1, 0, kStringFormat, source.c_str());
        outlet = info != nullptr ? make_outlet(info, 0, 360) : nullptr;
        return outlet != nullptr;
    }
    ~Lsl()
    {
        if (outlet != nullptr) destroy_outlet(outlet);
        if (info != nullptr) destroy_info(info);
        if (library != nullptr) dlclose(library);
    }
};

Markers::Markers(std::vector<std::string> const& wanted, int port, std::string const& experiment,
                 gi::Report& report)
    : port_(port), report_(report)
{
    for (std::string const& w : wanted) {
        if (w == "udp") {
            socket_ = ::socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
            if (socket_ < 0)
                throw gi::InputError("no socket for markers", std::strerror(errno), "leave out record.markers");
        } else if (w == "lsl") {
            lsl_ = std::make_unique<Lsl>();
            if (lsl_->open(experiment)) continue;
            lsl_.reset();
            report.lose("marker streams that could not be opened: liblsl is not installed");
        } else {
            throw gi::InputError("record.markers: " + w, "there is no such kind of marker", "choose udp or lsl");
        }
    }
}

Markers::~Markers()
{
    if (socket_ >= 0) ::close(socket_);
}

void Markers::send(double time_s, std::string const& what, nlohmann::ordered_json about)
{
    if (socket_ < 0 && !lsl_) return;
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
    if (lsl_) {
        char const* sample = text.c_str();
        // LSL's clock is the steady clock on Linux.
        if (lsl_->push(lsl_->outlet, &sample, time_s) != 0)
            report_.lose("markers that could not be sent", 1, "liblsl");
    }
}

} // namespace viewer
