#pragma once
// Command-line options of `lightwell render`.

#include "gi/filter/denoise.h"
#include "gi/render/render_settings.h"
#include "viewer/offline/rank_options.h"

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace CLI {
class App;
}

namespace viewer {

struct RenderOptions {
    std::string scene, method = "reference", size = "512x512", camera, look_from, look_at, environment, background,
                       budget, until, filter = "box", denoise = "none", out, png, stats, tone = "srgb", eye;
    std::vector<std::string> layers;
    std::optional<double> fov_deg, time_s, aperture_radius_m, focus_distance_m;
    double environment_rotate_deg = 0, environment_scale = 1, exposure_ev = 0, eye_distance_m = 0.063;
    std::optional<double> screen_distance_m; ///< with --eye
    std::optional<std::uint32_t> paths;
    std::uint64_t seed = 0;
    int bounces = 64, threads = 0;
    std::string schedule = "auto", device = "cpu", look_ups = "auto", shadows = "auto", radiance_cache = "auto";
    gi::SlhbSettings slhb;
    gi::VirtualLightSettings vpl;
    std::string points; ///< "4096" or "30%"; empty = the default of vpl
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
/// A chosen method, with its schedule in the case of slhb.
struct NamedMethod {
    std::string method;
    gi::Schedule schedule;
    std::string as_given; ///< "--schedule stored"
};
/// Throws InputError if an option of slhb is given that none of the methods (at least one) uses.
void check_slhb(CLI::App const& command, std::vector<NamedMethod> const& methods);
/// Options of method slhb: all, or only those of quality without axes and buffers.
void declare_slhb(CLI::App& command, RenderOptions& options);
void declare_slhb_quality(CLI::App& command, RenderOptions& options);
/// Options of the methods vpl_* (gi/methods/vpl), and the check that some method uses the given ones.
void declare_virtual_lights(CLI::App& command, RenderOptions& options);
void check_virtual_lights(CLI::App const& command, std::vector<NamedMethod> const& methods);
void declare_options(CLI::App& command, RenderOptions& options);

/// Sets the default output name and checks that the options work together. Throws InputError.
gi::RenderSettings make_settings(RenderOptions& options);

/// Throws InputError if the filter cannot work with these settings.
gi::DenoiseSettings make_denoise_settings(RenderOptions const& options, gi::RenderSettings const& settings);

} // namespace viewer
