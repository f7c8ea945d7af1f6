// Vrui.cfg: sections of tags and values, one environment per section of "section Vrui".

#include "viewer/displays/import.h"
#include "viewer/displays/import_common.h"
#include "viewer/displays/text_tree.h"

#include <fmt/format.h>
#include <map>
#include <set>

namespace viewer {
namespace {

struct VruiContext {
    Display display;
    std::string file;
    gi::Report& report;
    gi::dvec3 right{1, 0, 0}, up{0, 0, 1}, forward{0, 1, 0};
    double metres = 0.0254; ///< per unit of length

    gi::dvec3 direction(gi::dvec3 v) const { return {glm::dot(v, right), glm::dot(v, up), -glm::dot(v, forward)}; }
    gi::dvec3 place(gi::dvec3 v) const { return metres * direction(v); }
    gi::InputError error(TextNode const& at, std::string const& problem, std::string const& why,
                         std::string const& suggestion) const
    {
        return {{file, at.line, at.column}, problem, why, suggestion};
    }
    std::string where(TextNode const& at) const { return fmt::format("{}:{}", file, at.line); }
    void lose_others(TextNode const& section, std::set<std::string> const& known)
    {
        for (TextNode const& tag : section.children)
            if (!known.contains(tag.key))
                report.lose(
                    fmt::format("Vrui {} of a screen, window or viewer: not imported", tag.key.substr(0, 64)), 1,
                    where(tag));
    }
};

/// Lines with their continuations; brackets and commas are dropped from values, quotes kept together.
TextNode read_sections(std::string const& text, std::string const& file)
{
    std::vector<TextNode> open{{"", {}, {}, 1, 1}};
    int line = 0;
    for (std::size_t at = 0; at < text.size();) {
        std::string logical;
        int const first = line + 1;
        for (bool more = true; more && at < text.size();) {
            std::size_t const end = std::min(text.find('\n', at), text.size());
            std::string part = text.substr(at, end - at);
            if (!part.empty() && part.back() == '\r') part.pop_back();
            at = end + 1;
            ++line;
            more = !part.empty() && part.back() == '\\';
            if (more) part.back() = ' ';
            logical += part;
        }
        std::vector<TextToken> tokens;
        for (TextToken& token : tokens_of(logical, "(),{};=", file))
            if (token.is_quoted || std::string("(),{};=").find(token.text) == std::string::npos) {
                token.line = first;
                tokens.push_back(std::move(token));
            }
        if (tokens.empty()) continue;
        TextToken const& key = tokens[0];
        if (key.text == "section") {
            if (tokens.size() < 2)
                throw gi::InputError({file, first, key.column}, "a section without a name",
                                     "it is found by its name", "section NAME");
            if (open.size() > std::size_t(kDeepestBlock))
                throw gi::InputError({file, first, key.column}, "sections nest too deeply", "100 levels are read",
                                     "check for a missing endsection");
            open.push_back({tokens[1].text, {}, {}, first, key.column});
        } else if (key.text == "endsection") {
            if (open.size() < 2)
                throw gi::InputError({file, first, key.column}, "an endsection too many", "nothing is open",
                                     "remove it");
            TextNode done = std::move(open.back());
            open.pop_back();
            open.back().children.push_back(std::move(done));
        } else {
            open.back().children.push_back({key.text, {tokens.begin() + 1, tokens.end()}, {}, first, key.column});
        }
    }
    if (open.size() > 1)
        throw gi::InputError({file, open.back().line, open.back().column},
                             "section '" + open.back().key.substr(0, 64) + "' has no end", "it is not closed",
                             "end it with endsection");
    return std::move(open.front());
}

std::vector<std::string> names_in(TextNode const& environment, std::string const& tag)
{
    std::vector<std::string> out;
    if (TextNode const* const node = environment.find(tag))
        for (TextToken const& token : node->values) out.push_back(token.text);
    return out;
}

TextNode const& section_of(TextNode const& environment, std::string const& name, char const* of,
                           VruiContext const& c)
{
    TextNode const* const node = environment.find(name);
    if (!node)
        throw c.error(environment, fmt::format("there is no section '{}'", name.substr(0, 64)),
                      fmt::format("{} names it", of), "is it in another file? merge them");
    return *node;
}

gi::dvec3 needed_point(TextNode const& section, char const* tag, VruiContext const& c)
{
    TextNode const* const node = section.find(tag);
    if (!node) throw c.error(section, std::string(tag) + " is missing", "the wall is not defined", "add it");
    return point_of(*node, c.file);
}

double number_in(TextNode const& section, char const* tag, double otherwise, VruiContext const& c)
{
    TextNode const* const node = section.find(tag);
    return node ? numbers_of(*node, 1, c.file)[0] : otherwise;
}

gi::dvec3 unit(gi::dvec3 v, TextNode const& at, VruiContext const& c)
{
    if (!(glm::length(v) > 1e-9)) throw c.error(at, "a direction is zero", "it points nowhere", "give another");
    return glm::normalize(v);
}

/// None for screens that are not fixed rectangles.
std::optional<WallCorners> read_screen(TextNode const& s, VruiContext& c)
{
    char const* odd = s.text("deviceMounted") == "true"               ? "carried by a device"
                      : s.text("offAxis") == "true"                   ? "with a homography"
                      : s.find("transform") || s.find("preTransform") ? "with a transformation"
                                                                      : nullptr;
    if (odd) {
        c.report.lose(fmt::format("Vrui screens {} skipped: only fixed rectangles are imported", odd), 1,
                      c.where(s));
        return {};
    }
    c.lose_others(s, {"name", "deviceMounted", "offAxis", "origin", "horizontalAxis", "verticalAxis", "width",
                      "height", "rotateCenter", "rotateAxis", "rotateAngle"});
    gi::dvec3 const across = unit(needed_point(s, "horizontalAxis", c), s, c);
    gi::dvec3 upward = unit(needed_point(s, "verticalAxis", c), s, c);
    // Vrui makes the second axis orthogonal to the first.
    upward = unit(upward - glm::dot(upward, across) * across, s, c);
    gi::dvec3 const origin = needed_point(s, "origin", c);
    double const width = number_in(s, "width", 0, c), height = number_in(s, "height", 0, c);
    gi::dvec3 corners[3] = {origin, origin + width * across, origin + height * upward};
    if (double const angle = number_in(s, "rotateAngle", 0, c); angle != 0) {
        TextNode const *const center = s.find("rotateCenter"), *const axis = s.find("rotateAxis");
        gi::dvec3 const about = center ? point_of(*center, c.file) : gi::dvec3{0};
        gi::dquat const turn =
            glm::angleAxis(glm::radians(angle), unit(axis ? point_of(*axis, c.file) : gi::dvec3{1, 0, 0}, s, c));
        for (gi::dvec3& p : corners) p = about + turn * (p - about);
    }
    return WallCorners{c.place(corners[0]), c.place(corners[1]), c.place(corners[2])};
}

User read_viewer(TextNode const& s, VruiContext& c)
{
    static std::set<std::string> const kLights{
        "headLightEnabled",    "headLightPosition",     "headLightDirection",  "headLightColor",
        "headLightSpotCutoff", "headLightSpotExponent", "headLightAttenuation"};
    std::set<std::string> known{"name",          "headTracked",     "headDevice",      "headDeviceTransformation",
                                "viewDirection", "monoEyePosition", "leftEyePosition", "rightEyePosition"};
    known.insert(kLights.begin(), kLights.end()); // our scenes have their own
    c.lose_others(s, known);
    User user;
    user.name = s.key;
    if (TextNode const* t = s.find("headDeviceTransformation")) {
        bool const is_translation = t->values.size() == 4 && t->values[0].text == "translate";
        if (is_translation)
            user.head.translation_m = c.place({number_of(t->values[1], c.file), number_of(t->values[2], c.file),
                                               number_of(t->values[3], c.file)});
        else
            c.report.lose("Vrui headDeviceTransformation that is more than translate (x, y, z): taken as none", 1,
                          c.where(*t));
    }
    if (s.text("headTracked") == "true")
        c.report.lose("Vrui device daemons are not supported trackers: the head rests until a tracker is added", 1,
                      c.where(s));
    TextNode const *const left = s.find("leftEyePosition"), *const right = s.find("rightEyePosition");
    if (!left || !right) {
        c.report.lose("interpupillary distance not in the file: 0.063 m assumed", 1, c.where(s));
        return user;
    }
    gi::dvec3 const l = c.place(point_of(*left, c.file)), r = c.place(point_of(*right, c.file)), between = r - l;
    user.interpupillary_m = imported_eyes(glm::length(between), "viewer '" + s.key + "'", c.report);
    if (glm::length(between) > 0) {
        double const yaw = std::atan2(-between.z, between.x);
        if (std::abs(yaw) > 1e-9) user.head.rotation_deg.y = glm::degrees(yaw);
        if (std::abs(between.y) > 1e-3 * glm::length(between))
            c.report.lose("Vrui viewers whose eyes are not level: taken as level", 1, c.where(s));
    }
    user.eye_offset_m = glm::conjugate(pose_of(user.head).rotation) * ((l + r) * 0.5);
    return user;
}

StereoMode stereo_of(TextNode const& window, VruiContext& c)
{
    std::string const type = window.text("windowType", "Mono");
    if (type == "Mono") return StereoMode::off;
    if (type == "QuadbufferStereo") return StereoMode::quad_buffer;
    if (type == "AnaglyphicStereo") return StereoMode::anaglyph_red_cyan;
    if (type == "SplitViewportStereo") return StereoMode::side_by_side;
    if (type == "InterlacedViewportStereo") return StereoMode::rows;
    c.report.lose("Vrui windowType " + type.substr(0, 64) + ": shown without stereo", 1, c.where(window));
    return StereoMode::off;
}

void read_window(TextNode const& environment, std::string const& name, int rank, VruiContext& c)
{
    TextNode const& s = section_of(environment, name, "the list of windows", c);
    c.lose_others(s, {"display", "windowPos", "windowFullscreen", "windowType", "screenName", "viewerName"});
    std::string const screen = s.text("screenName"), viewer = s.text("viewerName");
    auto const corners = read_screen(section_of(environment, screen, "screenName", c), c);
    if (!corners) return;
    DisplayWindow window;
    window.name = free_name(c.display.windows, name);
    window.fullscreen = s.text("windowFullscreen") == "true";
    if (TextNode const* pos = s.find("windowPos")) {
        auto const v = numbers_of(*pos, 4, c.file);
        for (double const x : v)
            if (std::abs(x) > 1e6)
                throw c.error(*pos, "a window is a million pixels away", "no desktop is", "check it");
        window.x_px = int(v[0]);
        window.y_px = int(v[1]);
        window.width_px = int(v[2]);
        window.height_px = int(v[3]);
    } else {
        window.width_px = 1920;
        window.height_px = 1080;
        c.report.lose("windows whose size the file does not tell, taken as 1920 x 1080", 1, c.where(s));
    }
    Wall wall;
    wall.name = free_name(c.display.walls, screen);
    wall.corners = *corners;
    wall.window = int(c.display.windows.size());
    wall.stereo = stereo_of(s, c);
    wall.rank = rank;
    wall.user = -1;
    for (std::size_t u = 0; u < c.display.users.size(); ++u)
        if (c.display.users[u].name == viewer) wall.user = int(u);
    if (wall.user < 0) {
        wall.user = int(c.display.users.size());
        c.display.users.push_back(read_viewer(section_of(environment, viewer, "viewerName", c), c));
    }
    c.display.windows.push_back(window);
    c.display.walls.push_back(wall);
}

void read_units(TextNode const& environment, VruiContext& c)
{
    TextNode const *const metre = environment.find("meterScale"), *const inch = environment.find("inchScale");
    double const scale = metre ? numbers_of(*metre, 1, c.file)[0] : inch ? numbers_of(*inch, 1, c.file)[0] : 1;
    if (!(scale > 1e-6 && scale < 1e6))
        throw c.error(environment, "the length unit is not positive, or out of range",
                      "inchScale and meterScale give the number of units", "inchScale 1.0");
    c.metres = (metre ? 1 : 0.0254) / scale;
    if (TextNode const* f = environment.find("forwardDirection")) c.forward = unit(point_of(*f, c.file), *f, c);
    if (TextNode const* u = environment.find("upDirection")) c.up = unit(point_of(*u, c.file), *u, c);
    c.right = unit(glm::cross(c.forward, c.up), environment, c);
    c.up = glm::cross(c.right, c.forward);
}

} // namespace

Display parse_vrui(std::string const& text, std::string const& name, std::string const& section,
                   gi::Report& report)
{
    TextNode const file = read_sections(text, name);
    TextNode const* const vrui = file.find("Vrui");
    if (!vrui)
        throw gi::InputError({name, 1, 1}, "there is no section Vrui", "configurations of Vrui have one",
                             "is this a file of Vrui?");
    TextNode const* environment = nullptr;
    std::string others;
    int other_count = 0;
    for (TextNode const& child : vrui->children) {
        bool const is_wanted = section.empty() ? child.find("screenNames") != nullptr : child.key == section;
        if (is_wanted && !environment) {
            environment = &child;
        } else if (!child.children.empty()) {
            others += (other_count++ ? ", " : "") + child.key.substr(0, 64);
        }
    }
    VruiContext c{{}, name, report};
    if (!environment)
        throw c.error(*vrui,
                      section.empty() ? "no environment has screenNames"
                                      : "there is no environment '" + section + "'",
                      "the environment lists the walls", "there are: " + (others.empty() ? "none" : others));
    if (other_count)
        report.lose("Vrui environments other than the one imported", std::uint64_t(other_count),
                    others.substr(0, 500));
    read_units(*environment, c);
    std::set<std::string> used{"screenNames", "viewerNames",      "windowNames", "inchScale",
                               "meterScale",  "forwardDirection", "upDirection"};
    auto const read_windows = [&](std::string const& tag, int rank) {
        used.insert(tag);
        for (std::string const& window : names_in(*environment, tag)) {
            read_window(*environment, window, rank, c);
            used.insert({window, section_of(*environment, window, "the list of windows", c).text("screenName")});
        }
    };
    read_windows("windowNames", 0);
    for (TextNode const& tag : environment->children)
        if (int node = 0, length = 0; std::sscanf(tag.key.c_str(), "node%4dWindowNames%n", &node, &length) == 1 &&
                                      length == int(tag.key.size()) && node >= 0)
            read_windows(tag.key, node);
    for (User const& user : c.display.users) used.insert(user.name);
    std::string left_out;
    int count = 0;
    for (TextNode const& tag : environment->children)
        if (!used.contains(tag.key)) left_out += (count++ ? ", " : "") + tag.key.substr(0, 64);
    if (count)
        report.lose("Vrui settings that are not about walls, windows and viewers: not imported",
                    std::uint64_t(count), left_out.substr(0, 2000));
    return finished(std::move(c.display), name, report);
}

} // namespace viewer
