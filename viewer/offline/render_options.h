#pragma once
// Command-line options of `lightwell render`.

#include "gi/filter/denoise.h"
#include "gi/methods/registry.h"
#include "gi/render/render_settings.h"
#include "viewer/offline/rank_options.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
class Option;
} // namespace CLI

namespace viewer {

struct RenderOptions {
    std::string scene, method{gi::kDefaultMethod}, size = "512x512", camera, look_from, look_at, environment,
                                                   background, budget, until, denoise = "none", out, png, stats,
                                                   tone = "srgb", eye, checkpoint = "30s", state,
                                                   light = "studio"; ///< light: one of kLightChoices
    std::vector<std::string> layers;
    std::optional<double> fov_deg, time_s, aperture_radius_m, focus_distance_m;
    double environment_rotate_deg = 0, environment_scale = 1, exposure_ev = 0, eye_distance_m = 0.063;
    std::optional<double> screen_distance_m; ///< with --eye
    std::optional<std::uint32_t> paths;
    gi::RenderSettings settings; ///< of gi::render_options(); make_settings() adds the others
    bool half = false, resume = false, json = false, quiet = false;
    std::string frames, video, turntable, camera_path; ///< empty = none
    bool turns = false;                                ///< --turntable was given, maybe without a value
    bool seed_per_frame = false;
    int reuse = 1;        ///< frames
    double shutter_s = 0; ///< exposure time, from the frame's time on
    RankOptions ranks;
};

/// Options of camera, environment map and time, for every command that renders.
void declare_view_options(CLI::App& command, RenderOptions& options);
/// Options of the camera's lens, for commands that render whole pictures.
void declare_lens_options(CLI::App& command, RenderOptions& options);
/// Options of the eyes of a stereo pair.
void declare_eye_options(CLI::App& command, RenderOptions& options);
void declare_denoise(CLI::App& command, RenderOptions& options);
/// Options of how pixels are stored and shown. @param shown  the options that write tone-mapped pictures
void declare_pixels(CLI::App& command, RenderOptions& options, std::string const& shown);
/// Declares one option of gi::render_options(), with its default. The text goes to `settings`.
CLI::Option* declare_option(CLI::App& command, gi::RenderSettings& settings, std::string_view name);
/// Declares the options that one of the methods reads, but for those of all methods. @param methods  empty = all
void declare_method_options(CLI::App& command, gi::RenderSettings& settings,
                            std::vector<std::string_view> const& methods = {},
                            std::vector<std::string_view> const& except = {});
/// Throws InputError if a given option is read by none of the methods (at least one), or if some contradict.
void check_method_options(CLI::App const& command, std::vector<gi::ChosenMethod> const& methods);
/// Options of `lightwell render`.
void declare_options(CLI::App& command, RenderOptions& options);

/// Sets the default output name and checks that the options work together. Throws InputError.
gi::RenderSettings make_settings(RenderOptions& options);

/// Throws InputError if the filter cannot work with these settings.
gi::DenoiseSettings make_denoise_settings(RenderOptions const& options, gi::RenderSettings const& settings);

} // namespace viewer
