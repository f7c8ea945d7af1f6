#pragma once
// Calmer virtual light from frame to frame. Only what is added to the camera's picture is filtered, never the
// camera's picture: with out = added + (1 - a) camera,
//   added = with - (1 - a) without
// is kept from frame to frame, looked up where the surface was (pose and depth), held within the neighbourhood's
// mean +- gamma standard deviations of the new frame (variance clipping, Salvi 2016), and
//   added' = history + weight (added - history).
// Noise of independent frames goes down to weight / (2 - weight) of its variance where nothing is clipped; a
// change of light is followed to 63 % in about 1 / weight frames. Where nothing is added the result is nothing,
// exactly.

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/composite/rendered_pair.h"

namespace ar {

struct TemporalSettings {
    float weight = 0.2f;             ///< of the new frame, (0, 1]
    float gamma = 1.5f;              ///< standard deviations; infinite = history is never clipped
    int radius_px = 2;               ///< of the neighbourhood
    float depth_tolerance = 0.05f;   ///< of the depth: more is another surface
    float coverage_tolerance = 0.1f; ///< of `a`: more is another thing
};

struct TemporalCounts {
    std::size_t followed = 0; ///< pixels with history
    std::size_t fresh = 0;    ///< without: new in the picture, another surface, not finite
    std::size_t clipped = 0;  ///< values whose history was outside of the neighbourhood
};

class TemporalFilter {
public:
    /// @param camera  pinhole; all pictures have its size
    /// @throws gi::InputError another lens, settings out of range
    explicit TemporalFilter(CameraModel const& camera, TemporalSettings const& settings = {});

    /// @param pair    of this frame
    /// @param depth   CV_32FC1, metres along the axis, of what the pixel shows (objects or proxies); 0 =
    /// infinitely far
    /// @return pair whose `without` and coverage are those given. @throws gi::InputError types or sizes
    RenderedPair operator()(RenderedPair const& pair, cv::Mat const& depth, Pose const& world_from_camera);
    /// The next frame has no history: after cuts, changes of exposure or scene.
    void forget();
    TemporalCounts const& counts() const { return counts_; } ///< of the last frame

private:
    CameraModel camera_;
    TemporalSettings settings_;
    cv::Mat added_, coverage_, depth_; ///< of the frame before; added_ empty = none
    Pose world_from_camera_;
    TemporalCounts counts_;
};

} // namespace ar
