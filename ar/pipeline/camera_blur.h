#pragma once
// Measures the blur of the camera's pictures, so that added light can be blurred equally: lens blur at the borders
// of printed markers, motion blur from the camera's motion while the shutter was open.

#include "ar/camera/camera_model.h"
#include "ar/composite/edge_spread.h"
#include "ar/markers/marker_map.h"

#include <optional>
#include <vector>

namespace ar {

struct CameraBlurCounts {
    std::size_t measured = 0;    ///< frames with usable edges
    std::size_t unmeasured = 0;  ///< frames without a usable edge, which keep the previous blur
    std::size_t moved = 0;       ///< frames with motion of a pixel or more while the shutter was open
    std::size_t no_exposure = 0; ///< frames for which the source reports no exposure time
};

class CameraBlur {
public:
    CameraBlur(MarkerMap const& markers, CameraModel const& camera);

    /// Measures a frame. @param radiance  CV_32FC3  @param exposure_s  0 = unknown
    void follow(cv::Mat const& radiance, gi::RigidPose const& world_from_camera, double time_s, double exposure_s);
    /// Call for frames without a pose: the motion to the next frame is unknown.
    void forget() { before_.reset(); }

    /// Standard deviation of the lens blur in camera pixels, smoothed over frames; nothing if never measured.
    std::optional<double> sigma_px() const { return sigma_px_; }
    /// Camera pose when this frame's shutter opened; nothing if unknown or if it moved by less than a pixel.
    std::optional<gi::RigidPose> shutter_opened() const { return opened_; }
    CameraBlurCounts const& counts() const { return counts_; }

private:
    std::vector<EdgeSegment> edges(gi::RigidPose const& world_from_camera, double& shortest_px) const;

    CameraModel camera_;
    std::vector<std::array<glm::dvec3, 4>> markers_; ///< corners in the world
    struct Before {
        gi::RigidPose world_from_camera;
        double time_s;
    };
    std::optional<Before> before_;
    std::optional<gi::RigidPose> opened_;
    std::optional<double> sigma_px_;
    CameraBlurCounts counts_;
};

} // namespace ar
