#include "ar/camera/lens_domain.h"

#include "gi/core/error.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numbers>

namespace ar::test {
namespace {

CameraModel with(LensModel lens, std::array<double, 8> distortion, glm::ivec2 size_px = {640, 480}, double f = 300)
{
    return {lens, size_px, f, f, 0.5 * (size_px.x - 1), 0.5 * (size_px.y - 1), distortion};
}

struct Case {
    char const* name;
    LensModel lens;
    std::array<double, 8> distortion;
    double radius;
    DomainEnd end;
};

TEST(LensDomain, EndsAtTheFirstPoleOrFold)
{
    double const inf = 1e3;
    for (Case const& c : {
             Case{"none", LensModel::pinhole, {}, inf, DomainEnd::none},
             Case{"pincushion", LensModel::radial_tangential, {0.2, 0.1}, inf, DomainEnd::none},
             // r (1 - 0.3 r^2): 1 = 0.9 r^2
             Case{"barrel", LensModel::radial_tangential, {-0.3}, 1 / std::sqrt(0.9), DomainEnd::fold},
             // r (1 + k1 r^2 + k2 r^4) with a slope of (1 - u)(4 - u) / 4: folds at 1, and grows again from 2 on
             Case{"folds twice", LensModel::radial_tangential, {-5. / 12, 1. / 20}, 1, DomainEnd::fold},
             Case{"pole", LensModel::rational, {0, 0, 0, 0, 0, -0.25}, 2, DomainEnd::pole},
             // r (1 - r^2 / 0.99) / (1 - r^2): the fold before the pole is its edge
             Case{"pole of a hair", LensModel::rational, {-1 / 0.99, 0, 0, 0, 0, -1}, 0.9293, DomainEnd::pole},
             Case{"of denominators that stay positive",
                  LensModel::rational,
                  {0.4, 0.1, 0, 0, 0.02, 0.7, 0.2, 0.03},
                  inf,
                  DomainEnd::none},
             Case{"equidistant", LensModel::fisheye, {}, std::numbers::pi, DomainEnd::none},
             // a (1 - a^2 / 3)
             Case{"fisheye", LensModel::fisheye, {-1. / 3}, 1, DomainEnd::fold},
         }) {
        LensDomain const d = domain_of(with(c.lens, c.distortion));
        EXPECT_NEAR(d.radius, c.radius, 1e-3 * c.radius) << c.name;
        EXPECT_EQ(d.end, c.end) << c.name;
    }
}

TEST(LensDomain, NothingIsProjectedBeyond)
{
    CameraModel const barrel = with(LensModel::radial_tangential, {-0.3});
    EXPECT_TRUE(project(barrel, {1.05, 0, 1}));
    EXPECT_FALSE(project(barrel, {1.06, 0, 1}));
    EXPECT_FALSE(project(barrel, {50, 0, 1}));
    CameraModel const twice = with(LensModel::radial_tangential, {-5. / 12, 1. / 20});
    EXPECT_FALSE(project(twice, {3, 0, 1})) << "where it grows again";
    // All pixels with a ray come back, on one branch.
    for (int x = 320; x < 640; x += 7) {
        auto const d = direction_of(twice, {x, 240});
        if (!d) continue;
        EXPECT_LE(d->x / d->z, 1.001) << x;
        EXPECT_NEAR(project(twice, *d)->x, x, 1e-6);
    }
    CameraModel const fisheye = with(LensModel::fisheye, {-1. / 3});
    EXPECT_TRUE(project(fisheye, {std::sin(0.99), 0, std::cos(0.99)}));
    EXPECT_FALSE(project(fisheye, {std::sin(1.01), 0, std::cos(1.01)}));
}

TEST(LensDomain, PolesAndFoldsWithinThePictureAreRefused)
{
    auto const problem = [](CameraModel const& c) -> std::string {
        try {
            check(c, "c.yaml");
        } catch (gi::InputError const& e) {
            return e.what();
        }
        return {};
    };
    // As published in an issue of OpenCV's: the denominator is 0 at 0.8088, the corners are at 0.911.
    CameraModel pole =
        with(LensModel::rational,
             {2.9972164630889893, -6.0928826332092285, 0.0005746248061768711, -4.857033854932524e-05,
              -1.2618762254714966, 3.5340938568115234, -4.270793914794922, -5.302351951599121},
             {3840, 2180}, 2421.79);
    EXPECT_NE(problem(pole).find("its denominator is 0 within the picture, 0.8088 focal lengths"),
              std::string::npos)
        << problem(pole);
    pole.size_px = {1200, 900}; // a crop within the pole's ring
    pole.cx = 599.5;
    pole.cy = 449.5;
    EXPECT_EQ(problem(pole), "");
    EXPECT_NE(problem(with(LensModel::radial_tangential, {-0.3})).find("folds back"), std::string::npos);
    EXPECT_EQ(problem(with(LensModel::radial_tangential, {-0.05})), "");
    EXPECT_NE(problem(with(LensModel::rational, {-1 / 0.99, 0, 0, 0, 0, -1})).find("denominator"),
              std::string::npos);
}

TEST(LensDomain, FisheyesAreMarkedWhereTheyHold)
{
    // Equidistant, 320 / 100 rad to the sides: all of it has rays, most of it wide ones.
    LensReach const wide = reach_of(with(LensModel::fisheye, {}, {640, 480}, 160));
    EXPECT_EQ(wide.share, 1);
    EXPECT_NEAR(wide.widest_deg, glm::degrees(std::hypot(319.5, 239.5) / 160), 1e-6);
    EXPECT_GT(wide.share_wide, 0.2);
    // Folds at 1 rad: 220 px from the middle, as dark beyond as circular fisheyes are.
    CameraModel const circle = with(LensModel::fisheye, {-1. / 3}, {480, 480}, 330);
    LensReach const part = reach_of(circle);
    EXPECT_NEAR(part.share, std::numbers::pi * 220 * 220 / (480. * 480.), 0.05);
    EXPECT_NEAR(part.widest_deg, glm::degrees(1.), 5);
    EXPECT_EQ(part.share_wide, 0);
    check(circle, "circle.yaml");
    EXPECT_THROW(check(with(LensModel::fisheye, {-1. / 3}, {480, 480}, 150), "c.yaml"), gi::InputError);
}

} // namespace
} // namespace ar::test
