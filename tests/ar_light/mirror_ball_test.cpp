#include "ar/light/mirror_ball.h"

#include "ar/light/lamps.h"
#include "gi/core/error.h"
#include "gi/core/rotation.h"
#include "tests/ar_light/environments.h"
#include "tests/ar_light/irradiance_maps.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <numbers>

namespace ar::test {
namespace {

constexpr double kRadius = 0.1;
std::vector<Disc> const kBallDiscs{
    {{0.3, 0.9, 0.2}, 0.06, 60}, {{-1, 0.2, 0.4}, 0.05, 60}, {{0.5, 0.4, 0.9}, 0.05, 50}};

/// A camera that shows the ball with a radius of about 110 px, off the middle, and where it stands.
struct Shot {
    CameraModel camera;
    gi::RigidPose world_from_camera;
};

Shot shot(double distance, double turn_rad, LensModel lens = LensModel::radial_tangential)
{
    double const f = 110 / std::tan(std::asin(kRadius / distance));
    Shot s{{lens, {420, 320}, f, f * 1.003, 207, 162, {}}, {}};
    if (lens == LensModel::radial_tangential) s.camera.distortion = {-0.1, 0.03, 0.0005, -0.0004, 0};
    // OpenCV's axes in a world with y up, seen from the south, turned about y; the ball is a little aside.
    glm::dquat const level(0, 1, 0, 0);
    s.world_from_camera.rotation = gi::exp_rotation({0, turn_rad, 0}) * level * gi::exp_rotation({0.05, 0, 0.1});
    auto const aside = direction_of(s.camera, {245, 140});
    s.world_from_camera.position = -(s.world_from_camera.rotation * (distance * *aside));
    return s;
}

/// What the camera sees of a ball at the origin: 3 x 3 rays per pixel, one reflection,
/// the surround behind or a sheet of paper.
cv::Mat traced(Shot const& s, Environment const& light, double reflectivity, bool sheet)
{
    int const n = 3;
    cv::Mat picture(s.camera.size_px.y, s.camera.size_px.x, CV_32FC3);
    glm::dvec3 const eye = s.world_from_camera.position;
    for (int y = 0; y < picture.rows; ++y)
        for (int x = 0; x < picture.cols; ++x) {
            cv::Vec3d sum(0, 0, 0);
            bool const near = glm::length(glm::dvec2(x - 245, y - 140)) < 145;
            for (int k = 0; k < n * n; ++k) {
                glm::dvec2 const p(x - 0.5 + (k % n + 0.5) / n, y - 0.5 + (k / n + 0.5) / n);
                if (!near && k > 0) {
                    sum += sum / k;
                    continue;
                }
                glm::dvec3 const d = s.world_from_camera.rotation * *direction_of(s.camera, p);
                double const b = glm::dot(eye, d), c = glm::dot(eye, eye) - kRadius * kRadius;
                if (b * b - c > 0) {
                    glm::dvec3 const at = eye + (-b - std::sqrt(b * b - c)) * d;
                    sum += reflectivity * light(glm::reflect(d, at / kRadius));
                } else {
                    sum += sheet ? cv::Vec3d(0.9, 0.85, 0.8) : light(d);
                }
            }
            picture.at<cv::Vec3f>(y, x) = cv::Vec3f(sum / (n * n));
        }
    return picture;
}

BallSight truth(Shot const& s) { return *predicted_ball(s.world_from_camera, {0, 0, 0}, kRadius); }

double between_deg(glm::dvec3 a, glm::dvec3 b)
{
    return glm::degrees(std::acos(std::clamp(glm::dot(glm::normalize(a), glm::normalize(b)), -1.0, 1.0)));
}

/// How far the lamp of `map` that is nearest to the disc is from it.
double nearest_deg(std::vector<Lamp> const& lamps, Disc const& disc)
{
    double best = 180;
    for (Lamp const& l : lamps) best = std::min(best, between_deg(l.direction, disc.direction));
    return best;
}

TEST(MirrorBall, GivesBackTheSurroundFromAnyDistance)
{
    Environment const light = with_discs(kRoom, kBallDiscs);
    cv::Mat const true_irradiance = irradiance_map(drawn({256, 128}, light), {16, 8}, IrradianceBy::exact_sum);
    for (double const distance : {0.3, 1.0, 4.0}) {
        Shot const s = shot(distance, 0.2);
        BallSettings settings;
        settings.size = {256, 128};
        settings.reflectivity = cv::Vec3d::all(0.6);
        settings.camera_half_angle_rad = 1e-3;
        PartialMap const seen =
            unwrap_ball(traced(s, light, 0.6, false), s.camera, s.world_from_camera.rotation, truth(s), settings);
        FilledMap const f = filled(seen);
        double const error =
            relative_error2(irradiance_map(f.radiance, {16, 8}, IrradianceBy::exact_sum), true_irradiance);
        auto const lamps = split_lamps(f.radiance).lamps;
        double worst = 0;
        for (Disc const& d : kBallDiscs) worst = std::max(worst, nearest_deg(lamps, d));
        fmt::print(
            "ball at {:.1f} m: {:.1f} % of the sphere, relMSE of irradiance {:.1e}, lamps within {:.3f} deg\n",
            distance, 100 * covered_share(seen), error, worst);
        EXPECT_LT(error, 0.02);
        EXPECT_LT(worst, 1);
        EXPECT_EQ(lamps.size(), kBallDiscs.size());
        EXPECT_GT(covered_share(seen), distance < 0.5 ? 0.92 : 0.97);
        EXPECT_NEAR(covered_share(seen) + f.filled_share, 1, 1e-9);
    }
}

TEST(MirrorBall, IsNotTheOrthographicOne)
{
    // Near the camera the orthographic rule would be degrees off: the lamp of a picture unwrapped so is elsewhere.
    Shot const s = shot(0.3, 0.2);
    Environment const light = with_discs(kRoom, {kBallDiscs[1]});
    cv::Mat const picture = traced(s, light, 1, false);
    BallSight flat = truth(s);
    CameraModel far = s.camera; // the same pixels as from far away
    double const shrink = 1e-3;
    far.lens = LensModel::pinhole;
    far.fx /= shrink;
    far.fy /= shrink;
    flat.axis =
        glm::normalize(glm::dvec3(flat.axis.x / flat.axis.z * shrink, flat.axis.y / flat.axis.z * shrink, 1));
    flat.half_angle_rad = std::atan(std::tan(flat.half_angle_rad) * shrink);
    auto const lamps =
        split_lamps(filled(unwrap_ball(picture, far, s.world_from_camera.rotation, flat)).radiance).lamps;
    EXPECT_GT(nearest_deg(lamps, kBallDiscs[1]), 1);
}

TEST(MirrorBall, TwoPicturesLeaveNoHole)
{
    Environment const light = with_discs(kRoom, kBallDiscs);
    cv::Mat const true_irradiance = irradiance_map(drawn({256, 128}, light), {16, 8}, IrradianceBy::exact_sum);
    std::vector<PartialMap> seen;
    for (double const turn : {0.2, 0.2 + std::numbers::pi / 2}) {
        Shot const s = shot(0.8, turn);
        BallSettings settings;
        settings.size = {256, 128};
        seen.push_back(
            unwrap_ball(traced(s, light, 1, false), s.camera, s.world_from_camera.rotation, truth(s), settings));
    }
    PartialMap const both = merged(seen);
    double const error =
        relative_error2(irradiance_map(filled(both).radiance, {16, 8}, IrradianceBy::exact_sum), true_irradiance);
    fmt::print("one picture covers {:.1f} %, two {:.2f} %; relMSE of irradiance {:.1e}\n",
               100 * covered_share(seen[0]), 100 * covered_share(both), error);
    EXPECT_GT(covered_share(both), 0.999);
    EXPECT_LT(error, 0.005);
}

class Found : public testing::TestWithParam<double> {};
INSTANTIATE_TEST_SUITE_P(At, Found, testing::Values(0.3, 1.0, 4.0),
                         [](auto const& p) { return fmt::format("{}cm", int(100 * p.param)); });

TEST_P(Found, BallIsWhereItIsToAFractionOfAPixel)
{
    Shot const s = shot(GetParam(), 0.2);
    cv::Mat const picture = traced(s, with_discs(kRoom, kBallDiscs), 0.6, true);
    BallSight const is = truth(s);
    auto const check = [&](BallSight const& found, char const* how) {
        double const f = s.camera.fx;
        double const off_px = f * std::tan(std::acos(std::min(1.0, glm::dot(found.axis, is.axis))));
        double const radius_px = f * (std::tan(found.half_angle_rad) - std::tan(is.half_angle_rad));
        fmt::print("{}: {:.3f} px off, radius {:+.3f} px, rim {:.2f} px rms in {} places\n", how, off_px,
                   radius_px, found.rms_px, found.rim_points);
        EXPECT_LT(off_px, 0.3);
        EXPECT_LT(std::abs(radius_px), 0.3);
        EXPECT_NEAR(ball_distance_m(found, kRadius), GetParam(), 0.003 * GetParam());
    };
    check(find_ball(picture, s.camera, ball_of_circle(s.camera, {249, 137}, 117)), "given a circle");
    BallSight const found = find_ball(picture, s.camera);
    check(found, "by itself");
    BallSettings settings;
    settings.size = {256, 128};
    settings.reflectivity = cv::Vec3d::all(0.6);
    FilledMap const f = filled(unwrap_ball(picture, s.camera, s.world_from_camera.rotation, found, settings));
    cv::Mat const map = drawn({256, 128}, with_discs(kRoom, kBallDiscs));
    double const error = relative_error2(irradiance_map(f.radiance), irradiance_map(map));
    double worst = 0;
    auto const lamps = split_lamps(f.radiance).lamps;
    for (Disc const& d : kBallDiscs) worst = std::max(worst, nearest_deg(lamps, d));
    fmt::print("unwrapped as found: relMSE of irradiance {:.1e}, lamps within {:.2f} deg\n", error, worst);
    EXPECT_LT(error, 0.02);
    EXPECT_LT(worst, 1);
    cv::Mat bytes;
    picture.convertTo(bytes, CV_8UC3, 200);
    check(find_ball(bytes, s.camera), "in bytes");
}

TEST(MirrorBall, ThatIsNotThereIsAnError)
{
    Shot const s = shot(1, 0);
    cv::Mat const flat(320, 420, CV_32FC3, cv::Scalar(0.5, 0.5, 0.5));
    EXPECT_THROW(find_ball(flat, s.camera), gi::InputError);
    EXPECT_THROW(find_ball(flat, s.camera, truth(s)), gi::InputError);
    EXPECT_THROW(ball_of_circle(s.camera, {100, 100}, -3), gi::InputError);
    EXPECT_FALSE(predicted_ball(s.world_from_camera, {0, 0, 0}, 3));
    EXPECT_FALSE(predicted_ball(s.world_from_camera, 3.0 * s.world_from_camera.position, kRadius));
    BallSettings black;
    black.reflectivity[1] = 0;
    EXPECT_THROW(unwrap_ball(flat, s.camera, {1, 0, 0, 0}, truth(s), black), gi::InputError);
    EXPECT_THROW(unwrap_ball(cv::Mat(), s.camera, {1, 0, 0, 0}, truth(s)), gi::InputError);
    cv::Mat bad = flat.clone();
    bad.at<cv::Vec3f>(2, 2)[0] = std::nanf("");
    EXPECT_THROW(unwrap_ball(bad, s.camera, {1, 0, 0, 0}, truth(s)), gi::InputError);
}

TEST(MirrorBall, PartlyOutsideThePictureCoversLess)
{
    Shot s = shot(1, 0.2);
    BallSight const is = truth(s);
    cv::Mat const picture = traced(s, kRoom, 1, false);
    double const whole = covered_share(unwrap_ball(picture, s.camera, s.world_from_camera.rotation, is));
    s.camera.cx -= 230; // as if the picture had been cut
    double const cut = covered_share(unwrap_ball(picture, s.camera, s.world_from_camera.rotation, is));
    EXPECT_LT(cut, 0.75 * whole);
    EXPECT_GT(cut, 0.2);
}

} // namespace
} // namespace ar::test
