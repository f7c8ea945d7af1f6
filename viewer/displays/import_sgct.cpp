// SGCT 3, JSON (its sgct.schema.json). Parsed as YAML, of which JSON is a subset,
// so that every value has its line.

#include "gi/core/yaml.h"
#include "viewer/displays/import_common.h"
#include "viewer/displays/json_text.h"
#include "viewer/displays/sgct_config.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <set>

namespace viewer {
namespace {

using gi::Yaml;

void lose_others(Yaml const& map, std::set<std::string> const& known, std::string const& path,
                 ImportLog const& log)
{
    for (auto const& [key, value] : map.entries())
        if (!known.contains(key.text()))
            log.lose("SGCT " + path + key.text().substr(0, 64) + ": not imported", 1, text_at(key.place()));
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

gi::dquat orientation(Yaml const& y)
{
    if (!y.has("w")) return sgct_turn(number_or(y, "yaw", 0), number_or(y, "pitch", 0), number_or(y, "roll", 0));
    gi::dvec3 const v = point(y);
    gi::dquat const q{number(y.at("w")), v.x, v.y, v.z};
    if (!(glm::length(q) > 1e-6 && glm::length(q) < 1e6))
        throw y.error("the orientation is no rotation", "a quaternion has length 1", "give yaw, pitch and roll");
    return glm::normalize(q);
}

WallCorners planar(Yaml const& p, ImportLog const& log)
{
    lose_others(p, {"type", "fov", "distance", "orientation", "offset"}, "projection.", log);
    Yaml const fov = needed(p, "fov");
    lose_others(fov, {"hfov", "vfov", "left", "right", "up", "down", "distance"}, "projection.fov.", log);
    double const across = number_or(fov, "hfov", 0) / 2, upward = number_or(fov, "vfov", 0) / 2;
    SgctPlanar planar{number_or(fov, "left", across),
                      number_or(fov, "right", across),
                      number_or(fov, "up", upward),
                      number_or(fov, "down", upward),
                      number_or(p, "distance", number_or(fov, "distance", 10)),
                      {1, 0, 0, 0},
                      gi::dvec3{0}};
    if (p.has("orientation")) planar.turn = orientation(p.at("orientation"));
    if (p.has("offset")) planar.offset_m = point(p.at("offset"));
    return corners_of(planar);
}

WallCorners plane(Yaml const& p, ImportLog const& log)
{
    lose_others(p, {"type", "lowerleft", "upperleft", "upperright"}, "projection.", log);
    gi::dvec3 const ll = point(needed(p, "lowerleft")), ul = point(needed(p, "upperleft")),
                    ur = point(needed(p, "upperright"));
    return {ll, ll + ur - ul, ul};
}

/// Resolutions of cube maps and backgrounds have no equivalent: faces are as fine as the viewport.
void read_fisheye(Yaml const& y, SgctProjection& p, ImportLog const& log)
{
    lose_others(y, {"type", "fov", "tilt", "diameter", "crop", "keepaspectratio", "offset"}, "projection.", log);
    p.fov_deg = number_or(y, "fov", p.fov_deg);
    p.tilt_deg = number_or(y, "tilt", p.tilt_deg);
    p.diameter_m = number_or(y, "diameter", p.diameter_m);
    if (y.has("keepaspectratio")) p.keeps_aspect = y.at("keepaspectratio").boolean();
    if (y.has("offset")) p.offset = point(y.at("offset"));
    if (!y.has("crop")) return;
    std::size_t i = 0;
    for (char const* side : {"left", "right", "bottom", "top"})
        p.crop[i++] = needed(y.at("crop"), side).number(0, 0.499);
}

SgctProjection read_projection(Yaml const& y, ImportLog const& log)
{
    SgctProjection p;
    p.name = needed(y, "type").text();
    p.at = y.at("type").place();
    p.kind = SgctProjectionKind::plane;
    if (p.name == "ProjectionPlane") {
        p.corners = plane(y, log);
    } else if (p.name == "PlanarProjection" || p.name == "TextureMappedProjection") {
        p.corners = planar(y, log);
    } else if (p.name == "FisheyeProjection") {
        p.kind = SgctProjectionKind::fisheye;
        read_fisheye(y, p, log);
    } else if (p.name == "CylindricalProjection") {
        lose_others(y, {"type", "rotation", "heightoffset", "radius"}, "projection.", log);
        p.kind = SgctProjectionKind::cylindrical;
        p.rotation_deg = number_or(y, "rotation", 0);
        p.height_offset = number_or(y, "heightoffset", 0);
        p.radius_m = number_or(y, "radius", p.radius_m);
    } else if (p.name == "EquirectangularProjection") {
        lose_others(y, {"type"}, "projection.", log);
        p.kind = SgctProjectionKind::equirectangular;
    } else if (p.name == "SphericalMirrorProjection") {
        lose_others(y, {"type", "tilt", "geometry"}, "projection.", log);
        p.kind = SgctProjectionKind::spherical_mirror;
        p.tilt_deg = number_or(y, "tilt", 0);
        std::size_t i = 0;
        for (char const* face : {"bottom", "left", "right", "top"})
            p.meshes[i++] = needed(needed(y, "geometry"), face).text();
    } else
        p.kind = SgctProjectionKind::other;
    return p;
}

SgctViewport read_viewport(Yaml const& y, ImportLog const& log)
{
    lose_others(y, {"pos", "size", "projection", "user", "eye", "mesh"}, "viewport.", log);
    SgctViewport v;
    v.at = y.place();
    if (y.has("pos")) {
        v.x = number(needed(y.at("pos"), "x"));
        v.y = number(needed(y.at("pos"), "y"));
    }
    if (y.has("size")) {
        v.width = number(needed(y.at("size"), "x"));
        v.height = number(needed(y.at("size"), "y"));
    }
    if (y.has("user")) v.user = y.at("user").text();
    if (y.has("mesh")) v.mesh = y.at("mesh").text();
    if (y.has("eye")) {
        int const eye = y.at("eye").one_of({"center", "left", "right"}, "eye");
        v.eye = eye == 1 ? Eye::left : eye == 2 ? Eye::right : Eye::middle;
    }
    if (y.has("projection")) v.projection = read_projection(y.at("projection"), log);
    return v;
}

SgctWindow read_window(Yaml const& y, ImportLog const& log)
{
    lose_others(
        y, {"name", "id", "pos", "size", "res", "fullscreen", "monitor", "stereo", "viewports", "border", "mpcdi"},
        "window.", log);
    SgctWindow w;
    w.at = y.place();
    w.window.name = y.has("name") ? y.at("name").text() : "window";
    auto const pixel = [](Yaml const& at) { return int(at.integer(-1000000, 1000000)); };
    Yaml const size = needed(y, "size");
    w.window.width_px = pixel(needed(size, "x"));
    w.window.height_px = pixel(needed(size, "y"));
    if (y.has("pos")) {
        w.window.x_px = pixel(needed(y.at("pos"), "x"));
        w.window.y_px = pixel(needed(y.at("pos"), "y"));
    }
    w.window.fullscreen = flag(y, "fullscreen");
    if (y.has("border")) w.window.borders = y.at("border").boolean();
    if (y.has("monitor")) w.window.monitor = int(y.at("monitor").integer(-1, 255));
    if (y.has("stereo")) {
        w.stereo = y.at("stereo").text();
        w.at = y.at("stereo").place();
    }
    w.picture_aspect = double(w.window.width_px) / std::max(1, w.window.height_px);
    if (y.has("res")) {
        int const across = pixel(needed(y.at("res"), "x")), upward = pixel(needed(y.at("res"), "y"));
        w.picture_aspect = double(across) / std::max(1, upward);
        lose_resolution(w, across, upward, y.at("res").place(), log);
    }
    if (y.has("mpcdi"))
        log.lose("SGCT windows with MPCDI, which is not supported, skipped", 1, text_at(y.at("mpcdi").place()));
    if (y.has("viewports"))
        for (Yaml const& v : y.at("viewports").items()) w.viewports.push_back(read_viewport(v, log));
    return w;
}

void read_scene(Yaml const& y, SgctConfig& config, ImportLog const& log)
{
    lose_others(y, {"offset", "orientation", "scale"}, "scene.", log);
    double yaw = 0, pitch = 0, roll = 0;
    bool const has_turn = y.has("orientation");
    if (has_turn) {
        Yaml const turn = y.at("orientation");
        yaw = number_or(turn, "yaw", 0);
        pitch = turn.has("w") ? 1 : number_or(turn, "pitch", 0);
        roll = number_or(turn, "roll", 0);
    }
    config.world = world_of_scene(y.has("offset") ? point(y.at("offset")) : gi::dvec3{0}, yaw, pitch, roll,
                                  number_or(y, "scale", 1));
    if (!config.world)
        log.lose("SGCT scene that is tilted or scaled: not imported, only offsets and yaw are", 1,
                 text_at(y.place()));
}

} // namespace

Display parse_sgct(std::string const& text, std::string const& name, ImportLog log)
{
    Yaml const root = parse_placed_json(text, name, "SGCT");
    SgctConfig config;
    lose_others(root,
                {"version", "masteraddress", "nodes", "users", "scene", "$schema", "title", "description",
                 "author", "generator", "meta"},
                "", log);
    if (root.has("masteraddress"))
        lose_address(root.at("masteraddress").text(), text_at(root.at("masteraddress").place()), log);
    Yaml const nodes = needed(root, "nodes");
    if (root.has("users"))
        for (Yaml const& u : root.at("users").items()) {
            lose_others(u, {"name", "eyeseparation", "pos"}, "user.", log);
            SgctUser user;
            user.at = u.place();
            user.name = u.has("name") ? u.at("name").text() : "default";
            user.eyes_m = number_or(u, "eyeseparation", user.eyes_m);
            if (u.has("pos")) user.position_m = point(u.at("pos"));
            config.users.push_back(user);
        }
    if (root.has("scene")) read_scene(root.at("scene"), config, log);
    for (Yaml const& node : nodes.items()) {
        lose_others(node, {"address", "port", "datatransferport", "swaplock", "windows"}, "node.", log);
        if (node.has("address")) lose_address(node.at("address").text(), text_at(node.place()), log);
        config.nodes.emplace_back();
        if (node.has("windows"))
            for (Yaml const& window : node.at("windows").items()) {
                SgctWindow w = read_window(window, log);
                if (flag(node, "swaplock")) w.window.swap_group = w.window.swap_barrier = 1;
                config.nodes.back().push_back(std::move(w));
            }
    }
    return display_of(config, name, log);
}

} // namespace viewer
