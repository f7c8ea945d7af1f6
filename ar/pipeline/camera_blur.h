#pragma once
// How blurred the camera's pictures are, so that what is added can be as blurred: the lens by the borders of the
// printed markers, motion by how far the camera moved while the shutter was open.

#include "ar/camera/camera_model.h"
#include "ar/composite/edge_spread.h"
#include "ar/markers/marker_map.h"

#include <optional>
#include <vector>

namespace viewer {

struct CameraBlurCounts {
    std::size_t measured = 0;    ///< frames whose edges told something
    std::size_t unmeasured = 0;  ///< frames without an edge that counts: the blur of those before
    std::size_t moved = 0;       ///< frames with motion of a pixel or more while the shutter was open
    std::size_t no_exposure = 0; ///< frames of which the source does not tell how long the shutter was open
};

class CameraBlur {
public:
    CameraBlur(ar::MarkerMap const& markers, ar::CameraModel const& camera);

    /// @param radiance  CV_32FC3  @param exposure_s  0 = not known
    void follow(cv::Mat const& radiance, ar::Pose const& world_from_camera, double time_s, double exposure_s);
    /// Without a pose: there is no motion known to the next frame.
    void forget() { before_.reset(); }

    /// Standard deviation of the lens's blur, in pixels of the camera, smoothed over frames; nothing: never
    /// measured.
    std::optional<double> sigma_px() const { return sigma_px_; }
    /// The camera when this frame's shutter opened; nothing: it is not known, or moved by less than a pixel.
    std::optional<ar::Pose> shutter_opened() const { return opened_; }
    CameraBlurCounts const& counts() const { return counts_; }

private:
    std::vector<ar::EdgeSegment> edges(ar::Pose const& world_from_camera, double& shortest_px) const;

    ar::CameraModel camera_;
    std::vector<std::array<glm::dvec3, 4>> markers_; ///< corners in the world
    struct Before {
        ar::Pose world_from_camera;
        double time_s;
    };
    std::optional<Before> before_;
    std::optional<ar::Pose> opened_;
    std::optional<double> sigma_px_;
    CameraBlurCounts counts_;
};

} // namespace viewer
