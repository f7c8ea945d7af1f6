#pragma once
// Estimates albedos of real surfaces from camera frames: ar/composite/albedo.h,
// with the incident light from the reference renderer.

#include "ar/composite/albedo.h"
#include "ar/pipeline/pipeline.h"
#include "ar/pipeline/posed_frame.h"
#include "ar/scene/real_scene.h"
#include "gi/core/progress.h"

namespace ar {

struct EstimateSettings {
    double resolution = 0.5;  ///< compared pixels per camera pixel, in each direction
    std::uint32_t paths = 16; ///< of the reference renderer, per compared pixel, before denoising
    int bounces = 6;
    int most_turns = 8; ///< maximum number of alternations of rendering and fitting
    float tolerance = 2e-3f;
    AlbedoSettings fit;
};

struct AlbedoEstimate {
    std::vector<AlbedoEntry> entries; ///< one per patch; `texture` is left empty
    std::vector<cv::Mat> textures;    ///< one per patch: CV_32FC3, linear, upper row first; empty = none
    AlbedoSolution solution;
    std::size_t filled = 0, texels = 0, outside = 0; ///< over all textures, see AlbedoTexture
};

/// @param real   as from `model_of`, with its lights
/// @param light  environment map in the world's frame; null = none
/// @throws gi::InputError nothing to estimate, no light, no frame
AlbedoEstimate estimate_albedos(RealScene real, std::shared_ptr<gi::EnvironmentMap const> light,
                                CalibratedCamera const& camera, std::span<PosedFrame const> frames,
                                EstimateSettings const& settings, gi::StopRequest const& stop, gi::Report& report);

} // namespace ar
