#pragma once
// Albedos of real surfaces from what the camera has seen of them: ar/composite/albedo.h with the reference
// renderer as the one that knows how much light falls where.

#include "ar/composite/albedo.h"
#include "ar/pipeline/pipeline.h"
#include "ar/scene/real_scene.h"
#include "gi/core/progress.h"

namespace viewer {

/// A frame without virtual things.
struct AlbedoFrame {
    cv::Mat rgb; ///< CV_8UC3, of the calibration's size
    ar::Exposure exposure;
    ar::Pose world_from_camera;
    double confidence = 1; ///< of the pose
};

struct EstimateSettings {
    double resolution = 0.5;  ///< pixels compared per pixel of the camera, each way
    std::uint32_t paths = 16; ///< of the reference renderer, per pixel compared, before its noise is filtered
    int bounces = 6;
    int most_turns = 8; ///< of rendering and fitting
    float tolerance = 2e-3f;
    ar::AlbedoSettings fit;
};

struct AlbedoEstimate {
    std::vector<AlbedoEntry> entries; ///< a patch each; `texture` is left empty
    std::vector<cv::Mat> textures;    ///< the same: CV_32FC3, linear, upper row first; empty = none
    ar::AlbedoSolution solution;
    std::size_t filled = 0, texels = 0, outside = 0; ///< of all textures, see ar::AlbedoTexture
};

/// @param real   as of `model_of`, with its lamps
/// @param light  from far away, in the world; null = none
/// @throws gi::InputError nothing to estimate, no light, no frame
AlbedoEstimate estimate_albedos(RealScene real, std::shared_ptr<gi::EnvironmentMap const> light,
                                ArCamera const& camera, std::span<AlbedoFrame const> frames,
                                EstimateSettings const& settings, gi::StopRequest const& stop, gi::Report& report);

} // namespace viewer
