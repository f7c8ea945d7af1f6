#pragma once
// An AR session file, SESSION.yaml. docs/ar.md describes the keys.

#include "ar/capture/open_source.h"
#include "ar/composite/composite.h"
#include "ar/pose/tracker.h"
#include "ar/pose/trust.h"
#include "ar/scene/occlusion.h"
#include "ar/scene/proxies.h"
#include "gi/filter/denoise.h"
#include "gi/methods/names.h"
#include "gi/render/render_settings.h"

#include <filesystem>
#include <optional>
#include <string>

namespace ar {

struct SessionFrames {
    std::string source; ///< name for open_source
    OpenOptions options;
};

/// The model of the real place: a scene file, and proxies.
struct RealPlace : PlacedScene {
    bool estimate_scene = false;     ///< use estimated albedos for the scene's materials
    std::filesystem::path estimates; ///< output file of `lightwell ar albedo`
    std::vector<Proxy> proxies;
};

/// How virtual objects are lit.
enum class PairLight {
    automatic, ///< prefiltered where the scenes allow it
    /// By prefiltered light (ar/pipeline/prefiltered): no noise, real-time; matt and broadly glossy surfaces.
    prefiltered,
    paths ///< by paths of SessionRender::method
};

struct SessionRender {
    PairLight light = PairLight::automatic;
    std::uint32_t paths = 2; ///< per rendered pixel and frame
    /// Rendered pixels per pixel of the camera; nothing: as resolution_of has it.
    std::optional<double> resolution;
    gi::DenoiseSettings denoise;               ///< no effect with fewer than two paths
    std::string method{gi::kDefaultMethod};
    gi::RenderSettings settings{.bounces = 3}; ///< of that method
};

/// Processing of a rendered pair before compositing; each step costs time only if enabled.
struct FinishSettings {
    bool upsample = true;    ///< below a resolution of 1: guided, with full-resolution borders of virtual objects
    bool mattes = false;     ///< refine borders where real objects occlude virtual ones by the camera's picture
    bool match_blur = false; ///< blur added light as much as the camera's pictures
};

/// Processing of camera poses. Poses of trackers and files have no confidence and are not filtered.
struct PoseUse {
    PoseTrackerSettings tracker;
    TrustSettings trust;
    std::filesystem::path features; ///< map of features instead of markers (ar/features); empty = markers
    bool fused = true;              ///< fuse the estimates of successive frames (ar/pose/fused.h)
    bool filtered = false; ///< use the tracker's poses (smoothed, or a tripod's mean) instead of each frame's own
    double predict_s = 0;  ///< extrapolate for frames without a pose up to this long after the last one
};

/// Camera pose from a room's tracker instead of markers: key `pose`.
///
///   world from camera = (world from room) (room from sensor) (sensor from camera)
///
/// The tracker reports the pose of the sensor, a body fixed to the camera. A sensor's axes are those of heads: x
/// right, y up, z back; the camera's are x right, y down, z ahead.
struct TrackerUse {
    std::filesystem::path display; ///< display file with the trackers; empty = set on the command line
    std::string tracker;           ///< name; empty = the tracker of the display's first user with one
    gi::RigidPose camera_from_sensor{glm::dvec3(0), glm::dquat(0, 1, 0, 0)}; ///< default: same viewing direction
    gi::RigidPose world_from_room;                                           ///< the world of the markers
    double offset_s = 0; ///< for recorded poses: time of the first frame, since the first pose
};

/// The parts of composites, as multi-layer EXR files.
struct PassSettings {
    std::filesystem::path folder; ///< empty = none
    int bits = 16;                ///< of radiance, 16 or 32; depths and motion always have 32
    bool is_undistorted = false;  ///< as a pinhole that covers the camera's view, not in its lens
};

struct RightCamera {
    std::string source; ///< name for open_source
    std::filesystem::path calibration;
    gi::RigidPose left_from_right; ///< its pose in the left camera's frame
};

/// Cameras that are fixed to a headset: key `hmd`.
struct HmdCameras {
    /// The head's axes are x right, y up, z back; the camera's x right, y down, z ahead. Default: same direction.
    gi::RigidPose head_from_camera{glm::dvec3(0), glm::dquat(0, 1, 0, 0)};
    double plane_m = 1; ///< distance of the picture plane; objects at this distance appear at their true position
    std::optional<RightCamera> right; ///< camera of the right eye; none: one camera for both eyes
};

struct Session {
    std::filesystem::path file;
    SessionFrames frames;
    std::filesystem::path camera, markers;
    std::filesystem::path light;   ///< lat-long map; empty: only lights of the real scene
    bool light_from_frame = false; ///< no map: the light is estimated from the first frame with a trusted pose
    double light_turn_deg = 0, light_scale = 1;
    int live_light = 0; ///< update the light from the camera's frames every this many frames; 0 = never
    RealPlace real;
    PlacedScene virtual_things;
    std::optional<TrackerUse> tracked; ///< camera pose from a tracker instead of markers
    std::optional<HmdCameras> hmd;     ///< the camera is on a headset
    SessionRender render;
    double smoothing = 1; ///< weight of the new frame in the temporal filter, (0, 1]; 1 = no filter
    CompositeSettings composite;
    bool match_noise = true; ///< add noise as in the camera's calibration
    FinishSettings finish;
    PoseUse pose;
    PassSettings passes;
    std::optional<OcclusionPictures> occlusion; ///< by real objects that are not modelled
};

/// As the session says, else 1/3 by prefiltered light, whose pictures gain nothing from more, and 1/2 by paths.
inline double resolution_of(SessionRender const& render, bool is_prefiltered)
{
    return render.resolution.value_or(is_prefiltered ? 1.0 / 3 : 0.5);
}

/// Paths in the file are relative to its folder. @throws gi::InputError with file:line:column
Session read_session(std::filesystem::path const& file);
Session parse_session(std::string const& text, std::filesystem::path const& file);

} // namespace ar
