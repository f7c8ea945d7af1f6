#include "ar/light/live_probe.h"

#include "ar/camera/photometry.h"
#include "gi/core/error.h"
#include "gi/core/rotation.h"
#include "tests/ar_light/environments.h"
#include "tests/ar_light/irradiance_maps.h"

#include <chrono>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <numbers>
#include <random>

namespace ar::test {
namespace {

CameraModel camera()
{
    return {LensModel::radial_tangential, {320, 240}, 262, 262, 159, 121, {-0.2, 0.05, 0, 0, 0}};
}

glm::dquat looking(double turn_deg, double up_deg)
{
    return gi::exp_rotation({0, glm::radians(turn_deg), 0}) * glm::dquat(0, 1, 0, 0) *
           gi::exp_rotation({glm::radians(up_deg), 0, 0});
}

cv::Mat seen(Environment const& light, glm::dquat const& world_from_camera, double scale = 1)
{
    static std::vector<glm::dvec3> const rays = [] {
        CameraModel const c = camera();
        std::vector<glm::dvec3> all;
        for (int k = 0; k < c.size_px.x * c.size_px.y; ++k)
            all.push_back(*direction_of(c, {k % c.size_px.x, k / c.size_px.x}));
        return all;
    }();
    cv::Mat picture(camera().size_px.y, camera().size_px.x, CV_32FC3);
    for (std::size_t k = 0; k < rays.size(); ++k)
        picture.ptr<cv::Vec3f>()[k] = cv::Vec3f(scale * light(world_from_camera * rays[k]));
    return picture;
}

/// Once around, some frames up and down.
void look_around(LiveProbe& probe, Environment const& light, double from_s, double scale = 1)
{
    int i = 0;
    for (double const up : {-50.0, 0.0, 50.0})
        for (int turn = 0; turn < 360; turn += 40, ++i) {
            glm::dquat const q = looking(turn, up);
            probe.update(seen(light, q, scale), {}, camera(), q, from_s + 0.1 * i);
        }
}

double irradiance_error(cv::Mat const& map, cv::Mat const& truth)
{
    return relative_error2(irradiance_map(map), irradiance_map(resampled(truth, map.size())));
}

Environment const kLit = with_discs(kRoom, {{{0.3, 0.5, -0.8}, 0.15, 8}});

TEST(LiveProbe, LearnsWhatItLooksAt)
{
    cv::Mat const truth = drawn({256, 128}, kLit);
    LiveProbe probe;
    look_around(probe, kLit, 0);
    double const error = irradiance_error(probe.map(), truth);
    fmt::print("looked around without a prior: relMSE of irradiance {:.5f}\n", error);
    EXPECT_LT(error, 0.005);
    cv::Mat const age = probe.age_s();
    double least = 0;
    cv::minMaxLoc(age, &least);
    EXPECT_EQ(least, 0);
    double most = 0;
    cv::minMaxLoc(probe.confidence(), nullptr, &most);
    EXPECT_LE(most, 1);
}

TEST(LiveProbe, ScalesThePriorWhereItDoesNotLook)
{
    cv::Mat const then = drawn({256, 128}, kLit);
    LiveProbe probe(then);
    EXPECT_LT(irradiance_error(probe.map(), then), 1e-4);
    // The light is dimmed and redder now: all directions by the same share, but only some are seen.
    Environment const now = [](glm::dvec3 d) { return kLit(d).mul(cv::Vec3d(0.5, 0.4, 0.3)); };
    ProbeUpdate u;
    for (int i = 0; i < 5; ++i) {
        glm::dquat const q = looking(10.0 * i, 0);
        u = probe.update(seen(now, q), {}, camera(), q, 0.1 * i);
    }
    EXPECT_LT(u.known_share, 0.5);
    double const error = irradiance_error(probe.map(), drawn({256, 128}, now));
    fmt::print(
        "prior of another brightness, {:.0f} % of the sphere known: scale {:.3f} {:.3f} {:.3f}, relMSE {:.6f}\n",
        100 * u.known_share, probe.prior_scale()[0], probe.prior_scale()[1], probe.prior_scale()[2], error);
    EXPECT_NEAR(probe.prior_scale()[0], 0.5, 0.01);
    EXPECT_NEAR(probe.prior_scale()[2], 0.3, 0.01);
    EXPECT_LT(error, 0.001);
}

TEST(LiveProbe, DoesNotCareForTheExposure)
{
    cv::Mat const prior = drawn({128, 64}, kRoom);
    Photometry const p = srgb_photometry();
    Photometry reference = p;
    reference.reference = {0.01, 1, 0, 0};
    std::vector<cv::Mat> maps;
    for (bool const changes : {false, true}) {
        LiveProbe probe(prior);
        for (int i = 0; i < 12; ++i) {
            glm::dquat const q = looking(15.0 * i, 5);
            Exposure const e{changes ? 0.01 * std::pow(0.8, i % 5) : 0.01, changes && i % 2 ? 0.7 : 1.0, 0, 0};
            cv::Mat const rgb = bytes_of(seen(kRoom, q, 0.8), reference, e);
            ProbeUpdate const u =
                probe.update(radiance_of(rgb, reference, e), is_clipped(rgb), camera(), q, 0.1 * i);
            EXPECT_FALSE(u.lamp_changed);
            EXPECT_EQ(u.changed_texels, 0);
        }
        maps.push_back(probe.map());
    }
    double const differ = cv::norm(maps[0], maps[1], cv::NORM_INF) / cv::norm(maps[0], cv::NORM_INF);
    fmt::print("exposures from 1 to 0.29: the map differs by {:.2f} % of its brightest, bytes of sRGB\n",
               100 * differ);
    EXPECT_LT(differ, 0.01);
}

TEST(LiveProbe, FollowsAnExposureThatIsNotTold)
{
    cv::Mat const prior = drawn({128, 64}, kRoom);
    LiveProbeSettings settings;
    settings.exposure = ExposureKnowledge::unknown;
    LiveProbe probe(prior, settings);
    for (int i = 0; i < 12; ++i) {
        glm::dquat const q = looking(8.0 * i, 5);
        double const gain = std::pow(1.3, i % 4);
        ProbeUpdate const u = probe.update(seen(kRoom, q, gain), {}, camera(), q, 0.1 * i);
        EXPECT_NEAR(u.gain * gain, 1, 0.02) << i;
        EXPECT_EQ(u.changed_texels, 0);
    }
    EXPECT_LT(irradiance_error(probe.map(), prior), 0.001);
}

TEST(LiveProbe, NoticesALampThatIsSwitchedOnOrMoved)
{
    std::mt19937 random(5);
    std::normal_distribution<float> noise(0, 0.02f);
    LiveProbe probe(drawn({128, 64}, kRoom));
    auto const show = [&](Environment const& light, double t) {
        glm::dquat const q = looking(0, 10);
        cv::Mat picture = seen(light, q);
        for (auto& v : cv::Mat_<cv::Vec3f>(picture))
            for (float& c : v.val) c = std::max(0.0f, c * (1 + noise(random)));
        return probe.update(picture, {}, camera(), q, t);
    };
    double t = 0;
    for (int i = 0; i < 20; ++i, t += 0.033) {
        ProbeUpdate const u = show(kRoom, t);
        EXPECT_FALSE(u.lamp_changed);
        EXPECT_LT(u.change, 0.01);
    }
    Environment const on = with_discs(kRoom, {{{0.1, 0.2, -1}, 0.1, 60}}),
                      moved = with_discs(kRoom, {{{-0.3, 0.2, -1}, 0.1, 60}});
    ProbeUpdate const switched = show(on, t += 0.033);
    EXPECT_TRUE(switched.lamp_changed);
    EXPECT_GT(switched.change, 0.5);
    EXPECT_NEAR(sample(probe.map(), glm::normalize(glm::dvec3(0.1, 0.2, -1)))[1], 50,
                20); // at once, not bit by bit
    for (int i = 0; i < 5; ++i) EXPECT_FALSE(show(on, t += 0.033).lamp_changed);
    EXPECT_TRUE(show(moved, t += 0.033).lamp_changed);
    EXPECT_LT(sample(probe.map(), glm::normalize(glm::dvec3(0.1, 0.2, -1)))[1], 2);
    EXPECT_TRUE(show(kRoom, t += 0.033).lamp_changed);
    fmt::print("lamp switched on: change {:.2f}, {} texels\n", switched.change, switched.changed_texels);
}

TEST(LiveProbe, DoesNotTakeClippedLampsForDimOnes)
{
    cv::Mat const prior = drawn({256, 128}, with_discs(kRoom, {{{0.1, 0.2, -1}, 0.12, 60}}));
    LiveProbe probe(prior);
    Photometry const p = srgb_photometry();
    glm::dquat const q = looking(0, 10);
    Environment const lit = with_discs(kRoom, {{{0.1, 0.2, -1}, 0.12, 60}});
    for (int i = 0; i < 10; ++i) {
        cv::Mat const rgb = bytes_of(seen(lit, q), p);
        ProbeUpdate const u = probe.update(radiance_of(rgb, p), is_clipped(rgb), camera(), q, 0.033 * i);
        EXPECT_GT(u.clipped, 0u);
    }
    EXPECT_LT(irradiance_error(probe.map(), prior), 0.02);
}

TEST(LiveProbe, RefusesWhatDoesNotFitAndCountsWhatIsNotFinite)
{
    LiveProbe probe;
    cv::Mat picture = seen(kRoom, looking(0, 0));
    EXPECT_THROW(probe.update(picture.colRange(0, 100), {}, camera(), looking(0, 0), 0), gi::InputError);
    EXPECT_THROW(probe.update(picture, cv::Mat::zeros(3, 3, CV_8UC1), camera(), looking(0, 0), 0), gi::InputError);
    EXPECT_THROW(probe.update(picture, {}, camera(), looking(0, 0), NAN), gi::InputError);
    EXPECT_THROW(LiveProbe(cv::Mat(3, 3, CV_32FC3, cv::Scalar(1, 1, 1))), gi::InputError);
    LiveProbeSettings none;
    none.step_px = 0;
    EXPECT_THROW(LiveProbe({}, none), gi::InputError);
    picture.setTo(cv::Scalar(NAN, 1, 1));
    picture.at<cv::Vec3f>(2, 2) = {1, 1, 1};
    ProbeUpdate const u = probe.update(picture, {}, camera(), looking(0, 0), 0);
    EXPECT_EQ(u.refused, 80u * 60 - 1);
    for (auto const& v : cv::Mat_<cv::Vec3f>(probe.map())) EXPECT_TRUE(std::isfinite(v[0]));
}

TEST(LiveProbe, CostsLittle)
{
    CameraModel const c{LensModel::radial_tangential, {640, 480}, 525, 525, 319, 239, {-0.2, 0.05, 0, 0, 0}};
    cv::Mat const picture(480, 640, CV_32FC3, cv::Scalar(1, 2, 3));
    LiveProbe probe(drawn({128, 64}, kRoom));
    std::vector<double> ms;
    for (int i = 0; i < 40; ++i) {
        auto const start = std::chrono::steady_clock::now();
        ProbeUpdate const u = probe.update(picture, {}, c, looking(3.0 * i, 0), 0.033 * i);
        ms.push_back(std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
        EXPECT_EQ(u.samples, 160u * 120);
    }
    std::sort(ms.begin(), ms.end());
    fmt::print("a frame of 640 x 480, every 4th pixel: median {:.2f} ms, least {:.2f} ms\n", ms[20], ms[0]);
}

} // namespace
} // namespace ar::test
