#include "viewer/displays/sgct_config.h"

#include "viewer/displays/import_common.h"
#include "viewer/displays/mesh_file.h"

#include <fmt/format.h>

namespace viewer {
namespace {

struct SgctStereo {
    StereoMode mode = StereoMode::off;
    bool swap = false;
};

/// SGCT's interlaced modes count rows from below and put the left eye on row 0.
SgctStereo stereo_of(SgctWindow const& w, ImportLog const& log)
{
    std::string const& name = w.stereo;
    std::string const plain = name.substr(0, name.find("_inverted"));
    bool const is_inverted = plain != name, is_even = w.window.height_px % 2 == 0;
    if (plain == "none" || plain == "no_stereo") return {};
    if (plain == "active" || plain == "quadbuffer") return {StereoMode::quad_buffer, is_inverted};
    if (plain == "anaglyph_red_cyan") return {StereoMode::anaglyph_red_cyan, is_inverted};
    if (plain == "side_by_side") return {StereoMode::side_by_side, is_inverted};
    if (plain == "top_bottom") return {StereoMode::top_bottom, is_inverted};
    if (plain == "vertical_interlaced") return {StereoMode::rows, is_inverted != is_even};
    if (plain == "checkerboard") return {StereoMode::checkerboard, is_inverted != is_even};
    log.lose("SGCT stereo mode '" + name.substr(0, 64) + "': shown without stereo", 1, text_at(w.at));
    return {};
}

/// The square of the fisheye within the viewport, as SGCT's FisheyeProjection::update draws it.
ViewportCircle circle_of(SgctProjection const& p, double aspect)
{
    auto const [left, right, bottom, top] = p.crop;
    double const across = 1 - left - right, upward = 1 - bottom - top;
    double x = 1, y = 1; // of the drawn rectangle, half sizes
    if (p.keeps_aspect) {
        double const shown = aspect * (2 - 2 * bottom - 2 * top) / (2 - 2 * left - 2 * right);
        if (shown >= 1)
            x = 1 / shown;
        else
            y = shown;
    }
    double const u = (0.5 - left) / across, v = (0.5 - bottom) / upward;
    return {0.5 + x * (u - 0.5), 0.5 + y * (v - 0.5), x * 0.5 / across, y * 0.5 / upward};
}

Surface surface_of(SgctProjection const& p, double aspect)
{
    Surface s;
    if (p.kind == SgctProjectionKind::cylindrical) {
        // Its pictures begin at azimuth 135 degrees - rotation and are as high as the radius.
        s.type = SurfaceType::cylindrical;
        s.radius_m = p.radius_m;
        double const left = std::remainder(135 - p.rotation_deg, 360);
        s.azimuths_deg = {left, left + 360};
        s.heights_m = {p.radius_m * p.height_offset, p.radius_m * (p.height_offset + 1)};
    } else if (p.kind == SgctProjectionKind::equirectangular) {
        s.type = SurfaceType::equirectangular;
        s.azimuths_deg = {-135, 225}; // azimuth 45 degrees is in the middle
    } else {
        s.type = SurfaceType::fisheye;
        s.fov_deg = p.fov_deg;
        s.radius_m = p.diameter_m / 2;
        s.place.rotation_deg.x = 90 - p.tilt_deg;
        // Its frame is ours turned by half a turn about x.
        s.place.translation_m =
            -(pose_of(s.place).rotation * (s.radius_m * gi::dvec3{p.offset.x, -p.offset.y, -p.offset.z}));
        for (int i = 0; i < 3; ++i) s.place.translation_m[i] += 0.0; // no -0
        s.circle = circle_of(p, aspect);
    }
    return s;
}

struct SgctConversion {
    Display display;
    std::filesystem::path folder;
    ImportLog const& log;
};

/// None: the viewport is skipped.
std::optional<WallMesh> mesh_of(std::string const& mesh, SgctWindow const& w, SgctViewport const& v,
                                SgctConversion const& c)
{
    double const aspect =
        double(w.window.width_px) / std::max(1, w.window.height_px) * v.width / std::max(1e-6, v.height);
    try {
        return load_mesh_file(c.folder / mesh, aspect);
    } catch (gi::InputError const& e) {
        c.log.lose("SGCT viewports whose mesh cannot be read, skipped: " + std::string(e.what()), 1,
                   text_at(v.at));
        return {};
    }
}

/// The four faces that a ball mirrors, each on its mesh.
void add_mirror(Wall wall, SgctWindow const& w, SgctViewport const& v, SgctConversion& c)
{
    constexpr double kHalf_m = 1.2;
    auto const about = [](double degrees, gi::dvec3 axis) { return glm::angleAxis(glm::radians(degrees), axis); };
    gi::dquat const tilt = about(45 - v.projection.tilt_deg, {1, 0, 0});
    struct Face {
        char const* name;
        gi::dquat turn;
    };
    Face const faces[4]{{"front", {1, 0, 0, 0}}, // the mesh called bottom shows the front face
                        {"left", about(90, {0, 1, 0})},
                        {"right", about(-90, {0, 1, 0})},
                        {"top", about(90, {1, 0, 0})}};
    std::string const name = wall.name;
    for (std::size_t i = 0; i < 4; ++i) {
        wall.warp = mesh_of(v.projection.meshes[i], w, v, c);
        if (!wall.warp) continue;
        auto const corner = [&](double x, double y) {
            return tilt * faces[i].turn * (kHalf_m * gi::dvec3{x, y, -1});
        };
        wall.corners = {corner(-1, -1), corner(1, -1), corner(-1, 1)};
        wall.name = free_name(c.display.walls, name + " " + faces[i].name);
        c.display.walls.push_back(wall);
    }
}

void add_viewport(SgctWindow const& w, SgctViewport const& v, SgctStereo stereo, int window, int rank,
                  std::vector<SgctUser> const& users, SgctConversion& c)
{
    SgctProjection const& p = v.projection;
    if (p.kind == SgctProjectionKind::none || p.kind == SgctProjectionKind::other) {
        c.log.lose(p.kind == SgctProjectionKind::none ? "SGCT viewports without a projection skipped"
                                                      : "SGCT viewports with a " + p.name.substr(0, 64) +
                                                            ", which is not shown in a window, skipped",
                   1, text_at(p.kind == SgctProjectionKind::none ? v.at : p.at));
        return;
    }
    Wall wall;
    if (p.name == "TextureMappedProjection")
        c.log.lose("SGCT TextureMappedProjection: taken as a PlanarProjection", 1, text_at(p.at));
    wall.name = free_name(c.display.walls, w.window.name);
    wall.window = window;
    wall.rank = rank;
    wall.eye = v.eye;
    if (v.eye == Eye::middle) {
        wall.stereo = stereo.mode;
        wall.swap_eyes = stereo.swap;
    } else if (stereo.mode != StereoMode::off) {
        c.log.lose("SGCT stereo mode of a window with a viewport for one eye: shown to that eye alone", 1,
                   text_at(v.at));
    }
    wall.viewport = from_below(v.x, v.y, v.width, v.height);
    std::string const wanted = v.user.value_or(users.front().name);
    wall.user = -1;
    for (std::size_t u = 0; u < users.size(); ++u)
        if (users[u].name == wanted) wall.user = int(u);
    if (wall.user < 0)
        throw gi::InputError(v.at, "there is no user '" + wanted.substr(0, 64) + "'",
                             "a viewport is drawn for a user's eyes", "name one of users");
    if (p.kind == SgctProjectionKind::spherical_mirror) {
        add_mirror(wall, w, v, c);
        return;
    }
    if (!v.mesh.empty()) {
        wall.warp = mesh_of(v.mesh, w, v, c);
        if (!wall.warp) return;
    }
    if (p.kind == SgctProjectionKind::plane) {
        wall.corners = p.corners;
        if (auto const fault = find_fault(wall.corners))
            throw gi::InputError(p.at, fault->problem, fault->why, fault->suggestion);
    } else {
        wall.surface = surface_of(p, w.picture_aspect * v.width / std::max(1e-6, v.height));
        if (auto const fault = find_fault(*wall.surface))
            throw gi::InputError(p.at, p.name + ": " + fault->problem, fault->why, fault->suggestion);
    }
    c.display.walls.push_back(wall);
}

} // namespace

WallCorners corners_of(SgctPlanar const& p)
{
    auto const at = [&](double degrees) { return p.distance_m * std::tan(glm::radians(degrees)); };
    auto const corner = [&](double x, double y) { return p.turn * gi::dvec3{x, y, -p.distance_m} + p.offset_m; };
    double const left = -at(p.left_deg), right = at(p.right_deg), top = at(p.up_deg), bottom = -at(p.down_deg);
    return {corner(left, bottom), corner(right, bottom), corner(left, top)};
}

gi::dquat sgct_turn(double yaw_deg, double pitch_deg, double roll_deg)
{
    auto const about = [](double degrees, gi::dvec3 axis) { return glm::angleAxis(glm::radians(degrees), axis); };
    return about(-yaw_deg, {0, 1, 0}) * about(pitch_deg, {1, 0, 0}) * about(-roll_deg, {0, 0, 1});
}

std::optional<RoomPlace> world_of_scene(gi::dvec3 offset, double yaw, double pitch, double roll, double scale)
{
    if (pitch != 0 || roll != 0 || scale != 1) return {};
    // A point of the scene is at offset + turn * point in the room.
    gi::dquat const back = glm::conjugate(sgct_turn(yaw, 0, 0));
    gi::dvec3 position = back * -offset;
    for (int i = 0; i < 3; ++i) position[i] += 0.0;
    return RoomPlace{position, yaw};
}

void lose_resolution(SgctWindow const& w, int width_px, int height_px, gi::TextLocation const& at,
                     ImportLog const& log)
{
    if (width_px == w.window.width_px && height_px == w.window.height_px) return;
    log.lose("SGCT resolutions of pictures other than their window's: only their proportions are imported", 1,
             fmt::format("{}: {} x {}", text_at(at), width_px, height_px));
}

std::string text_at(gi::TextLocation const& at)
{
    return at.column > 0 ? fmt::format("{}:{}:{}", at.file, at.line, at.column)
                         : fmt::format("{}:{}", at.file, at.line);
}

Display display_of(SgctConfig const& config, std::string const& file, ImportLog const& log)
{
    SgctConversion c{{}, std::filesystem::path(file).parent_path(), log};
    c.display.world = config.world;
    std::vector<SgctUser> users = config.users;
    if (users.empty()) {
        log.lose("no user in the file: one stands at the origin", 1, file);
        users.push_back({"default", 0.063, gi::dvec3{0}, {file, 1, 0}});
    }
    for (SgctUser& u : users) {
        User user;
        user.name = free_name(c.display.users, u.name);
        user.interpupillary_m = imported_eyes(u.eyes_m, "user '" + user.name + "', " + text_at(u.at), log);
        user.head.translation_m = u.position_m;
        c.display.users.push_back(user);
    }
    int rank = 0;
    for (std::vector<SgctWindow> const& node : config.nodes) {
        bool has_walls = false;
        for (SgctWindow const& w : node) {
            DisplayWindow window = w.window;
            window.name = free_name(c.display.windows, window.name);
            c.display.windows.push_back(window);
            SgctStereo const stereo = stereo_of(w, log);
            std::size_t const walls = c.display.walls.size();
            SgctWindow named = w;
            named.window.name = window.name;
            for (SgctViewport const& v : w.viewports)
                add_viewport(named, v, stereo, int(c.display.windows.size()) - 1, rank, users, c);
            if (c.display.walls.size() == walls)
                c.display.windows.pop_back();
            else
                has_walls = true;
        }
        rank += has_walls ? 1 : 0;
    }
    return finished(std::move(c.display), file, log);
}

} // namespace viewer
