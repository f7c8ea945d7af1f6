#pragma once
// Converts rendered pairs to what the camera would have seen: at the camera's size, with its lens distortion and
// sharpness, and occluded by real objects in front. Steps that the session does not enable cost nothing.

#include "ar/composite/occlusion_matte.h"
#include "ar/composite/temporal.h"
#include "ar/composite/upsample.h"
#include "ar/composite/warp.h"
#include "ar/pipeline/camera_blur.h"
#include "ar/pipeline/virtual_surfaces.h"
#include "ar/scene/session_file.h"

namespace ar {

/// The camera frame that a pair belongs to.
struct FinishFrame {
    cv::Mat radiance; ///< CV_32FC3, of the camera; used only for mattes and blur
    gi::RigidPose world_from_camera;
    double time_s = 0, exposure_s = 0;
};

struct FinishCounts {
    UpsampleCounts upsample;     ///< of all frames
    MatteCounts matte;           ///< of all frames
    std::size_t unlit = 0;       ///< SharpSurfaces::unlit, of all frames
    CameraBlurCounts blur;
    double camera_sigma_px = 0, added_sigma_px = 0; ///< of the last frame
};

/// Whether rendered pixels are means over many points, so that they need no borders at full size.
enum class PixelPoints { one, many };

/// First surfaces along the camera's axis, m, CV_32FC1, in the camera's lens; 0 = none.
struct SeenDepth {
    cv::Mat composite; ///< virtual objects and the model of the place
    cv::Mat place;     ///< the model of the place alone
};

class PairFinish {
public:
    /// @param session  with a resolution  @param points  of each rendered pixel
    PairFinish(Session const& session, CameraModel const& camera, MarkerMap const& markers,
               PixelPoints points = PixelPoints::many);

    /// The camera to render with.
    CameraModel const& pinhole() const { return pinhole_; }
    bool needs_radiance() const { return session_.finish.mattes || blur_; }
    bool needs_world() const { return session_.finish.upsample || session_.finish.mattes; }
    /// @param world  with all virtual objects in place, the same object in every call; read only if needed
    RenderedPair operator()(PairPictures const& rendered, FinishFrame const& frame, gi::World const& world);
    /// Nearest rendered pixels: at a resolution below 1 their borders are coarser than those of the pair.
    SeenDepth depth_of(PairPictures const& rendered) const;
    /// Discards the history; call when the camera's pose is lost.
    void forget();
    FinishCounts const& counts() const { return counts_; }

private:
    RenderedPair smoothed(PairPictures const& p, gi::RigidPose const& world_from_camera);
    RenderedPair upsampled(RenderedPair const& low, SharpSurfaces const& sharp, gi::Camera const& camera);
    RenderedPair blurred(RenderedPair pair, FinishFrame const& frame, cv::Mat const& depth_m);

    Session session_;
    CameraModel camera_, pinhole_; ///< rendered
    Warp warp_;                    ///< from the final size of pairs
    std::optional<TemporalFilter> filter_;
    std::optional<CameraBlur> blur_;
    std::optional<VirtualSurfaces> virtual_;
    std::optional<RealSurfaces> real_;
    cv::Mat wanted_, wanted_coverage_; ///< reused buffers
    FinishCounts counts_;
};

} // namespace ar
