#pragma once
// Checks the estimate of light from frames (ar/pipeline/frame_light.h) where it is known: the synthetic desk is
// rendered under an environment map and seen through the synthetic camera; the estimate is compared with that map,
// and composites lit by both with each other.

#include "ar/pipeline/frame_light.h"

namespace ar {

struct LightCheckSettings {
    glm::ivec2 size_px{320, 240};
    std::uint32_t paths = 64;    ///< of the rendered frames
    int views = 1;               ///< frames, spread over the synthetic camera's path
    bool unknown_albedo = false; ///< the desk's colours are unknown too
    bool composites = true;      ///< compare composites
    FrameLightSettings estimate;
};

struct LightChecked {
    FrameLight light;
    double lamp_deg = -1;        ///< between the strongest lamps of both; -1 = one of them has none
    double vector_deg = 0;       ///< between the net fluxes (mean direction) of luminance
    double up_ratio = 0;         ///< irradiance of an upward face, estimate over truth, luminance
    double mean_ratio = 0;       ///< of the mean over all normals
    double white_deg = 0;        ///< angle between the colours (RGB) of the mean irradiance
    double irradiance_rms = 0;   ///< relative, over all normals
    double facing_rms = 0;       ///< over normals that face up or the camera
    double truth_lamp_share = 0; ///< of the upward irradiance in the truth by its strongest lamp
    double up_sigmas = 0;        ///< error of the upward irradiance over its stated standard deviation
    double estimate_s = 0;
    double flip = -1;         ///< composite by the estimate against by the truth, affected pixels, mean; -1 = none
    double flip_even = -1;    ///< the same of an even environment of the right upward irradiance
    double flip_nothing = -1; ///< of adding nothing
};

/// @param truth  lat-long map, CV_32FC3
LightChecked check_light(cv::Mat const& truth, LightCheckSettings const& settings, gi::StopRequest const& stop,
                         gi::Report& report);

} // namespace ar
