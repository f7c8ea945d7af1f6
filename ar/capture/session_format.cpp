#include "ar/capture/session_format.h"

#include "gi/core/crc32.h"
#include "gi/core/error.h"

#include <array>
#include <charconv>
#include <cmath>
#include <ctime>
#include <fmt/chrono.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace ar {
namespace {

using Json = nlohmann::ordered_json;

constexpr std::string_view kSumKey = ",\"crc32\":\"";
constexpr std::size_t kSumTail = kSumKey.size() + 8 + 2; // and "}
constexpr std::array kFormats{PixelFormat::rgb8, PixelFormat::bgr8,  PixelFormat::gray8, PixelFormat::nv12,
                              PixelFormat::yuyv, PixelFormat::mjpeg, PixelFormat::rgb16, PixelFormat::rgb_linear};
constexpr std::array kOrigins{TimestampOrigin::sensor, TimestampOrigin::driver, TimestampOrigin::file,
                              TimestampOrigin::arrival};

/// What is wrong with a value, as text for whoever reads the whole.
struct Wrong : std::runtime_error {
    using std::runtime_error::runtime_error;
};

template <typename Enum, std::size_t N>
Enum named(std::array<Enum, N> const& all, Json const& json, char const* what)
{
    for (Enum const e : all)
        if (json.is_string() && json.get_ref<std::string const&>() == name_of(e)) return e;
    throw Wrong(fmt::format("an unknown {}", what));
}

Json const& at(Json const& json, char const* key)
{
    if (!json.is_object()) throw Wrong(fmt::format("no object where '{}' should be in one", key));
    auto const found = json.find(key);
    if (found == json.end()) throw Wrong(fmt::format("no '{}'", key));
    return *found;
}

double number(Json const& json, char const* what)
{
    if (!json.is_number()) throw Wrong(fmt::format("{} is no number", what));
    double const v = json.get<double>();
    if (!std::isfinite(v)) throw Wrong(fmt::format("{} is not finite", what));
    return v;
}

std::uint64_t count(Json const& json, char const* what)
{
    if (!json.is_number_unsigned()) throw Wrong(fmt::format("{} is no whole number from 0 on", what));
    return json.get<std::uint64_t>();
}

std::string text(Json const& json, char const* what)
{
    if (!json.is_string()) throw Wrong(fmt::format("{} is no text", what));
    return json.get<std::string>();
}

glm::ivec2 size_in(Json const& json)
{
    if (!json.is_array() || json.size() != 2) throw Wrong("size_px is no pair");
    std::uint64_t const x = count(json[0], "size_px"), y = count(json[1], "size_px");
    if (x < 1 || y < 1 || x > 65536 || y > 65536) throw Wrong("size_px is not 1 to 65536 each way");
    return {int(x), int(y)};
}

std::uint32_t sum_in(std::string_view hex)
{
    std::uint32_t sum = 0;
    auto const [end, error] = std::from_chars(hex.data(), hex.data() + hex.size(), sum, 16);
    if (hex.size() != 8 || error != std::errc() || end != hex.data() + hex.size())
        throw Wrong("a checksum that is none");
    return sum;
}

Json json_of(Controls const& c)
{
    Json json = Json::object();
    auto const put = [&](char const* name, auto const& value) {
        if (value) json[name] = *value;
    };
    put("automatic_exposure", c.automatic_exposure);
    put("exposure_time_s", c.exposure_time_s);
    put("gain", c.gain);
    put("automatic_white_balance", c.automatic_white_balance);
    put("red_gain", c.red_gain);
    put("blue_gain", c.blue_gain);
    put("frame_duration_s", c.frame_duration_s);
    return json;
}

Controls controls_of(Json const& json)
{
    Controls c;
    if (!json.is_object()) throw Wrong("'controls' is no object");
    auto const get_number = [&](char const* name, std::optional<double>& to) {
        if (json.contains(name)) to = number(json[name], name);
    };
    auto const get_bool = [&](char const* name, std::optional<bool>& to) {
        if (!json.contains(name)) return;
        if (!json[name].is_boolean()) throw Wrong(fmt::format("{} is neither true nor false", name));
        to = json[name].get<bool>();
    };
    get_bool("automatic_exposure", c.automatic_exposure);
    get_number("exposure_time_s", c.exposure_time_s);
    get_number("gain", c.gain);
    get_bool("automatic_white_balance", c.automatic_white_balance);
    get_number("red_gain", c.red_gain);
    get_number("blue_gain", c.blue_gain);
    get_number("frame_duration_s", c.frame_duration_s);
    return c;
}

IndexEntry frame_entry(Json const& json)
{
    IndexEntry e;
    Frame& f = e.frame;
    f.sequence = count(at(json, "sequence"), "sequence");
    f.captured_s = number(at(json, "captured_s"), "captured_s");
    f.arrived_s = number(at(json, "arrived_s"), "arrived_s");
    f.origin = named(kOrigins, at(json, "origin"), "origin");
    Json const& exposure = at(json, "exposure");
    if (!exposure.is_array() || exposure.size() != 4) throw Wrong("exposure has not four numbers");
    f.exposure = {number(exposure[0], "exposure"), number(exposure[1], "exposure"),
                  number(exposure[2], "exposure"), number(exposure[3], "exposure")};
    f.format = named(kFormats, at(json, "format"), "format");
    f.size_px = size_in(at(json, "size_px"));
    e.at = count(at(json, "at"), "at");
    e.bytes = count(at(json, "bytes"), "bytes");
    e.sum = sum_in(text(at(json, "sum"), "sum"));
    std::uint64_t const expected = packed_bytes(f.format, f.size_px);
    if (e.bytes < 1 || e.bytes > kMostFrameBytes) throw Wrong("a frame without bytes, or with more than 1 GiB");
    if (expected != 0 && e.bytes != expected)
        throw Wrong(fmt::format("{} bytes where its format and size make {}", e.bytes, expected));
    bool const is_even = f.size_px.x % 2 == 0 && (f.format == PixelFormat::yuyv || f.size_px.y % 2 == 0);
    if ((f.format == PixelFormat::nv12 || f.format == PixelFormat::yuyv) && !is_even)
        throw Wrong("an odd size, which its format cannot have");
    return e;
}

/// Line and column of a byte.
gi::TextLocation place_of(std::string const& name, std::string const& text, std::size_t byte)
{
    gi::TextLocation place{name, 1, 1};
    for (std::size_t i = 0; i + 1 < byte && i < text.size(); ++i) {
        if (text[i] == '\n') {
            ++place.line;
            place.column = 0;
        }
        ++place.column;
    }
    return place;
}

} // namespace

std::uint32_t checksum(std::span<std::uint8_t const> bytes) { return gi::crc32(bytes); }

std::uint64_t packed_bytes(PixelFormat format, glm::ivec2 size)
{
    auto const pixels = std::uint64_t(size.x) * std::uint64_t(size.y);
    switch (format) {
    case PixelFormat::rgb8:
    case PixelFormat::bgr8:
        return 3 * pixels;
    case PixelFormat::gray8:
        return pixels;
    case PixelFormat::nv12:
        return pixels + 2 * (std::uint64_t(size.x / 2) * std::uint64_t(size.y / 2));
    case PixelFormat::yuyv:
        return 2 * pixels;
    case PixelFormat::mjpeg:
        return 0;
    case PixelFormat::rgb16:
        return 6 * pixels;
    case PixelFormat::rgb_linear:
        return 12 * pixels;
    }
    throw std::logic_error("a pixel format without a size");
}

void set_packed_planes(Frame& f, std::vector<std::uint8_t> bytes)
{
    auto const owner = std::make_shared<std::vector<std::uint8_t>>(std::move(bytes));
    int const x = f.size_px.x, y = f.size_px.y;
    f.planes = {};
    switch (f.format) {
    case PixelFormat::rgb8:
    case PixelFormat::bgr8:
        f.planes[0] = cv::Mat(y, x, CV_8UC3, owner->data());
        break;
    case PixelFormat::gray8:
        f.planes[0] = cv::Mat(y, x, CV_8UC1, owner->data());
        break;
    case PixelFormat::nv12:
        f.planes[0] = cv::Mat(y, x, CV_8UC1, owner->data());
        f.planes[1] = cv::Mat(y / 2, x / 2, CV_8UC2, owner->data() + std::size_t(x) * std::size_t(y));
        break;
    case PixelFormat::yuyv:
        f.planes[0] = cv::Mat(y, x, CV_8UC2, owner->data());
        break;
    case PixelFormat::mjpeg:
        f.planes[0] = cv::Mat(1, int(owner->size()), CV_8UC1, owner->data());
        break;
    case PixelFormat::rgb16:
        f.planes[0] = cv::Mat(y, x, CV_16UC3, owner->data());
        break;
    case PixelFormat::rgb_linear:
        f.planes[0] = cv::Mat(y, x, CV_32FC3, owner->data());
        break;
    }
    f.owner = owner;
}

std::string with_checksum(std::string const& text)
{
    std::uint32_t const sum = checksum({reinterpret_cast<std::uint8_t const*>(text.data()), text.size()});
    return fmt::format("{}{}{:08x}\"}}", text, kSumKey, sum);
}

std::string index_line(IndexEntry const& e)
{
    Json json;
    if (e.controls) {
        json["controls"] = json_of(*e.controls);
    } else {
        Frame const& f = e.frame;
        Exposure const& x = f.exposure;
        json["frame"] = {{"sequence", f.sequence},
                         {"captured_s", f.captured_s},
                         {"arrived_s", f.arrived_s},
                         {"origin", name_of(f.origin)},
                         {"exposure", {x.time_s, x.gain, x.red_gain, x.blue_gain}},
                         {"format", name_of(f.format)},
                         {"size_px", {f.size_px.x, f.size_px.y}},
                         {"at", e.at},
                         {"bytes", e.bytes},
                         {"sum", fmt::format("{:08x}", e.sum)}};
    }
    std::string line = json.dump();
    line.pop_back();
    return with_checksum(line);
}

std::optional<IndexEntry> parse_index_line(std::string_view line, std::string& problem)
{
    try {
        if (line.size() > kMostIndexLine) throw Wrong("too long");
        if (line.size() <= kSumTail || !line.ends_with("\"}")) throw Wrong("no line of an index");
        std::string_view const said = line.substr(0, line.size() - kSumTail), tail = line.substr(said.size());
        if (!tail.starts_with(kSumKey)) throw Wrong("no line of an index");
        if (checksum({reinterpret_cast<std::uint8_t const*>(said.data()), said.size()}) !=
            sum_in(tail.substr(kSumKey.size(), 8)))
            throw Wrong("changed (checksum)");
        Json const json = Json::parse(line);
        if (json.contains("controls")) {
            IndexEntry e;
            e.controls = controls_of(json["controls"]);
            return e;
        }
        return frame_entry(at(json, "frame"));
    } catch (Wrong const& e) {
        problem = e.what();
    } catch (Json::exception const&) {
        problem = "no JSON";
    }
    return std::nullopt;
}

std::string to_json(SessionHeader const& h)
{
    Json json;
    json["what"] = "recorded frames";
    json["version"] = kSessionVersion;
    json["created"] =
        h.created.empty() ? fmt::format("{:%Y-%m-%dT%H:%M:%SZ}", fmt::gmtime(std::time(nullptr))) : h.created;
    SourceDescription const& c = h.camera;
    json["camera"] = {{"name", c.name},
                      {"id", c.id},
                      {"size_px", {c.size_px.x, c.size_px.y}},
                      {"format", name_of(c.format)},
                      {"frames_per_s", c.frames_per_s},
                      {"controls", c.controls}};
    json["calibration"] = h.calibration;
    json["note"] = h.note;
    if (h.finished) json["finished"] = {{"frames", h.finished->frames}, {"lost", h.finished->lost}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

SessionHeader parse_session_header(std::string const& source, std::string const& name)
{
    try {
        Json const json = Json::parse(source);
        SessionHeader h;
        if (text(at(json, "what"), "what") != "recorded frames")
            throw Wrong("it is no session of recorded frames");
        if (std::uint64_t const v = count(at(json, "version"), "version"); v != kSessionVersion)
            throw gi::InputError(name + ": the session has format " + std::to_string(v),
                                 fmt::format("this version reads {}", kSessionVersion),
                                 "use the version of the program that recorded it");
        h.created = text(at(json, "created"), "created");
        h.calibration = text(at(json, "calibration"), "calibration");
        h.note = text(at(json, "note"), "note");
        Json const& c = at(json, "camera");
        h.camera.name = text(at(c, "name"), "name");
        h.camera.id = text(at(c, "id"), "id");
        h.camera.size_px = size_in(at(c, "size_px"));
        h.camera.format = named(kFormats, at(c, "format"), "format");
        h.camera.frames_per_s = number(at(c, "frames_per_s"), "frames_per_s");
        for (Json const& control : at(c, "controls")) h.camera.controls.push_back(text(control, "a control"));
        if (json.contains("finished")) {
            Json const& f = json["finished"];
            h.finished = {count(at(f, "frames"), "frames"), count(at(f, "lost"), "lost")};
        }
        return h;
    } catch (Wrong const& e) {
        throw gi::InputError(name + ": no recorded session that can be read", e.what(), "name another folder");
    } catch (Json::parse_error const& e) {
        throw gi::InputError(place_of(name, source, e.byte), "no JSON", "something else was expected here",
                             "name another folder");
    } catch (Json::exception const& e) {
        throw gi::InputError(name + ": no recorded session that can be read", e.what(), "name another folder");
    }
}

} // namespace ar
