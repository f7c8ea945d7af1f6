#pragma once
// Settings that can change while the viewer runs, by key. The panel, the remote protocol, recordings and replays
// change only these and the scene (scene_edits.h).

#include "gi/filter/denoise.h"
#include "gi/filter/tone_map.h"
#include "gi/render/render_settings.h"
#include "viewer/protocol/frame_command.h"

#include <span>

namespace viewer {

struct Settings {
    std::string method = "slhb", compare;      ///< compare: second method, shown beside the first; empty = none
    std::string schedule = "auto", directions; ///< as --schedule and --directions
    int resolution = 0, axes = 0, light_samples = 0; ///< of slhb; 0 = chosen by the plan
    int updated_axes = 0; ///< stored axes per bounce updated each frame for dynamic geometry; 0 = all. With the
                          ///< schedule auto, the live viewer sets it every frame (update_governor.h)
    std::string device = "cpu";  ///< of slhb; cuda = its GPU kernels
    int light_paths = 256;       ///< of the methods vpl_*, as are the next two
    std::string points = "1024"; ///< per imperfect shadow map, or "30%" of its texels
    double ao_radius_m = 0.5;
    int bounces = 3;
    int seed = 0;
    int reuse = 16; ///< frames of temporal reuse; 1 = none
    std::string denoise = "atrous";
    bool share_eyes = true;     ///< each eye may reuse light computed for the other
    bool radiance_cache = true; ///< paths may end in the radiance cache while anything moves
    double exposure_ev = 0;
    std::string tone = "srgb";
    // Settings of the interactive loop
    double rate_hz = 20;           ///< target frame rate
    int paths = 0;                 ///< per pixel and frame; 0 = as many as the frame rate allows
    double scale = 0;              ///< picture side over window side; 0 = as the frame rate allows
    bool play = true;              ///< animation clips run
    double speed = 1;              ///< playback speed of the clips
    double eye_distance_m = 0.063; ///< between the pupils
    std::string stereo = "off";
    bool swap_eyes = false;
    std::string view = "picture"; ///< picture, split, flicker, difference
    double split = 0.5;           ///< position of the split, as a share of the width
    bool reproject = true;        ///< reproject the last picture to the current head pose
    bool refine = true;           ///< keep adding paths while nothing moves
    bool panel = true;
};

enum class SettingType { word, number, whole_number, yes_or_no };
char const* name_of(SettingType type);
struct SettingKey {
    std::string key;
    SettingType type = SettingType::word;
    std::string what;               ///< description for users, with the unit
    std::vector<std::string> words; ///< allowed words; for `points` only examples
    double low = 0, high = 0;       ///< range of numbers
};
std::span<SettingKey const> setting_keys();
bool is_setting(std::string const& key);
/// The current name of a key: older recordings and scripts may use a former one.
std::string current_key(std::string const& key);

/// Throws InputError if the key is unknown, or the value has the wrong type or is out of range.
void set(Settings& settings, Change const& change);
/// Parses "KEY=VALUE". The value is JSON if it parses as JSON, else a word. Throws InputError.
Change parse_change(std::string const& text);
nlohmann::json get(Settings const& settings, std::string const& key);

/// Points per imperfect shadow map from "1024", or "30%" of the map's texels, rounded. Throws InputError.
/// @param name  of the setting, for the message  @param point_map  texels along a side of the map
int parse_points(std::string const& name, std::string const& text, int point_map);

/// The settings in the form that methods take. Throws InputError if `points` is not valid.
gi::RenderSettings render_settings(Settings const& settings, int threads);
gi::DenoiseSettings denoise_settings(Settings const& settings, int threads);
gi::ToneMapSettings tone_settings(Settings const& settings);

} // namespace viewer
