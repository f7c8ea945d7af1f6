// The light found again from the irradiance of known surfaces, some of them in the shadow of a wall.

#include "ar/light/lamps.h"
#include "ar/light/lat_long.h"
#include "ar/light/light_fit.h"
#include "ar/light/nonnegative.h"
#include "gi/core/error.h"
#include "gi/core/rng.h"

#include <gtest/gtest.h>
#include <numbers>

namespace ar::test {
namespace {

TEST(NonNegative, SolvesWithBoundsAsKarushKuhnAndTuckerDemand)
{
    gi::Pcg32 rng(3, 1);
    constexpr int n = 12;
    cv::Mat a(30, n, CV_64F), q;
    std::vector<double> g(n), lower(n, 0.0);
    for (int i = 0; i < a.rows; ++i)
        for (int j = 0; j < n; ++j) a.at<double>(i, j) = rng.uniform_double() - 0.4;
    cv::mulTransposed(a, q, true);
    for (double& v : g) v = 4 * rng.uniform_double() - 2;
    lower[4] = 0.7;
    std::vector<double> const x = solve_nonnegative(q, g, lower);
    int bound = 0;
    for (int i = 0; i < n; ++i) {
        double slope = -g[std::size_t(i)];
        for (int j = 0; j < n; ++j) slope += q.at<double>(i, j) * x[std::size_t(j)];
        bool const at_bound = x[std::size_t(i)] <= lower[std::size_t(i)];
        bound += at_bound;
        EXPECT_GE(x[std::size_t(i)], lower[std::size_t(i)]);
        if (at_bound)
            EXPECT_GT(slope, -1e-4);
        else
            EXPECT_NEAR(slope, 0, 1e-4);
    }
    EXPECT_GT(bound, 0);
    EXPECT_LT(bound, n);
}

TEST(LightBasis, CoversTheSphereEvenly)
{
    LightBasis const basis(256);
    for (glm::dvec3 const n : {glm::dvec3(1, 0, 0), glm::dvec3(0, -1, 0), glm::normalize(glm::dvec3(1, 2, -3))}) {
        double sum = 0;
        for (int k = 0; k < basis.count(); ++k)
            sum += basis.cell_sr() * std::max(0.0, glm::dot(n, basis.direction(k)));
        EXPECT_NEAR(sum, std::numbers::pi, 0.02);
        EXPECT_GT(glm::dot(basis.direction(basis.nearest(n)), n), std::cos(2 * basis.cell_radius_rad()));
    }
    EXPECT_NEAR(2.0 * double(basis.neighbours().size()) / basis.count(), 6, 1);
    EXPECT_THROW(LightBasis(3), gi::InputError);
}

/// A wall hides what is beyond x > 0 from points at its foot, more of it the nearer they are.
struct Place {
    glm::dvec3 normal;
    double distance_m; ///< from a wall 1 m high and wide without end
    bool sees(glm::dvec3 d) const { return !(d.x > 0 && d.y < d.x / std::max(1e-3, distance_m)); }
};

class LightFromShading : public testing::Test {
protected:
    LightFromShading() : basis_(200)
    {
        gi::Pcg32 rng(7, 2);
        for (int i = 0; i < 600; ++i) {
            Place p{{0, 1, 0}, 3.0 * rng.uniform_double()};
            if (i % 3 == 1) p = {glm::normalize(glm::dvec3(rng.uniform() - 0.5, 0.3, 1)), 1e3};
            if (i % 3 == 2) p = {glm::normalize(glm::dvec3(-1, 0.3, rng.uniform() - 0.5)), 1e3};
            places_.push_back(p);
        }
    }

    /// @param sun  irradiance of a face turned to it
    LightRows rows(cv::Mat const& sky, glm::dvec3 sun_towards, cv::Vec3d sun)
    {
        LightRows r;
        r.direct = cv::Mat::zeros(int(places_.size()), basis_.count(), CV_32F);
        for (cv::Mat& m : r.by_surfaces) m = cv::Mat::zeros(r.direct.size(), CV_32F);
        r.of_disc = [this](glm::dvec3 towards, double) {
            std::vector<float> out;
            for (Place const& p : places_)
                out.push_back(p.sees(towards) ? float(std::max(0.0, glm::dot(p.normal, towards))) : 0.0f);
            return out;
        };
        std::vector<float> const lit = r.of_disc(sun_towards, 0);
        gi::Pcg32 rng(1, 9);
        for (std::size_t i = 0; i < places_.size(); ++i) {
            cv::Vec3d e = double(lit[i]) * sun;
            for (int k = 0; k < basis_.count(); ++k) {
                glm::dvec3 const d = basis_.direction(k);
                double const t =
                    places_[i].sees(d) ? basis_.cell_sr() * std::max(0.0, glm::dot(places_[i].normal, d)) : 0;
                r.direct.at<float>(int(i), k) = float(t);
                e += t * cv::Vec3d(sample(sky, d));
            }
            r.irradiance.push_back(e * (1 + 0.02 * (rng.uniform_double() - 0.5)));
            r.sigma.push_back(0.01 * e + cv::Vec3d::all(1e-3));
        }
        return r;
    }

    LightBasis basis_;
    std::vector<Place> places_;
};

cv::Mat sky()
{
    cv::Mat map(16, 32, CV_32FC3);
    for (int j = 0; j < map.rows; ++j)
        map.row(j).setTo(j < 8 ? cv::Scalar(0.6, 0.8, 1.2) : cv::Scalar(0.2, 0.17, 0.15));
    return map;
}

TEST_F(LightFromShading, FindsTheSunByItsShadow)
{
    glm::dvec3 const sun = glm::normalize(glm::dvec3(0.6, 0.7, 0.4));
    cv::Vec3d const power(6, 5.5, 4.5);
    LightFit const fit = fit_light(basis_, rows(sky(), sun, power));
    auto const found = dominant_lamp(fit);
    ASSERT_TRUE(found);
    EXPECT_LT(glm::degrees(std::acos(glm::dot(found->direction, sun))),
              2.5); // one shadow tells one angle, shading the other
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(found->irradiance[c] / power[c], 1, 0.08);
    EXPECT_GT(fit.residual_without_lamps, 2 * fit.residual);
    cv::Mat const map = map_of(basis_, fit, {128, 64});
    cv::Vec3d const truth = irradiance_exact(sky(), {0, 1, 0}) + sun.y * power;
    cv::Vec3d const up = irradiance_exact(map, {0, 1, 0});
    for (int c = 0; c < 3; ++c) EXPECT_NEAR(up[c] / truth[c], 1, 0.02);
}

TEST_F(LightFromShading, SeesNoSunWhereNoneIs)
{
    LightFit const fit = fit_light(basis_, rows(sky(), {0, 1, 0}, {0, 0, 0}));
    EXPECT_TRUE(fit.lamps.empty());
    EXPECT_FALSE(dominant_lamp(fit));
}

TEST_F(LightFromShading, KnowsWhatItDoesNotKnow)
{
    LightFit const fit = fit_light(basis_, rows(sky(), glm::normalize(glm::dvec3(0.6, 0.7, 0.4)), {6, 5, 4}));
    // No surface faces down, or +x away from the wall.
    EXPECT_GT(irradiance_sigma(basis_, fit, {0, -1, 0}) /
                  luminance(irradiance_exact(map_of(basis_, fit, {64, 32}), {0, -1, 0})),
              5 * irradiance_sigma(basis_, fit, {0, 1, 0}) /
                  luminance(irradiance_exact(map_of(basis_, fit, {64, 32}), {0, 1, 0})));
    EXPECT_LT(fit.known[std::size_t(basis_.nearest(glm::normalize(glm::dvec3(0.3, -1, -0.3))))], 0.2f);
}

TEST_F(LightFromShading, TakesWhatTheCameraSees)
{
    LightRows r = rows(sky(), {0, 1, 0}, {0, 0, 0});
    r.seen.resize(std::size_t(basis_.count()));
    int const below = basis_.nearest({0, -1, 0}), clipped = basis_.nearest(glm::normalize(glm::dvec3(0, -1, 1)));
    r.seen[std::size_t(below)] = {{0.5, 0.4, 0.3}, 1, false};
    r.seen[std::size_t(clipped)] = {{0.9, 0.9, 0.9}, 1, true};
    LightFit const fit = fit_light(basis_, r);
    EXPECT_NEAR(fit.radiance.at<cv::Vec3f>(below)[0], 0.5, 0.05);
    EXPECT_NEAR(fit.radiance.at<cv::Vec3f>(below)[2], 0.3, 0.03);
    EXPECT_GE(fit.radiance.at<cv::Vec3f>(clipped)[1], 0.9f);
    EXPECT_GT(fit.known[std::size_t(below)], 0.7f);
}

TEST_F(LightFromShading, RefusesTooFewPixelsAndDarkness)
{
    LightRows r = rows(sky(), {0, 1, 0}, {0, 0, 0});
    LightRows few = r;
    few.irradiance.resize(20);
    EXPECT_THROW(fit_light(basis_, few), gi::InputError);
    for (cv::Vec3d& e : r.irradiance) e = {0, 0, 0};
    EXPECT_THROW(fit_light(basis_, r), gi::InputError);
}

TEST(LightMap, KeepsTheLightOfLampsSmallerThanATexel)
{
    LightBasis const basis(64);
    LightFit fit;
    fit.radiance = cv::Mat(64, 1, CV_32FC3, cv::Scalar(0, 0, 0));
    fit.lamps.push_back({glm::normalize(glm::dvec3(0.1, 1, 0.3)), 0.0047, {3, 2, 1}, {}, 1});
    fit.lamps.push_back({{0, 0, 1}, 0.3, {1, 1, 1}, {}, 1});
    for (cv::Size const size : {cv::Size(64, 32), cv::Size(256, 128)}) {
        cv::Vec3d const all = integral(map_of(basis, fit, size));
        EXPECT_NEAR(all[0], 4, 1e-3);
        EXPECT_NEAR(all[2], 2, 1e-3);
    }
}

} // namespace
} // namespace ar::test
