#pragma once
// What can be set while the viewer runs, by key: the panel, the remote protocol, recordings and replays all set
// these and nothing else (besides what is in the scene: scene_edits.h).

#include "gi/filter/denoise.h"
#include "gi/filter/tone_map.h"
#include "gi/render/render_settings.h"
#include "viewer/protocol/frame_command.h"

#include <span>

namespace viewer {

struct Settings {
    std::string method = "slhb", compare;      ///< compare: a second method to look at beside it; empty = none
    std::string schedule = "auto", directions; ///< as --schedule and --directions
    int resolution = 0, axes = 0, light_samples = 0; ///< of slhb, 0 = what the plan chooses
    int updated_axes =
        0; ///< with the schedule auto: stored axes of each bounce that are brought to what has moved,
           ///< per frame; 0 = all. The live viewer sets it in every frame (update_governor.h)
    std::string device = "cpu";  ///< of slhb: cuda = by kernels
    int light_paths = 256;       ///< of the methods vpl_*, as are the next
    std::string points = "1024"; ///< of an imperfect shadow map, or "30%" of its texels
    double ao_radius_m = 0.5;
    int bounces = 3;
    int seed = 0;
    int reuse = 16; ///< frames of temporal reuse; 1 = none
    std::string denoise = "atrous";
    bool share_eyes = true;     ///< an eye may take light that the other one found
    bool radiance_cache = true; ///< while anything moves, paths may end in the radiance cache
    double exposure_ev = 0;
    std::string tone = "srgb";
    // Of the interactive loop
    double rate_hz = 20;           ///< frames that it aims at
    int paths = 0;                 ///< per pixel and frame; 0 = what the rate allows
    double scale = 0;              ///< of the pictures' sides against the window's; 0 = what the rate allows
    bool play = true;              ///< clips go on
    double speed = 1;              ///< of clips
    double eye_distance_m = 0.063; ///< between the pupils
    std::string stereo = "off";
    bool swap_eyes = false;
    std::string view = "picture"; ///< picture, split, flicker, difference
    double split = 0.5;           ///< where the picture is split, of its width
    bool reproject = true;        ///< show the last picture as seen from where the head is now
    bool refine = true;           ///< goes on rendering while nothing moves
    bool panel = true;
};

/// A key that Settings has.
enum class SettingType { word, number, whole_number, yes_or_no };
char const* name_of(SettingType type);
struct SettingKey {
    std::string key;
    SettingType type = SettingType::word;
    std::string what;               ///< for people, with its unit
    std::vector<std::string> words; ///< that it may be; of `points` some of them
    double low = 0, high = 0;       ///< of numbers
};
std::span<SettingKey const> setting_keys();
bool is_setting(std::string const& key);
/// The key as it is now: recordings and scripts of before may have an older one.
std::string current_key(std::string const& key);

/// Throws InputError where the value is not of the key's type or range, or there is no such key.
void set(Settings& settings, Change const& change);
/// "KEY=VALUE", the value as JSON where it is that, else a word. Throws InputError.
Change parse_change(std::string const& text);
nlohmann::json get(Settings const& settings, std::string const& key);

/// "1024", or "30%" of the texels of a map, rounded: points of an imperfect shadow map. Throws InputError.
/// @param name  of the setting, for the message  @param point_map  texels on a side
int parse_points(std::string const& name, std::string const& text, int point_map);

/// What they say to a method. Throws InputError on values that do not go together.
gi::RenderSettings render_settings(Settings const& settings, int threads);
gi::DenoiseSettings denoise_settings(Settings const& settings, int threads);
gi::ToneMapSettings tone_settings(Settings const& settings);

} // namespace viewer
