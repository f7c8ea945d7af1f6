#pragma once
// Settings that can change while the viewer runs, by key. The panel, the remote protocol, recordings and replays
// change only these and the scene (scene_edits.h).

#include "gi/core/option.h"
#include "gi/filter/denoise.h"
#include "gi/filter/tone_map.h"
#include "gi/methods/names.h"
#include "gi/render/render_option.h"
#include "viewer/protocol/frame_command.h"

#include <span>

namespace viewer {

struct Settings {
    std::string method{gi::kDefaultMethod},
        compare;               ///< compare: second method, shown beside the first; empty = none
    gi::RenderSettings render; ///< those of gi::render_options() that are live count
    int updated_axes = 0; ///< stored axes per bounce updated each frame for dynamic geometry; 0 = all. With the
                          ///< schedule auto, the live viewer sets it every frame (update_governor.h)
    int reuse = 16;       ///< frames of temporal reuse; 1 = none
    std::string denoise = "atrous";
    bool first_surfaces = true; ///< surfaces are shown at full size where light is computed at a smaller one
    bool share_eyes = true;     ///< each eye may reuse light computed for the other
    double exposure_ev = 0;
    /// On: windows and headsets set exposure_ev by what is shown; hold: they did.
    std::string auto_exposure = "off";
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
    bool headlight = false;       ///< a light at the eye (headlight.h)
    std::string view = "picture"; ///< picture, split, flicker, difference
    double split = 0.5;           ///< position of the split, as a share of the width
    bool predict = true;          ///< render for where users and clips will be when the picture is seen
    bool reproject = true;        ///< reproject the last picture to the current head pose
    /// Pictures are to be shown by the surfaces of the current head pose, with the light of the last one.
    bool draw_surfaces = false;
    bool refine = true; ///< keep adding paths while nothing moves
    bool panel = true;
    double font_scale = 1; ///< of the letters in the panel, over the usual size on the monitor
};

/// The version of the program that wrote a file, or for whose schema a file was written.
/// Methods had other names in 0.1 (gi/methods/names.h).
enum class MadeFor : std::uint8_t { version_0_1, this_version };
/// Version from the program's name in files: "lightwell 0.1.0 (git ...)".
MadeFor made_for(std::string const& program);
/// What a file that says nothing has.
Settings first_settings(MadeFor made_for);
/// A change as this version has it.
Change current(Change change, MadeFor made_for);

struct SettingKey : gi::Option<Settings> {
    std::string group;     ///< heading in the panel; empty for the method and what all methods have
    bool restarts = false; ///< a change restarts the methods
    gi::RenderOption const* option = nullptr; ///< of which it is the setting

    /// False for what only files of earlier versions have.
    bool is_offered() const { return option == nullptr || option->replaced_by.empty(); }
};
std::span<SettingKey const> setting_keys();
/// The beginning of its meaning, with the unit, as the label of a control: "Target frame rate, Hz"; its name if that
/// is too long, or goes on from the name.
std::string label_of(SettingKey const& key);
bool is_setting(std::string const& key);
/// The current name of a key: older recordings and scripts may use a former one.
std::string current_key(std::string const& key);
/// True if a change of the setting restarts the methods.
bool restarts_methods(std::string const& key);

/// For settings that people give: throws InputError if only files of earlier versions have the key, and the method does
/// not read it.
void check_offered(Settings const& settings, std::string const& key);
/// Throws InputError if the key is unknown, or the value has the wrong type or is out of range.
void set(Settings& settings, Change const& change);
/// Parses "KEY=VALUE". The value is JSON if it parses as JSON, else a word. Throws InputError.
Change parse_change(std::string const& text);
nlohmann::json get(Settings const& settings, std::string const& key);
/// All settings, by key.
nlohmann::json all_settings(Settings const& settings);
/// The changes that make `now` of `before`.
std::vector<Change> differences(Settings const& before, Settings const& now);

gi::DenoiseSettings denoise_settings(Settings const& settings, int threads);
gi::ToneMapSettings tone_settings(Settings const& settings);

} // namespace viewer
