// What a compositor needs of a renderer: nothing there, nothing changed, in every bit.

#include "ar/pipeline/pair_renderer.h"

#include "ar/pipeline/bridge.h"
#include "ar/pipeline/synthetic.h"
#include "gi/core/error.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/motion/skinning.h"

#include <opencv2/imgproc.hpp>

namespace viewer::test {
namespace {

ar::PaperOnTable blank_paper() { return {cv::Mat(4, 4, CV_8UC1, cv::Scalar(255)), 0.3, 0.2, {-0.15, 0.3}}; }

std::shared_ptr<gi::EnvironmentMap const> sky()
{
    cv::Mat map(16, 32, CV_32FC3, cv::Scalar(0.5, 0.6, 0.8));
    cv::rectangle(map, {20, 3, 3, 3}, cv::Scalar(20, 18, 14), cv::FILLED);
    return std::make_shared<gi::EnvironmentMap const>(ar::environment_of(map));
}

ar::PairPictures rendered(gi::Scene virtual_things, std::uint32_t paths, gi::Report& report, double time_s = 0,
                          bool is_denoised = false)
{
    gi::RenderSettings settings;
    settings.bounces = 2;
    ar::LocalScene local = ar::join_scenes(ar::generate_desk(ar::DeskPart::near, blank_paper()),
                                           std::move(virtual_things), gi::dmat4(1));
    ar::PairRenderer renderer(std::move(local), settings, report);
    renderer.set_environment(sky());
    ar::CameraModel camera = ar::synthetic_camera({80, 60}).model;
    camera.lens = ar::LensModel::pinhole;
    return renderer.render(ar::gi_camera(camera, ar::synthetic_pose(0.5)), 80, 60, paths, time_s,
                           {.denoiser = is_denoised ? gi::Denoiser::atrous : gi::Denoiser::none}, {});
}

TEST(PairRenderers, WithNothingVirtualChangeNothing)
{
    gi::Report report;
    ar::PairPictures const p = rendered({}, 2, report);
    EXPECT_EQ(cv::norm(p.with, p.without, cv::NORM_INF), 0);
    EXPECT_EQ(cv::countNonZero(p.coverage), 0);
    EXPECT_GT(cv::mean(p.without)[1], 0.01) << "the place is lit";
    ar::PairPictures const smooth = rendered({}, 2, report, 0, true);
    EXPECT_EQ(cv::norm(smooth.with, smooth.without, cv::NORM_INF), 0);
    EXPECT_GT(cv::norm(smooth.with, p.with, cv::NORM_INF), 0);
}

TEST(PairRenderers, PutThingsOnTheTable)
{
    gi::Report report;
    ar::PairPictures const p = rendered(ar::generate_statue(), 8, report);
    int const covered = cv::countNonZero(p.coverage > 0.5);
    EXPECT_GT(covered, 100);
    EXPECT_LT(covered, 80 * 60 / 3);
    cv::Mat const behind = (p.coverage > 0.99) & (p.depth_m >= p.real_depth_m) & (p.real_depth_m > 0);
    EXPECT_EQ(cv::countNonZero(behind), 0);
    cv::Mat darker;
    cv::cvtColor(p.without - p.with, darker, cv::COLOR_RGB2GRAY);
    EXPECT_GT(cv::countNonZero((darker > 0.02) & (p.coverage == 0)), 40) << "shadows beside the things";
}

TEST(PairRenderers, MoveWhatHasClips)
{
    gi::Report report;
    ar::PairPictures const a = rendered(ar::generate_statue(), 1, report, 0),
                           b = rendered(ar::generate_statue(), 1, report, 0.4);
    EXPECT_GT(cv::norm(a.coverage, b.coverage, cv::NORM_L1), 5);
}

TEST(PairRenderers, TakeAwayVirtualLampsToo)
{
    gi::Scene lamp;
    gi::Light light;
    light.intensity = gi::vec3(4);
    lamp.lights.push_back(light);
    gi::Node node;
    node.translation = {0.1, 0.3, 0.1};
    node.light = 0;
    lamp.nodes.push_back(node);
    gi::Report report;
    ar::PairPictures const p = rendered(lamp, 16, report), dark = rendered({}, 16, report);
    EXPECT_GT(cv::mean(p.with)[0], 1.2 * cv::mean(p.without)[0]);
    EXPECT_NEAR(cv::mean(p.without)[0], cv::mean(dark.without)[0], 0.05 * cv::mean(dark.without)[0]);
}

/// Each corner on a joint of its own: shrinking joints about themselves would leave the triangle.
TEST(LocalScenes, TakeAwayAllOfSkins)
{
    gi::Scene scene;
    gi::Mesh mesh;
    gi::Skin skin;
    for (std::size_t j = 0; j < 3; ++j) {
        gi::Node joint;
        joint.translation = {double(j == 1), double(j == 2), 3};
        scene.nodes.push_back(joint);
        skin.joints.push_back(std::int32_t(j));
        skin.inverse_bind.push_back(gi::mat4(1));
        mesh.positions.push_back({0, 0, 0});
        mesh.joints.push_back({std::uint16_t(j), 0, 0, 0});
        mesh.weights.push_back({1, 0, 0, 0});
    }
    mesh.triangles = {{0, 1, 2}};
    scene.meshes = {mesh};
    scene.skins = {skin};
    gi::Node holder;
    holder.meshes = {0};
    holder.skin = 0;
    scene.nodes.push_back(holder);
    ar::LocalScene const local = ar::join_scenes({}, scene, gi::dmat4(1));
    auto const size = [&](gi::PairSide side) {
        gi::Pose const pose = ar::local_pose(local, std::nullopt, side);
        std::size_t const node = local.scene->nodes.size() - 1;
        auto const at = gi::deform(*local.scene, pose, node, local.scene->meshes[0]).positions;
        return glm::distance(at[0], at[1]) + glm::distance(at[0], at[2]);
    };
    EXPECT_NEAR(size(gi::PairSide::with), 2, 1e-6);
    EXPECT_LT(size(gi::PairSide::without), 1e-9);
}

TEST(LocalScenes, WithRealThingsThatMoveAreRefused)
{
    EXPECT_THROW(ar::join_scenes(gi::generate_avatar(), {}, gi::dmat4(1)), gi::InputError);
}

} // namespace
} // namespace viewer::test
