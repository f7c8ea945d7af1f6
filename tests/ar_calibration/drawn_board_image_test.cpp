// From pixels to a lens: a board drawn through a known camera, with blur and noise, found and calibrated.

#include "ar/calibration/collector.h"
#include "ar/markers/detect.h"
#include "tests/ar_markers/drawn_view.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

namespace ar::test {
namespace {

gi::RigidPose view_pose(cv::RNG& rng, CameraModel const& c, glm::dvec3 middle)
{
    // From in front, up to 35 degrees from the side, the board anywhere in the picture.
    double const distance = rng.uniform(0.38, 0.6) * c.fx / 525;
    double const a = rng.uniform(-0.6, 0.6), b = rng.uniform(-0.6, 0.6);
    glm::dvec3 const eye = middle + distance * glm::normalize(glm::dvec3(std::sin(a), std::sin(b), std::cos(a)));
    glm::dvec3 const target = middle + glm::dvec3(rng.uniform(-0.1, 0.1), rng.uniform(-0.08, 0.08), 0);
    gi::RigidPose const p = looking(eye, target);
    return {p.position, glm::normalize(p.rotation * glm::angleAxis(rng.uniform(-0.4, 0.4), glm::dvec3(0, 0, 1)))};
}

class OfDrawnLens : public testing::TestWithParam<LensModel> {};
INSTANTIATE_TEST_SUITE_P(All, OfDrawnLens,
                         testing::Values(LensModel::radial_tangential, LensModel::rational, LensModel::fisheye),
                         [](auto const& p) { return name_of(p.param); });

TEST_P(OfDrawnLens, IsCalibratedWithinTwoPerMille)
{
    CameraModel truth{GetParam(), {640, 480}, 525, 528, 318.5, 243.25, {}};
    if (truth.lens == LensModel::radial_tangential) truth.distortion = {-0.28, 0.09, 0.001, -0.0007, -0.01};
    if (truth.lens == LensModel::rational) truth.distortion = {0.4, 0.1, 0.0005, -0.0003, 0.02, 0.7, 0.2, 0.03};
    if (truth.lens == LensModel::fisheye) {
        truth.fx = 330;
        truth.fy = 331;
        truth.distortion = {0.03, -0.01, 0.004, -0.001};
    }
    MarkerMap map;
    map.boards = {{10, 7, 0.035, 0.026, "DICT_5X5_100", 0, false, {}}};
    ViewSettings settings;
    settings.rays = 3;
    settings.dots_per_m = 3000;
    DrawnWorld const world(map, truth, settings);
    cv::RNG rng(20261122);
    Collector collector(truth.size_px, ViewSource::stills, truth.lens, 24);
    double corner_error = 0;
    int corners = 0, offered = 0;
    while (offered < 60 && (!collector.enough() || collector.views().size() < 24)) {
        gi::RigidPose const pose = view_pose(rng, truth, {0.175, 0.1225, 0});
        Sighting const s = detect(world.picture(pose, std::uint64_t(offered)), map);
        for (double e : world.errors(s, pose)) corner_error += e * e;
        corners += int(s.points.size());
        collector.offer(view_of(s, map, 0, fmt::format("picture {}", offered++)));
    }
    LensCalibration const c = calibrate_lens(collector.views(), truth.size_px, truth.lens);
    auto const is = parameters_of(c.camera), was = parameters_of(truth);
    fmt::print("{}: {} of {} views; corners {:.3f} px rms off; reprojection {:.3f} px; coverage {:.0f} %\n",
               name_of(truth.lens), c.used_views(), offered, std::sqrt(corner_error / corners), c.rms_px,
               100 * c.coverage);
    for (std::size_t i = 0; i < 4; ++i) {
        fmt::print("  {} {:.3f} +- {:.3f}, truth {}: {:+.3f} %\n", c.parameters[i], is[i],
                   c.standard_deviations[i], was[i], 100 * (is[i] / was[i] - 1));
        EXPECT_LT(std::abs(is[i] / was[i] - 1), 0.002) << c.parameters[i];
    }
    EXPECT_LT(c.rms_px, 0.2);
    // What counts in the end: rays of pixels.
    double worst = 0;
    for (int y = 24; y < 480; y += 48)
        for (int x = 32; x < 640; x += 64) {
            auto const d = direction_of(truth, {x, y});
            auto const p = d ? project(c.camera, *d) : std::nullopt;
            if (p) worst = std::max(worst, glm::distance(*p, glm::dvec2(x, y)));
        }
    fmt::print("  pixels of rays off by {:.3f} px at most\n", worst);
    EXPECT_LT(worst, 1);
}

} // namespace
} // namespace ar::test
