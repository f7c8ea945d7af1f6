#pragma once
// Pixels of frames as samples of the light: points of real surfaces with their radiance and albedo, and the light
// that is seen where no real surface is.

#include "ar/pipeline/frame_light.h"
#include "ar/pipeline/light_transfer.h"

namespace ar {

struct LightPixel {
    ReceivingPoint point;
    cv::Vec3d radiance, albedo; ///< albedo: 1 for a surface of a patch
    double albedo_spread = 0;   ///< relative, within the pixel
    int patch = -1;             ///< whose albedo is unknown; -1 = known
    double floor = 0;           ///< standard deviation of the radiance by noise and bytes
};

struct LightPixels {
    std::vector<LightPixel> surfaces;
    std::vector<SeenLight> seen;     ///< per direction of the basis
    cv::Mat background, weight;      ///< lat-long: CV_32FC3 and CV_32FC1 (share of a texel that was seen)
    FrameLightCounts counts;
};

/// @param own_light  per frame: radiance of the surfaces by the model's own lights, CV_32FC3; empty = none
/// @param patch_of_material  -1 = its albedo is known
LightPixels light_pixels(gi::World const& world, LightTransfer const& transfer, LightBasis const& basis,
                         CameraModel const& camera, Photometry const& photometry,
                         std::span<PosedFrame const> frames, std::vector<cv::Mat> const& own_light,
                         std::vector<int> const& patch_of_material, int samples);

} // namespace ar
