#include "viewer/displays/display_file.h"

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace viewer {
namespace {

/// Text in double quotes, which YAML reads like JSON. Numbers are written in their shortest exact form.
std::string quoted(std::string const& text)
{
    return nlohmann::json(text).dump(-1, ' ', false, nlohmann::json::error_handler_t::replace);
}

std::string vec(gi::dvec3 v) { return fmt::format("[{}, {}, {}]", v.x, v.y, v.z); }

class Writer {
public:
    void line(std::string const& text) { out_ += text + "\n"; }
    /// Writes the first line of a list item; the others follow.
    void begin(std::string const& name) { line("  - name: " + quoted(name)); }
    void key(std::string const& key, std::string const& value) { line("    " + key + ": " + value); }
    std::string take() { return std::move(out_); }

private:
    std::string out_;
};

std::string mesh_text(WallMesh const& m)
{
    std::string out = fmt::format("\n      columns: {}\n      rows: {}\n      nodes:", m.columns, m.rows);
    for (WarpNode const& n : m.nodes)
        out += fmt::format("\n        - [{}, {}, {}, {}{}]", n.place.x, n.place.y, n.picture.x, n.picture.y,
                           n.weight == 1 ? "" : fmt::format(", {}", n.weight));
    return out;
}

std::string surface_text(Surface const& s)
{
    Surface const usual;
    std::string out = std::string("\n      type: ") + name_of(s.type);
    auto const key = [&](char const* name, std::string const& value) {
        out += std::string("\n      ") + name + ": " + value;
    };
    auto const pair = [](glm::dvec2 v) { return fmt::format("[{}, {}]", v.x, v.y); };
    if (s.place.translation_m != gi::dvec3{0}) key("center_m", vec(s.place.translation_m));
    if (s.place.rotation_deg != gi::dvec3{0}) key("rotation_deg", vec(s.place.rotation_deg));
    if (s.radius_m != 0) key("radius_m", fmt::format("{}", s.radius_m));
    if (s.fov_deg != usual.fov_deg) key("fov_deg", fmt::format("{}", s.fov_deg));
    if (s.circle)
        key("circle", fmt::format("[{}, {}, {}, {}]", s.circle->x, s.circle->y, s.circle->half_width,
                                  s.circle->half_height));
    if (s.azimuths_deg != usual.azimuths_deg) key("azimuths_deg", pair(s.azimuths_deg));
    if (s.elevations_deg != usual.elevations_deg) key("elevations_deg", pair(s.elevations_deg));
    if (s.heights_m != usual.heights_m) key("heights_m", pair(s.heights_m));
    SphericalMirror const &m = s.mirror, none;
    if (m.center_m != none.center_m) key("mirror_center_m", vec(m.center_m));
    if (m.radius_m != none.radius_m) key("mirror_radius_m", fmt::format("{}", m.radius_m));
    if (m.projector.translation_m != gi::dvec3{0}) key("projector_position_m", vec(m.projector.translation_m));
    if (m.projector.rotation_deg != gi::dvec3{0}) key("projector_rotation_deg", vec(m.projector.rotation_deg));
    if (auto const& t = m.projector_tangents; t != none.projector_tangents)
        key("projector_tangents", fmt::format("[{}, {}, {}, {}]", t[0], t[1], t[2], t[3]));
    if (!s.points.file.empty()) key("file", quoted(s.points.file));
    if (s.unit_m != 1) key("unit_m", fmt::format("{}", s.unit_m));
    return out;
}

void write_wall(Writer& w, Wall const& wall, Display const& d)
{
    w.begin(wall.name);
    if (wall.surface) {
        w.key("projection", surface_text(*wall.surface));
    } else {
        w.key("lower_left_m", vec(wall.corners.lower_left));
        w.key("lower_right_m", vec(wall.corners.lower_right));
        w.key("upper_left_m", vec(wall.corners.upper_left));
    }
    w.key("window", quoted(d.windows[std::size_t(wall.window)].name));
    if (wall.second_window >= 0) w.key("second_window", quoted(d.windows[std::size_t(wall.second_window)].name));
    if (Viewport const& v = wall.viewport; v != Viewport{})
        w.key(v.unit == LengthUnit::px ? "viewport_px" : "viewport_fraction",
              fmt::format("[{}, {}, {}, {}]", v.x, v.y, v.width, v.height));
    if (wall.render_width_px > 0)
        w.key("render_px", fmt::format("[{}, {}]", wall.render_width_px, wall.render_height_px));
    if (wall.stereo != StereoMode::off) w.key("stereo", quoted(name_of(wall.stereo)));
    if (wall.eye != Eye::middle) w.key("eye", name_of(wall.eye));
    if (wall.swap_eyes) w.key("swap_eyes", "true");
    w.key("user", quoted(d.users[std::size_t(wall.user)].name));
    if (WallBlend const& b = wall.blend; b != WallBlend{})
        w.key("blend", fmt::format("{{left_m: {}, right_m: {}, top_m: {}, bottom_m: {}, power: {}, gamma: {}}}",
                                   b.left_m, b.right_m, b.top_m, b.bottom_m, b.power, b.gamma));
    std::string const warp_file = wall.warp_map ? wall.warp_map->file : wall.warp_file;
    if (!warp_file.empty())
        w.key("warp", "{file: " + quoted(warp_file) + "}");
    else if (wall.warp)
        w.key("warp", mesh_text(*wall.warp));
    for (auto const& [key, picture] :
         {std::pair{"blend_picture", &wall.blend_picture}, {"black_level_picture", &wall.black_level_picture}})
        if (*picture)
            w.key(key, fmt::format("{{file: {}, gamma: {}}}", quoted((*picture)->light.file), (*picture)->gamma));
    if (wall.gain != gi::dvec3{1}) w.key("gain", vec(wall.gain));
    if (wall.rank != 0) w.key("rank", std::to_string(wall.rank));
}

void write_window(Writer& w, DisplayWindow const& window)
{
    w.begin(window.name);
    w.key("size_px", fmt::format("[{}, {}]", window.width_px, window.height_px));
    if (window.x_px != 0 || window.y_px != 0)
        w.key("position_px", fmt::format("[{}, {}]", window.x_px, window.y_px));
    if (window.monitor >= 0) w.key("monitor", std::to_string(window.monitor));
    if (window.fullscreen) w.key("fullscreen", "true");
    if (!window.borders) w.key("borders", "false");
    if (window.swap_group != 0) w.key("swap_group", std::to_string(window.swap_group));
    if (window.swap_barrier != 0) w.key("swap_barrier", std::to_string(window.swap_barrier));
}

void write_user(Writer& w, User const& user, Display const& d)
{
    w.begin(user.name);
    w.key("interpupillary_m", fmt::format("{}", user.interpupillary_m));
    w.key("head_position_m", vec(user.head.translation_m));
    if (user.head.rotation_deg != gi::dvec3{0}) w.key("head_rotation_deg", vec(user.head.rotation_deg));
    if (user.eye_offset_m != gi::dvec3{0}) w.key("eye_offset_m", vec(user.eye_offset_m));
    if (user.tracker >= 0) w.key("head_tracker", quoted(d.trackers[std::size_t(user.tracker)].name));
    if (!user.avatar.empty())
        w.key("avatar", user.avatar_joints.empty() ? quoted(user.avatar)
                                                   : fmt::format("{{file: {}, joints: {}}}", quoted(user.avatar),
                                                                 quoted(user.avatar_joints)));
    if (user.eye_height_m) w.key("eye_height_m", fmt::format("{}", *user.eye_height_m));
}

void write_tracker(Writer& w, DisplayTracker const& t)
{
    w.begin(t.name);
    w.key("type", name_of(t.type));
    if (t.address != DisplayTracker{}.address) w.key("address", quoted(t.address));
    if (t.port != 0) w.key("port", std::to_string(t.port));
    if (!t.device.empty()) w.key("device", quoted(t.device));
    if (!t.controls.empty()) w.key("controls", quoted(t.controls));
    if (t.wand) {
        std::string buttons, axes;
        for (WandAction const a : t.wand->buttons)
            buttons += (buttons.empty() ? "" : ", ") + std::string(name_of(a));
        for (WandAxis const& a : t.wand->axes) axes += (axes.empty() ? "" : ", ") + name_of(a);
        w.key("wand", "{buttons: [" + buttons + "], axes: [" + axes + "]}");
    }
    if (!t.body.empty()) w.key("body", quoted(t.body));
    for (LimbBody const& b : kLimbBodies)
        if (!(t.*b.body).empty()) w.key(b.key, quoted(t.*b.body));
    if (!t.file.empty()) w.key("file", quoted(t.file));
    if (t.room_from_tracker != Placement{})
        w.key("room_from_tracker", "{translation_m: " + vec(t.room_from_tracker.translation_m) +
                                       ", rotation_deg: " + vec(t.room_from_tracker.rotation_deg) + "}");
    if (t.latency_ms != 0) w.key("latency_ms", fmt::format("{}", t.latency_ms));
    if (t.filter != TrackerFilter{})
        w.key("filter", fmt::format("{{type: {}, min_cutoff_hz: {}, beta_per_m: {}}}",
                                    t.filter.type == FilterType::none ? "none" : "one-euro",
                                    t.filter.min_cutoff_hz, t.filter.beta_per_m));
}

} // namespace

std::string to_yaml(Display const& d)
{
    Writer w;
    if (!d.name.empty()) w.line("name: " + quoted(d.name));
    w.line("walls:");
    for (Wall const& wall : d.walls) write_wall(w, wall, d);
    w.line("windows:");
    for (DisplayWindow const& window : d.windows) write_window(w, window);
    w.line("users:");
    for (User const& user : d.users) write_user(w, user, d);
    if (!d.trackers.empty()) w.line("trackers:");
    for (DisplayTracker const& tracker : d.trackers) write_tracker(w, tracker);
    if (d.world) {
        w.line("world:");
        w.line("  position_m: " + vec(d.world->position_m));
        w.line(fmt::format("  yaw_deg: {}", d.world->yaw_deg));
    }
    return w.take();
}

} // namespace viewer
