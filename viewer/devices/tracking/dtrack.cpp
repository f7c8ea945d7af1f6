#include "viewer/devices/tracking/dtrack.h"

#include "gi/core/text.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>

namespace viewer {
namespace {

constexpr std::size_t kMostPacketBodies = 256; ///< per packet

/// Reads the numbers of one [...] and removes it from the text; false if there is none or a value is not a number.
bool take_block(std::string_view& text, std::vector<double>& numbers)
{
    text = gi::trimmed(text);
    std::size_t const end = text.find(']');
    if (text.empty() || text.front() != '[' || end == std::string_view::npos) return false;
    std::string_view inside = text.substr(1, end - 1);
    text.remove_prefix(end + 1);
    numbers.clear();
    for (std::string_view word = gi::take_word(inside); !word.empty(); word = gi::take_word(inside)) {
        auto const n = gi::parse_finite(word, kLargestNumber);
        if (!n) return false;
        numbers.push_back(*n);
    }
    return true;
}

enum class Rotation { good, absent, wrong };

Rotation read_rotation(std::vector<double> const& b, gi::dquat& rotation)
{
    glm::dmat3 m;
    double largest = 0;
    for (int i = 0; i < 9; ++i) {
        m[i / 3][i % 3] = b[std::size_t(i)]; // column by column, as in GLM
        largest = std::max(largest, std::abs(b[std::size_t(i)]));
    }
    if (largest == 0) return Rotation::absent;
    glm::dmat3 const unit = glm::transpose(m) * m;
    for (int c = 0; c < 3; ++c)
        for (int r = 0; r < 3; ++r)
            if (!(std::abs(unit[c][r] - (c == r ? 1.0 : 0.0)) < 0.01)) return Rotation::wrong;
    if (glm::determinant(m) < 0) return Rotation::wrong;
    rotation = glm::normalize(glm::quat_cast(m));
    return Rotation::good;
}

/// A whole number within 0..largest; -1 if invalid.
int whole(double value, int largest)
{
    return value >= 0 && value <= largest && value == std::floor(value) ? int(value) : -1;
}

enum class LineForm { body, flystick, flystick2 };

/// Reads one body of a line; false if it is malformed.
bool take_body(std::string_view& text, LineForm form, TrackerSample& sample)
{
    std::vector<double> head, place, matrix, controls;
    std::size_t const head_size = form == LineForm::body ? 2 : form == LineForm::flystick ? 3 : 4;
    std::size_t const place_size = form == LineForm::flystick2 ? 3 : 6;
    if (!take_block(text, head) || head.size() != head_size) return false;
    if (!take_block(text, place) || place.size() != place_size) return false;
    if (!take_block(text, matrix) || matrix.size() != 9) return false;
    int const id = whole(head[0], 9999);
    if (id < 0) return false;
    sample.body = (form == LineForm::body ? "" : "flystick") + std::to_string(id);
    if (form == LineForm::flystick) {
        if (!(head[2] >= 0 && head[2] <= 4294967295.0)) return false;
        sample.buttons = std::uint32_t(head[2]);
    }
    if (form == LineForm::flystick2) {
        int const buttons = whole(head[2], 1024), controllers = whole(head[3], 1024);
        if (buttons < 0 || controllers < 0 || !take_block(text, controls)) return false;
        std::size_t const words = std::size_t(buttons + 31) / 32;
        if (controls.size() != words + std::size_t(controllers)) return false;
        if (words > 0) {
            if (!(controls[0] >= 0 && controls[0] <= 4294967295.0)) return false;
            sample.buttons = std::uint32_t(controls[0]);
        }
        auto const first = controls.begin() + std::ptrdiff_t(words);
        sample.axes.assign(first, first + std::ptrdiff_t(std::min(std::size_t(controllers), kMostAxes)));
    }
    Rotation const rotation = read_rotation(matrix, sample.pose.rotation);
    if (rotation == Rotation::wrong) return false;
    sample.visible = head[1] >= 0 && rotation == Rotation::good;
    sample.quality = sample.visible ? std::min(1.0, head[1]) : 0.0;
    if (sample.visible) sample.pose.position = 1e-3 * gi::dvec3{place[0], place[1], place[2]};
    return true;
}

void read_bodies(std::string_view rest, LineForm form, TrackerPacket& packet)
{
    std::string_view const first = gi::take_word(rest);
    auto count = gi::parse_number<std::uint64_t>(first);
    if (count && form == LineForm::flystick2)
        count = gi::parse_number<std::uint64_t>(gi::take_word(rest)); // defined, then in this line
    if (!count || *count > kMostPacketBodies) {
        ++packet.malformed;
        return;
    }
    for (std::uint64_t i = 0; i < *count; ++i) {
        TrackerSample sample;
        if (packet.samples.size() >= kMostPacketBodies || !take_body(rest, form, sample)) {
            ++packet.malformed;
            return;
        }
        packet.samples.push_back(std::move(sample));
    }
    if (!gi::trimmed(rest).empty()) ++packet.malformed;
}

} // namespace

TrackerPacket parse_dtrack(std::string_view text)
{
    TrackerPacket packet;
    std::optional<double> time_s;
    while (!text.empty()) {
        std::string_view rest = gi::take_until(text, '\n');
        std::string_view const name = gi::take_word(rest);
        if (name.empty()) continue;
        if (name == "fr") {
            packet.frame = gi::parse_number<std::uint64_t>(gi::trimmed(rest));
            if (!packet.frame) ++packet.malformed;
        } else if (name == "ts") {
            time_s = gi::parse_finite(gi::trimmed(rest), kLargestNumber);
            if (!time_s) ++packet.malformed;
        } else if (name == "6dcal") {
            if (!gi::parse_number<std::uint64_t>(gi::trimmed(rest))) ++packet.malformed;
        } else if (name == "6d") {
            read_bodies(rest, LineForm::body, packet);
        } else if (name == "6df") {
            read_bodies(rest, LineForm::flystick, packet);
        } else if (name == "6df2") {
            read_bodies(rest, LineForm::flystick2, packet);
        } else {
            ++packet.ignored;
        }
    }
    for (TrackerSample& sample : packet.samples) sample.measured_s = time_s;
    return packet;
}

std::string format_dtrack(std::vector<TrackerSample> const& samples, std::uint64_t frame)
{
    std::string bodies, flysticks;
    int body_count = 0, seen_count = 0, flystick_count = 0;
    std::string time;
    for (TrackerSample const& s : samples) {
        bool const is_flystick = s.body.starts_with("flystick");
        auto const id = gi::parse_number<std::uint64_t>(std::string_view(s.body).substr(is_flystick ? 8 : 0));
        if (!id || *id > 9999) continue;
        if (s.measured_s && time.empty()) time = fmt::format("ts {:.6f}\r\n", *s.measured_s);
        glm::dmat3 const m = s.visible ? glm::mat3_cast(s.pose.rotation) : glm::dmat3(0);
        gi::dvec3 const p = s.visible ? 1e3 * s.pose.position : gi::dvec3{0};
        std::string matrix, place = fmt::format("{:.4f} {:.4f} {:.4f}", p.x, p.y, p.z);
        for (int i = 0; i < 9; ++i) matrix += fmt::format("{}{:.8f}", i == 0 ? "" : " ", m[i / 3][i % 3]);
        if (is_flystick) {
            ++flystick_count;
            std::string controls = std::to_string(s.buttons.value_or(0));
            for (double const axis : s.axes) controls += fmt::format(" {:.2f}", axis);
            flysticks += fmt::format(" [{} {:.3f} 32 {}][{}][{}][{}]", *id, s.visible ? 1.0 : -1.0, s.axes.size(),
                                     place, matrix, controls);
        } else {
            ++body_count;
            if (!s.visible) continue; // DTrack omits invisible bodies
            ++seen_count;
            gi::dvec3 const angles{std::atan2(-m[2][1], m[2][2]), std::asin(std::clamp(m[2][0], -1.0, 1.0)),
                                   std::atan2(-m[1][0], m[0][0])};
            bodies += fmt::format(" [{} {:.3f}][{} {:.4f} {:.4f} {:.4f}][{}]", *id, 1.0, place,
                                  glm::degrees(angles.x), glm::degrees(angles.y), glm::degrees(angles.z), matrix);
        }
    }
    std::string text =
        fmt::format("fr {}\r\n{}6dcal {}\r\n6d {}{}\r\n", frame, time, body_count, seen_count, bodies);
    if (flystick_count > 0) text += fmt::format("6df2 {} {}{}\r\n", flystick_count, flystick_count, flysticks);
    return text;
}

} // namespace viewer
