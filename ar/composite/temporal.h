#pragma once
// Temporal filter for the added light. Only what is added to the camera's picture is filtered, never the
// camera's picture itself: with out = added + (1 - a) camera,
//   added = with - (1 - a) without
// is kept from frame to frame, reprojected to where the surface was (pose and depth), clamped to mean +- gamma
// standard deviations of the new frame's neighbourhood (variance clipping, Salvi 2016), and blended:
//   added' = history + weight (added - history).
// The variance of noise that is independent between frames falls to weight / (2 - weight)
// where nothing is clipped; a change of light is adopted to 63 % in about 1 / weight frames.
// Where nothing is added, the result is exactly 0.
//
// While objects and light are known to stay as they are and the camera moves by less than a fiftieth of a pixel,
// differences are noise, even those of whole faces, whose pixels share light samples: then nothing is clipped, and
// the result is the mean of all frames since the last change (256 at most).

#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/composite/rendered_pair.h"

namespace ar {

/// What has happened to objects and light since the previous frame, as far as is known; the camera may move.
enum class SceneChange { none, unknown };

struct TemporalSettings {
    float weight = 0.2f;             ///< of the new frame, (0, 1]
    float gamma = 1.5f;              ///< standard deviations; infinite = history is never clipped
    int radius_px = 2;               ///< of the neighbourhood
    float depth_tolerance = 0.05f;   ///< relative; a larger difference is another surface
    float coverage_tolerance = 0.1f; ///< of `a`; a larger difference is another object
};

struct TemporalCounts {
    std::size_t followed = 0; ///< pixels with history
    std::size_t fresh = 0;    ///< pixels without: new in the picture, another surface, not finite
    std::size_t clipped = 0;  ///< values whose history was outside the neighbourhood's range
};

class TemporalFilter {
public:
    /// @param camera  pinhole; all pictures have its size
    /// @throws gi::InputError another lens, settings out of range
    explicit TemporalFilter(CameraModel const& camera, TemporalSettings const& settings = {});

    /// @param pair    of this frame
    /// @param depth   CV_32FC1, metres along the axis, of the visible surface (objects
    /// or proxies); 0 = infinitely far
    /// @return filtered pair with `without` and coverage unchanged. @throws gi::InputError wrong types or sizes
    RenderedPair operator()(RenderedPair const& pair, cv::Mat const& depth, gi::RigidPose const& world_from_camera,
                            SceneChange change = SceneChange::unknown);
    /// Discards the history; call after cuts and changes of exposure or scene.
    void forget();
    TemporalCounts const& counts() const { return counts_; } ///< of the last frame

private:
    CameraModel camera_;
    TemporalSettings settings_;
    cv::Mat added_, coverage_, depth_; ///< of the previous frame; added_ empty = none
    cv::Mat frames_;                   ///< CV_32FC1: whose mean added_ is, since the last change
    gi::RigidPose world_from_camera_;
    TemporalCounts counts_;
};

} // namespace ar
