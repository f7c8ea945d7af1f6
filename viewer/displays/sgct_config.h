#pragma once
// A configuration of SGCT, from JSON or the older XML, as plain data, and its conversion.

#include "viewer/displays/import.h"

#include <array>

namespace viewer {

enum class SgctProjectionKind { none, plane, fisheye, cylindrical, equirectangular, spherical_mirror, other };

/// Values that the file leaves out are SGCT's own.
struct SgctProjection {
    SgctProjectionKind kind = SgctProjectionKind::none;
    std::string name;                                      ///< as in the file, for messages
    WallCorners corners;                                   ///< plane
    double fov_deg = 180, tilt_deg = 0, diameter_m = 14.8; ///< fisheye; the tilt also of the mirror
    std::array<double, 4> crop{0, 0, 0, 0}; ///< left, right, bottom, top share of the fisheye's square
    bool keeps_aspect = true;
    gi::dvec3 offset{0};                                      ///< of a fisheye's eye, in radii
    double rotation_deg = 0, height_offset = 0, radius_m = 5; ///< cylindrical
    std::array<std::string, 4> meshes;                        ///< mirror: bottom, left, right, top
    gi::TextLocation at;
};

struct SgctViewport {
    double x = 0, y = 0, width = 1, height = 1; ///< fractions of the window, from its lower left corner
    Eye eye = Eye::middle;
    std::optional<std::string> user;
    std::string mesh; ///< of correction; empty = none
    SgctProjection projection;
    gi::TextLocation at;
};

struct SgctWindow {
    DisplayWindow window;
    double picture_aspect = 1; ///< of what is rendered before it is stretched over the window
    std::string stereo = "none";
    std::vector<SgctViewport> viewports;
    gi::TextLocation at;
};

struct SgctUser {
    std::string name;
    double eyes_m = 0.06;
    gi::dvec3 position_m{0};
    gi::TextLocation at;
};

struct SgctConfig {
    std::vector<SgctUser> users;
    std::vector<std::vector<SgctWindow>> nodes;
    std::optional<RoomPlace> world;
};

/// A plane `distance` before the room's origin, turned by yaw to the right, pitch upward and roll to the right;
/// left and down are positive. Degrees.
struct SgctPlanar {
    double left_deg = 0, right_deg = 0, up_deg = 0, down_deg = 0, distance_m = 10;
    gi::dquat turn{1, 0, 0, 0};
    gi::dvec3 offset_m{0};
};
WallCorners corners_of(SgctPlanar const& planar);
gi::dquat sgct_turn(double yaw_deg, double pitch_deg, double roll_deg);
/// The room's place in a scene that SGCT moves and turns; none if it does more than that.
std::optional<RoomPlace> world_of_scene(gi::dvec3 offset_m, double yaw_deg, double pitch_deg, double roll_deg,
                                        double scale);
/// Counts a resolution of a window's pictures that is not the window's.
void lose_resolution(SgctWindow const& w, int width_px, int height_px, gi::TextLocation const& at,
                     ImportLog const& log);
/// "file:line:column"
std::string text_at(gi::TextLocation const& at);

Display display_of(SgctConfig const& config, std::string const& file, ImportLog const& log);

} // namespace viewer
