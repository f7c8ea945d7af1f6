#pragma once
// Description of a display: walls in a room, the windows that feed them, users with eyes, and trackers for their
// heads. Plain data; display_file.h reads and writes it, check.h validates it.
//
// Frames: room, right-handed, +Y up, metres. Window pixels count from the top left corner, x to the right, y down.
// Positions on a wall (u, v) count from the lower left corner, 0 to 1.

#include "viewer/displays/off_axis.h"
#include "viewer/displays/placement.h"
#include "viewer/displays/stereo_mode.h"
#include "viewer/displays/surface.h"
#include "viewer/displays/wand.h"
#include "viewer/displays/warp_mesh.h"

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

namespace viewer {

enum class Eye { middle, left, right };
/// "left"
char const* name_of(Eye eye);

enum class LengthUnit { px, fraction };

/// Part of a window; fractions are of its size.
struct Viewport {
    LengthUnit unit = LengthUnit::fraction;
    double x = 0, y = 0, width = 1, height = 1;

    bool operator==(Viewport const&) const = default;
};

/// Blend bands where a wall's picture fades into its neighbour's: widths on the wall, from its edges inward.
struct WallBlend {
    double left_m = 0, right_m = 0, top_m = 0, bottom_m = 0;
    double power = 2;   ///< of the curve in blend.h: 1 = linear
    double gamma = 2.2; ///< of the projector: light = value^gamma

    bool operator==(WallBlend const&) const = default;
};

struct Wall {
    std::string name;
    WallCorners corners;            ///< of a flat wall
    std::optional<Surface> surface; ///< instead of corners: not flat
    int window = 0;
    int second_window = -1;                        ///< for the right eye, with StereoMode::two_windows
    Viewport viewport;                             ///< in either window
    int render_width_px = 0, render_height_px = 0; ///< of each eye's picture; 0 = as the viewport
    StereoMode stereo = StereoMode::off;
    Eye eye = Eye::middle;  ///< left, right: shows that eye alone (one projector per eye), without a stereo mode
    bool swap_eyes = false; ///< exchanges the left and right eye
    int user = 0;           ///< index of the user it is drawn for
    WallBlend blend;
    std::string warp_file; ///< path as written in the display file, if the mesh has its own file
    std::optional<WallMesh> warp;
    std::optional<MapFile> warp_map; ///< instead: parse_picture_positions()
    /// Factors on light, and the light of black: out = black + (1 - black) * blend * light, all linear.
    std::optional<LightMap> blend_picture, black_level_picture;
    gi::dvec3 gain{1}; ///< factor on red, green and blue light
    int rank = 0;      ///< process that draws it, in a cluster

    bool operator==(Wall const&) const = default;
};

/// True if a calibration bends the picture, by a mesh or a map.
inline bool is_warped(Wall const& wall) { return wall.warp || wall.warp_map; }
/// Paths, as written in the display file, of the files of a wall's mesh, maps and pictures.
std::vector<std::string> files_of(Wall const& wall);

struct DisplayWindow {
    std::string name;
    int width_px = 0, height_px = 0;
    int x_px = 0, y_px = 0; ///< on the monitor, or on the desktop if no monitor is given
    int monitor = -1;       ///< index in the window system; -1 = not given
    bool fullscreen = false;
    bool borders = true;  ///< the window system's frame and title
    int swap_group = 0;   ///< of the driver (GLX_NV_swap_group): its windows swap together; 0 = none
    int swap_barrier = 0; ///< joins the swap groups of several machines; 0 = none

    bool operator==(DisplayWindow const&) const = default;
};

struct User {
    std::string name;
    double interpupillary_m = 0.063;
    Placement head;            ///< resting pose, used without tracking
    gi::dvec3 eye_offset_m{0}; ///< from the tracked point to the midpoint between the eyes; in the head's frame
    int tracker = -1;          ///< tracker of the head; -1 = none
    std::string avatar{};      ///< file of the user's skinned model, as written; empty = none
    std::optional<double> eye_height_m{}; ///< standing, above the floor y = 0; none = that of the resting head
    std::string avatar_joints{};          ///< joint map of the model, as written; empty = by usual names

    bool operator==(User const&) const = default;
};

enum class DisplayTrackerType { osc, dtrack, vrpn, openxr, file, fake };

enum class FilterType { none, one_euro };

/// Casiez et al. 2012: cut-off frequency = minimum + beta * speed.
struct TrackerFilter {
    FilterType type = FilterType::none;
    double min_cutoff_hz = 1;
    double beta_per_m = 1; ///< Hz per m/s

    bool operator==(TrackerFilter const&) const = default;
};

struct DisplayTracker {
    std::string name;
    DisplayTrackerType type = DisplayTrackerType::fake;
    std::string address = "127.0.0.1"; ///< of the interface to listen on (osc, dtrack)
    int port = 0;
    /// Osc: /name or name; dtrack: number, flystick0; vrpn: number of the sensor;
    /// openxr: head, left_hand, right_hand.
    std::string body;
    std::string file; ///< recorded poses
    Placement room_from_tracker;
    double latency_ms = 0; ///< from motion to packet, measured
    TrackerFilter filter{};
    std::string left_hand_body{}, right_hand_body{}; ///< of the same sender, by its names; empty = default names
    std::string left_foot_body{}, right_foot_body{};
    std::optional<WandSettings> wand{}; ///< the body is a wand
    std::string device{};               ///< vrpn: Tracker0@host[:port]
    /// Type vrpn: device of the same server with the wand's buttons and analogs; empty = `device`'s.
    std::string controls{};

    bool operator==(DisplayTracker const&) const = default;
};

/// Further bodies of a tracker besides its main one.
struct LimbBody {
    char const* key; ///< key in display files
    std::string DisplayTracker::*body;
};
inline constexpr LimbBody kLimbBodies[]{{"left_hand_body", &DisplayTracker::left_hand_body},
                                        {"right_hand_body", &DisplayTracker::right_hand_body},
                                        {"left_foot_body", &DisplayTracker::left_foot_body},
                                        {"right_foot_body", &DisplayTracker::right_foot_body}};

/// Start of the room in a scene. The floor stays level, so the only angle is about +Y.
struct RoomPlace {
    gi::dvec3 position_m{0}; ///< of the room's origin, in the world
    double yaw_deg = 0;      ///< of the room's -Z, to the left

    bool operator==(RoomPlace const&) const = default;
};
gi::dmat4 world_from_room(RoomPlace const& place);

struct Display {
    std::string name;
    std::vector<Wall> walls;
    std::vector<DisplayWindow> windows;
    std::vector<User> users;
    std::vector<DisplayTracker> trackers;
    std::optional<RoomPlace> world{}; ///< none: the first user's resting head is at the scene's camera

    bool operator==(Display const&) const = default;
};

/// The name of a body without the / with which it may begin: "/head" and "head" mean the same everywhere.
inline std::string body_name(std::string const& id) { return id.starts_with('/') ? id.substr(1) : id; }

char const* name_of(DisplayTrackerType type);
std::optional<DisplayTrackerType> tracker_type(std::string const& name);

struct PixelRectangle {
    int x = 0, y = 0, width = 0, height = 0;

    bool operator==(PixelRectangle const&) const = default;
};
/// The wall's part of its window. Fractional edges are rounded to the nearest pixel,
/// so that neighbours share them.
PixelRectangle viewport_px(Wall const& wall, DisplayWindow const& window);

} // namespace viewer
