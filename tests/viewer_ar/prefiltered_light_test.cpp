// Prefiltered light: exact where nothing is in the way, near closed forms where something is, the same every time.

#include "ar/light/irradiance.h"
#include "ar/light/map_file.h"
#include "ar/pipeline/bridge.h"
#include "ar/pipeline/pair_renderer.h"
#include "ar/pipeline/prefiltered/prefiltered_light.h"
#include "ar/pipeline/synthetic.h"
#include "gi/core/error.h"
#include "gi/core/rng.h"
#include "gi/scene/generate/builder.h"
#include "gi/scene/shading/warp.h"
#include "tests/support/data.h"

#include <map>
#include <opencv2/imgproc.hpp>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

gi::Material matt(float albedo)
{
    gi::Material m;
    m.base_color = gi::vec3(albedo);
    m.specular = 0;
    return m;
}

std::shared_ptr<gi::EnvironmentMap const> environment(cv::Mat const& map)
{
    return std::make_shared<gi::EnvironmentMap const>(environment_of(map));
}

cv::Mat uniform(double radiance) { return cv::Mat(32, 64, CV_32FC3, cv::Scalar::all(radiance)); }

gi::Scene box(gi::vec3 low, gi::vec3 high, gi::Material const& material)
{
    gi::SceneBuilder b;
    b.box(b.add_material("box", material), low, high);
    return b.finish("box");
}

gi::Scene floor(float half_m, gi::Material const& material)
{
    gi::SceneBuilder b;
    b.quad(b.add_material("floor", material), {-half_m, 0, half_m}, {2 * half_m, 0, 0}, {0, 0, -2 * half_m});
    return b.finish("floor");
}

/// Virtual things on real ones, under a map.
struct Place {
    Place(gi::Scene real, gi::Scene things, std::shared_ptr<gi::EnvironmentMap const> map)
        : local(join_scenes(std::move(real), std::move(things), gi::dmat4(1))), moving(local.scene, 0, report)
    {
        moving.set_environment(std::move(map));
    }
    gi::World const& world() const { return moving.world(); }
    /// The point where a line along -normal meets the first triangle that faces it.
    LitPoint point(gi::vec3 at, gi::vec3 normal) const
    {
        LitPoint p{at, normal, normal, gi::kNoPrimitive, {}, {}};
        float nearest = gi::kInf;
        for (std::size_t t = 0; t < world().triangles.size(); ++t) {
            gi::Surface const& s = world().surfaces[t];
            gi::vec3 const n = gi::shading_detail::triangle_normal(s);
            gi::vec2 const b = gi::barycentric_at(s, at);
            gi::vec3 const on = s.corner + b.x * s.edge1 + b.y * s.edge2;
            if (std::abs(glm::dot(n, normal)) > 0.99f && glm::distance(on, at) < nearest) {
                nearest = glm::distance(on, at);
                p.triangle = std::uint32_t(t);
                p.position = on;
            }
        }
        return p;
    }

    gi::Report report;
    LocalScene local;
    gi::MovingWorld moving;
};

constexpr gi::vec3 kAxes[] = {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};

/// Largest relative difference of a free box's faces from the irradiance summed over the map; of the darkest ones,
/// relative to a twentieth of the brightest.
double worst_face(cv::Mat const& map)
{
    Place const place({}, box({-0.5f, -0.5f, -0.5f}, {0.5f, 0.5f, 0.5f}, matt(0.5f)), environment(map));
    PrefilteredLight const light(place.world());
    std::vector<cv::Vec3d> wanted;
    std::vector<gi::vec3> got;
    for (gi::vec3 const n : kAxes) {
        gi::vec3 const at = 0.5f * n + gi::vec3(-0.4f, 0.3f, 0.42f) * (1.0f - glm::abs(n));
        wanted.push_back(ar::irradiance_exact(map, gi::dvec3(n)));
        got.push_back(light.on_moving(place.point(at, n)).irradiance);
    }
    gi::Pcg32 rng = gi::Pcg32::for_path(1, 2, 3);
    for (int k = 0; k < 4; ++k) { // faces of boxes that lie anyhow
        float const y = 2 * rng.uniform() - 1;
        gi::vec3 const n(std::sqrt(1 - y * y) * gi::azimuth(rng.uniform()), y);
        wanted.push_back(ar::irradiance_exact(map, gi::dvec3(n)));
        got.push_back(light.open(n));
    }
    double worst = 0;
    for (int c = 0; c < 3; ++c) {
        double brightest = 0;
        for (cv::Vec3d const& w : wanted) brightest = std::max(brightest, w[c]);
        for (std::size_t k = 0; k < got.size(); ++k)
            worst = std::max(worst, std::abs(double(got[k][c]) - wanted[k][c]) /
                                        std::max(wanted[k][c], 0.05 * brightest));
    }
    return worst;
}

TEST(PrefilteredLights, FacesOfABoxHaveTheIrradianceOfTheMap)
{
    EXPECT_LT(worst_face(uniform(2)), 0.002);
    cv::Mat lamps = uniform(0.1);
    cv::rectangle(lamps, {50, 8, 2, 2}, cv::Scalar(300, 200, 100), cv::FILLED);
    cv::rectangle(lamps, {10, 20, 3, 1}, cv::Scalar(20, 100, 200), cv::FILLED);
    EXPECT_LT(worst_face(lamps), 0.01);
}

TEST(PrefilteredLights, FacesOfABoxUnderRealMaps)
{
    LIGHTWELL_NEED_DATA("envmaps");
    for (char const* const name :
         {"dancing_hall_1k.hdr", "autoshop_01_1k.hdr", "kloppenheim_05_1k.hdr", "hilly_terrain_01_1k.hdr",
          "st_peters_square_night_1k.hdr", "dresden_square_1k.hdr"}) {
        double const worst = worst_face(ar::read_map(gi::test::shared_data() / "envmaps" / name));
        std::printf("%s: %.4f\n", name, worst);
        EXPECT_LT(worst, 0.02) << name;
    }
}

TEST(PrefilteredLights, ASquareAboveTheFloorHidesItsFormFactor)
{
    // A black square of 1 m, 0.5 m above a floor under a uniform sky: beneath its middle remains 1 - F of the
    // light.
    gi::SceneBuilder b;
    b.quad(b.add_material("square", matt(0)), {-0.5f, 0.5f, 0.5f}, {1, 0, 0}, {0, 0, -1});
    Place const place(floor(4, matt(0.5f)), b.finish("square"), environment(uniform(1)));
    PrefilteredLight const light(place.world());
    for (double const off : {0.0, 0.25, 0.5}) {
        LitPoint const at = place.point({float(off), 0, 0}, {0, 1, 0});
        // Differential area to parallel rectangle with a corner above it (Howell, B-3), for four quarters.
        auto const corner = [](double a, double c) {
            double const x = a / 0.5, y = c / 0.5;
            return (x / std::sqrt(1 + x * x) * std::atan(y / std::sqrt(1 + x * x)) +
                    y / std::sqrt(1 + y * y) * std::atan(x / std::sqrt(1 + y * y))) /
                   (2 * gi::kPiD);
        };
        double const f = 2 * (corner(0.5 - off, 0.5) + corner(0.5 + off, 0.5));
        double const got = -double(light.change_on_still(at).irradiance.x) / gi::kPiD;
        std::printf("%.2f m beside the middle: hidden %.4f, closed form %.4f\n", off, got, f);
        EXPECT_NEAR(got, f, 0.03);
    }
    LitPoint const far = place.point({3.9f, 0, 3.9f}, {0, 1, 0});
    EXPECT_GT(light.change_on_still(far).irradiance.x, -0.02f);
}

TEST(PrefilteredLights, AWhiteRoomCornerUnderAWhiteSkyIsWhite)
{
    // Furnace: with an albedo of 1 everywhere, every surface has the radiance of the sky, hidden or not. What is
    // beyond the second bounce is lost.
    Place const place(floor(2, matt(1)), box({-0.2f, 0.001f, -0.2f}, {0.2f, 0.4f, 0.2f}, matt(1)),
                      environment(uniform(1)));
    PrefilteredLight const light(place.world());
    for (gi::vec3 const n : {kAxes[0], kAxes[2], kAxes[4]}) {
        gi::vec3 const at = gi::vec3(0, 0.2f, 0) + 0.2f * n;
        double const radiance = double(light.on_moving(place.point(at, n)).irradiance.x) / gi::kPiD;
        std::printf("side %g %g %g: %.4f\n", double(n.x), double(n.y), double(n.z), radiance);
        EXPECT_NEAR(radiance, 1, 0.06);
    }
    LitPoint const beside = place.point({0.3f, 0, 0}, {0, 1, 0});
    double const radiance =
        double((light.on_still(beside).irradiance + light.change_on_still(beside).irradiance).x) / gi::kPiD;
    std::printf("floor beside it: %.4f\n", radiance);
    EXPECT_NEAR(radiance, 1, 0.08);
}

TEST(EnvironmentCells, KeepAllLightAndAngle)
{
    cv::Mat map = uniform(0.2);
    cv::rectangle(map, {40, 5, 1, 1}, cv::Scalar(5000, 4000, 3000), cv::FILLED);
    cv::rectangle(map, {2, 12, 6, 8}, cv::Scalar(3, 4, 5), cv::FILLED);
    Place place({}, {}, environment(map));
    EnvironmentTexels const texels = environment_texels(place.world());
    EnvironmentCells cells;
    EXPECT_TRUE(cells.update(texels));
    EXPECT_EQ(cells.cells().size(), 128u);
    gi::dvec3 light(0);
    double sr = 0, share = 0;
    for (EnvironmentCell const& c : cells.cells()) {
        light += gi::dvec3(c.light);
        sr += double(c.solid_angle_sr);
        share += double(c.share);
        EXPECT_NEAR(glm::length(c.direction), 1, 1e-5);
    }
    EXPECT_NEAR(sr, 4 * gi::kPiD, 1e-4);
    EXPECT_NEAR(share, 1, 1e-5);
    cv::Vec3d const wanted = ar::integral(map);
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(light[c] / wanted[c], 1, 1e-5);
    EXPECT_FALSE(cells.update(texels)) << "the same light, the same parts";
    cv::Mat moved = uniform(0.2);
    cv::rectangle(moved, {10, 25, 1, 1}, cv::Scalar(5000, 4000, 3000), cv::FILLED);
    place.moving.set_environment(environment(moved));
    EXPECT_TRUE(cells.update(environment_texels(place.world()))) << "the lamp has moved";
    place.moving.set_environment(nullptr);
    EXPECT_TRUE(cells.update(environment_texels(place.world())));
    EXPECT_TRUE(cells.cells().empty());
}

TEST(PrefilteredLights, HardCases)
{
    gi::Scene const things = box({-0.1f, 0, -0.1f}, {0.1f, 0.2f, 0.1f}, matt(0.5f));
    cv::Mat const black = uniform(0);
    cv::Mat sun = uniform(0);
    sun.at<cv::Vec3f>(6, 20) = cv::Vec3f(1e6f, 1e6f, 1e6f);
    auto const lit = [&](gi::Scene real, gi::Scene virtual_things, std::shared_ptr<gi::EnvironmentMap const> map) {
        Place const place(std::move(real), std::move(virtual_things), std::move(map));
        PrefilteredLight light(place.world());
        light.moved();
        ReceivedLight sum;
        for (std::size_t t = 0; t < place.world().triangles.size(); ++t) {
            gi::Surface const& s = place.world().surfaces[t];
            gi::vec3 const n = gi::shading_detail::triangle_normal(s);
            LitPoint const at{
                s.corner + (s.edge1 + s.edge2) / 3.0f, n, n, std::uint32_t(t), n, {0.3f, gi::vec3(0.1f)}};
            for (ReceivedLight const& r :
                 {light.on_moving(at), light.change_on_still(at), light.on_still(at), light.on_still(at, 8, 7)}) {
                EXPECT_TRUE(gi::all_finite(r.irradiance) && gi::all_finite(r.glossy));
                sum.irradiance += r.irradiance;
            }
        }
        return sum.irradiance;
    };
    EXPECT_EQ(lit(floor(1, matt(0.5f)), things, nullptr), gi::vec3(0));
    EXPECT_EQ(lit(floor(1, matt(0.5f)), things, environment(black)), gi::vec3(0));
    EXPECT_GT(lit(floor(1, matt(0.5f)), things, environment(sun)).x, 0);
    EXPECT_GT(lit({}, things, environment(uniform(1))).x, 0) << "nothing real";
    EXPECT_GT(lit(floor(1, matt(0.5f)), {}, environment(uniform(1))).x, 0) << "nothing virtual";
    EXPECT_EQ(lit({}, {}, environment(uniform(1))), gi::vec3(0));
    EXPECT_GT(lit(floor(1e4f, matt(0.5f)), things, environment(uniform(1))).x, 0) << "a wide plain";
    EXPECT_GT(
        lit(floor(1e-3f, matt(0.5f)), box(gi::vec3(-1e-4f), gi::vec3(1e-4f), matt(0.5f)), environment(uniform(1)))
            .x,
        0);
    EXPECT_GT(lit(floor(1, matt(0.5f)), box({-0.1f, 0, -0.1f}, {0.1f, 0, 0.1f}, matt(0.5f)),
                  environment(cv::Mat(1, 2, CV_32FC3, cv::Scalar::all(1))))
                  .x,
              0)
        << "flat, coplanar with the floor, under a map of two texels";
}

PairPictures pictures(PairRenderer& renderer, double time_s = 0)
{
    ar::CameraModel camera = synthetic_camera({160, 120}).model;
    camera.lens = ar::LensModel::pinhole;
    return renderer.render(gi_camera(camera, synthetic_pose(0.5)), 160, 120, 1, time_s, {}, {});
}

TEST(PrefilteredPairs, AreTheSameInEveryFrame)
{
    gi::Report report;
    PaperOnTable const paper{cv::Mat(4, 4, CV_8UC1, cv::Scalar(255)), 0.3, 0.2, {-0.15, 0.3}};
    PairRenderer renderer(join_scenes(generate_desk(DeskPart::near, paper), generate_statue(), gi::dmat4(1)), {},
                          report);
    cv::Mat map = uniform(0.5);
    cv::rectangle(map, {20, 6, 3, 3}, cv::Scalar(20, 18, 14), cv::FILLED);
    renderer.set_environment(environment(map));
    EXPECT_EQ(renderer.choose(PairLight::automatic), "");
    PairPictures const first = pictures(renderer);
    EXPECT_GT(cv::countNonZero(first.coverage), 100);
    for (int frame = 0; frame < 3; ++frame) {
        PairPictures const again = pictures(renderer);
        EXPECT_EQ(cv::norm(again.with, first.with, cv::NORM_INF), 0);
        EXPECT_EQ(cv::norm(again.without, first.without, cv::NORM_INF), 0);
    }
    EXPECT_GT(cv::norm(pictures(renderer, 0.4).coverage, first.coverage, cv::NORM_L1), 5) << "clips play";
    PairPictures const back = pictures(renderer, 0);
    EXPECT_LT(cv::norm(back.with, first.with, cv::NORM_L1), 0.01 * cv::norm(first.with, cv::NORM_L1));
    PairRenderer nothing(join_scenes(generate_desk(DeskPart::near, paper), {}, gi::dmat4(1)), {}, report);
    nothing.set_environment(environment(map));
    nothing.choose(PairLight::prefiltered);
    PairPictures const same = pictures(nothing);
    EXPECT_EQ(cv::norm(same.with, same.without, cv::NORM_INF), 0);
    EXPECT_GT(cv::mean(same.without)[1], 0.01);
}

/// Mean radiance of a face's middle, looked up in a picture.
double face_mean(cv::Mat const& picture, ar::CameraModel const& camera, ar::Pose const& pose, gi::vec3 normal)
{
    gi::vec3 const u = std::abs(normal.y) > 0.5f ? gi::vec3(1, 0, 0) : gi::vec3(0, 1, 0),
                   v = glm::cross(normal, u);
    double sum = 0;
    int count = 0;
    for (int j = -9; j <= 9; ++j)
        for (int i = -9; i <= 9; ++i) {
            gi::vec3 const p = gi::vec3(0, 0.1f, 0) + 0.1f * normal + 0.008f * (float(i) * u + float(j) * v);
            glm::dvec3 const seen = glm::conjugate(pose.rotation) * (glm::dvec3(p) - pose.position_m);
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
    ar::CameraModel camera = synthetic_camera({640, 480}).model;
    camera.lens = ar::LensModel::pinhole;
    ar::CameraModel const half = ar::scaled(camera, {320, 240});
    for (auto const& [name, map] : maps) {
        gi::Report report;
        PairRenderer renderer(join_scenes(floor(0.7f, matt(0.6f)),
                                          box({-0.1f, 0, -0.1f}, {0.1f, 0.2f, 0.1f}, matt(0.5f)), gi::dmat4(1)),
                              {}, report);
        renderer.set_environment(environment(map));
        renderer.choose(PairLight::prefiltered);
        gi::Pcg32 rng = gi::Pcg32::for_path(7, 0, 0);
        auto const normal = [&] { return double(rng.uniform() + rng.uniform() + rng.uniform() - 1.5f) * 2; };
        std::map<int, std::vector<double>> means;
        for (int frame = 0; frame < 16; ++frame) {
            ar::Pose pose = synthetic_pose(0.35);
            pose.position_m += 5e-4 * glm::dvec3(normal(), normal(), normal());
            glm::dvec3 const axis(normal(), normal(), normal());
            pose.rotation =
                glm::normalize(pose.rotation * glm::dquat(1, 2.5e-4 * axis.x, 2.5e-4 * axis.y, 2.5e-4 * axis.z));
            PairPictures const p = renderer.render(gi_camera(half, pose), 320, 240, 1, 0, {}, {});
            for (int k : {0, 1, 2, 4, 5})
                if (glm::dot(glm::dvec3(kAxes[k]), pose.position_m - glm::dvec3(0, 0.1, 0)) > 0.2)
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
    PairRenderer renderer(join_scenes({}, box({-0.1f, 0, -0.1f}, {0.1f, 0.2f, 0.1f}, matt(0.5f)), gi::dmat4(1)),
                          {}, report);
    renderer.choose(PairLight::prefiltered);
    ar::CameraModel camera = synthetic_camera({160, 120}).model;
    camera.lens = ar::LensModel::pinhole;
    ar::Pose const pose = synthetic_pose(0.35);
    for (int const column : {4, 20, 36, 52}) {
        cv::Mat map = uniform(0.05);
        cv::rectangle(map, {column, 10, 2, 2}, cv::Scalar(40, 60, 80), cv::FILLED);
        renderer.set_environment(environment(map));
        PairPictures const p = renderer.render(gi_camera(camera, pose), 160, 120, 1, 0, {}, {});
        double const top = face_mean(p.with, camera, pose, {0, 1, 0});
        double const wanted = 0.5 / gi::kPiD * ar::irradiance_exact(map, {0, 1, 0})[1];
        EXPECT_NEAR(top / wanted, 1, 0.02) << column;
    }
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
    auto const why = [&](gi::Scene real, gi::Scene things, PairLight light) {
        PairRenderer renderer(join_scenes(std::move(real), std::move(things), gi::dmat4(1)), {}, report);
        return renderer.choose(light);
    };
    gi::Scene const things = box({-0.1f, 0, -0.1f}, {0.1f, 0.2f, 0.1f}, matt(0.5f));
    EXPECT_EQ(why(floor(1, matt(0.5f)), things, PairLight::automatic), "");
    EXPECT_NE(why(floor(1, matt(0.5f)), things, PairLight::paths), "");
    EXPECT_EQ(why(floor(1, matt(0.5f)), box(gi::vec3(0), gi::vec3(1), glass), PairLight::automatic),
              "surfaces are glass");
    EXPECT_EQ(why(floor(1, mirror), things, PairLight::automatic), "real surfaces are mirrors");
    EXPECT_EQ(why(floor(1, matt(0.5f)), box(gi::vec3(0), gi::vec3(1), mirror), PairLight::automatic),
              "virtual objects are mirrors");
    EXPECT_THROW(why(floor(1, mirror), things, PairLight::prefiltered), gi::InputError);
    gi::Material lamp = matt(0);
    lamp.emission = gi::vec3(1);
    EXPECT_EQ(why(floor(1, lamp), things, PairLight::automatic), "surfaces emit light");
}

} // namespace
} // namespace viewer::test
