// SGCT 3, JSON (its sgct.schema.json). Parsed as YAML, of which JSON is a subset, so that every value has its
// line. PlanarProjection: a plane 10 m from the room's origin, or at `distance`, rotated by yaw to the right,
// pitch upward and roll to the right; left and down angles are positive.

#include "gi/core/yaml.h"
#include "viewer/displays/import.h"
#include "viewer/displays/import_common.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <nlohmann/json.hpp>
#include <set>
#include <string_view>

namespace viewer {
namespace {

using gi::Yaml;

struct SgctContext {
    Display display;
    std::string file;
    gi::Report& report;
};

void lose_others(Yaml const& map, std::set<std::string> const& known, std::string const& path, SgctContext& c)
{
    for (std::string const& key : map.keys())
        if (!known.contains(key)) c.report.lose("SGCT " + path + key.substr(0, 64) + ": not imported", 1, c.file);
}

double number(Yaml const& y) { return y.number(-1e12, 1e12); }
double number_or(Yaml const& map, char const* key, double otherwise)
{
    return map.has(key) ? number(map.at(key)) : otherwise;
}

Yaml needed(Yaml const& map, char const* key)
{
    if (!map.is_map() || !map.has(key))
        throw map.error(std::string(key) + " is missing", "SGCT requires it", "is this a file of SGCT?");
    return map.at(key);
}

gi::dvec3 point(Yaml const& y) { return {number(needed(y, "x")), number(needed(y, "y")), number(needed(y, "z"))}; }

bool flag(Yaml const& map, char const* key) { return map.has(key) && map.at(key).boolean(); }

struct Stereo {
    StereoMode mode = StereoMode::off;
    bool swap = false;
};

/// SGCT's interlaced modes count rows from below and put the left eye on row 0.
Stereo read_stereo(Yaml const& y, int height_px, SgctContext& c)
{
    std::string const name = y.text();
    std::string const plain = name.substr(0, name.find("_inverted"));
    bool const is_inverted = plain != name, is_even = height_px % 2 == 0;
    if (plain == "none") return {};
    if (plain == "active") return {StereoMode::quad_buffer, is_inverted};
    if (plain == "anaglyph_red_cyan") return {StereoMode::anaglyph_red_cyan, is_inverted};
    if (plain == "side_by_side") return {StereoMode::side_by_side, is_inverted};
    if (plain == "top_bottom") return {StereoMode::top_bottom, is_inverted};
    if (plain == "vertical_interlaced") return {StereoMode::rows, is_inverted != is_even};
    if (plain == "checkerboard") return {StereoMode::checkerboard, is_inverted != is_even};
    c.report.lose("SGCT stereo mode '" + name.substr(0, 64) + "': shown without stereo", 1, c.file);
    return {};
}

gi::dquat orientation(Yaml const& y)
{
    if (y.has("w")) {
        gi::dvec3 const v = point(y);
        gi::dquat const q{number(y.at("w")), v.x, v.y, v.z};
        if (!(glm::length(q) > 1e-6 && glm::length(q) < 1e6))
            throw y.error("the orientation is no rotation", "a quaternion has length 1",
                          "give yaw, pitch and roll");
        return glm::normalize(q);
    }
    auto const about = [&](char const* key, double sign, gi::dvec3 axis) {
        return glm::angleAxis(sign * glm::radians(number_or(y, key, 0)), axis);
    };
    return about("yaw", -1, {0, 1, 0}) * about("pitch", 1, {1, 0, 0}) * about("roll", -1, {0, 0, 1});
}

WallCorners planar(Yaml const& p, SgctContext& c)
{
    lose_others(p, {"type", "fov", "distance", "orientation", "offset"}, "projection.", c);
    Yaml const fov = needed(p, "fov");
    double const across = number_or(fov, "hfov", 0) / 2, upward = number_or(fov, "vfov", 0) / 2;
    double const distance = number_or(p, "distance", 10);
    auto const at = [&](char const* key, double otherwise) {
        return distance * std::tan(glm::radians(number_or(fov, key, otherwise)));
    };
    double const left = -at("left", across), right = at("right", across), top = at("up", upward),
                 bottom = -at("down", upward);
    gi::dquat const turn = p.has("orientation") ? orientation(p.at("orientation")) : gi::dquat{1, 0, 0, 0};
    gi::dvec3 const offset = p.has("offset") ? point(p.at("offset")) : gi::dvec3{0};
    auto const corner = [&](double x, double y) { return turn * gi::dvec3{x, y, -distance} + offset; };
    return {corner(left, bottom), corner(right, bottom), corner(left, top)};
}

WallCorners plane(Yaml const& p, SgctContext& c)
{
    lose_others(p, {"type", "lowerleft", "upperleft", "upperright"}, "projection.", c);
    gi::dvec3 const ll = point(needed(p, "lowerleft")), ul = point(needed(p, "upperleft")),
                    ur = point(needed(p, "upperright"));
    return {ll, ll + ur - ul, ul};
}

void read_viewport(Yaml const& v, int window, int rank, Stereo stereo, std::string const& default_user,
                   std::map<std::string, int> const& users, SgctContext& c)
{
    lose_others(v, {"pos", "size", "projection", "user"}, "viewport.", c);
    Yaml const p = needed(v, "projection");
    std::string const type = needed(p, "type").text();
    if (type != "ProjectionPlane" && type != "PlanarProjection") {
        c.report.lose("SGCT viewports with a " + type.substr(0, 64) + " skipped: only flat walls are imported", 1,
                      c.file);
        return;
    }
    Wall wall;
    std::string const window_name = c.display.windows[std::size_t(window)].name;
    wall.name = free_name(c.display.walls, window_name);
    wall.corners = type == "ProjectionPlane" ? plane(p, c) : planar(p, c);
    wall.window = window;
    wall.rank = rank;
    wall.stereo = stereo.mode;
    wall.swap_eyes = stereo.swap;
    double x = 0, y = 0, width = 1, height = 1;
    if (v.has("pos")) {
        x = number(needed(v.at("pos"), "x"));
        y = number(needed(v.at("pos"), "y"));
    }
    if (v.has("size")) {
        width = number(needed(v.at("size"), "x"));
        height = number(needed(v.at("size"), "y"));
    }
    wall.viewport = from_below(x, y, width, height);
    std::string const user = v.has("user") ? v.at("user").text() : default_user;
    auto const known = users.find(user);
    if (known == users.end())
        throw v.at("user").error("there is no user '" + user.substr(0, 64) + "'",
                                 "a viewport is drawn for a user's eyes", "name one of users");
    wall.user = known->second;
    c.display.walls.push_back(wall);
}

void read_window(Yaml const& w, int rank, std::map<std::string, int> const& users, SgctContext& c)
{
    lose_others(w, {"name", "id", "pos", "size", "fullscreen", "monitor", "stereo", "viewports"}, "window.", c);
    DisplayWindow window;
    window.name = free_name(c.display.windows, w.has("name") ? w.at("name").text() : "window");
    auto const pixel = [](Yaml const& y) { return int(y.integer(-1000000, 1000000)); };
    Yaml const size = needed(w, "size");
    window.width_px = pixel(needed(size, "x"));
    window.height_px = pixel(needed(size, "y"));
    if (w.has("pos")) {
        window.x_px = pixel(needed(w.at("pos"), "x"));
        window.y_px = pixel(needed(w.at("pos"), "y"));
    }
    window.fullscreen = flag(w, "fullscreen");
    if (w.has("monitor")) window.monitor = int(w.at("monitor").integer(-1, 255));
    Stereo const stereo = w.has("stereo") ? read_stereo(w.at("stereo"), window.height_px, c) : Stereo{};
    c.display.windows.push_back(window);
    std::size_t const walls = c.display.walls.size();
    if (w.has("viewports"))
        for (Yaml const& v : w.at("viewports").items())
            read_viewport(v, int(c.display.windows.size()) - 1, rank, stereo, users.begin()->first, users, c);
    if (c.display.walls.size() == walls) c.display.windows.pop_back();
}

std::map<std::string, int> read_users(Yaml const& root, SgctContext& c)
{
    std::map<std::string, int> users;
    if (root.has("users"))
        for (Yaml const& u : root.at("users").items()) {
            lose_others(u, {"name", "eyeseparation", "pos"}, "user.", c);
            User user;
            std::string const name = u.has("name") ? u.at("name").text() : "default";
            user.name = free_name(c.display.users, name);
            user.interpupillary_m =
                imported_eyes(number_or(u, "eyeseparation", 0.06), "user '" + user.name + "'", c.report);
            if (u.has("pos")) user.head.translation_m = point(u.at("pos"));
            users.emplace(name, int(c.display.users.size()));
            c.display.users.push_back(user);
        }
    if (c.display.users.empty()) {
        c.report.lose("no user in the file: one stands at the origin", 1, c.file);
        c.display.users.push_back({"default", 0.063, {}, gi::dvec3{0}, -1});
        users.emplace("default", 0);
    }
    return users;
}

Yaml parse_json(std::string const& text, std::string const& file)
{
    try {
        return Yaml::parse(text, file, "SGCT");
    } catch (gi::InputError const&) { // its message is about YAML, but the file is meant to be JSON
        try {
            [[maybe_unused]] auto const json = nlohmann::json::parse(text);
        } catch (nlohmann::json::parse_error const& e) {
            std::string_view const read = std::string_view(text).substr(0, e.byte > 0 ? e.byte - 1 : 0);
            auto const line_start = read.rfind('\n') + 1; // npos + 1 is 0
            throw gi::InputError(
                {file, int(std::ranges::count(read, '\n')) + 1, int(read.size() - line_start) + 1},
                "this is not JSON", e.byte > text.size() ? "the text ends too early" : "this does not belong here",
                "check the brackets, the commas and the quotes");
        } catch (nlohmann::json::exception const&) { // a number is too large
        }
        throw;
    }
}

} // namespace

Display parse_sgct(std::string const& text, std::string const& name, gi::Report& report)
{
    Yaml const root = parse_json(text, name);
    SgctContext c{{}, name, report};
    lose_others(root, {"version", "masteraddress", "nodes", "users", "$schema", "title", "description", "author"},
                "", c);
    Yaml const nodes = needed(root, "nodes");
    std::map<std::string, int> const users = read_users(root, c);
    int rank = 0;
    for (Yaml const& node : nodes.items()) {
        lose_others(node, {"address", "port", "windows"}, "node.", c);
        if (node.has("windows"))
            for (Yaml const& window : node.at("windows").items()) read_window(window, rank, users, c);
        ++rank;
    }
    return finished(std::move(c.display), name, report);
}

} // namespace viewer
