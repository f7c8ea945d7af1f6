#include "gi/core/file.h"
#include "viewer/displays/check.h"
#include "viewer/displays/display_file.h"
#include "viewer/displays/display_keys.h"
#include "viewer/displays/mesh_file.h"

#include <fmt/format.h>

namespace viewer {
namespace {

using gi::Yaml;

constexpr double kAny = 1e9; ///< ranges are validated in check.cpp

Yaml needed(Yaml const& map, char const* key, char const* example)
{
    if (!map.has(key))
        throw map.error(fmt::format("{} is missing", key), "it has no default",
                        fmt::format("{}: {}", key, example));
    return map.at(key);
}

std::vector<double> numbers(Yaml const& list, std::size_t count, double low, double high)
{
    auto const items = list.items();
    if (items.size() != count)
        throw list.error(fmt::format("{} numbers, not {}", items.size(), count), "each number has its own meaning",
                         fmt::format("write a list of {}", count));
    std::vector<double> out;
    for (Yaml const& item : items) out.push_back(item.number(low, high));
    return out;
}

template <typename Part>
int index_of(std::vector<Part> const& parts, Yaml const& name, char const* list)
{
    std::string const wanted = name.text();
    std::string known;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].name == wanted) return int(i);
        if (i < 20) known += (i ? ", " : "") + parts[i].name;
    }
    throw name.error(fmt::format("'{}' is not in {}", wanted.substr(0, 64), list), "no entry has this name",
                     parts.empty() ? fmt::format("add {}", list) : "there are: " + known);
}

WallMesh read_mesh(Yaml const& y)
{
    WallMesh mesh;
    mesh.columns = int(needed(y, "columns", "2").integer(2, kMostWarpNodes));
    mesh.rows = int(needed(y, "rows", "2").integer(2, kMostWarpNodes));
    for (Yaml const& node : needed(y, "nodes", "[[0, 0, 0, 0], ...]").items()) {
        bool const is_weighted = node.is_list() && node.items().size() == 5;
        auto const v = numbers(node, is_weighted ? 5 : 4, -kAny, kAny);
        mesh.nodes.push_back({{v[0], v[1]}, {v[2], v[3]}, is_weighted ? v[4] : 1});
    }
    return mesh;
}

/// @param aspect  width / height of the wall's viewport
void read_warp(Wall& wall, Yaml const& y, std::filesystem::path const& folder, double aspect)
{
    check_display_keys(y, "warp");
    if (!y.has("file")) {
        wall.warp = read_mesh(y);
        return;
    }
    if (y.has("columns") || y.has("rows") || y.has("nodes"))
        throw y.error("warp has both a file and a mesh", "only one of them can count", "keep one");
    std::string const file = y.at("file").text();
    auto const path = folder / file;
    std::string const kind = gi::lower_extension(path);
    if (kind == ".pfm") {
        wall.warp_map = {
            file, std::make_shared<PixelMap const>(parse_picture_positions(read_map_bytes(path), path.string()))};
        return;
    }
    wall.warp_file = file;
    if (is_mesh_file(path)) {
        wall.warp = load_mesh_file(path, aspect);
        return;
    }
    auto const bytes = gi::read_bytes(path, std::size_t(1) << 20);
    Yaml const mesh = Yaml::parse({bytes.begin(), bytes.end()}, path.string(), "warp");
    mesh.only_keys({"columns", "rows", "nodes"});
    wall.warp = read_mesh(mesh);
    if (auto const fault = find_fault(*wall.warp))
        throw mesh.error(*fault, "the picture would be torn",
                         "write nodes row by row from below, each to the right of the one before");
}

LightMap read_light(Yaml const& y, std::filesystem::path const& folder)
{
    check_display_keys(y, "light_picture");
    LightMap map;
    map.gamma = needed(y, "gamma", "2.2").number(0.1, 10);
    map.light.file = needed(y, "file", "blend.png").text();
    auto const path = folder / map.light.file;
    map.light.map = std::make_shared<PixelMap const>(parse_light(read_map_bytes(path), map.gamma, path.string()));
    return map;
}

WallBlend read_blend(Yaml const& y)
{
    check_display_keys(y, "blend");
    WallBlend blend;
    for (auto const& [key, value] : {std::pair{"left_m", &blend.left_m},
                                     {"right_m", &blend.right_m},
                                     {"top_m", &blend.top_m},
                                     {"bottom_m", &blend.bottom_m},
                                     {"power", &blend.power},
                                     {"gamma", &blend.gamma}})
        if (y.has(key)) *value = y.at(key).number(-kAny, kAny);
    return blend;
}

Surface read_surface(Yaml const& y, std::filesystem::path const& folder)
{
    check_display_keys(y, "projection");
    Surface s;
    std::vector<std::string> names;
    for (SurfaceType const type : kSurfaceTypes) names.push_back(name_of(type));
    s.type = kSurfaceTypes[std::size_t(needed(y, "type", "fisheye").one_of(names, "projection"))];
    for (auto const& [key, value] : {std::pair{"center_m", &s.place.translation_m},
                                     {"rotation_deg", &s.place.rotation_deg},
                                     {"mirror_center_m", &s.mirror.center_m},
                                     {"projector_position_m", &s.mirror.projector.translation_m},
                                     {"projector_rotation_deg", &s.mirror.projector.rotation_deg}})
        if (y.has(key)) *value = y.at(key).vector(-kAny, kAny);
    for (auto const& [key, value] :
         {std::pair{"radius_m", &s.radius_m}, {"fov_deg", &s.fov_deg}, {"mirror_radius_m", &s.mirror.radius_m}})
        if (y.has(key)) *value = y.at(key).number(-kAny, kAny);
    for (auto const& [key, value] : {std::pair{"azimuths_deg", &s.azimuths_deg},
                                     {"elevations_deg", &s.elevations_deg},
                                     {"heights_m", &s.heights_m}})
        if (y.has(key)) {
            auto const v = numbers(y.at(key), 2, -kAny, kAny);
            *value = {v[0], v[1]};
        }
    if (y.has("circle")) {
        auto const v = numbers(y.at("circle"), 4, -kAny, kAny);
        s.circle = {v[0], v[1], v[2], v[3]};
    }
    if (y.has("projector_tangents")) {
        auto const v = numbers(y.at("projector_tangents"), 4, -kAny, kAny);
        s.mirror.projector_tangents = {v[0], v[1], v[2], v[3]};
    }
    if (y.has("unit_m")) s.unit_m = y.at("unit_m").number(-kAny, kAny);
    bool const is_points = s.type == SurfaceType::points;
    if (is_points != y.has("file"))
        throw y.error(is_points ? "file is missing" : "a file of a projection that is no points",
                      is_points ? "it says which point each pixel lights" : "only points are read from a file",
                      is_points ? "file: left.pfm, with unit_m: 0.001 if it is in mm" : "type: points");
    if (auto const f = find_fault(s); f && f->key != "file")
        throw(y.has(f->key) ? y.at(f->key) : y).error(f->problem, f->why, f->suggestion);
    if (is_points) {
        s.points.file = y.at("file").text();
        auto const path = folder / s.points.file;
        s.points.map =
            std::make_shared<PixelMap const>(parse_points(read_map_bytes(path), s.unit_m, path.string()));
    }
    return s;
}

void read_place(Wall& wall, Yaml const& y, std::filesystem::path const& folder)
{
    if (y.has("projection")) {
        for (char const* key : {"lower_left_m", "lower_right_m", "upper_left_m"})
            if (y.has(key))
                throw y.at(key).error("a projection and corners", "corners are those of a flat wall",
                                      "keep one of them");
        wall.surface = read_surface(y.at("projection"), folder);
        return;
    }
    double const far = 10 * kFarthestCorner_m;
    wall.corners = {needed(y, "lower_left_m", "[-1.5, 0, -1.5]").vector(-far, far),
                    needed(y, "lower_right_m", "[1.5, 0, -1.5]").vector(-far, far),
                    needed(y, "upper_left_m", "[-1.5, 3, -1.5]").vector(-far, far)};
}

Wall read_wall(Yaml const& y, Display const& d, std::filesystem::path const& folder)
{
    check_display_keys(y, "wall");
    Wall wall;
    wall.name = needed(y, "name", "front").text();
    read_place(wall, y, folder);
    wall.window = index_of(d.windows, needed(y, "window", "front"), "windows");
    if (y.has("second_window")) wall.second_window = index_of(d.windows, y.at("second_window"), "windows");
    if (y.has("user"))
        wall.user = index_of(d.users, y.at("user"), "users");
    else if (d.users.size() > 1)
        throw y.error("user is missing", "there are several", "name one of users");
    if (y.has("viewport_px") && y.has("viewport_fraction"))
        throw y.error("a viewport in pixels and one in fractions", "only one of them can count", "keep one");
    for (auto const& [key, unit] :
         {std::pair{"viewport_px", LengthUnit::px}, {"viewport_fraction", LengthUnit::fraction}})
        if (y.has(key)) {
            auto const v = numbers(y.at(key), 4, -kAny, kAny);
            wall.viewport = {unit, v[0], v[1], v[2], v[3]};
        }
    if (y.has("render_px")) {
        auto const items = y.at("render_px").items();
        if (items.size() != 2)
            throw y.at("render_px").error("not two numbers", "a picture has a width and a height", "[1024, 1024]");
        wall.render_width_px = int(items[0].integer(1, kLargestWindow_px));
        wall.render_height_px = int(items[1].integer(1, kLargestWindow_px));
    }
    if (y.has("stereo")) {
        auto const mode = stereo_mode(y.at("stereo").text());
        if (!mode)
            throw y.at("stereo").error("'" + y.at("stereo").text().substr(0, 64) + "' is no stereo mode",
                                       "the name is unknown", "there are: " + stereo_mode_names());
        wall.stereo = *mode;
    }
    if (y.has("eye")) wall.eye = y.at("eye").one_of({"left", "right"}, "eye") == 0 ? Eye::left : Eye::right;
    if (y.has("swap_eyes")) wall.swap_eyes = y.at("swap_eyes").boolean();
    if (y.has("blend")) wall.blend = read_blend(y.at("blend"));
    if (y.has("warp")) {
        PixelRectangle const px = viewport_px(wall, d.windows[std::size_t(wall.window)]);
        read_warp(wall, y.at("warp"), folder, px.width > 0 && px.height > 0 ? double(px.width) / px.height : 1);
    }
    if (y.has("blend_picture")) wall.blend_picture = read_light(y.at("blend_picture"), folder);
    if (y.has("black_level_picture")) wall.black_level_picture = read_light(y.at("black_level_picture"), folder);
    if (y.has("gain")) wall.gain = y.at("gain").vector_or_number(-kAny, kAny);
    if (y.has("rank")) wall.rank = int(y.at("rank").integer(0, 4095));
    return wall;
}

DisplayWindow read_window(Yaml const& y)
{
    check_display_keys(y, "window");
    DisplayWindow window;
    window.name = needed(y, "name", "front").text();
    auto const pair = [](Yaml const& list, std::int64_t low, std::int64_t high) {
        auto const items = list.items();
        if (items.size() != 2) throw list.error("not two numbers", "pixels count across and down", "[1920, 1080]");
        return std::pair{int(items[0].integer(low, high)), int(items[1].integer(low, high))};
    };
    std::tie(window.width_px, window.height_px) = pair(needed(y, "size_px", "[1920, 1080]"), -1000000, 1000000);
    if (y.has("position_px")) std::tie(window.x_px, window.y_px) = pair(y.at("position_px"), -10000000, 10000000);
    if (y.has("monitor")) window.monitor = int(y.at("monitor").integer(0, 1000));
    if (y.has("fullscreen")) window.fullscreen = y.at("fullscreen").boolean();
    if (y.has("borders")) window.borders = y.at("borders").boolean();
    if (y.has("swap_group")) window.swap_group = int(y.at("swap_group").integer(0, 1000));
    if (y.has("swap_barrier")) window.swap_barrier = int(y.at("swap_barrier").integer(0, 1000));
    return window;
}

/// The file of a model, or {file: ..., joints: ...}.
void read_avatar(User& user, Yaml const& y, std::filesystem::path const& folder)
{
    auto const is_file = [&folder](std::string const& name) {
        std::error_code error;
        return std::filesystem::is_regular_file(folder / name, error);
    };
    if (y.is_map()) check_display_keys(y, "avatar");
    Yaml const file = y.is_map() ? needed(y, "file", "guide.glb") : y;
    user.avatar = file.text();
    if (user.avatar != "avatar" && !is_file(user.avatar))
        throw file.error("there is no file '" + user.avatar.substr(0, 256) + "'", "it would be the user's body",
                         "name a skinned model, or avatar");
    if (!y.is_map() || !y.has("joints")) return;
    user.avatar_joints = y.at("joints").text();
    if (!is_file(user.avatar_joints))
        throw y.at("joints").error("there is no file '" + user.avatar_joints.substr(0, 256) + "'",
                                   "it would say which joints the model has", "lightwell avatar map proposes one");
}

User read_user(Yaml const& y, Display const& d, std::filesystem::path const& folder)
{
    check_display_keys(y, "user");
    User user;
    user.name = needed(y, "name", "visitor").text();
    if (y.has("interpupillary_m")) user.interpupillary_m = y.at("interpupillary_m").number(-kAny, kAny);
    user.head.translation_m = needed(y, "head_position_m", "[0, 1.7, 0]").vector(-kAny, kAny);
    if (y.has("head_rotation_deg")) user.head.rotation_deg = y.at("head_rotation_deg").vector(-kAny, kAny);
    if (y.has("eye_offset_m")) user.eye_offset_m = y.at("eye_offset_m").vector(-kAny, kAny);
    if (y.has("head_tracker")) user.tracker = index_of(d.trackers, y.at("head_tracker"), "trackers");
    if (y.has("avatar")) read_avatar(user, y.at("avatar"), folder);
    if (y.has("eye_height_m")) user.eye_height_m = y.at("eye_height_m").number(-kAny, kAny);
    return user;
}

TrackerFilter read_filter(Yaml const& y)
{
    check_display_keys(y, "filter");
    TrackerFilter filter;
    std::string const type = needed(y, "type", "one-euro").text();
    if (type != "none" && type != "one-euro")
        throw y.at("type").error("'" + type.substr(0, 64) + "' is no filter", "the name is unknown",
                                 "none or one-euro");
    filter.type = type == "none" ? FilterType::none : FilterType::one_euro;
    if (y.has("min_cutoff_hz")) filter.min_cutoff_hz = y.at("min_cutoff_hz").number(-kAny, kAny);
    if (y.has("beta_per_m")) filter.beta_per_m = y.at("beta_per_m").number(-kAny, kAny);
    return filter;
}

/// Words of a list, each understood by `read`.
template <typename Use, typename Read>
std::vector<Use> uses(Yaml const& list, std::size_t most, Read const& read, char const* what,
                      std::string const& known)
{
    std::vector<Use> all;
    for (Yaml const& item : list.items()) {
        if (all.size() == most)
            throw item.error(fmt::format("more than {} entries", most), "a wand has no more of them",
                             "shorten the list");
        auto const use = read(item.text());
        if (!use)
            throw item.error("'" + item.text().substr(0, 64) + "' is nothing that " + what + " of a wand does",
                             "the name is unknown", "there are: " + known);
        all.push_back(*use);
    }
    return all;
}

WandSettings read_wand(Yaml const& y)
{
    check_display_keys(y, "wand");
    WandSettings wand;
    if (y.has("buttons"))
        wand.buttons =
            uses<WandAction>(y.at("buttons"), kMostWandButtons, wand_action, "a button", wand_action_names());
    if (y.has("axes"))
        wand.axes = uses<WandAxis>(y.at("axes"), kMostWandAxes, wand_axis, "an axis", wand_axis_names());
    return wand;
}

DisplayTracker read_tracker(Yaml const& y)
{
    check_display_keys(y, "tracker");
    DisplayTracker tracker;
    tracker.name = needed(y, "name", "head").text();
    std::string const type = needed(y, "type", "dtrack").text();
    auto const known = tracker_type(type);
    if (!known)
        throw y.at("type").error("'" + type.substr(0, 64) + "' is no type of tracker", "the name is unknown",
                                 "osc, dtrack, vrpn, openxr, file or fake");
    tracker.type = *known;
    if (y.has("address")) tracker.address = y.at("address").text();
    if (y.has("port")) tracker.port = int(y.at("port").integer(-1000000, 1000000));
    if (y.has("device")) tracker.device = y.at("device").text();
    if (y.has("controls")) tracker.controls = y.at("controls").text();
    if (y.has("wand")) tracker.wand = read_wand(y.at("wand"));
    if (y.has("body")) tracker.body = y.at("body").text();
    for (LimbBody const& b : kLimbBodies)
        if (y.has(b.key)) tracker.*b.body = y.at(b.key).text();
    if (y.has("file")) tracker.file = y.at("file").text();
    if (y.has("room_from_tracker")) {
        Yaml const r = y.at("room_from_tracker");
        check_display_keys(r, "room_from_tracker");
        if (r.has("translation_m"))
            tracker.room_from_tracker.translation_m = r.at("translation_m").vector(-kAny, kAny);
        if (r.has("rotation_deg"))
            tracker.room_from_tracker.rotation_deg = r.at("rotation_deg").vector(-kAny, kAny);
    }
    if (y.has("latency_ms")) tracker.latency_ms = y.at("latency_ms").number(-kAny, kAny);
    if (y.has("filter")) tracker.filter = read_filter(y.at("filter"));
    return tracker;
}

/// The error at the fault's position in the file, or as near as possible.
gi::InputError error_of(DisplayFault const& f, Yaml const& root)
{
    if (f.list.empty()) return root.error(f.problem, f.why, f.suggestion);
    Yaml const part = root.at(f.list).items().at(f.index);
    Yaml const at = part.has(f.key) ? part.at(f.key) : part;
    return at.error(f.problem, f.why, f.suggestion);
}

} // namespace

Display parse_display(std::string const& text, std::string const& name, gi::Report& report)
{
    Yaml const root = Yaml::parse(text, name, "display");
    check_display_keys(root, "display");
    Display d;
    if (root.has("name")) d.name = root.at("name").text();
    auto const each = [&](char const* list, char const* example, auto const& read) {
        for (Yaml const& item : needed(root, list, example).items()) read(item);
    };
    if (root.has("trackers"))
        each("trackers", "[...]", [&](Yaml const& y) { d.trackers.push_back(read_tracker(y)); });
    each("windows", "[{name: front, size_px: [1920, 1080]}]",
         [&](Yaml const& y) { d.windows.push_back(read_window(y)); });
    auto const folder = std::filesystem::path(name).parent_path();
    each("users", "[{name: visitor, head_position_m: [0, 1.7, 0]}]",
         [&](Yaml const& y) { d.users.push_back(read_user(y, d, folder)); });
    each("walls", "[{name: front, window: front, lower_left_m: [-1.5, 0, -1.5], ...}]",
         [&](Yaml const& y) { d.walls.push_back(read_wall(y, d, folder)); });
    if (root.has("world")) {
        Yaml const w = root.at("world");
        check_display_keys(w, "world");
        d.world = RoomPlace{};
        if (w.has("position_m"))
            d.world->position_m = w.at("position_m").vector(-kFarthestCorner_m, kFarthestCorner_m);
        if (w.has("yaw_deg")) d.world->yaw_deg = w.at("yaw_deg").number(-3600, 3600);
    }
    if (auto const fault = find_fault(d)) throw error_of(*fault, root);
    report_doubts(d, report);
    return d;
}

Display load_display(std::filesystem::path const& file, gi::Report& report)
{
    auto const bytes = gi::read_bytes(file, std::size_t(1) << 24);
    return parse_display({bytes.begin(), bytes.end()}, file.string(), report);
}

} // namespace viewer
