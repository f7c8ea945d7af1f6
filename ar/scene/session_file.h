#pragma once
// What an AR session is made of: SESSION.yaml. docs/ar.md has the keys.

#include "ar/capture/open_source.h"
#include "ar/composite/composite.h"
#include "ar/pose/tracker.h"
#include "ar/scene/hmd_cameras.h"
#include "ar/scene/proxies.h"
#include "ar/scene/tracked_pose.h"
#include "gi/filter/denoise.h"
#include "gi/render/render_settings.h"

#include <filesystem>
#include <optional>
#include <string>

namespace viewer {

struct ArFrames {
    std::string source; ///< as ar::open_source takes it
    ar::OpenOptions options;
};

/// What of the place is modelled: a scene file, and proxies.
struct ArReal : ArPlaced {
    bool estimate_scene = false;     ///< albedos of the scene's materials are those that were estimated
    std::filesystem::path estimates; ///< what `lightwell ar albedo` found
    std::vector<ArProxy> proxies;
};

struct ArRender {
    std::uint32_t paths = 2; ///< per rendered pixel and frame
    double resolution = 0.5; ///< rendered pixels per pixel of the camera
    int bounces = 3;
    gi::DenoiseSettings denoise; ///< nothing without two paths
    std::uint64_t seed = 0;
    gi::SlhbSettings slhb; ///< directions, resolution, light_samples, fresh_light_samples, shadow_resolution
};

/// What is done to a rendered pair before it is put into a frame; each costs only where it is asked for.
struct ArFinish {
    bool upsample = true;    ///< below a resolution of 1: with guides, and borders of virtual things at full size
    bool mattes = false;     ///< borders where real things hide virtual ones follow the camera's picture
    bool match_blur = false; ///< what is added is as blurred as the camera's pictures
};

/// What becomes of the poses that frames tell.
struct ArPoseUse {
    ar::TrackerSettings tracker;
    bool filtered = false; ///< smoothed, or the mean of a tripod: those of `tracker`; else each frame's own
    double predict_s = 0;  ///< frames without a pose so long after the last: the motion goes on
};

struct ArSession {
    std::filesystem::path file;
    ArFrames frames;
    std::filesystem::path camera, markers;
    std::filesystem::path light; ///< lat-long map; empty: only lamps of the real scene
    double light_turn_deg = 0, light_scale = 1;
    int live_light = 0; ///< frames after which the light is renewed from what the camera sees; 0 = it stays
    ArReal real;
    ArPlaced virtual_things;
    std::optional<ArTracked> tracked; ///< a tracker says where the camera is, in place of markers
    std::optional<ArHmd> hmd;         ///< the camera is on a headset
    ArRender render;
    double smoothing = 1; ///< weight of a new frame's light among those before, (0, 1]; 1 = each frame for itself
    ar::CompositeSettings composite;
    bool match_noise = true; ///< what is added is as noisy as the calibration says that the camera is
    ArFinish finish;
    ArPoseUse pose;
};

/// Paths within are relative to the file's folder. @throws gi::InputError with file:line:column
ArSession read_ar_session(std::filesystem::path const& file);
ArSession parse_ar_session(std::string const& text, std::filesystem::path const& file);

} // namespace viewer
