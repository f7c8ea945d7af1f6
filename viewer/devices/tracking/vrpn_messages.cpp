#include "viewer/devices/tracking/vrpn_messages.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <string_view>

namespace viewer {
namespace {

constexpr std::string_view kVersion = "vrpn: ver. 07.38";
constexpr std::size_t kGreeting = 24, kAlign = 8, kHeader = 24;
constexpr std::size_t kLongestMessage = 64 * 1024; ///< VRPN's own buffer has 64,000 bytes
constexpr std::size_t kMostNames = 2000;           ///< VRPN's own limit
constexpr std::size_t kLongestName = 100;          ///< the same
constexpr std::int32_t kNamesSender = -1, kNamesType = -2, kWantsUdp = -3;
constexpr int kMostSensors = 10000;
constexpr char kPing[] = "vrpn_Base ping_message";

std::uint32_t u32(std::span<unsigned char const> b)
{
    return std::uint32_t(b[0]) << 24 | std::uint32_t(b[1]) << 16 | std::uint32_t(b[2]) << 8 | std::uint32_t(b[3]);
}
std::int32_t i32(std::span<unsigned char const> b) { return std::int32_t(u32(b)); }
double f64(std::span<unsigned char const> b)
{
    return std::bit_cast<double>(std::uint64_t(u32(b)) << 32 | u32(b.subspan(4)));
}

void put_u32(std::vector<unsigned char>& out, std::uint32_t v)
{
    for (int shift = 24; shift >= 0; shift -= 8) out.push_back(static_cast<unsigned char>(v >> shift));
}

void put_message(std::vector<unsigned char>& out, std::int32_t type, std::int32_t sender,
                 std::span<unsigned char const> payload)
{
    put_u32(out, std::uint32_t(kHeader + payload.size()));
    put_u32(out, 0); // the time of a request is not read
    put_u32(out, 0);
    put_u32(out, std::uint32_t(sender));
    put_u32(out, std::uint32_t(type));
    put_u32(out, 0);
    out.insert(out.end(), payload.begin(), payload.end());
    out.resize((out.size() + kAlign - 1) / kAlign * kAlign, 0);
}

std::vector<unsigned char> name_bytes(std::string const& name)
{
    std::vector<unsigned char> bytes;
    put_u32(bytes, std::uint32_t(name.size() + 1));
    for (char const c : name) bytes.push_back(static_cast<unsigned char>(c));
    bytes.push_back(0);
    return bytes;
}

std::size_t padded(std::size_t size) { return (size + kAlign - 1) / kAlign * kAlign; }

bool is_bounded(double v) { return std::abs(v) <= kLargestNumber; }

/// A pose or, with one more number, a velocity; false if malformed.
bool read_pose(std::span<unsigned char const> payload, TrackerSample& sample)
{
    std::int32_t const sensor = i32(payload);
    if (sensor < 0 || sensor >= kMostSensors) return false;
    double v[7];
    for (std::size_t k = 0; k < 7; ++k) {
        v[k] = f64(payload.subspan(8 + 8 * k));
        if (!is_bounded(v[k])) return false;
    }
    double const length = std::hypot(std::hypot(v[3], v[4]), std::hypot(v[5], v[6]));
    if (!(std::abs(length - 1) < 0.05)) return false;
    sample.body = std::to_string(sensor);
    sample.pose = {{v[0], v[1], v[2]}, glm::normalize(gi::dquat(v[6], v[3], v[4], v[5]))};
    return true;
}

} // namespace

std::vector<unsigned char> vrpn_greeting()
{
    std::vector<unsigned char> bytes(kVersion.begin(), kVersion.end());
    for (char const c : {' ', ' ', '0'})
        bytes.push_back(static_cast<unsigned char>(c)); // 0: no log on either side
    bytes.resize(kGreeting, 0);
    return bytes;
}

std::vector<unsigned char> vrpn_introduction(std::string const& device)
{
    std::vector<unsigned char> bytes;
    put_message(bytes, kNamesSender, 0, name_bytes(device));
    put_message(bytes, kNamesType, 0, name_bytes(kPing));
    return bytes;
}

std::vector<unsigned char> vrpn_udp_wish(std::string const& own_address, int own_port)
{
    std::vector<unsigned char> bytes, text(own_address.begin(), own_address.end());
    text.push_back(0);
    put_message(bytes, kWantsUdp, own_port, text);
    return bytes;
}

std::vector<unsigned char> vrpn_ping()
{
    std::vector<unsigned char> bytes;
    put_message(bytes, 0, 0, {});
    return bytes;
}

bool VrpnReader::take_stream(std::span<unsigned char const> bytes, TrackerPacket& packet)
{
    if (!fault_.empty()) return false;
    pending_.insert(pending_.end(), bytes.begin(), bytes.end());
    std::span<unsigned char const> rest(pending_);
    if (!greeted_) {
        // The longest common beginning decides early, so that another kind of server is named at once.
        std::string_view const major = kVersion.substr(0, kVersion.rfind('.') + 1);
        std::string_view const greeting(reinterpret_cast<char const*>(rest.data()),
                                        std::min(rest.size(), major.size()));
        if (!major.starts_with(greeting)) {
            bool const is_vrpn = greeting.starts_with("vrpn: ver.");
            fault_ = is_vrpn ? "the server has another version of VRPN than 07.xx" : "it is no VRPN server";
            return false;
        }
        if (rest.size() < kGreeting) return true;
        greeted_ = true;
        rest = rest.subspan(kGreeting);
    }
    while (!rest.empty()) {
        std::ptrdiff_t const used = take_message(rest, packet);
        if (used < 0) {
            ++packet.malformed;
            fault_ = "a message has an impossible length";
            return false;
        }
        if (used == 0) break;
        rest = rest.subspan(std::size_t(used));
    }
    pending_.erase(pending_.begin(), pending_.end() - std::ptrdiff_t(rest.size()));
    return true;
}

void VrpnReader::take_datagram(std::span<unsigned char const> bytes, TrackerPacket& packet)
{
    while (!bytes.empty()) {
        std::ptrdiff_t const used = take_message(bytes, packet);
        if (used <= 0) {
            ++packet.malformed;
            return;
        }
        bytes = bytes.subspan(std::size_t(used));
    }
}

std::ptrdiff_t VrpnReader::take_message(std::span<unsigned char const> bytes, TrackerPacket& packet)
{
    if (bytes.size() < kHeader) return 0;
    std::size_t const length = u32(bytes);
    if (length < kHeader || length > kLongestMessage) return -1;
    if (bytes.size() < padded(length)) return 0;
    double const time_s = double(u32(bytes.subspan(4))) + 1e-6 * double(u32(bytes.subspan(8)));
    std::int32_t const sender = i32(bytes.subspan(12)), type = i32(bytes.subspan(16));
    std::span<unsigned char const> const payload = bytes.subspan(kHeader, length - kHeader);
    if (type == kNamesSender) {
        take_name(senders_, sender, payload, packet);
    } else if (type == kNamesType) {
        take_name(types_, sender, payload, packet);
    } else if (type >= 0) {
        auto const device = senders_.find(sender), named = types_.find(type);
        if (device == senders_.end() || named == types_.end())
            ++packet.ignored; // a UDP packet may overtake the names
        else
            take_payload(device->second, named->second, time_s, payload, packet);
    }
    return std::ptrdiff_t(padded(length));
}

void VrpnReader::take_name(std::map<std::int32_t, std::string>& names, std::int32_t id,
                           std::span<unsigned char const> text, TrackerPacket& packet)
{
    bool const fits =
        text.size() >= 5 && u32(text) >= 1 && u32(text) <= text.size() - 4 && u32(text) <= kLongestName;
    if (!fits || id < 0 || (names.size() >= kMostNames && !names.contains(id))) {
        ++packet.malformed;
        return;
    }
    std::string const name(reinterpret_cast<char const*>(text.data()) + 4, u32(text) - 1);
    names[id] = name.substr(0, name.find('\0'));
}

void VrpnReader::add_buttons(double time_s, TrackerPacket& packet) const
{
    TrackerSample sample;
    sample.body = kDeviceControls;
    sample.parts = SampleParts::buttons;
    sample.buttons = buttons_;
    sample.measured_s = time_s;
    packet.samples.push_back(std::move(sample));
}

void VrpnReader::take_payload(std::string const& sender, std::string const& type, double time_s,
                              std::span<unsigned char const> p, TrackerPacket& packet)
{
    bool const poses = sender == devices_.tracker;
    hears_device_ = hears_device_ || poses;
    bool const controls = sender == (devices_.controls.empty() ? devices_.tracker : devices_.controls);
    if (poses && (type == "vrpn_Tracker Pos_Quat" || type == "vrpn_Tracker Velocity")) {
        bool const is_pose = type == "vrpn_Tracker Pos_Quat";
        TrackerSample sample;
        sample.measured_s = time_s;
        if (p.size() != (is_pose ? 64u : 72u) || !read_pose(p, sample))
            ++packet.malformed;
        else if (is_pose)
            packet.samples.push_back(std::move(sample));
        else
            ++packet.ignored; // pose_track.h makes its own velocity, free of its filter's delay
        return;
    }
    if (controls && type == "vrpn_Button Change") {
        if (p.size() != 8 || i32(p) < 0) {
            ++packet.malformed;
        } else if (i32(p) >= 32) {
            ++packet.ignored;
        } else {
            std::uint32_t const bit = 1u << u32(p);
            buttons_ = i32(p.subspan(4)) != 0 ? buttons_ | bit : buttons_ & ~bit;
            add_buttons(time_s, packet);
        }
        return;
    }
    if (controls && type == "vrpn_Button States") {
        std::size_t const count = p.size() >= 4 ? u32(p) : 0;
        if (p.size() < 4 || count > 4096 || p.size() != 4 + 4 * count) {
            ++packet.malformed;
            return;
        }
        buttons_ = 0;
        for (std::size_t k = 0; k < std::min<std::size_t>(count, 32); ++k)
            if (u32(p.subspan(4 + 4 * k)) != 0) buttons_ |= 1u << k;
        add_buttons(time_s, packet);
        return;
    }
    if (controls && type == "vrpn_Analog Channel") {
        double const count = p.size() >= 8 ? f64(p) : -1;
        if (!(count >= 0 && count <= 1024 && count == std::floor(count)) ||
            p.size() != 8 + 8 * std::size_t(count)) {
            ++packet.malformed;
            return;
        }
        TrackerSample sample;
        sample.body = kDeviceControls;
        sample.parts = SampleParts::buttons;
        sample.measured_s = time_s;
        for (std::size_t k = 0; k < std::min(std::size_t(count), kMostAxes); ++k)
            sample.axes.push_back(f64(p.subspan(8 + 8 * k)));
        if (!std::all_of(sample.axes.begin(), sample.axes.end(), is_bounded))
            ++packet.malformed;
        else
            packet.samples.push_back(std::move(sample));
        return;
    }
    if (poses || controls) ++packet.ignored;
}

} // namespace viewer
