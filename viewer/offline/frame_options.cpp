#include "viewer/offline/frame_options.h"

#include "gi/core/error.h"
#include "gi/scene/load/load.h"
#include "viewer/base/outputs.h"
#include "viewer/base/validators.h"
#include "viewer/offline/video_writer.h"

#include <CLI/CLI.hpp>

namespace viewer {
namespace {

constexpr char const* kGroup = "Frames";

} // namespace

void declare_frames(CLI::App& c, RenderOptions& o)
{
    CLI::Option* const frames =
        c.add_option("--frames", o.frames,
                     "FIRST:END@FPS: frame k is at time k / FPS; END is the frame after the last, so 0:120@30\n"
                     "lasts 4 s, and 60:120 continues 0:60; 0:4s@30 is the same; --budget and --until are "
                     "per frame.\n--out and --png contain %d or %04d for the frame number")
            ->group(kGroup);
    c.add_option("--video", o.video, "tone-mapped video: F.mkv (FFV1, lossless) or F.mp4 (H.264)")
        ->group(kGroup)
        ->needs(frames);
    c.add_option_function<std::string>(
         "--turntable",
         [&o](std::string const& text) {
             o.turns = true;
             o.turntable = text == "true" ? "" : text; // CLI11 passes this if there is no value
         },
         "TURNS or DEGdeg: over the frames, the camera circles the middle of the scene or --look-at "
         "(default:\none "
         "turn). With --time the scene does not move")
        ->expected(0, 1)
        ->type_name("[TEXT]")
        ->group(kGroup)
        ->needs(frames);
    c.add_option("--camera-path", o.camera_path,
                 "YAML key frames of the camera (data/camera_path.yaml); without --frames: the camera at --time")
        ->group(kGroup);
    c.add_option("--reuse", o.reuse,
                 "temporal reuse: average up to this many frames per pixel (all frames while nothing moves)")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str()
        ->group(kGroup)
        ->needs(frames);
    c.add_option("--shutter", o.shutter_s,
                 "motion blur: exposure time, s, from the time of the frame or --time on; includes camera motion")
        ->check(in_range(0, 1e6))
        ->capture_default_str()
        ->group(kGroup);
    c.add_flag("--seed-per-frame", o.seed_per_frame, "frame k has the seed --seed + k, for noise that flickers")
        ->group(kGroup)
        ->needs(frames)
        ->excludes("--reuse"); // frames with reuse continue one sequence of random numbers
}

CameraMotion make_motion(RenderOptions const& o)
{
    CameraMotion motion;
    if (o.turns) motion.turn_rad = parse_turn(o.turntable);
    if (o.camera_path.empty()) return motion;
    auto const refuse = [](std::string const& other) {
        return gi::InputError("--camera-path and " + other + " are both given", "each of them sets the camera",
                              "keep one of them");
    };
    if (o.turns) throw refuse("--turntable");
    if (!o.camera.empty()) throw refuse("--camera");
    if (!o.look_from.empty()) throw refuse("--look-from");
    if (!o.look_at.empty()) throw refuse("--look-at");
    motion.path = gi::load_camera_path(o.camera_path);
    if (o.fov_deg && motion.path->keys.front().fov_rad)
        throw gi::InputError("--fov is given for a camera path", "its keys have fields of view", "drop it");
    return motion;
}

FrameSettings make_frame_settings(RenderOptions const& o, gi::RenderSettings const& settings)
{
    FrameSettings f;
    f.range = parse_frame_range(o.frames);
    f.motion = make_motion(o);
    if (o.time_s && !f.motion.path && !o.turns)
        throw gi::InputError("--time with --frames", "scene and camera would not move",
                             "leave --time out, or move the camera by --turntable or --camera-path");
    if (!o.out.empty()) {
        f.exr = parse_frame_name("--out", o.out);
        f.state = f.exr->of_all(f.range) + ".state";
    }
    if (!o.png.empty()) f.png = parse_frame_name("--png", o.png);
    f.video = o.video;
    if (!f.video.empty()) check_video(f.video, settings.width, settings.height, f.range.fps());
    f.files = {f.video, f.state, o.stats};
    for (int k = f.range.first; k < f.range.end; ++k) {
        if (f.exr) f.files.push_back(f.exr->of(k));
        if (f.png) f.files.push_back(f.png->of(k));
        if (f.motion.path) // throws early if the path has no direction somewhere
            for (double const after_s : {0.0, o.shutter_s})
                gi::camera_at(*f.motion.path, f.range.time_s(k) + after_s, 1);
    }
    check_outputs(f.files, {o.scene, o.environment, o.camera_path});
    return f;
}

} // namespace viewer
