#pragma once
#include "viewer/offline/load_world.h"
#include "viewer/offline/rank_work.h"

namespace viewer {

/// `lightwell render --frames`: every frame to its files, and all of them to a video. Of several processes each
/// renders every size-th frame, and the leading one writes the statistics and the video. @return the exit code
int render_frames(RenderOptions const& options, gi::RenderSettings const& settings,
                  gi::DenoiseSettings const& denoise_settings, CameraChoice const& choice, RankWork& work);

} // namespace viewer
