#include "viewer/displays/check.h"

#include "viewer/displays/vrpn_address.h"

#include <cmath>
#include <fmt/format.h>
#include <set>

namespace viewer {
namespace {

using Fault = std::optional<DisplayFault>;

bool is_within(double x, double low, double high) { return x >= low && x <= high; } // false for NaN

bool is_placed(Placement const& p)
{
    for (int i = 0; i < 3; ++i)
        if (!is_within(p.translation_m[i], -kFarthestCorner_m, kFarthestCorner_m) ||
            !is_within(p.rotation_deg[i], -3600, 3600))
            return false;
    return true;
}

template <typename Part>
Fault names_fault(std::vector<Part> const& parts, char const* list)
{
    std::set<std::string> seen;
    for (std::size_t i = 0; i < parts.size(); ++i) {
        if (parts[i].name.empty())
            return DisplayFault{list,     i, "name", "the name is empty", "messages and pictures use names",
                                "name it"};
        if (!seen.insert(parts[i].name).second)
            return DisplayFault{list,
                                i,
                                "name",
                                "'" + parts[i].name + "' is used twice",
                                "others refer to it by its name",
                                "give each its own"};
    }
    return {};
}

Fault viewport_fault(Wall const& wall, std::size_t i, DisplayWindow const& window)
{
    Viewport const& v = wall.viewport;
    bool const in_px = v.unit == LengthUnit::px;
    char const* const key = in_px ? "viewport_px" : "viewport_fraction";
    double const limit = kLargestWindow_px;
    for (double const x : {v.x, v.y, v.width, v.height})
        if (!is_within(x, 0, limit))
            return DisplayFault{"walls",
                                i,
                                key,
                                "the viewport is not within the window",
                                "it would be cut off",
                                "give [left, top, width, height] from the top left corner"};
    PixelRectangle const r = viewport_px(wall, window);
    if (r.width < 1 || r.height < 1)
        return DisplayFault{"walls",
                            i,
                            key,
                            "the viewport has no pixels",
                            "nothing could be shown in it",
                            "give [left, top, width, height]"};
    if (r.x + r.width > window.width_px || r.y + r.height > window.height_px)
        return DisplayFault{"walls",
                            i,
                            key,
                            fmt::format("the viewport reaches to pixel ({}, {}) of window '{}', which has {} x {}",
                                        r.x + r.width, r.y + r.height, window.name, window.width_px,
                                        window.height_px),
                            "it would be cut off",
                            "make it smaller, or the window larger"};
    if ((wall.stereo == StereoMode::side_by_side && r.width % 2 != 0) ||
        (wall.stereo == StereoMode::top_bottom && r.height % 2 != 0))
        return DisplayFault{"walls",
                            i,
                            key,
                            fmt::format("{} x {} pixels cannot be halved", r.width, r.height),
                            std::string(name_of(wall.stereo)) + " gives each eye one half",
                            "choose an even size"};
    return {};
}

Fault finish_fault(Wall const& wall, std::size_t i)
{
    WallBlend const& b = wall.blend;
    if (wall.surface && b != WallBlend{})
        return DisplayFault{"walls",
                            i,
                            "blend",
                            "a blend on a projection",
                            "bands have widths on a flat wall",
                            "fade by the weights of a warp mesh"};
    double const width_m = wall.surface ? 0 : wall_frame(wall.corners).width_m,
                 height_m = wall.surface ? 0 : wall_frame(wall.corners).height_m;
    for (double const band : {b.left_m, b.right_m, b.top_m, b.bottom_m})
        if (!is_within(band, 0, 1e6))
            return DisplayFault{"walls",
                                i,
                                "blend",
                                "a band of blending is negative or not finite",
                                "it is a width on the wall",
                                "give metres, or 0"};
    double const slack = 1 + 1e-9;
    if (b.left_m + b.right_m > width_m * slack || b.top_m + b.bottom_m > height_m * slack)
        return DisplayFault{"walls",
                            i,
                            "blend",
                            "the bands of blending overlap each other",
                            fmt::format("the wall is {:.4g} x {:.4g} m", width_m, height_m),
                            "make them narrower"};
    if (!is_within(b.power, 0.1, 10))
        return DisplayFault{"walls",
                            i,
                            "blend",
                            fmt::format("a power of {:g}", b.power),
                            "the range is 0.1 to 10",
                            "2 is usual, 1 is straight"};
    if (!is_within(b.gamma, 1, 4))
        return DisplayFault{
            "walls",       i, "blend", fmt::format("a gamma of {:g}", b.gamma), "projectors have 1 to 4",
            "2.2 is usual"};
    for (int c = 0; c < 3; ++c)
        if (!is_within(wall.gain[c], 0, 4))
            return DisplayFault{"walls",
                                i,
                                "gain",
                                fmt::format("a gain of {:g}", wall.gain[c]),
                                "it is a factor on light, 0 to 4",
                                "1 leaves it as it is"};
    if (wall.warp)
        if (auto const fault = find_fault(*wall.warp))
            return DisplayFault{"walls",
                                i,
                                "warp",
                                *fault,
                                "the picture would be torn",
                                "write nodes row by row from below, each to the right of the one before"};
    return {};
}

Fault wall_fault(Display const& d, std::size_t i)
{
    Wall const& wall = d.walls[i];
    auto const fault = [&](char const* key, std::string const& problem, std::string const& why,
                           std::string const& suggestion) {
        return DisplayFault{"walls", i, key, problem, why, suggestion};
    };
    if (wall.surface) {
        if (auto const f = find_fault(*wall.surface))
            return fault("projection", "wall '" + wall.name + "': " + f->problem, f->why, f->suggestion);
        if (wall.render_width_px != wall.render_height_px)
            return fault("render_px", "a face of a cube that is not square",
                         "a projection is drawn from such faces", "give the same number twice");
    } else if (auto const corners = find_fault(wall.corners))
        return fault("lower_left_m", "wall '" + wall.name + "': " + corners->problem, corners->why,
                     corners->suggestion);
    if (wall.window < 0 || std::size_t(wall.window) >= d.windows.size())
        return fault("window", "wall '" + wall.name + "' has no window", "it needs one to be drawn in",
                     "name one of windows");
    if (wall.user < 0 || std::size_t(wall.user) >= d.users.size())
        return fault("user", "wall '" + wall.name + "' has no user", "it is drawn for a user's eyes",
                     "name one of users");
    if (wall.eye != Eye::middle && wall.stereo != StereoMode::off)
        return fault("eye", std::string("eye: ") + name_of(wall.eye) + " with stereo: " + name_of(wall.stereo),
                     "the wall shows one eye, or both", "remove one of them");
    bool const two = wall.stereo == StereoMode::two_windows;
    if (two != (wall.second_window >= 0))
        return fault("stereo", two ? "two-windows without a second_window" : "a second_window without two-windows",
                     "the right eye has a window of its own then, and only then",
                     two ? "name one" : "set stereo: two-windows, or remove it");
    if (two && (std::size_t(wall.second_window) >= d.windows.size() || wall.second_window == wall.window))
        return fault("second_window", "the right eye has no window of its own", "both would draw over each other",
                     "name another of windows");
    if (wall.rank < 0 || wall.rank > 4095)
        return fault("rank", fmt::format("rank {}", wall.rank), "processes count from 0 to 4095", "change it");
    bool const sized = wall.render_width_px > 0 && wall.render_height_px > 0;
    if ((wall.render_width_px != 0 || wall.render_height_px != 0) &&
        (!sized || wall.render_width_px > kLargestWindow_px || wall.render_height_px > kLargestWindow_px))
        return fault("render_px", fmt::format("pictures of {} x {}", wall.render_width_px, wall.render_height_px),
                     fmt::format("1 to {} pixels are drawn", kLargestWindow_px), "change it, or remove it");
    if (auto f = viewport_fault(wall, i, d.windows[std::size_t(wall.window)])) return f;
    if (two)
        if (auto f = viewport_fault(wall, i, d.windows[std::size_t(wall.second_window)])) return f;
    return finish_fault(wall, i);
}

Fault window_fault(DisplayWindow const& w, std::size_t i)
{
    if (w.width_px < 1 || w.height_px < 1 || w.width_px > kLargestWindow_px || w.height_px > kLargestWindow_px)
        return DisplayFault{"windows",
                            i,
                            "size_px",
                            fmt::format("a window of {} x {}", w.width_px, w.height_px),
                            fmt::format("windows have 1 to {} pixels a side", kLargestWindow_px),
                            "change it"};
    if (std::abs(w.x_px) > 1000000 || std::abs(w.y_px) > 1000000)
        return DisplayFault{
            "windows",  i, "position_px", "the window is a million pixels away", "no desktop is that large",
            "change it"};
    if (w.swap_group < 0 || w.swap_group > 1000 || w.swap_barrier < 0 || w.swap_barrier > 1000 ||
        (w.swap_barrier > 0 && w.swap_group == 0))
        return DisplayFault{"windows",
                            i,
                            w.swap_group == 0 ? "swap_barrier" : "swap_group",
                            fmt::format("swap group {} at barrier {}", w.swap_group, w.swap_barrier),
                            "groups and barriers count from 1, and a barrier joins groups",
                            "swap_group: 1, swap_barrier: 1"};
    if (w.monitor < -1 || w.monitor > 255)
        return DisplayFault{"windows",
                            i,
                            "monitor",
                            fmt::format("monitor {}", w.monitor),
                            "monitors count from 0 to 255",
                            "change it, or leave it out"};
    return {};
}

Fault user_fault(Display const& d, std::size_t i)
{
    User const& user = d.users[i];
    double const eyes = user.interpupillary_m;
    if (!is_within(eyes, kNarrowestEyes_m, kWidestEyes_m)) {
        std::string suggestion = "0.063 is usual; stereo: off shows one eye's picture";
        for (auto const& [unit, metres] : {std::pair{"millimetres", 1e-3}, {"centimetres", 1e-2}})
            if (is_within(eyes * metres, kNarrowestEyes_m, kWidestEyes_m))
                suggestion = fmt::format("metres? {} {} are {:.4g} m", eyes, unit, eyes * metres);
        return DisplayFault{"users",
                            i,
                            "interpupillary_m",
                            fmt::format("eyes {} m apart", eyes),
                            fmt::format("people's are {} to {} m apart", kNarrowestEyes_m, kWidestEyes_m),
                            suggestion};
    }
    if (!is_placed(user.head))
        return DisplayFault{"users",
                            i,
                            "head_position_m",
                            "the head's pose is invalid",
                            "a value is not finite or too large",
                            "metres and degrees"};
    if (!is_within(glm::length(user.eye_offset_m), 0, 1))
        return DisplayFault{"users",
                            i,
                            "eye_offset_m",
                            "the eyes are more than a metre from the tracked point",
                            "it is worn on the head",
                            "is it in metres? 0.1 is usual"};
    if (user.tracker < -1 || user.tracker >= int(d.trackers.size()))
        return DisplayFault{"users",
                            i,
                            "head_tracker",
                            "there is no such tracker",
                            "the head could not be tracked",
                            "name one of trackers, or leave it out"};
    if (user.eye_height_m && !is_within(*user.eye_height_m, 0.3, 3))
        return DisplayFault{"users",
                            i,
                            "eye_height_m",
                            fmt::format("eyes {} m above the floor", *user.eye_height_m),
                            "the range for standing people is 0.3 to 3 m",
                            "is it in metres? 1.65 is usual"};
    if (!user.avatar.empty() && i > CommandLimits::users)
        return DisplayFault{"users",
                            i,
                            "avatar",
                            "too many users with avatars",
                            fmt::format("frame commands hold {} besides the first", CommandLimits::users),
                            "give avatars only to the first users"};
    return {};
}

Fault tracker_fault(DisplayTracker const& t, std::size_t i)
{
    auto const fault = [&](char const* key, std::string const& problem, std::string const& why,
                           std::string const& suggestion) {
        return DisplayFault{"trackers", i, key, problem, why, suggestion};
    };
    bool const is_network = t.type == DisplayTrackerType::osc || t.type == DisplayTrackerType::dtrack;
    if (is_network && !is_within(t.port, 1, 65535))
        return fault("port", fmt::format("port {}", t.port), "packets are received on a port, 1 to 65535",
                     t.type == DisplayTrackerType::osc ? "port: 9000" : "port: 5000");
    if (is_network && t.address.empty())
        return fault("address", "no address", "it listens on one interface only", "address: 127.0.0.1");
    bool const is_vrpn = t.type == DisplayTrackerType::vrpn;
    if (is_vrpn && !parse_vrpn_address(t.device))
        return fault("device",
                     t.device.empty() ? "no device" : "'" + t.device.substr(0, 64) + "' is no device of VRPN",
                     "it is the device's name, @ and its server", "device: Tracker0@localhost");
    if (is_vrpn && (t.port != 0 || t.address != DisplayTracker{}.address))
        return fault(t.port != 0 ? "port" : "address", "a port or address of our own with type: vrpn",
                     "the server is named by device", "device: Tracker0@host:3883");
    if (!is_vrpn && !(t.device.empty() && t.controls.empty()))
        return fault(t.device.empty() ? "controls" : "device",
                     "a device with type: " + std::string(name_of(t.type)), "only VRPN has named devices",
                     "type: vrpn");
    if (t.type == DisplayTrackerType::osc &&
        (body_name(t.body).empty() || body_name(t.body).find('/') != std::string::npos))
        return fault("body", "'" + t.body.substr(0, 64) + "' is no body of OSC",
                     "it is the part <body> of addresses such as /tracker/<body>/pose", "body: head, or /head");
    auto const is_number = [](std::string const& id) {
        return !id.empty() && id.size() <= 4 && id.find_first_not_of("0123456789") == std::string::npos;
    };
    bool const is_flystick = t.body.starts_with("flystick") && is_number(t.body.substr(8));
    if (t.type == DisplayTrackerType::dtrack && !is_number(t.body) && !is_flystick)
        return fault("body", "'" + t.body.substr(0, 64) + "' is no body of DTrack",
                     "bodies have numbers from 0, flysticks are flystick0, flystick1, ...", "body: 0");
    if (is_vrpn && !is_number(t.body))
        return fault("body", "'" + t.body.substr(0, 64) + "' is no sensor of VRPN", "sensors have numbers from 0",
                     "body: 0");
    if (t.wand && (t.type == DisplayTrackerType::openxr || t.type == DisplayTrackerType::fake))
        return fault("wand", "a wand with type: " + std::string(name_of(t.type)),
                     "its controls are read of osc, dtrack, vrpn and file", "remove it");
    if (t.type == DisplayTrackerType::openxr && t.body != "head" && t.body != "left_hand" &&
        t.body != "right_hand")
        return fault("body", "'" + t.body + "' is nothing that OpenXR tracks", "it tracks a head and two hands",
                     "head, left_hand or right_hand");
    bool const has_limbs = is_network || is_vrpn || t.type == DisplayTrackerType::file;
    std::set<std::string> bodies{body_name(t.body)};
    for (LimbBody const& b : kLimbBodies) {
        std::string const& id = t.*b.body;
        if (id.empty()) continue;
        if (!has_limbs)
            return fault(b.key, "a body for type: " + std::string(name_of(t.type)), "it has its own names",
                         "remove it");
        if (!bodies.insert(body_name(id)).second)
            return fault(b.key, "body '" + id.substr(0, 64) + "' twice", "it cannot be two parts of a body",
                         "give each its own");
    }
    if ((t.type == DisplayTrackerType::file) == t.file.empty())
        return fault("file", t.file.empty() ? "no file" : "a file with type: " + std::string(name_of(t.type)),
                     "poses are read from one with type: file, and only then", "give it, or remove it");
    if (!is_placed(t.room_from_tracker))
        return fault("room_from_tracker", "the tracker's pose is invalid", "a value is not finite or too large",
                     "metres and degrees");
    if (!is_within(t.latency_ms, 0, 1000))
        return fault("latency_ms", fmt::format("a latency of {} ms", t.latency_ms), "it is 0 to 1000",
                     "milliseconds from motion to packet");
    if (!is_within(t.filter.min_cutoff_hz, 0.001, 1000) || !is_within(t.filter.beta_per_m, 0, 1e4))
        return fault("filter", "the filter is out of range", "cut-off 0.001 to 1000 Hz, beta 0 to 10,000 per m",
                     "min_cutoff_hz: 1, beta_per_m: 1");
    return {};
}

/// Trackers of different protocols at the same address and port; those of one protocol may share it.
Fault ports_fault(Display const& d)
{
    auto const is_network = [](DisplayTracker const& t) {
        return t.type == DisplayTrackerType::osc || t.type == DisplayTrackerType::dtrack;
    };
    for (std::size_t i = 0; i < d.trackers.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            DisplayTracker const &a = d.trackers[i], &b = d.trackers[j];
            if (!is_network(a) || !is_network(b) || a.type == b.type || a.port != b.port || a.address != b.address)
                continue;
            return DisplayFault{
                "trackers",
                i,
                "port",
                fmt::format("trackers '{}' and '{}' share {} port {}", b.name, a.name, a.address, a.port),
                "one speaks OSC, the other DTrack",
                "give each a port of its own"};
        }
    return {};
}

bool overlap(PixelRectangle const& a, PixelRectangle const& b)
{
    return a.x < b.x + b.width && b.x < a.x + a.width && a.y < b.y + b.height && b.y < a.y + a.height;
}

/// Finds walls that would draw over each other, and windows that two processes would open.
Fault sharing_fault(Display const& d)
{
    for (std::size_t i = 0; i < d.walls.size(); ++i)
        for (std::size_t j = 0; j < i; ++j) {
            Wall const &a = d.walls[i], &b = d.walls[j];
            for (int const mine : {a.window, a.second_window})
                for (int const other : {b.window, b.second_window}) {
                    if (mine < 0 || mine != other) continue;
                    DisplayWindow const& window = d.windows[std::size_t(mine)];
                    if (a.rank != b.rank)
                        return DisplayFault{
                            "walls",
                            i,
                            "rank",
                            fmt::format("window '{}' is on ranks {} and {}", window.name, b.rank, a.rank),
                            "one process opens a window",
                            "give its walls one rank, or each a window"};
                    // Meshes and maps place pictures within the viewport, so several such walls may share one.
                    if (!is_warped(a) && !is_warped(b) && overlap(viewport_px(a, window), viewport_px(b, window)))
                        return DisplayFault{
                            "walls",
                            i,
                            a.viewport.unit == LengthUnit::px ? "viewport_px" : "viewport_fraction",
                            fmt::format("walls '{}' and '{}' overlap in window '{}'", b.name, a.name, window.name),
                            "one would be drawn over the other",
                            "move one of them"};
                }
        }
    return {};
}

} // namespace

Fault find_fault(Display const& d)
{
    if (d.walls.empty())
        return DisplayFault{"", 0, "walls", "the display has no walls", "there is nothing to draw on", "add one"};
    if (d.walls.size() > kMostWalls)
        return DisplayFault{"",
                            0,
                            "walls",
                            fmt::format("{} walls", d.walls.size()),
                            fmt::format("up to {} are handled", kMostWalls),
                            "is it one display?"};
    for (auto const& fault : {names_fault(d.walls, "walls"), names_fault(d.windows, "windows"),
                              names_fault(d.users, "users"), names_fault(d.trackers, "trackers")})
        if (fault) return fault;
    for (std::size_t i = 0; i < d.windows.size(); ++i)
        if (auto fault = window_fault(d.windows[i], i)) return fault;
    for (std::size_t i = 0; i < d.trackers.size(); ++i)
        if (auto fault = tracker_fault(d.trackers[i], i)) return fault;
    if (auto fault = ports_fault(d)) return fault;
    for (std::size_t i = 0; i < d.users.size(); ++i)
        if (auto fault = user_fault(d, i)) return fault;
    for (std::size_t i = 0; i < d.walls.size(); ++i)
        if (auto fault = wall_fault(d, i)) return fault;
    return sharing_fault(d);
}

void require_sound(Display const& display, std::string const& file)
{
    if (auto const f = find_fault(display)) throw gi::InputError({file, 0, 0}, f->problem, f->why, f->suggestion);
}

} // namespace viewer
