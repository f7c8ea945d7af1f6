// nDisplay of Unreal Engine: .ndisplay (JSON, versions 4.26 to 5, lengths in cm) and the older
// .cfg (a line per part, "[screen] id=front loc="X=1.5,Y=0,Z=1.5" ...", lengths in m). Screens are
// rectangles about their centre, seen along +X of their frame; places are relative to a parent. Axes:
// x forward, y to the right, z up (left-handed). Viewports with the projection policies "simple", "mpcdi" and "vioso"
// become walls; the other calibrated ones need libraries of other companies.

#include "gi/core/file.h"
#include "gi/core/text.h"
#include "gi/core/yaml.h"
#include "viewer/displays/calibration.h"
#include "viewer/displays/check.h"
#include "viewer/displays/import.h"
#include "viewer/displays/import_common.h"
#include "viewer/displays/json_text.h"

#include <algorithm>
#include <fmt/format.h>
#include <map>
#include <set>

namespace viewer {
namespace {

using gi::Yaml;

/// Place of a part relative to its parent, in the axes and the length of the file.
struct UnrealPlace {
    std::string parent;
    gi::dvec3 location{0};
    double pitch_deg = 0, yaw_deg = 0, roll_deg = 0;
    gi::TextLocation at;
};

struct UnrealScreen {
    UnrealPlace place;
    double width = 0, height = 0;
};

struct UnrealCamera {
    UnrealPlace place;
    double eyes = 0; ///< distance, in the length of the file
    bool swap_eyes = false;
    Eye eye = Eye::middle;
};

struct UnrealViewport {
    std::string name, camera, policy, screen;
    std::map<std::string, std::string> parameters; ///< of the policy
    PixelRectangle region;
    double buffer_ratio = 1;
    gi::TextLocation at;
};

struct UnrealNode {
    std::string name;
    PixelRectangle window;
    bool is_fullscreen = false;
    std::vector<UnrealViewport> viewports;
    gi::TextLocation at;
};

struct UnrealConfig {
    std::map<std::string, UnrealPlace> nodes;
    std::map<std::string, UnrealScreen> screens;
    std::vector<std::pair<std::string, UnrealCamera>> cameras;
    std::vector<UnrealNode> cluster;
    bool has_swap_lock = false;
    int swap_group = 1, swap_barrier = 1;
    double metres = 0.01; ///< per unit of length
};

std::string lower(std::string text)
{
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return text;
}

std::string text_of(gi::TextLocation const& at) { return fmt::format("{}:{}:{}", at.file, at.line, at.column); }

gi::dvec3 ours(gi::dvec3 theirs) { return {theirs.y, theirs.z, -theirs.x}; }

/// Columns: x, y and z axis of a frame turned by pitch, yaw and roll (FRotationMatrix).
glm::dmat3 unreal_rotation(UnrealPlace const& p)
{
    double const pitch = glm::radians(p.pitch_deg), yaw = glm::radians(p.yaw_deg), roll = glm::radians(p.roll_deg);
    double const sp = std::sin(pitch), cp = std::cos(pitch), sy = std::sin(yaw), cy = std::cos(yaw),
                 sr = std::sin(roll), cr = std::cos(roll);
    return {{cp * cy, cp * sy, sp},
            {sr * sp * cy - cr * sy, sr * sp * sy + cr * cy, -sr * cp},
            {-(cr * sp * cy + sr * sy), cy * sr - cr * sp * sy, cr * cp}};
}

struct UnrealFrame {
    glm::dmat3 rotation{1};
    gi::dvec3 origin{0};
};

UnrealFrame frame_of(UnrealConfig const& config, UnrealPlace const& place)
{
    constexpr int kDeepest = 100;
    UnrealFrame frame{unreal_rotation(place), place.location};
    std::string parent = place.parent;
    for (int depth = 0; !parent.empty(); ++depth) {
        auto const node = config.nodes.find(parent);
        if (node == config.nodes.end())
            throw gi::InputError(place.at, "there is no parent '" + parent.substr(0, 64) + "'",
                                 "the place is relative to it; it may be in Unreal's asset only",
                                 "export it with its transforms as nodes of the scene");
        if (depth > kDeepest)
            throw gi::InputError(node->second.at, "parents go round in a circle", "none has a place of its own",
                                 "give one of them no parent");
        glm::dmat3 const turn = unreal_rotation(node->second);
        frame = {turn * frame.rotation, node->second.location + turn * frame.origin};
        parent = node->second.parent;
    }
    return frame;
}

WallCorners corners_of(UnrealConfig const& config, UnrealScreen const& s)
{
    UnrealFrame const frame = frame_of(config, s.place);
    auto const corner = [&](double y, double z) {
        return config.metres *
               ours(frame.origin + frame.rotation * gi::dvec3{0, y * s.width / 2, z * s.height / 2});
    };
    return {corner(-1, -1), corner(1, -1), corner(-1, 1)};
}

/// Cameras that differ only in the eye they show are one user.
int user_of(Display& d, UnrealConfig const& config, std::string const& name, UnrealCamera const& camera,
            ImportLog const& log)
{
    UnrealFrame const frame = frame_of(config, camera.place);
    glm::dmat3 const m(ours(frame.rotation[1]), ours(frame.rotation[2]), -ours(frame.rotation[0]));
    User user;
    user.head = placement_of({config.metres * ours(frame.origin), glm::quat_cast(m)});
    user.interpupillary_m = imported_eyes(config.metres * camera.eyes, text_of(camera.place.at), log);
    for (std::size_t u = 0; u < d.users.size(); ++u)
        if (d.users[u].head == user.head && d.users[u].interpupillary_m == user.interpupillary_m) return int(u);
    user.name = free_name(d.users, name);
    d.users.push_back(user);
    return int(d.users.size()) - 1;
}

/// Keys of a policy's parameters that are read.
std::set<std::string> parameters_of(std::string const& policy)
{
    if (lower(policy) == "vioso") return {"file", "index", "origin", "UnitsInMeter", "unitsinmeter"};
    if (lower(policy) != "mpcdi") return {"screen"};
    return {"file", "buffer", "region",   "origin", "mpcdi",       "MPCDIType", "mpcditype",
            "pfm",  "scale",  "ue_space", "alpha",  "alpha_gamma", "beta"};
}

std::string parameter(UnrealViewport const& v, char const* key)
{
    auto const found = v.parameters.find(key);
    return found == v.parameters.end() ? "" : found->second;
}

double parameter_number(UnrealViewport const& v, char const* key, double otherwise)
{
    std::string const text = parameter(v, key);
    if (text.empty()) return otherwise;
    auto const value = gi::parse_finite(text, 1e6);
    if (!value || !(*value > 0))
        throw gi::InputError(v.at, std::string(key) + " of the projection policy is '" + text.substr(0, 64) + "'",
                             "it is a positive number", "1");
    return *value;
}

/// The name of a file beside the configuration: as written, or without its folders, which may be those of Windows.
std::string beside(std::filesystem::path const& folder, std::string name)
{
    std::ranges::replace(name, '\\', '/');
    std::error_code failure;
    if (std::filesystem::is_regular_file(folder / name, failure)) return name;
    return name.substr(name.rfind('/') + 1);
}

/// An MPCDI file's region.
Wall region_of(UnrealViewport const& v, std::filesystem::path const& folder, ImportLog const& log)
{
    std::string const region = parameter(v, "region");
    std::filesystem::path const file = folder / beside(folder, parameter(v, "file"));
    bool const is_archive = gi::lower_extension(file) == ".mpcdi";
    CalibrationFiles const files =
        is_archive ? CalibrationFiles::of_archive(file) : CalibrationFiles::of_folder(file.parent_path());
    std::string name = file.string();
    std::string const xml = is_archive ? mpcdi_text(files, file, name) : gi::read_text(file, std::size_t(1) << 20);
    for (CalibratedProjector& p : read_mpcdi(xml, name, files, log, region))
        if (p.wall.name == region) return std::move(p.wall);
    throw gi::InputError(v.at, name + " has no region '" + region.substr(0, 64) + "'", "the viewport names it",
                         "name one of its regions");
}

/// A mapping of VIOSO's file.
Wall mapping_of(UnrealViewport const& v, std::filesystem::path const& folder, ImportLog const& log)
{
    std::filesystem::path const file = folder / beside(folder, parameter(v, "file"));
    double const unit_m = 1 / parameter_number(v, "unitsinmeter", 1 / kViosoUnit_m);
    auto const bytes = read_map_bytes(file);
    std::string const index = parameter(v, "index");
    auto const number = index.empty() ? 0 : gi::parse_number<std::size_t>(index).value_or(kMostWalls);
    std::vector<CalibratedProjector> all = read_vioso(bytes, file.string(), unit_m, log, number);
    if (number >= all.size())
        throw gi::InputError(v.at, fmt::format("{} has no mapping {}", file.string(), index.substr(0, 32)),
                             fmt::format("it has {}, counted from 0", all.size()), "set another index");
    return std::move(all[number].wall);
}

/// A PFM with points in the scale of the configuration, and its pictures.
Wall explicit_pfm(UnrealViewport const& v, std::filesystem::path const& folder, ImportLog const& log)
{
    constexpr double kUnreal_m = 0.01; // a unit of Unreal
    CalibrationFiles const files = CalibrationFiles::of_folder(folder);
    constexpr std::size_t kMostBytes = std::size_t(1) << 30;
    auto const bytes_of = [&](std::string const& name) { return files.read(name, kMostBytes, v.at); };
    Surface s;
    s.type = SurfaceType::points;
    std::string const pfm = beside(folder, parameter(v, "pfm"));
    auto bytes = bytes_of(pfm);
    PixelMap map = parse_points(bytes, kUnreal_m * parameter_number(v, "scale", 1), files.full_name(pfm));
    std::string const axes = lower(parameter(v, "ue_space"));
    if (axes == "true" || axes == "1") {
        for (glm::vec3& p : map.values) p = {p.y, p.z, -p.x};
        bytes = pfm_bytes(map);
    } else
        s.unit_m = kUnreal_m * parameter_number(v, "scale", 1);
    s.points = {log.keep_file(v.name + "_points.pfm", std::move(bytes)), std::make_shared<PixelMap const>(map)};
    Wall wall;
    wall.surface = std::move(s);
    auto const light = [&](char const* key, double gamma) -> std::optional<LightMap> {
        if (parameter(v, key).empty()) return {};
        std::string const name = beside(folder, parameter(v, key));
        auto picture = bytes_of(name);
        auto light_map = std::make_shared<PixelMap const>(parse_light(picture, gamma, files.full_name(name)));
        return LightMap{
            {log.keep_file(v.name + "_" + key + gi::lower_extension(name), std::move(picture)), light_map}, gamma};
    };
    double const gamma = parameter_number(v, "alpha_gamma", 1);
    wall.blend_picture = light("alpha", gamma);
    wall.black_level_picture = light("beta", gamma);
    return wall;
}

/// The wall of a calibrated viewport, placed by its origin. None, and counted, if its files cannot be read.
std::optional<Wall> calibrated_wall(UnrealViewport const& v, UnrealConfig const& config,
                                    std::filesystem::path const& folder, ImportLog const& log)
{
    Wall wall;
    try {
        if (parameter(v, "file").empty() && parameter(v, "pfm").empty())
            throw gi::InputError(v.at, "a policy " + lower(v.policy) + " without a file",
                                 "it would name the calibration", "set file, or pfm of the policy mpcdi");
        wall = lower(v.policy) == "vioso"     ? mapping_of(v, folder, log)
               : parameter(v, "file").empty() ? explicit_pfm(v, folder, log)
                                              : region_of(v, folder, log);
    } catch (gi::InputError const& e) {
        log.lose("nDisplay viewports whose calibration cannot be read, skipped: " + std::string(e.what()), 1,
                 text_of(v.at));
        return {};
    }
    UnrealFrame frame;
    if (std::string const origin = parameter(v, "origin"); !origin.empty()) {
        auto const node = config.nodes.find(origin);
        if (node == config.nodes.end())
            throw gi::InputError(v.at, "there is no transform '" + origin.substr(0, 64) + "'",
                                 "the calibration is placed by it", "name one of the scene's transforms");
        frame = frame_of(config, node->second);
    }
    // The calibration's x is to the right, its y up, its z backward.
    glm::dmat3 const turn(ours(frame.rotation[1]), ours(frame.rotation[2]), -ours(frame.rotation[0]));
    gi::dvec3 const at = config.metres * ours(frame.origin);
    if (wall.surface) {
        RoomPose const own = pose_of(wall.surface->place);
        wall.surface->place = placement_of({at + turn * own.position, glm::quat_cast(turn) * own.rotation});
    } else {
        for (gi::dvec3* corner : {&wall.corners.lower_left, &wall.corners.lower_right, &wall.corners.upper_left})
            *corner = at + turn * *corner;
    }
    return wall;
}

void add_viewport(Display& d, UnrealConfig const& config, UnrealViewport const& v, int window, int rank,
                  std::filesystem::path const& folder, ImportLog const& log)
{
    std::string const policy = lower(v.policy);
    bool const is_calibrated = policy == "mpcdi" || policy == "vioso";
    std::optional<Wall> const calibrated = is_calibrated ? calibrated_wall(v, config, folder, log) : std::nullopt;
    if (is_calibrated && !calibrated) return;
    if (policy != "simple" && !calibrated) {
        bool const is_closed = policy == "easyblend" || policy == "domeprojection";
        log.lose("nDisplay projection policy " + policy.substr(0, 64) + ": not supported, viewport skipped" +
                     (is_closed ? ": only its maker's library reads its files, export them as MPCDI" : ""),
                 1, text_of(v.at));
        return;
    }
    auto const screen = config.screens.find(v.screen);
    if (screen == config.screens.end() && !calibrated)
        throw gi::InputError(v.at, "there is no screen '" + v.screen.substr(0, 64) + "'",
                             "the viewport is drawn for it", "name one of the screens");
    UnrealCamera const* camera = nullptr;
    std::string name = v.camera;
    for (auto const& [id, c] : config.cameras)
        if (id == v.camera || (v.camera.empty() && !camera)) {
            camera = &c;
            name = id;
        }
    if (!camera)
        throw gi::InputError(
            v.at, v.camera.empty() ? "there is no camera" : "there is no camera '" + v.camera.substr(0, 64) + "'",
            "the viewport is drawn for its eyes", "add it to the scene");
    for (Wall const& other : d.walls) {
        Viewport const& o = other.viewport;
        if (other.window == window && v.region.x < o.x + o.width && o.x < v.region.x + v.region.width &&
            v.region.y < o.y + o.height && o.y < v.region.y + v.region.height)
            throw gi::InputError(v.at, "viewports '" + other.name + "' and '" + v.name + "' overlap",
                                 "one would be drawn over the other", "give each a region of its own");
    }
    Wall wall = calibrated.value_or(Wall{});
    wall.name = free_name(d.walls, v.name);
    if (!calibrated) wall.corners = corners_of(config, screen->second);
    if (auto const fault = wall.surface ? std::nullopt : find_fault(wall.corners); fault && !calibrated)
        throw gi::InputError(screen->second.place.at, "screen '" + v.screen.substr(0, 64) + "': " + fault->problem,
                             fault->why, fault->suggestion);
    wall.window = window;
    wall.rank = rank;
    wall.eye = camera->eye;
    wall.swap_eyes = camera->swap_eyes;
    wall.user = user_of(d, config, name, *camera, log);
    wall.viewport = {LengthUnit::px, double(v.region.x), double(v.region.y), double(v.region.width),
                     double(v.region.height)};
    if (v.buffer_ratio != 1 && !wall.surface) {
        wall.render_width_px = std::max(1, int(std::lround(v.buffer_ratio * v.region.width)));
        wall.render_height_px = std::max(1, int(std::lround(v.buffer_ratio * v.region.height)));
    }
    d.walls.push_back(wall);
}

Display display_of(UnrealConfig const& config, std::string const& file, ImportLog const& log)
{
    Display d;
    int rank = 0;
    bool has_both_eyes = false;
    auto const folder = std::filesystem::path(file).parent_path();
    for (UnrealNode const& node : config.cluster) {
        DisplayWindow window;
        window.name = free_name(d.windows, node.name);
        window.x_px = node.window.x;
        window.y_px = node.window.y;
        window.width_px = node.window.width;
        window.height_px = node.window.height;
        window.fullscreen = node.is_fullscreen;
        window.borders = false;
        if (config.has_swap_lock) {
            window.swap_group = config.swap_group;
            window.swap_barrier = config.swap_barrier;
        }
        if (window.width_px <= 0 || window.height_px <= 0) {
            for (UnrealViewport const& v : node.viewports) {
                window.width_px = std::max(window.width_px, v.region.x + v.region.width);
                window.height_px = std::max(window.height_px, v.region.y + v.region.height);
            }
            log.lose("windows whose size the file does not tell, taken as that of their viewports", 1,
                     text_of(node.at));
        }
        std::size_t const walls = d.walls.size();
        d.windows.push_back(window);
        for (UnrealViewport const& v : node.viewports)
            add_viewport(d, config, v, int(d.windows.size()) - 1, rank, folder, log);
        if (d.walls.size() == walls)
            d.windows.pop_back();
        else
            ++rank;
        for (std::size_t w = walls; w < d.walls.size(); ++w) has_both_eyes |= d.walls[w].eye == Eye::middle;
    }
    if (has_both_eyes)
        log.lose(
            "nDisplay is told on its command line whether to draw stereo: walls of both eyes imported without it",
            1, file);
    return finished(std::move(d), file, log);
}

// JSON

void lose_keys(Yaml const& map, std::set<std::string> const& known, std::string const& path, ImportLog const& log)
{
    for (auto const& [key, value] : map.entries())
        if (!known.contains(key.text()))
            log.lose("nDisplay " + path + key.text().substr(0, 64) + ": not imported", 1, text_of(key.place()));
}

/// Counts keys that say more than what Unreal writes where nothing was chosen.
void lose_stated(Yaml const& map, std::initializer_list<char const*> keys, std::string const& path,
                 ImportLog const& log)
{
    for (char const* key : keys) {
        if (!map.has(key)) continue;
        Yaml const y = map.at(key);
        bool const is_usual = y.is_text()  ? y.text() == "-1" || y.text() == "false" || y.text().empty()
                              : y.is_map() ? y.keys().empty() || (y.has("bEnabled") && !y.at("bEnabled").boolean())
                                           : y.items().empty();
        if (!is_usual) log.lose("nDisplay " + path + key + ": not imported", 1, text_of(y.place()));
    }
}

double length_in(Yaml const& map, char const* key) { return map.has(key) ? map.at(key).number(-1e9, 1e9) : 0; }

std::string name_in(Yaml const& map, char const* key) { return map.has(key) ? map.at(key).text() : ""; }

/// @param others  keys that are no place @param kind  for notes
UnrealPlace read_unreal_place(Yaml const& y, std::set<std::string> others, std::string const& kind,
                              ImportLog const& log)
{
    others.insert({"parentId", "location", "rotation"});
    lose_keys(y, others, kind, log);
    UnrealPlace p;
    p.at = y.place();
    p.parent = name_in(y, "parentId");
    if (y.has("location")) {
        Yaml const at = y.at("location");
        p.location = {length_in(at, "x"), length_in(at, "y"), length_in(at, "z")};
    }
    if (y.has("rotation")) {
        Yaml const turn = y.at("rotation");
        p.pitch_deg = length_in(turn, "pitch");
        p.yaw_deg = length_in(turn, "yaw");
        p.roll_deg = length_in(turn, "roll");
    }
    return p;
}

PixelRectangle read_unreal_rectangle(Yaml const& y)
{
    auto const pixel = [&](char const* key) { return y.has(key) ? int(y.at(key).integer(-1000000, 1000000)) : 0; };
    return {pixel("x"), pixel("y"), pixel("w"), pixel("h")};
}

UnrealViewport read_unreal_viewport(std::string const& name, Yaml const& y, ImportLog const& log)
{
    lose_keys(y,
              {"camera", "bufferRatio", "region", "projectionPolicy", "gPUIndex", "allowCrossGPUTransfer",
               "isShared", "overscan"},
              "viewport ", log);
    if (y.has("overscan") && y.at("overscan").has("bEnabled") && y.at("overscan").at("bEnabled").boolean())
        log.lose("nDisplay viewport overscan: not imported", 1, text_of(y.at("overscan").place()));
    if (y.has("isShared") && y.at("isShared").boolean())
        log.lose("nDisplay viewport isShared: not imported", 1, text_of(y.at("isShared").place()));
    lose_stated(y, {"gPUIndex", "allowCrossGPUTransfer"}, "viewport ", log);
    UnrealViewport v;
    v.name = name;
    v.at = y.place();
    v.camera = name_in(y, "camera");
    v.buffer_ratio = y.has("bufferRatio") ? y.at("bufferRatio").number(0.01, 10) : 1;
    v.region = read_unreal_rectangle(y.needed("region", "{x: 0, y: 0, w: 1920, h: 1080}"));
    Yaml const policy = y.needed("projectionPolicy", "{type: simple, parameters: {screen: front}}");
    v.policy = policy.needed("type", "simple").text();
    v.at = policy.at("type").place();
    if (policy.has("parameters")) {
        v.screen = name_in(policy.at("parameters"), "screen");
        for (auto const& [key, value] : policy.at("parameters").entries())
            if (value.is_text()) v.parameters[lower(key.text())] = value.text();
        lose_keys(policy.at("parameters"), parameters_of(v.policy), "projectionPolicy.parameters.", log);
    }
    return v;
}

UnrealNode read_unreal_node(std::string const& name, Yaml const& y, ImportLog const& log)
{
    lose_keys(y,
              {"host", "sound", "fullScreen", "renderHeadless", "graphicsAdapter", "textureShare", "window",
               "postprocess", "outputRemap", "viewports"},
              "node ", log);
    if (y.has("outputRemap") && y.at("outputRemap").has("bEnable") && y.at("outputRemap").at("bEnable").boolean())
        log.lose("nDisplay outputRemap: not imported", 1, text_of(y.at("outputRemap").place()));
    if (y.has("postprocess") && !y.at("postprocess").keys().empty())
        log.lose("nDisplay postprocess: not imported", 1, text_of(y.at("postprocess").place()));
    if (y.has("host") && y.at("host").is_text())
        lose_address(y.at("host").text(), text_of(y.at("host").place()), log);
    lose_stated(y, {"sound", "renderHeadless", "graphicsAdapter", "textureShare"}, "node ", log);
    UnrealNode node;
    node.name = name;
    node.at = y.place();
    if (y.has("window")) node.window = read_unreal_rectangle(y.at("window"));
    node.is_fullscreen = y.has("fullScreen") && y.at("fullScreen").boolean();
    if (y.has("viewports"))
        for (auto const& [key, viewport] : y.at("viewports").entries())
            node.viewports.push_back(read_unreal_viewport(key.text(), viewport, log));
    return node;
}

void read_unreal_scene(Yaml const& scene, UnrealConfig& config, ImportLog const& log)
{
    lose_keys(scene, {"xforms", "cameras", "screens"}, "scene.", log);
    if (scene.has("xforms"))
        for (auto const& [name, y] : scene.at("xforms").entries())
            config.nodes[name.text()] = read_unreal_place(y, {}, "xform ", log);
    if (scene.has("cameras"))
        for (auto const& [name, y] : scene.at("cameras").entries()) {
            UnrealCamera camera{
                read_unreal_place(y, {"interpupillaryDistance", "swapEyes", "stereoOffset"}, "camera ", log), 6.4,
                false, Eye::middle};
            if (y.has("interpupillaryDistance")) camera.eyes = length_in(y, "interpupillaryDistance");
            camera.swap_eyes = y.has("swapEyes") && y.at("swapEyes").boolean();
            std::string const offset = name_in(y, "stereoOffset");
            camera.eye = offset == "left" ? Eye::left : offset == "right" ? Eye::right : Eye::middle;
            if (camera.eye == Eye::middle && !offset.empty() && offset != "none")
                log.lose("nDisplay camera stereoOffset " + offset.substr(0, 64) + ": taken as none", 1,
                         text_of(y.at("stereoOffset").place()));
            config.cameras.push_back({name.text(), camera});
        }
    if (scene.has("screens"))
        for (auto const& [name, y] : scene.at("screens").entries()) {
            Yaml const size = y.needed("size", "{width: 300, height: 200}");
            config.screens[name.text()] = {read_unreal_place(y, {"size"}, "screen ", log),
                                           length_in(size, "width"), length_in(size, "height")};
        }
}

// The older text

/// A line: its kind and its arguments.
struct UnrealLine {
    std::string kind;
    std::map<std::string, std::string> values;
    gi::TextLocation at;

    std::string text(std::string const& key, std::string const& otherwise = "") const
    {
        auto const found = values.find(key);
        return found == values.end() ? otherwise : found->second;
    }
    bool flag(std::string const& key) const { return text(key) == "true" || text(key) == "1"; }
    double number(std::string const& key, double otherwise) const
    {
        if (!values.contains(key)) return otherwise;
        auto const value = gi::parse_finite(text(key));
        if (!value || std::abs(*value) > 1e9)
            throw gi::InputError(at, key + "=" + text(key).substr(0, 64) + " of [" + kind + "]", "it is no number",
                                 "write 1 or 0.5");
        return *value;
    }
    int pixels(std::string const& key) const { return int(std::clamp(number(key, 0), -1e6, 1e6)); }
    /// "X=1.5,Y=0,Z=1.5", in any order.
    double part(std::string const& key, char letter) const
    {
        std::string const all = text(key);
        for (std::size_t i = 0; i + 1 < all.size(); ++i) {
            if (std::toupper(static_cast<unsigned char>(all[i])) != letter || all[i + 1] != '=') continue;
            std::size_t const end = std::min(all.find_first_of(", ", i + 2), all.size());
            auto const value = gi::parse_finite(all.substr(i + 2, end - i - 2));
            if (value && std::abs(*value) < 1e9) return *value;
            throw gi::InputError(at, key + "=\"" + all.substr(0, 64) + "\" of [" + kind + "]",
                                 std::string(1, letter) + " is no number", "loc=\"X=1.5,Y=0,Z=1.5\"");
        }
        return 0;
    }
    UnrealPlace place() const
    {
        return {text("parent"),   {part("loc", 'X'), part("loc", 'Y'), part("loc", 'Z')},
                part("rot", 'P'), part("rot", 'Y'),
                part("rot", 'R'), at};
    }
};

std::optional<UnrealLine> read_line(std::string const& text, gi::TextLocation const& at)
{
    std::size_t i = text.find_first_not_of(" \t\r");
    if (i == std::string::npos || text[i] == '#') return {};
    std::size_t const close = text.find(']', i);
    if (text[i] != '[' || close == std::string::npos)
        throw gi::InputError(at, "'" + text.substr(i, 32) + "' is no part of nDisplay",
                             "a line begins with its kind", "[screen] id=front ...");
    UnrealLine line{text.substr(i + 1, close - i - 1), {}, at};
    for (i = close + 1; i < text.size();) {
        i = text.find_first_not_of(" \t\r", i);
        if (i == std::string::npos || text[i] == '#') break;
        std::size_t const equals = text.find('=', i);
        if (equals == std::string::npos)
            throw gi::InputError(at, "'" + text.substr(i, 32) + "' has no value", "arguments are name=value",
                                 "remove it");
        std::string key = text.substr(i, equals - i);
        while (!key.empty() && (key.back() == ' ' || key.back() == '\t')) key.pop_back();
        std::size_t from = text.find_first_not_of(" \t", equals + 1), end = 0;
        if (from == std::string::npos) from = text.size();
        if (from < text.size() && text[from] == '"') {
            end = text.find('"', ++from);
            if (end == std::string::npos)
                throw gi::InputError(at, "a quote is not closed", "the text has no end", "end it with \"");
        } else
            end = std::min(text.find_first_of(" \t\r", from), text.size());
        line.values[key] = text.substr(from, end - from);
        i = end + (end < text.size() && text[end] == '"' ? 1 : 0);
    }
    return line;
}

std::vector<std::string> split_names(std::string const& text)
{
    std::vector<std::string> names;
    std::string name;
    for (char const c : text + ",") {
        if (c != ',' && c != ' ')
            name += c;
        else if (!name.empty())
            names.push_back(std::exchange(name, {}));
    }
    return names;
}

using UnrealLines = std::map<std::string, UnrealLine>; ///< by id

UnrealLine const& line_of(UnrealLines const& lines, std::string const& id, char const* kind, UnrealLine const& of)
{
    auto const found = lines.find(id);
    if (found == lines.end())
        throw gi::InputError(of.at, fmt::format("there is no [{}] id={}", kind, id.substr(0, 64)),
                             "the line refers to it", "add it, or correct the name");
    return found->second;
}

/// Counts arguments of a line that are not read; lines of other kinds are counted as a whole.
void lose_arguments(UnrealLine const& line, ImportLog const& log)
{
    static std::map<std::string, std::set<std::string>> const kRead{
        {"cluster_node", {"id", "window", "addr", "master"}},
        {"window", {"id", "viewports", "fullscreen", "WinX", "WinY", "ResX", "ResY", "postprocess"}},
        {"viewport", {"id", "x", "y", "X", "Y", "width", "height", "projection", "camera", "buffer_ratio"}},
        {"projection", {"id", "type", "screen"}},
        {"scene_node", {"id", "loc", "rot", "parent", "tracker_id"}},
        {"screen", {"id", "loc", "rot", "parent", "size", "tracker_id"}},
        {"camera", {"id", "loc", "rot", "parent", "eye_dist", "eye_swap", "force_offset", "tracker_id"}},
        {"general", {"swap_sync_policy"}},
        {"nvidia", {"sync_group", "sync_barrier"}},
        {"NVIDIA", {"sync_group", "sync_barrier"}}};
    auto const read = kRead.find(line.kind);
    if (read == kRead.end()) return;
    bool const is_projection = line.kind == "projection";
    std::string const policy = lower(line.text("type"));
    bool const is_read = !is_projection || policy == "simple" || policy == "mpcdi" ||
                         policy == "vioso"; // others are skipped as a whole
    for (auto const& [key, value] : line.values)
        if (is_read && !read->second.contains(key) && !(is_projection && parameters_of(policy).contains(key)))
            log.lose("nDisplay [" + line.kind + "] " + key.substr(0, 64) + ": not imported", 1, text_of(line.at));
    lose_address(line.text("addr"), text_of(line.at), log);
}

UnrealViewport viewport_of(UnrealLine const& v, UnrealLine const& projection)
{
    UnrealViewport out;
    out.name = v.text("id");
    out.camera = v.text("camera");
    out.policy = projection.text("type");
    out.screen = projection.text("screen");
    for (auto const& [key, value] : projection.values) out.parameters[lower(key)] = value;
    out.region = {v.pixels("x"), v.pixels("y"), v.pixels("width"), v.pixels("height")};
    if (v.values.contains("X")) out.region.x = v.pixels("X");
    if (v.values.contains("Y")) out.region.y = v.pixels("Y");
    out.buffer_ratio = std::clamp(v.number("buffer_ratio", 1), 0.01, 10.0);
    out.at = projection.at;
    return out;
}

} // namespace

Display parse_ndisplay(std::string const& text, std::string const& name, ImportLog log)
{
    Yaml const root = parse_placed_json(text, name, "nDisplay file");
    Yaml const all = root.needed("nDisplay", "{scene: {...}, cluster: {...}}");
    lose_keys(
        all,
        {"description", "version", "assetPath", "misc", "scene", "cluster", "customParameters", "diagnostics"}, "",
        log);
    lose_stated(all, {"misc", "customParameters", "diagnostics"}, "", log);
    UnrealConfig config;
    read_unreal_scene(all.needed("scene", "{xforms: {}, cameras: {}, screens: {}}"), config, log);
    Yaml const cluster = all.needed("cluster", "{nodes: {}}");
    lose_keys(cluster, {"primaryNode", "masterNode", "sync", "network", "failover", "nodes"}, "cluster.", log);
    if (cluster.has("sync") && cluster.at("sync").has("renderSyncPolicy")) {
        Yaml const sync = cluster.at("sync").at("renderSyncPolicy");
        std::string const type = lower(name_in(sync, "type"));
        config.has_swap_lock = type == "nvidia";
        if (!config.has_swap_lock && type != "none" && type != "ethernet") // ours swap together over the network
            log.lose("nDisplay renderSyncPolicy " + type.substr(0, 64) + ": not imported", 1,
                     text_of(sync.place()));
    }
    for (auto const& [key, node] : cluster.needed("nodes", "{node_0: {...}}").entries())
        config.cluster.push_back(read_unreal_node(key.text(), node, log));
    return display_of(config, name, log);
}

Display parse_ndisplay_cfg(std::string const& text, std::string const& name, ImportLog log)
{
    UnrealConfig config;
    config.metres = 1;
    UnrealLines windows, viewports, projections;
    std::vector<UnrealLine> nodes;
    int number = 0;
    for (std::size_t at = 0; at < text.size();) {
        std::size_t const end = std::min(text.find('\n', at), text.size());
        auto const line = read_line(text.substr(at, end - at), {name, ++number, 1});
        at = end + 1;
        if (!line) continue;
        std::string const& kind = line->kind;
        lose_arguments(*line, log);
        std::string const id = line->text("id");
        if (kind == "cluster_node")
            nodes.push_back(*line);
        else if (kind == "window")
            windows[id] = *line;
        else if (kind == "viewport")
            viewports[id] = *line;
        else if (kind == "projection")
            projections[id] = *line;
        else if (kind == "scene_node")
            config.nodes[id] = line->place();
        else if (kind == "screen")
            config.screens[id] = {line->place(), line->part("size", 'X'), line->part("size", 'Y')};
        else if (kind == "camera") {
            double const force = line->number("force_offset", 0);
            config.cameras.push_back({id,
                                      {line->place(), line->number("eye_dist", 0.064), line->flag("eye_swap"),
                                       force < 0   ? Eye::left
                                       : force > 0 ? Eye::right
                                                   : Eye::middle}});
        } else if (kind == "general")
            config.has_swap_lock = line->text("swap_sync_policy") == "2";
        else if (kind == "nvidia" || kind == "NVIDIA") {
            config.swap_group = int(std::clamp(line->number("sync_group", 1), 1.0, 1000.0));
            config.swap_barrier = int(std::clamp(line->number("sync_barrier", 1), 0.0, 1000.0));
        } else if (kind != "info")
            log.lose("nDisplay [" + kind.substr(0, 64) + "]: not imported", 1, text_of(line->at));
        for (char const* tracker : {"tracker_id"})
            if (!line->text(tracker).empty())
                log.lose("nDisplay " + std::string(tracker) + ": not imported, the place rests", 1,
                         text_of(line->at));
    }
    for (UnrealLine const& n : nodes) {
        UnrealLine const& w = line_of(windows, n.text("window"), "window", n);
        UnrealNode node{n.text("id"),
                        {w.pixels("WinX"), w.pixels("WinY"), w.pixels("ResX"), w.pixels("ResY")},
                        w.flag("fullscreen"),
                        {},
                        w.at};
        if (w.values.contains("postprocess")) log.lose("nDisplay postprocess: not imported", 1, text_of(w.at));
        for (std::string const& id : split_names(w.text("viewports"))) {
            UnrealLine const& v = line_of(viewports, id, "viewport", w);
            node.viewports.push_back(viewport_of(v, line_of(projections, v.text("projection"), "projection", v)));
        }
        config.cluster.push_back(std::move(node));
    }
    return display_of(config, name, log);
}

} // namespace viewer
