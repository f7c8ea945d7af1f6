#pragma once
// Options of frame sequences: --frames, --camera-path, --turntable.

#include "viewer/offline/frame_camera.h"
#include "viewer/base/frame_range.h"
#include "viewer/offline/render_options.h"

namespace viewer {

/// Parsed options of --frames.
struct FrameSettings {
    FrameRange range;
    std::optional<FrameName> exr, png;
    std::string video, state;       ///< empty = none; state: a file that exists while frames are missing
    std::vector<std::string> files; ///< all files that may be written
    CameraMotion motion;

    /// Scene time of a frame; constant with --time.
    double scene_time_s(RenderOptions const& o, int frame) const { return o.time_s.value_or(range.time_s(frame)); }
    /// Position in the sequence, 0..1, at `after_s` after a frame.
    double fraction(int frame, double after_s = 0) const
    {
        return (frame - range.first + after_s * range.fps()) / range.count();
    }
};

void declare_frames(CLI::App& command, RenderOptions& options);
/// Motion by --camera-path and --turntable. Throws InputError if they contradict other options.
CameraMotion make_motion(RenderOptions const& options);
/// Parses the options and checks that all outputs can be written. Throws InputError.
FrameSettings make_frame_settings(RenderOptions const& options, gi::RenderSettings const& settings);

} // namespace viewer
