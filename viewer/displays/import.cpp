#include "viewer/displays/import.h"

#include "gi/core/file.h"
#include "viewer/displays/calibration.h"
#include "viewer/displays/check.h"
#include "viewer/displays/display_file.h"
#include "viewer/displays/import_common.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <map>
#include <set>

namespace viewer {

char const* name_of(DisplayFormat format)
{
    switch (format) {
    case DisplayFormat::sgct:
        return "SGCT";
    case DisplayFormat::pvx:
        return "ParaView";
    case DisplayFormat::equalizer:
        return "Equalizer";
    case DisplayFormat::vrui:
        return "Vrui";
    case DisplayFormat::ndisplay:
        return "nDisplay";
    case DisplayFormat::mpcdi:
        return "MPCDI";
    case DisplayFormat::vioso:
        return "VIOSO";
    case DisplayFormat::yaml:
        break;
    }
    return "Lightwell";
}

namespace {

/// By the name of the first element.
DisplayFormat format_of_xml(std::filesystem::path const& file)
{
    constexpr std::size_t kMostXmlBytes = std::size_t(1) << 20;
    std::string const text = gi::read_text(file, kMostXmlBytes);
    std::size_t at = 0;
    while ((at = text.find('<', at)) != std::string::npos && text.compare(at, 4, "<!--") == 0)
        at = text.find("-->", at);
    while (at != std::string::npos && at + 1 < text.size() && (text[at + 1] == '?' || text[at + 1] == '!'))
        at = text.find('<', at + 1);
    return at != std::string::npos && text.compare(at, 6, "<MPCDI") == 0 ? DisplayFormat::mpcdi
                                                                         : DisplayFormat::sgct;
}

} // namespace

DisplayFormat format_of(std::filesystem::path const& file)
{
    std::string const end = file.extension().string();
    for (auto const& [known, format] : {std::pair{".yaml", DisplayFormat::yaml},
                                        {".yml", DisplayFormat::yaml},
                                        {".json", DisplayFormat::sgct},
                                        {".xml", DisplayFormat::sgct},
                                        {".ndisplay", DisplayFormat::ndisplay},
                                        {".pvx", DisplayFormat::pvx},
                                        {".mpcdi", DisplayFormat::mpcdi},
                                        {".vwf", DisplayFormat::vioso},
                                        {".eqc", DisplayFormat::equalizer},
                                        {".cfg", DisplayFormat::vrui}})
        if (end == known) return format == DisplayFormat::sgct && end == ".xml" ? format_of_xml(file) : format;
    if (end == ".ol" || end == ".pol")
        throw gi::InputError("'" + file.string() + "' is a calibration of Scalable Display's EasyBlend",
                             "its format is not public: only their library reads it",
                             "export the calibration as MPCDI, which is read");
    throw gi::InputError(
        "'" + file.string() + "' is of no known kind of display", "its file extension is unknown",
        ".yaml (ours), .json and .xml (SGCT), .pvx (ParaView), .eqc (Equalizer), .cfg (Vrui, nDisplay), "
        ".ndisplay, .mpcdi and mpcdi.xml, .vwf (VIOSO)");
}

namespace {

std::string text_of(std::filesystem::path const& file)
{
    auto const bytes = gi::read_bytes(file, std::size_t(1) << 20);
    return {bytes.begin(), bytes.end()};
}

/// The older text format of nDisplay shares its extension with Vrui.
bool is_ndisplay_cfg(std::string const& text)
{
    for (std::size_t at = 0; at < text.size();) {
        std::size_t const end = std::min(text.find('\n', at), text.size());
        std::size_t const first = text.find_first_not_of(" \t\r", at);
        if (first < end && text[first] != '#') return text[first] == '[';
        at = end + 1;
    }
    return false;
}

Display parse(std::filesystem::path const& file, ImportOptions const& o, ImportLog const& log)
{
    DisplayFormat const format = format_of(file);
    std::string name = file.string();
    bool const is_archive = format == DisplayFormat::mpcdi && file.extension() != ".xml";
    std::string const text = is_archive || format == DisplayFormat::vioso ? "" : text_of(file);
    bool const is_vrui = format == DisplayFormat::vrui && !is_ndisplay_cfg(text);
    if (!is_vrui && !(o.section.empty() && o.base_file.empty()))
        throw gi::InputError("a section or base file of " + name, "only configurations of Vrui have them",
                             "leave it out");
    switch (format) {
    case DisplayFormat::sgct:
        return file.extension() == ".xml" ? parse_sgct_xml(text, name, log) : parse_sgct(text, name, log);
    case DisplayFormat::pvx:
        return parse_pvx(text, name, log);
    case DisplayFormat::equalizer:
        return parse_equalizer(text, name, log);
    case DisplayFormat::ndisplay:
        return parse_ndisplay(text, name, log);
    case DisplayFormat::mpcdi:
        if (is_archive) {
            CalibrationFiles const archive = CalibrationFiles::of_archive(file);
            std::string const xml = mpcdi_text(archive, file, name);
            return display_of(read_mpcdi(xml, name, archive, log), name, log);
        }
        return display_of(read_mpcdi(text, name, CalibrationFiles::of_folder(file.parent_path()), log), name, log);
    case DisplayFormat::vrui:
        if (!is_vrui) return parse_ndisplay_cfg(text, name, log);
        if (o.base_file.empty()) return parse_vrui(text, name, o.section, log);
        return parse_vrui({{text_of(o.base_file), o.base_file.string()}, {text, name}}, o.section, log);
    case DisplayFormat::vioso:
        return display_of(read_vioso(read_map_bytes(file), name, kViosoUnit_m, log), name, log);
    case DisplayFormat::yaml:
        break;
    }
    return parse_display(text, name, log.report());
}

} // namespace

void ImportLog::lose(std::string const& what, std::uint64_t count, std::string const& where) const
{
    constexpr std::size_t kMost = 10000;
    report_->lose(what, count, where);
    if (parts_->size() < kMost) parts_->push_back({what, where});
}

std::string ImportLog::keep_file(std::string const& name, std::vector<unsigned char> bytes) const
{
    auto const is_taken = [&](std::string const& wanted) {
        return std::ranges::any_of(*files_, [&](KeptFile const& f) { return f.name == wanted; });
    };
    std::string plain;
    for (char const c : name)
        plain += std::isalnum(static_cast<unsigned char>(c)) || c == '-' || c == '_' || c == '.' ? c : '_';
    std::size_t const dot = plain.rfind('.');
    std::string free = prefix_ + plain;
    for (int n = 2; is_taken(free); ++n)
        free = prefix_ + fmt::format("{}_{}{}", plain.substr(0, dot), n, plain.substr(dot));
    files_->push_back({free, std::move(bytes)});
    return free;
}

void ImportLog::keep_only(std::set<std::string> const& names) const
{
    std::erase_if(*files_, [&](KeptFile const& f) { return !names.contains(f.name); });
}

Display import_display(std::filesystem::path const& file, ImportOptions const& options, ImportLog const& log)
{
    Display display = parse(file, options, log);
    std::set<std::string> named;
    for (Wall const& wall : display.walls)
        for (std::string const& name : files_of(wall)) named.insert(name);
    log.keep_only(named); // without those of viewports that were skipped
    return display;
}

double imported_eyes(double metres, std::string const& where, ImportLog const& log)
{
    if (metres >= kNarrowestEyes_m && metres <= kWidestEyes_m) return metres;
    log.lose("implausible interpupillary distances, replaced by 0.063 m", 1,
             fmt::format("{}: {} m", where, metres));
    return User{}.interpupillary_m;
}

void place_eyes(User& user, gi::dvec3 left, gi::dvec3 right, std::string const& where, ImportLog const& log)
{
    gi::dvec3 const between = right - left, middle = 0.5 * (left + right);
    double const distance = glm::length(between);
    user.interpupillary_m = imported_eyes(distance, where, log);
    if (distance > 1e-9 && glm::length(between / distance - gi::dvec3{1, 0, 0}) > 1e-9) {
        // The turn about y, then the least one that lifts an eye: the head does not nod.
        double const level = std::hypot(between.x, between.z), yaw = std::atan2(-between.z, between.x);
        user.head.rotation_deg = {0, glm::degrees(yaw), 0};
        if (std::abs(between.y) > 1e-9 * distance) {
            gi::dquat const turn = glm::angleAxis(yaw, gi::dvec3{0, 1, 0}),
                            lift = glm::angleAxis(std::atan2(between.y, level), gi::dvec3{0, 0, 1});
            user.head.rotation_deg = placement_of({user.head.translation_m, turn * lift}).rotation_deg;
        }
        if (std::abs(between.y) > 1e-3 * distance)
            log.lose(
                "eyes at different heights: kept for the resting head, side by side once a tracker gives its pose",
                1, where);
        if (between.x < 0)
            log.lose(
                "eyes of which the right one is on the left: kept for the resting head, not once a tracker gives "
                "its pose",
                1, where);
    }
    user.eye_offset_m = glm::conjugate(pose_of(user.head).rotation) * middle;
}

void lose_address(std::string const& address, std::string const& where, ImportLog const& log)
{
    if (address.empty() || address == "localhost" || address.starts_with("127.")) return;
    log.lose("addresses of machines: not imported, they are given when a cluster is started", 1,
             where + ": " + address.substr(0, 64));
}

Viewport from_below(double x, double y, double width, double height)
{
    return {LengthUnit::fraction, x, 1 - y - height, width, height};
}

namespace {

/// Windows without walls (helpers that draw parts for others) and processes without windows are left out.
void drop_unused(Display& d, std::string const& file, ImportLog const& log)
{
    std::vector<int> window_of(d.windows.size(), -1);
    std::vector<DisplayWindow> windows;
    std::map<int, int> rank_of;
    for (Wall const& wall : d.walls) {
        window_of[std::size_t(wall.window)] = 0;
        rank_of[wall.rank] = 0;
    }
    for (std::size_t w = 0; w < d.windows.size(); ++w) {
        if (window_of[w] < 0) {
            log.lose("windows that show no wall: not imported", 1, file + ", window '" + d.windows[w].name + "'");
            continue;
        }
        window_of[w] = int(windows.size());
        windows.push_back(d.windows[w]);
    }
    int next = 0;
    for (auto& [theirs, ours] : rank_of) ours = next++;
    for (Wall& wall : d.walls) {
        wall.window = window_of[std::size_t(wall.window)];
        wall.rank = rank_of[wall.rank];
    }
    d.windows = std::move(windows);
}

} // namespace

Display finished(Display display, std::string const& file, ImportLog const& log)
{
    if (display.walls.empty()) {
        constexpr std::size_t kNamed = 3;
        std::vector<SkippedPart> parts = log.parts(); // skipped walls first
        std::stable_partition(parts.begin(), parts.end(), [](SkippedPart const& part) {
            return part.what.find("skipped") != std::string::npos;
        });
        std::string skipped;
        for (std::size_t i = 0; i < std::min(kNamed, parts.size()); ++i)
            skipped += (i ? "; " : "") + parts[i].what + " (" + parts[i].where + ")";
        if (parts.size() > kNamed) skipped += fmt::format("; and {} more", parts.size() - kNamed);
        throw gi::InputError({file, 0, 0}, "no wall could be imported",
                             skipped.empty() ? "the file describes none" : skipped,
                             "walls with corners or projections are needed");
    }
    drop_unused(display, file, log);
    for (Wall& wall : display.walls)
        for (gi::dvec3* p : {&wall.corners.lower_left, &wall.corners.lower_right, &wall.corners.upper_left})
            *p += gi::dvec3(0); // no -0
    // Fractions written with few digits may miss the window's edge by less than a pixel.
    for (Wall& wall : display.walls)
        if (Viewport& v = wall.viewport; v.unit == LengthUnit::fraction) {
            auto const tidy = [](double& at, double& size) {
                if (std::abs(at) < 1e-3) at = 0;
                if (std::abs(at + size - 1) < 1e-3) size = 1 - at;
            };
            tidy(v.x, v.width);
            tidy(v.y, v.height);
        }
    require_sound(display, file);
    report_doubts(display, log.report());
    return display;
}

} // namespace viewer
