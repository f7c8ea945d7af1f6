// Pairs by prefiltered light: the same in every frame, following what moves, and refused where they cannot light.

#include "ar/light/lat_long.h"
#include "ar/light/map_file.h"
#include "ar/pipeline/pair_renderer.h"
#include "ar/pipeline/synthetic.h"
#include "gi/core/error.h"
#include "gi/core/rng.h"
#include "gi/scene/generate/procedural_texture.h"
#include "tests/support/data.h"
#include "tests/viewer_ar/lit_places.h"

#include <map>
#include <opencv2/imgproc.hpp>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

ar::PairPictures pictures(ar::PairRenderer& renderer, double time_s = 0)
{
    ar::CameraModel camera = ar::synthetic_camera({160, 120}).model;
    camera.lens = ar::LensModel::pinhole;
    return renderer.render(ar::gi_camera(camera, ar::synthetic_pose(0.5)), 160, 120, 1, time_s, {}, {});
}

TEST(PrefilteredPairs, AreTheSameInEveryFrame)
{
    gi::Report report;
    ar::PaperOnTable const paper{cv::Mat(4, 4, CV_8UC1, cv::Scalar(255)), 0.3, 0.2, {-0.15, 0.3}};
    ar::PairRenderer renderer(
        ar::join_scenes(ar::generate_desk(ar::DeskPart::near, paper), ar::generate_statue(), gi::dmat4(1)), {},
        report);
    cv::Mat map = uniform(0.5);
    cv::rectangle(map, {20, 6, 3, 3}, cv::Scalar(20, 18, 14), cv::FILLED);
    renderer.set_environment(environment(map));
    EXPECT_EQ(renderer.choose(ar::PairLight::automatic), "");
    ar::PairPictures const first = pictures(renderer);
    EXPECT_GT(cv::countNonZero(first.coverage), 100);
    for (int frame = 0; frame < 3; ++frame) {
        ar::PairPictures const again = pictures(renderer);
        EXPECT_EQ(cv::norm(again.with, first.with, cv::NORM_INF), 0);
        EXPECT_EQ(cv::norm(again.without, first.without, cv::NORM_INF), 0);
    }
    EXPECT_GT(cv::norm(pictures(renderer, 0.4).coverage, first.coverage, cv::NORM_L1), 5) << "clips play";
    ar::PairPictures const back = pictures(renderer, 0);
    EXPECT_LT(cv::norm(back.with, first.with, cv::NORM_L1), 0.01 * cv::norm(first.with, cv::NORM_L1));
    ar::PairRenderer nothing(ar::join_scenes(ar::generate_desk(ar::DeskPart::near, paper), {}, gi::dmat4(1)), {},
                             report);
    nothing.set_environment(environment(map));
    nothing.choose(ar::PairLight::prefiltered);
    ar::PairPictures const same = pictures(nothing);
    EXPECT_EQ(cv::norm(same.with, same.without, cv::NORM_INF), 0);
    EXPECT_GT(cv::mean(same.without)[1], 0.01);
}

/// Mean radiance of a face's middle, looked up in a picture.
double face_mean(cv::Mat const& picture, ar::CameraModel const& camera, gi::RigidPose const& pose, gi::vec3 normal)
{
    gi::vec3 const u = std::abs(normal.y) > 0.5f ? gi::vec3(1, 0, 0) : gi::vec3(0, 1, 0),
                   v = glm::cross(normal, u);
    double sum = 0;
    int count = 0;
    for (int j = -9; j <= 9; ++j)
        for (int i = -9; i <= 9; ++i) {
            gi::vec3 const p = gi::vec3(0, 0.1f, 0) + 0.1f * normal + 0.008f * (float(i) * u + float(j) * v);
            glm::dvec3 const seen = glm::conjugate(pose.rotation) * (glm::dvec3(p) - pose.position);
            cv::Point const at(int(std::lround(camera.fx * seen.x / seen.z + camera.cx)),
                               int(std::lround(camera.fy * seen.y / seen.z + camera.cy)));
            if (!cv::Rect({0, 0}, picture.size()).contains(at)) continue;
            sum += double(picture.at<cv::Vec3f>(at)[1]);
            ++count;
        }
    EXPECT_GT(count, 300);
    return sum / std::max(count, 1);
}

/// A matt box on a table, the camera held by hand: each pose a little off.
TEST(PrefilteredPairs, DoNotFlickerWhenTheCameraTrembles)
{
    std::vector<std::pair<std::string, cv::Mat>> maps{{"a lamp", uniform(0.3)}};
    cv::rectangle(maps[0].second, {20, 6, 2, 2}, cv::Scalar(90, 80, 60), cv::FILLED);
    for (char const* const name : {"dancing_hall_1k.hdr", "autoshop_01_1k.hdr", "kloppenheim_05_1k.hdr"})
        if (fs::path const file = gi::test::shared_data() / "envmaps" / name; fs::exists(file))
            maps.emplace_back(name, ar::read_map(file));
    ar::CameraModel camera = ar::synthetic_camera({640, 480}).model;
    camera.lens = ar::LensModel::pinhole;
    ar::CameraModel const half = ar::scaled(camera, {320, 240});
    for (auto const& [name, map] : maps) {
        gi::Report report;
        ar::PairRenderer renderer(ar::join_scenes(floor(0.7f, matt(0.6f)),
                                                  box({-0.1f, 0, -0.1f}, {0.1f, 0.2f, 0.1f}, matt(0.5f)),
                                                  gi::dmat4(1)),
                                  {}, report);
        renderer.set_environment(environment(map));
        renderer.choose(ar::PairLight::prefiltered);
        gi::Pcg32 rng = gi::Pcg32::for_path(7, 0, 0);
        auto const normal = [&] { return double(rng.uniform() + rng.uniform() + rng.uniform() - 1.5f) * 2; };
        std::map<int, std::vector<double>> means;
        for (int frame = 0; frame < 16; ++frame) {
            gi::RigidPose pose = ar::synthetic_pose(0.35);
            pose.position += 5e-4 * glm::dvec3(normal(), normal(), normal());
            glm::dvec3 const axis(normal(), normal(), normal());
            pose.rotation =
                glm::normalize(pose.rotation * glm::dquat(1, 2.5e-4 * axis.x, 2.5e-4 * axis.y, 2.5e-4 * axis.z));
            ar::PairPictures const p = renderer.render(ar::gi_camera(half, pose), 320, 240, 1, 0, {}, {});
            for (int k : {0, 1, 2, 4, 5})
                if (glm::dot(glm::dvec3(kAxes[k]), pose.position - glm::dvec3(0, 0.1, 0)) > 0.2)
                    means[k].push_back(face_mean(p.with, half, pose, kAxes[k]));
        }
        for (auto const& [k, m] : means) {
            double mean = 0, squares = 0;
            for (double const v : m) mean += v / double(m.size());
            for (double const v : m) squares += (v - mean) * (v - mean) / double(m.size());
            std::printf("%s, face %d: standard deviation %.3f %%\n", name.c_str(), k,
                        100 * std::sqrt(squares) / mean);
            EXPECT_LT(std::sqrt(squares), 0.01 * mean) << name;
        }
        EXPECT_GE(means.size(), 2u);
    }
}

TEST(PrefilteredPairs, FollowALampInTheFrameAfter)
{
    gi::Report report;
    ar::PairRenderer renderer(
        ar::join_scenes({}, box({-0.1f, 0, -0.1f}, {0.1f, 0.2f, 0.1f}, matt(0.5f)), gi::dmat4(1)), {}, report);
    renderer.choose(ar::PairLight::prefiltered);
    ar::CameraModel camera = ar::synthetic_camera({160, 120}).model;
    camera.lens = ar::LensModel::pinhole;
    gi::RigidPose const pose = ar::synthetic_pose(0.35);
    for (int const column : {4, 20, 36, 52}) {
        cv::Mat map = uniform(0.05);
        cv::rectangle(map, {column, 10, 2, 2}, cv::Scalar(40, 60, 80), cv::FILLED);
        renderer.set_environment(environment(map));
        ar::PairPictures const p = renderer.render(ar::gi_camera(camera, pose), 160, 120, 1, 0, {}, {});
        double const top = face_mean(p.with, camera, pose, {0, 1, 0});
        double const wanted = 0.5 / gi::kPiD * ar::irradiance_exact(map, {0, 1, 0})[1];
        EXPECT_NEAR(top / wanted, 1, 0.02) << column;
    }
}

/// With few directions, pixels share all of them: no dither.
TEST(PrefilteredPairs, CastShadowsUnderMapsOfFewTexels)
{
    gi::Report report;
    ar::PairRenderer renderer(ar::join_scenes(floor(0.7f, matt(0.6f)),
                                              box({-0.1f, 0.05f, -0.1f}, {0.1f, 0.2f, 0.1f}, matt(0.5f)),
                                              gi::dmat4(1)),
                              {}, report);
    renderer.set_environment(environment(cv::Mat(2, 4, CV_32FC3, cv::Scalar::all(1))));
    renderer.choose(ar::PairLight::prefiltered);
    ar::PairPictures const p = pictures(renderer);
    // Beside the box the shadow is as dark in one column of pixels as in the next.
    cv::Mat change;
    cv::cvtColor(p.without - p.with, change, cv::COLOR_RGB2GRAY);
    int shadowed = 0, alone = 0;
    for (int y = 1; y < change.rows - 1; ++y)
        for (int x = 1; x < change.cols - 1; ++x) {
            if (p.coverage.at<float>(y, x) > 0 || !(change.at<float>(y, x) > 0.02f)) continue;
            ++shadowed;
            alone += !(change.at<float>(y, x - 1) > 0.02f) && !(change.at<float>(y, x + 1) > 0.02f);
        }
    EXPECT_GT(shadowed, 100);
    EXPECT_LT(alone, shadowed / 20);
}

TEST(PrefilteredPairs, AreRefusedWhereTheyCannotLight)
{
    gi::Report report;
    gi::Material glass = matt(1);
    glass.transmission = 1;
    glass.specular = 1;
    glass.roughness = 0;
    gi::Material mirror = matt(0.9f);
    mirror.metallic = 1;
    mirror.roughness = 0;
    auto const why = [&](gi::Scene real, gi::Scene things, ar::PairLight light) {
        ar::PairRenderer renderer(ar::join_scenes(std::move(real), std::move(things), gi::dmat4(1)), {}, report);
        return renderer.choose(light);
    };
    gi::Scene const things = box({-0.1f, 0, -0.1f}, {0.1f, 0.2f, 0.1f}, matt(0.5f));
    EXPECT_EQ(why(floor(1, matt(0.5f)), things, ar::PairLight::automatic), "");
    EXPECT_NE(why(floor(1, matt(0.5f)), things, ar::PairLight::paths), "");
    EXPECT_EQ(why(floor(1, matt(0.5f)), box(gi::vec3(0), gi::vec3(1), glass), ar::PairLight::automatic),
              "surfaces are glass");
    EXPECT_EQ(why(floor(1, mirror), things, ar::PairLight::automatic), "real surfaces are mirrors");
    EXPECT_EQ(why(floor(1, matt(0.5f)), box(gi::vec3(0), gi::vec3(1), mirror), ar::PairLight::automatic),
              "virtual objects are mirrors");
    EXPECT_THROW(why(floor(1, mirror), things, ar::PairLight::prefiltered), gi::InputError);
    gi::Scene worn = box(gi::vec3(0), gi::vec3(1), matt(0.9f));
    gi::Material& polished = worn.materials[0];
    polished.metallic = 1; // its roughness is in a texture, here and there smooth
    polished.metallic_roughness_map.texture = gi::add_procedural_texture(
        worn.textures, 16, false, [](gi::vec2 uv) { return gi::vec4(0, uv.x < 0.2f ? 0.04f : 0.8f, 1, 1); });
    EXPECT_EQ(why(floor(1, matt(0.5f)), worn, ar::PairLight::automatic), "virtual objects are mirrors");
    gi::Material lamp = matt(0);
    lamp.emission = gi::vec3(1);
    EXPECT_EQ(why(floor(1, lamp), things, ar::PairLight::automatic), "surfaces emit light");
}

} // namespace
} // namespace viewer::test
