// Pairs rendered at half size: borders of virtual objects as sharp as at full size, and hidden ones known.

#include "ar/pipeline/bridge.h"
#include "ar/pipeline/pair_finish.h"
#include "ar/pipeline/synthetic.h"
#include "ar/scene/proxy_mesh.h"
#include "gi/scene/generate/builder.h"

#include <opencv2/imgproc.hpp>

namespace viewer::test {
namespace {

constexpr glm::ivec2 kSize(96, 72);

/// A red ball on a table, behind a block.
ar::LocalScene scene()
{
    gi::Report report;
    gi::Scene real;
    for (ar::Proxy const& p :
         {ar::Proxy{"table", {}, ar::ProxyPlane{{-0.6, 0, 0.5}, {1.2, 0, 0}, {0, 0, -1}}},
          ar::Proxy{"block", {}, ar::ProxyBox{{0.12, 0.25, 0.05}, {{0.07, 0.125, 0.15}, {1, 0, 0, 0}}}}})
        gi::append(real, ar::scene_of(p, report), p.name, gi::dmat4(1));
    gi::SceneBuilder b;
    gi::Material red;
    red.base_color = {0.7f, 0.1f, 0.1f};
    red.specular = 0;
    b.sphere(b.add_material("ball", red), {0, 0.13f, 0}, 0.12f, 48);
    return ar::join_scenes(std::move(real), b.finish("ball"), gi::dmat4(1));
}

struct Finished {
    ar::RenderedPair pair;
    ar::FinishCounts counts;
};

gi::RenderSettings quick_settings()
{
    gi::RenderSettings settings;
    settings.bounces = 1;
    settings.of<gi::SlhbSettings>().directions = "icosahedron:80";
    settings.of<gi::SlhbSettings>().resolution = 48;
    settings.of<gi::SlhbSettings>().light_samples = 4;
    settings.of<gi::SlhbSettings>().shadow_resolution = 64;
    return settings;
}

Finished finished(double resolution, ar::FinishSettings const& finish, std::uint32_t paths,
                  cv::Mat const& radiance = {})
{
    ar::Session session;
    session.render.resolution = resolution;
    session.finish = finish;
    gi::Report report;
    ar::PairRenderer renderer(scene(), quick_settings(), report, "slhb");
    renderer.set_environment(std::make_shared<gi::EnvironmentMap const>(
        ar::environment_of(cv::Mat(8, 16, CV_32FC3, cv::Scalar::all(0.5)))));
    ar::PairFinish finisher(session, ar::synthetic_camera(kSize).model, {});
    gi::RigidPose const pose = ar::synthetic_pose(0.5);
    ar::CameraModel const& pinhole = finisher.pinhole();
    ar::PairPictures const p = renderer.render(ar::gi_camera(pinhole, pose), pinhole.size_px.x, pinhole.size_px.y,
                                               paths, 0, gi::DenoiseSettings{}, {});
    Finished f;
    f.pair = finisher(p, {radiance, pose, 0, 0}, renderer.world_with(0));
    f.counts = finisher.counts();
    return f;
}

double mean_difference(cv::Mat const& a, cv::Mat const& b)
{
    cv::Mat d;
    cv::absdiff(a, b, d);
    return cv::mean(d)[0];
}

TEST(PairFinishes, KeepBordersSharpAtHalfSize)
{
    cv::Mat const full = finished(1, {}, 12).pair.coverage;
    ar::FinishSettings plain;
    plain.upsample = false;
    Finished const enlarged = finished(0.5, plain, 12), sharp = finished(0.5, {}, 12);
    ASSERT_EQ(sharp.pair.coverage.size(), cv::Size(kSize.x, kSize.y));
    EXPECT_LT(mean_difference(sharp.pair.coverage, full), 0.65 * mean_difference(enlarged.pair.coverage, full));
    // Where the ball covers all of a pixel, it is as bright as before.
    cv::Mat const inside = (full == 1) & (sharp.pair.coverage == 1) & (enlarged.pair.coverage == 1);
    ASSERT_GT(cv::countNonZero(inside), 100);
    EXPECT_NEAR(cv::mean(sharp.pair.direct, inside)[0] / cv::mean(enlarged.pair.direct, inside)[0], 1, 0.05);
    EXPECT_EQ(enlarged.counts.unlit, 0u);
}

/// Mean over the ball of the standard deviation of what it shows, over frames of one pose.
double flicker(double smoothing)
{
    ar::Session session;
    session.render.resolution = 0.5;
    session.smoothing = smoothing;
    gi::Report report;
    ar::PairRenderer renderer(scene(), quick_settings(), report, "slhb");
    renderer.set_environment(std::make_shared<gi::EnvironmentMap const>(
        ar::environment_of(cv::Mat(8, 16, CV_32FC3, cv::Scalar::all(0.5)))));
    ar::PairFinish finisher(session, ar::synthetic_camera(kSize).model, {});
    gi::RigidPose const pose = ar::synthetic_pose(0.5);
    ar::CameraModel const& pinhole = finisher.pinhole();
    cv::Mat sum(kSize.y, kSize.x, CV_32FC1, cv::Scalar(0)), squares = sum.clone(), covered;
    constexpr int kFirst = 6, kFrames = 14;
    for (int k = 0; k < kFrames; ++k) {
        ar::PairPictures const p = renderer.render(ar::gi_camera(pinhole, pose), pinhole.size_px.x,
                                                   pinhole.size_px.y, 1, 0, {.denoiser = gi::Denoiser::none}, {});
        ar::RenderedPair const pair = finisher(p, {{}, pose, k / 30.0, 0}, renderer.world_with(0));
        if (k < kFirst) continue;
        cv::Mat red;
        cv::extractChannel(pair.direct, red, 0);
        sum += red;
        squares += red.mul(red);
        cv::Mat const now = pair.coverage == 1;
        covered = covered.empty() ? now : cv::Mat(covered & now);
    }
    constexpr double n = kFrames - kFirst;
    cv::Mat variance = squares / n - (sum / n).mul(sum / n), deviation;
    cv::sqrt(cv::max(variance, 0), deviation);
    EXPECT_GT(cv::countNonZero(covered), 100);
    return cv::mean(deviation, covered)[0];
}

TEST(PairFinishes, SmoothWhatVirtualThingsShow) { EXPECT_LT(flicker(0.2), 0.6 * flicker(1)); }

TEST(PairFinishes, RefineBordersOfOccludersByTheCamera)
{
    // The block is black in the camera's picture, and three pixels wider to the left than its proxy.
    ar::FinishSettings finish;
    Finished const before = finished(1, finish, 4);
    finish.mattes = true;
    ar::CameraModel const camera = ar::synthetic_camera(kSize).model;
    gi::RigidPose const from_world = gi::inverse(ar::synthetic_pose(0.5));
    cv::Mat radiance(kSize.y, kSize.x, CV_32FC3, cv::Scalar::all(0.6));
    auto const low = ar::project(camera, from_world * glm::dvec3(0.01, 0, 0.175)),
               high = ar::project(camera, from_world * glm::dvec3(0.13, 0.25, 0.175));
    ASSERT_TRUE(low && high);
    cv::Rect const block(cv::Point(int(low->x) - 3, int(high->y)), cv::Point(int(high->x), int(low->y)));
    cv::rectangle(radiance, block, cv::Scalar::all(0.02), cv::FILLED);
    Finished const after = finished(1, finish, 4, radiance);
    EXPECT_GT(after.counts.matte.band, 30u);
    EXPECT_GT(after.counts.matte.refined, 10u);
    cv::Rect const strip(block.x, block.y + 3, 2, block.height / 3);
    EXPECT_GT(cv::mean(before.pair.coverage(strip))[0], 0.8);
    EXPECT_LT(cv::mean(after.pair.coverage(strip))[0], 0.4);
}

} // namespace
} // namespace viewer::test
