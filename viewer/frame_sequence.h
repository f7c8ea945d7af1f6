#pragma once
#include "viewer/load_world.h"

namespace viewer {

/// `lightwell render --frames`: every frame to its files, and all of them to a video. @return the exit code
int render_frames(RenderOptions const& options, gi::RenderSettings const& settings,
                  gi::DenoiseSettings const& denoise_settings, CameraChoice const& choice);

} // namespace viewer
