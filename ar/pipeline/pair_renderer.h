#pragma once
// Renders a local scene with and without its virtual things, for compositing.

#include "ar/pipeline/local_scene.h"
#include "gi/core/report.h"
#include "gi/filter/denoise.h"
#include "gi/scene/motion/moving_world.h"

#include <opencv2/core.hpp>

namespace viewer {

/// Pictures of a pinhole camera. With and without: radiance, CV_32FC3, RGB, by the same random numbers.
struct PairPictures {
    cv::Mat with, without;
    cv::Mat direct;                ///< CV_32FC3: what of `with` comes of virtual things seen first
    cv::Mat coverage;              ///< CV_32FC1: share of the pixel where a virtual thing is seen first
    cv::Mat depth_m, real_depth_m; ///< CV_32FC1, along the axis: first surface with and without; 0 = none
    std::uint32_t paths = 0;       ///< per pixel of each
};

class PairRenderer {
public:
    /// @param settings  method slhb; the size of pictures and the paths are given with each of them
    PairRenderer(LocalScene local, gi::RenderSettings const& settings, gi::Report& report);

    /// The light of the place, from all sides; null: none.
    void set_environment(std::shared_ptr<gi::EnvironmentMap const> map);
    /// @param filter  of both pictures: what is equal in both stays so but near what is not. The a-trous filter
    ///                goes by variance, and does nothing with one path
    PairPictures render(gi::Camera const& camera, int width, int height, std::uint32_t paths, gi::SceneTime time_s,
                        gi::DenoiseSettings filter, gi::StopRequest const& stop);
    gi::World const& world() const { return world_.world(); }
    /// The same, with everything virtual in its place. It is moved again by the next picture.
    gi::World const& world_with(gi::SceneTime time_s);

private:
    gi::Changes turn(gi::PairSide side, gi::SceneTime time_s);

    LocalScene local_;
    gi::RenderSettings settings_;
    gi::Report& report_;
    gi::MovingWorld world_;
    std::vector<gi::Light> virtual_lights_; ///< as they are when they are there
    gi::Changes pending_;                   ///< since the last picture
    std::unique_ptr<gi::FrameRenderer> frames_;
};

} // namespace viewer
