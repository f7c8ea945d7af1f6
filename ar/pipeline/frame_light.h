#pragma once
// The light of the place without a probe: from the shading and shadows of the modelled real surfaces in one or a
// few frames (ar/light/light_fit.h). Light comes from far away; surfaces are matt.
//
// Surfaces whose albedo is to be estimated (`albedo: estimate`) take part with one unknown colour each: light and
// albedos are fitted in turns. Where no albedo is known, only their product is: then their mean is set to
// `mean_albedo` grey, and scale and white balance are those of that assumption.

#include "ar/camera/camera_model.h"
#include "ar/light/light_fit.h"
#include "ar/pipeline/posed_frame.h"
#include "ar/scene/real_scene.h"
#include "gi/core/progress.h"

#include <span>

namespace ar {

struct FrameLightSettings {
    int directions = 256;       ///< of the environment
    int samples = 3000;         ///< pixels compared, over all frames
    cv::Size size{256, 128};    ///< of the map
    double mean_albedo = 0.4;   ///< prior, where no albedo is known (grey world)
    double model_sigma = 0.03;  ///< relative, of a sample: geometry, albedo, light from near
    double common_sigma = 0.03; ///< relative, of all samples alike: albedos and response of the camera
    LightFitSettings fit;
};

/// Counts of the pixels examined: used, or left out and why.
struct FrameLightCounts {
    std::size_t used = 0;
    std::size_t clipped = 0, dark = 0; ///< a byte of 0 or 255; an albedo below 0.03
    std::size_t border = 0;            ///< another surface, normal or no surface within a pixel
    std::size_t not_matt = 0;          ///< metal, glass, lamps
    std::size_t background = 0;        ///< seen directly: light from there
    std::size_t background_clipped = 0;
};

struct FrameLight {
    cv::Mat map;   ///< CV_32FC3, lat-long
    cv::Mat known; ///< CV_32FC1: 0 = the prior's guess, 1 = determined by the frames
    LightFit fit;
    FrameLightCounts counts;
    double undetermined_share = 0; ///< of the sphere, `known` below 0.2
    double undetermined_above = 0; ///< of the upper half
    double seen_share = 0;         ///< of the sphere, in view of the camera behind all surfaces
    bool scale_is_known = true;    ///< false: no albedo is known, see above
    struct Albedo {
        std::string name;
        cv::Vec3d albedo{0, 0, 0};
        std::size_t samples = 0; ///< 0 = not seen: as the prior
    };
    std::vector<Albedo> albedos; ///< of surfaces to be estimated
    struct Face {
        char const* name;
        glm::dvec3 normal;
        cv::Vec3d irradiance;
        double sigma = 0; ///< relative, of luminance, 1 standard deviation
    };
    std::array<Face, 6> faces;
};

/// @param real  as from `model_of`, in the world's frame
/// @throws gi::InputError no frame, no real surface, too few usable pixels
FrameLight estimate_light(RealScene real, CameraModel const& camera, Photometry const& photometry,
                          std::span<PosedFrame const> frames, FrameLightSettings const& settings,
                          gi::StopRequest const& stop, gi::Report& report);

std::string describe(FrameLight const& light);
/// Warnings about numbers that are unreliable; empty = none.
std::vector<std::string> warnings_of(FrameLight const& light);
/// Writes the map as OpenEXR: R, G, B, and the layer "known" (1 = determined by the frames, 0 = a guess).
void write_light(std::filesystem::path const& file, FrameLight const& light, gi::Report& report);

} // namespace ar
