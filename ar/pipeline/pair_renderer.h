#pragma once
// Renders a local scene with and without its virtual objects, for compositing.

#include "ar/pipeline/local_scene.h"
#include "gi/core/report.h"
#include "gi/filter/denoise.h"
#include "gi/scene/motion/moving_world.h"

#include <opencv2/core.hpp>

namespace viewer {

/// Pictures of a pinhole camera. `with` and `without`: radiance, CV_32FC3, RGB, from the same random numbers.
struct PairPictures {
    cv::Mat with, without;
    cv::Mat direct;                ///< CV_32FC3: part of `with` from virtual first surfaces
    cv::Mat coverage;              ///< CV_32FC1: share of the pixel whose first surface is virtual
    cv::Mat depth_m, real_depth_m; ///< CV_32FC1, along the axis: first surface with and without; 0 = none
    std::uint32_t paths = 0;       ///< per pixel of each picture
};

class PairRenderer {
public:
    /// @param settings  method slhb; size and number of paths are set per call of `render`
    PairRenderer(LocalScene local, gi::RenderSettings const& settings, gi::Report& report);

    /// Sets the place's environment map; null: none.
    void set_environment(std::shared_ptr<gi::EnvironmentMap const> map);
    /// @param filter  for both pictures: equal pixels stay equal except near unequal ones. The a-trous filter
    ///                needs variances, and does nothing with one path
    PairPictures render(gi::Camera const& camera, int width, int height, std::uint32_t paths, gi::SceneTime time_s,
                        gi::DenoiseSettings filter, gi::StopRequest const& stop);
    gi::World const& world() const { return world_.world(); }
    /// The world with all virtual objects in place; valid until the next picture.
    gi::World const& world_with(gi::SceneTime time_s);

private:
    gi::Changes turn(gi::PairSide side, gi::SceneTime time_s);

    LocalScene local_;
    gi::RenderSettings settings_;
    gi::Report& report_;
    gi::MovingWorld world_;
    std::vector<gi::Light> virtual_lights_; ///< the virtual lights, for the side with them
    gi::Changes pending_;                   ///< since the last picture
    std::unique_ptr<gi::FrameRenderer> frames_;
};

} // namespace viewer
