#include "viewer/devices/tracking/osc.h"

#include "gi/core/error.h"
#include "gi/core/pose.h"
#include "gi/core/text.h"

#include <algorithm>
#include <cstring>
#include <lo/lo.h>
#include <memory>

namespace viewer {
namespace {

constexpr int kMostNesting = 8;
constexpr std::size_t kMostMessages = 1024; ///< per packet

std::vector<std::string> const& argument_names()
{
    static std::vector<std::string> const names{"x",       "y",       "z",       "qx",   "qy",   "qz",
                                                "qw",      "yaw",     "pitch",   "roll", "time", "frame",
                                                "buttons", "visible", "quality", "axes", "body", "_"};
    return names;
}

struct Message {
    std::string path, types;
    std::vector<std::optional<double>> numbers; ///< per argument, if it is a number
    std::vector<std::string> texts;             ///< per argument, if it is a text
};

struct FreeMessage { // liblo's handles are void* up to version 0.31
    using pointer = lo_message;
    void operator()(lo_message m) const { lo_message_free(m); }
};
struct FreeBundle {
    using pointer = lo_bundle;
    void operator()(lo_bundle b) const { lo_bundle_free_recursive(b); }
};

/// Length of the text that begins there, including padding; 0 if it does not end within the bytes.
std::size_t padded_text(std::span<unsigned char const> bytes)
{
    auto const end = std::find(bytes.begin(), bytes.end(), 0);
    if (end == bytes.end()) return 0;
    std::size_t const length = (std::size_t(end - bytes.begin()) / 4 + 1) * 4;
    return length <= bytes.size() ? length : 0;
}

/// Reads unaligned arguments: 8-byte values are at multiples of 4.
template <typename T>
T value_at(lo_arg const* argument)
{
    T value;
    std::memcpy(&value, static_cast<void const*>(argument), sizeof value);
    return value;
}

/// Decodes the arguments with liblo. Checks first what liblo does not: an empty type list.
std::optional<Message> read_message(std::span<unsigned char const> bytes)
{
    std::size_t const path = padded_text(bytes);
    if (path == 0 || bytes[0] != '/' || bytes.size() <= path || bytes[path] != ',') return std::nullopt;
    if (padded_text(bytes.subspan(path)) == 0) return std::nullopt;
    std::vector<unsigned char> copy(bytes.begin(), bytes.end()); // liblo needs writable memory
    int result = 0;
    std::unique_ptr<void, FreeMessage> const m(lo_message_deserialise(copy.data(), copy.size(), &result));
    if (!m) return std::nullopt;
    Message message;
    message.path = reinterpret_cast<char const*>(bytes.data());
    message.types = lo_message_get_types(m.get());
    lo_arg** const arguments = lo_message_get_argv(m.get());
    std::size_t const count = std::size_t(lo_message_get_argc(m.get()));
    for (std::size_t i = 0; i < count; ++i) {
        std::optional<double> number;
        std::string text;
        lo_arg const* const a = arguments[i];
        switch (message.types[i]) {
        case 'i':
            number = value_at<std::int32_t>(a);
            break;
        case 'h':
            number = double(value_at<std::int64_t>(a));
            break;
        case 'f':
            number = double(value_at<float>(a));
            break;
        case 'd':
            number = value_at<double>(a);
            break;
        case 'T':
            number = 1;
            break;
        case 'F':
            number = 0;
            break;
        case 's':
        case 'S':
            text = reinterpret_cast<char const*>(a);
            break;
        default:
            break;
        }
        if (number && !(std::abs(*number) <= kLargestNumber)) number.reset();
        message.numbers.push_back(number);
        message.texts.push_back(std::move(text));
    }
    return message;
}

/// The name at <body>, empty if the pattern has none; none if the path does not match.
std::optional<std::string> match(std::string_view pattern, std::string_view path)
{
    std::string body;
    while (!pattern.empty() && !path.empty()) {
        std::string_view const wanted = gi::take_until(pattern, '/'), given = gi::take_until(path, '/');
        if (wanted == "<body>" && !given.empty())
            body = given;
        else if (wanted != given)
            return std::nullopt;
        if (pattern.empty() != path.empty()) return std::nullopt;
    }
    return body;
}

/// None if the arguments do not match the pattern.
std::optional<TrackerSample> read_sample(Message const& m, OscPattern const& pattern, std::string body,
                                         std::optional<double> bundle_time_s)
{
    TrackerSample sample;
    sample.measured_s = bundle_time_s;
    gi::dvec3 angles{0};
    glm::dvec4 q{0};
    bool has_position = false, has_quaternion = false, has_angles = false, may_end = false;
    std::size_t at = 0;
    std::string_view words = pattern.arguments;
    for (std::string_view word = gi::take_word(words); !word.empty(); word = gi::take_word(words)) {
        if (word.front() == '[') may_end = true;
        while (!word.empty() && word.front() == '[') word.remove_prefix(1);
        while (!word.empty() && word.back() == ']') word.remove_suffix(1);
        if (at == m.numbers.size()) {
            if (may_end) break;
            return std::nullopt;
        }
        std::optional<double> const number = m.numbers[at];
        std::string const& text = m.texts[at];
        ++at;
        if (word == "_") continue;
        if (word == "body") {
            if (number && *number == std::floor(*number))
                body = std::to_string(std::int64_t(*number));
            else if (!text.empty())
                body = text;
            else
                return std::nullopt;
            continue;
        }
        if (!number) return std::nullopt;
        double const n = *number;
        if (word == "x" || word == "y" || word == "z") {
            sample.pose.position[word[0] - 'x'] = n;
            has_position = true;
        } else if (word.front() == 'q' && word.size() == 2) {
            q[word == "qw" ? 3 : word[1] - 'x'] = n;
            has_quaternion = true;
        } else if (word == "yaw" || word == "pitch" || word == "roll") {
            angles[word == "yaw" ? 0 : word == "pitch" ? 1 : 2] = glm::radians(n);
            has_angles = true;
        } else if (word == "time") {
            sample.measured_s = n;
        } else if (word == "visible") {
            sample.visible = n != 0;
        } else if (word == "quality") {
            sample.quality = std::clamp(n, 0.0, 1.0);
        } else if (word == "buttons") {
            if (!(n >= -2147483648.0 && n <= 4294967295.0) || n != std::floor(n)) return std::nullopt;
            sample.buttons = std::uint32_t(std::int64_t(n)); // a negative int32 has the same bits
        } else if (word == "axes") {                         // all that follow
            sample.axes.push_back(n);
            for (; at < m.numbers.size(); ++at) {
                if (!m.numbers[at]) return std::nullopt;
                if (sample.axes.size() < kMostAxes) sample.axes.push_back(*m.numbers[at]);
            }
        } else if (word == "frame") {
            if (!(n >= 0) || n != std::floor(n)) return std::nullopt;
            sample.frame = std::uint64_t(n);
        }
    }
    if (at != m.numbers.size() || body.empty()) return std::nullopt;
    sample.body = std::move(body);
    if (has_quaternion && sample.visible) {
        double const length = glm::length(q);
        if (!(std::abs(length - 1) < 0.05)) return std::nullopt;
        sample.pose.rotation = glm::normalize(gi::dquat(q.w, q.x, q.y, q.z));
    }
    if (has_angles)
        sample.pose.rotation = gi::exp_rotation({0, angles[0], 0}) * gi::exp_rotation({angles[1], 0, 0}) *
                               gi::exp_rotation({0, 0, angles[2]});
    bool const has_rotation = has_quaternion || has_angles;
    sample.parts = has_position && has_rotation ? SampleParts::pose
                   : has_position               ? SampleParts::position
                   : has_rotation               ? SampleParts::rotation
                                                : SampleParts::buttons;
    return sample;
}

std::uint32_t big_endian(std::span<unsigned char const> b)
{
    return std::uint32_t(b[0]) << 24 | std::uint32_t(b[1]) << 16 | std::uint32_t(b[2]) << 8 | std::uint32_t(b[3]);
}

bool is_bundle(std::span<unsigned char const> bytes)
{
    return bytes.size() >= 16 && std::memcmp(bytes.data(), "#bundle", 8) == 0;
}

struct Reader {
    std::vector<OscPattern> const& patterns;
    TrackerPacket& packet;
    std::size_t messages = 0;

    void read(std::span<unsigned char const> bytes, std::optional<double> time_s, int depth)
    {
        if (is_bundle(bytes))
            read_bundle(bytes, depth);
        else
            read_one(bytes, time_s);
    }

    void read_bundle(std::span<unsigned char const> bytes, int depth)
    {
        if (depth == kMostNesting) {
            ++packet.malformed;
            return;
        }
        std::uint32_t const seconds = big_endian(bytes.subspan(8)), fraction = big_endian(bytes.subspan(12));
        std::optional<double> time_s; // NTP time; 0.1 means "immediately", which is not a time
        if (seconds != 0) time_s = seconds + fraction / 4294967296.0;
        bytes = bytes.subspan(16);
        while (!bytes.empty()) {
            std::uint32_t const size = bytes.size() >= 4 ? big_endian(bytes) : 0;
            if (size == 0 || size > bytes.size() - 4 || messages >= kMostMessages) {
                ++packet.malformed;
                return;
            }
            read(bytes.subspan(4, size), time_s, depth + 1);
            bytes = bytes.subspan(4 + std::size_t(size));
        }
    }

    void read_one(std::span<unsigned char const> bytes, std::optional<double> time_s)
    {
        ++messages;
        auto const message = read_message(bytes);
        if (!message) {
            ++packet.malformed;
            return;
        }
        bool named = false;
        for (OscPattern const& p : patterns) {
            auto const body = match(p.path, message->path);
            if (!body) continue;
            named = true;
            if (auto sample = read_sample(*message, p, *body, time_s)) {
                add(std::move(*sample));
                return;
            }
        }
        ++(named ? packet.malformed : packet.ignored);
    }

    /// Merges a position and a rotation of the same body and time.
    void add(TrackerSample sample)
    {
        for (TrackerSample& s : packet.samples) {
            if (s.body != sample.body || s.measured_s != sample.measured_s) continue;
            if (s.parts == SampleParts::position && sample.parts == SampleParts::rotation)
                s.pose.rotation = sample.pose.rotation;
            else if (s.parts == SampleParts::rotation && sample.parts == SampleParts::position)
                s.pose.position = sample.pose.position;
            else
                continue;
            s.parts = SampleParts::pose;
            s.visible = s.visible && sample.visible;
            if (sample.buttons) s.buttons = sample.buttons;
            return;
        }
        packet.samples.push_back(std::move(sample));
    }
};

} // namespace

std::vector<OscPattern> const& default_osc_patterns()
{
    static std::vector<OscPattern> const patterns{
        {"/tracker/<body>/pose", "x y z qx qy qz qw [time frame buttons visible]"},
        {"/tracker/<body>/position", "x y z [time frame]"},
        {"/tracker/<body>/rotation", "qx qy qz qw [time frame]"},
        {"/tracker/<body>/euler", "yaw pitch roll [time frame]"},
        {"/tracker/<body>/pose_euler", "x y z yaw pitch roll [time frame]"},
        {"/tracker/<body>/buttons", "buttons"},
        {"/tracker/<body>/axes", "axes"},
        {"/VMC/Ext/Hmd/Pos", "body x y z qx qy qz qw"},
        {"/VMC/Ext/Con/Pos", "body x y z qx qy qz qw"},
        {"/VMC/Ext/Tra/Pos", "body x y z qx qy qz qw"},
        {"/tracking/trackers/<body>/position", "x y z"},
        {"/tracking/trackers/<body>/rotation", "pitch yaw roll"},
    };
    return patterns;
}

void check(OscPattern const& pattern)
{
    std::string const name = "OSC pattern '" + pattern.path + "' with arguments '" + pattern.arguments + "'";
    if (!pattern.path.starts_with('/'))
        throw gi::InputError(name + " is not understood", "an OSC address begins with /",
                             "write /tracker/<body>/pose");
    bool has_body = ("/" + pattern.path + "/").find("/<body>/") != std::string::npos;
    std::vector<std::string> seen;
    int quaternion = 0, position = 0, angles = 0;
    std::string_view words = pattern.arguments;
    for (std::string_view word = gi::take_word(words); !word.empty(); word = gi::take_word(words)) {
        while (!word.empty() && word.front() == '[') word.remove_prefix(1);
        while (!word.empty() && word.back() == ']') word.remove_suffix(1);
        std::string const w(word);
        auto const& known = argument_names();
        if (std::find(known.begin(), known.end(), w) == known.end())
            throw gi::InputError(
                name + " is not understood", "there is no argument '" + w + "'",
                "use x y z qx qy qz qw yaw pitch roll time frame buttons visible quality axes body _");
        if (w != "_" && std::find(seen.begin(), seen.end(), w) != seen.end())
            throw gi::InputError(name + " is not understood", "'" + w + "' occurs twice", "name it once");
        if (!seen.empty() && seen.back() == "axes")
            throw gi::InputError(name + " is not understood",
                                 "axes are all arguments that follow, but '" + w + "' comes", "put axes last");
        seen.push_back(w);
        has_body = has_body || w == "body";
        quaternion += w.front() == 'q' && w.size() == 2;
        position += w == "x" || w == "y" || w == "z";
        angles += w == "yaw" || w == "pitch" || w == "roll";
    }
    if (!has_body)
        throw gi::InputError(name + " names no body", "poses need the name of their body",
                             "put <body> into the path or body among the arguments");
    if (position % 3 != 0 || quaternion % 4 != 0 || angles % 3 != 0 || (quaternion > 0 && angles > 0))
        throw gi::InputError(name + " is not understood",
                             "a position is x y z, a rotation is qx qy qz qw or yaw pitch roll",
                             "name all of them");
}

TrackerPacket parse_osc(std::span<unsigned char const> bytes, std::vector<OscPattern> const& patterns)
{
    TrackerPacket packet;
    Reader{patterns, packet}.read(bytes, std::nullopt, 0);
    return packet;
}

std::vector<unsigned char> format_osc(std::vector<TrackerSample> const& samples, std::uint64_t frame)
{
    lo_timetag const at_once{0, 1};
    std::unique_ptr<void, FreeBundle> const bundle(lo_bundle_new(at_once));
    for (TrackerSample const& s : samples) {
        lo_message const m = lo_message_new();
        for (int i = 0; i < 3; ++i) lo_message_add_double(m, s.pose.position[i]);
        for (double const q : {s.pose.rotation.x, s.pose.rotation.y, s.pose.rotation.z, s.pose.rotation.w})
            lo_message_add_double(m, q);
        lo_message_add_double(m, s.measured_s.value_or(s.received_s));
        lo_message_add_int64(m, std::int64_t(frame));
        lo_message_add_int64(m, s.buttons.value_or(0));
        lo_message_add_int32(m, s.visible ? 1 : 0);
        lo_bundle_add_message(bundle.get(), ("/tracker/" + s.body + "/pose").c_str(), m);
        if (s.axes.empty()) continue;
        lo_message const axes = lo_message_new();
        for (double const axis : s.axes) lo_message_add_float(axes, float(axis));
        lo_bundle_add_message(bundle.get(), ("/tracker/" + s.body + "/axes").c_str(), axes);
    }
    std::size_t size = lo_bundle_length(bundle.get());
    std::vector<unsigned char> bytes(size);
    lo_bundle_serialise(bundle.get(), bytes.data(), &size);
    return bytes;
}

} // namespace viewer
