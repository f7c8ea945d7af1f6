#pragma once
#include "viewer/offline/load_world.h"
#include "viewer/offline/rank_work.h"

namespace viewer {

/// Runs `lightwell render --frames`: writes every frame to its files and all frames to a video. With several
/// processes each renders every size-th frame; the leading one writes statistics and video. @return exit code
int render_frames(RenderOptions const& options, gi::RenderSettings const& settings,
                  gi::DenoiseSettings const& denoise_settings, CameraChoice const& choice, RankWork& work);

} // namespace viewer
