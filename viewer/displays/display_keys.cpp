#include "viewer/displays/display_keys.h"

namespace viewer {

std::map<std::string, std::set<std::string>> const& display_keys()
{
    static std::map<std::string, std::set<std::string>> const keys{
        {"display", {"name", "walls", "windows", "users", "trackers", "world"}},
        {"wall", {"name",          "lower_left_m",
                  "lower_right_m", "upper_left_m",
                  "window",        "second_window",
                  "viewport_px",   "viewport_fraction",
                  "render_px",     "stereo",
                  "eye",           "swap_eyes",
                  "user",          "blend",
                  "warp",          "projection",
                  "blend_picture", "black_level_picture",
                  "gain",          "rank"}},
        {"projection",
         {"type", "center_m", "rotation_deg", "radius_m", "fov_deg", "circle", "azimuths_deg", "elevations_deg",
          "heights_m", "mirror_center_m", "mirror_radius_m", "projector_position_m", "projector_rotation_deg",
          "projector_tangents", "file", "unit_m"}},
        {"world", {"position_m", "yaw_deg"}},
        {"blend", {"left_m", "right_m", "top_m", "bottom_m", "power", "gamma"}},
        {"light_picture", {"file", "gamma"}},
        {"warp", {"file", "columns", "rows", "nodes"}},
        {"window",
         {"name", "size_px", "position_px", "monitor", "fullscreen", "borders", "swap_group", "swap_barrier"}},
        {"user",
         {"name", "interpupillary_m", "head_position_m", "head_rotation_deg", "eye_offset_m", "head_tracker",
          "avatar", "eye_height_m"}},
        {"avatar", {"file", "joints"}},
        {"tracker",
         {"name", "type", "address", "port", "device", "controls", "wand", "body", "left_hand_body",
          "right_hand_body", "left_foot_body", "right_foot_body", "file", "room_from_tracker", "latency_ms",
          "filter"}},
        {"room_from_tracker", {"translation_m", "rotation_deg"}},
        {"wand", {"buttons", "axes"}},
        {"filter", {"type", "min_cutoff_hz", "beta_per_m"}},
    };
    return keys;
}

} // namespace viewer
