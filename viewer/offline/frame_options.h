#pragma once
#include "viewer/offline/frame_camera.h"
#include "viewer/offline/frame_range.h"
#include "viewer/offline/render_options.h"

namespace viewer {

/// Everything about --frames, understood.
struct FrameSettings {
    FrameRange range;
    std::optional<FrameName> exr, png;
    std::string video, state;       ///< empty = none; state: a file that is there while frames are missing
    std::vector<std::string> files; ///< all that may be written
    CameraMotion motion;

    /// Of the animation: that of the frame, or where --time holds it still.
    double scene_time_s(RenderOptions const& o, int frame) const { return o.time_s.value_or(range.time_s(frame)); }
    /// Of all frames, at a moment after that of a frame.
    double fraction(int frame, double after_s = 0) const
    {
        return (frame - range.first + after_s * range.fps()) / range.count();
    }
};

void declare_frames(CLI::App& command, RenderOptions& options);
/// Of --camera-path and --turntable. Throws InputError where they contradict other options.
CameraMotion make_motion(RenderOptions const& options);
/// Checks, too, that all results can be written. Throws InputError.
FrameSettings make_frame_settings(RenderOptions const& options, gi::RenderSettings const& settings);

} // namespace viewer
