#include "viewer/devices/tracking/udp_tracker.h"

#include "viewer/devices/tracking/dtrack.h"

#include <fmt/format.h>

namespace viewer {
namespace {

constexpr std::size_t kMostBodies = 256; ///< limit on kept counters, because senders choose the names
constexpr int kMostPackets = 4096;       ///< per poll, so that a flood does not block the frame

} // namespace

UdpTracker::UdpTracker(std::string name, std::string const& address, int port, Parse parse, double frame_rate_hz)
    : name_(std::move(name)), socket_(address, port), parse_(std::move(parse)), frame_rate_hz_(frame_rate_hz)
{
}

void UdpTracker::poll(double, std::vector<TrackerSample>& samples)
{
    for (int i = 0; i < kMostPackets; ++i) {
        auto const datagram = socket_.receive();
        if (!datagram) break;
        if (datagram->cut) {
            ++counts_.packets;
            ++counts_.malformed;
        } else {
            take(datagram->bytes, datagram->received_s, samples);
        }
    }
}

void UdpTracker::take(std::span<unsigned char const> bytes, double received_s, std::vector<TrackerSample>& samples)
{
    ++counts_.packets;
    TrackerPacket packet = parse_(bytes);
    counts_.malformed += packet.malformed;
    counts_.ignored += packet.ignored;
    if (packet.frame && packets_.note(*packet.frame, counts_) == Arrival::duplicate) return;
    for (TrackerSample& s : packet.samples) {
        if (s.frame) {
            std::string const key = s.body + "/" + std::to_string(int(s.parts));
            bool const known = bodies_.contains(key) || bodies_.size() < kMostBodies;
            if (known && bodies_[key].note(*s.frame, counts_) == Arrival::duplicate) continue;
        }
        auto const frame = s.frame ? s.frame : packet.frame;
        if (!s.measured_s && frame && frame_rate_hz_ > 0) s.measured_s = double(*frame) / frame_rate_hz_;
        s.received_s = received_s;
        ++counts_.samples;
        samples.push_back(std::move(s));
    }
}

TrackerCounts UdpTracker::counts() const
{
    TrackerCounts c = counts_;
    c.dropped_by_kernel = socket_.dropped_by_kernel();
    return c;
}

std::string UdpTracker::description() const
{
    return fmt::format("{} at {} port {}", name_, socket_.address(), socket_.port());
}

std::unique_ptr<UdpTracker> make_osc_tracker(std::string const& address, int port,
                                             std::vector<OscPattern> patterns, double frame_rate_hz)
{
    for (OscPattern const& p : patterns) check(p);
    auto const parse = [patterns = std::move(patterns)](std::span<unsigned char const> bytes) {
        return parse_osc(bytes, patterns);
    };
    return std::make_unique<UdpTracker>("osc", address, port, parse, frame_rate_hz);
}

std::unique_ptr<UdpTracker> make_dtrack_tracker(std::string const& address, int port, double frame_rate_hz)
{
    auto const parse = [](std::span<unsigned char const> bytes) {
        return parse_dtrack({reinterpret_cast<char const*>(bytes.data()), bytes.size()});
    };
    return std::make_unique<UdpTracker>("dtrack", address, port, parse, frame_rate_hz);
}

} // namespace viewer
