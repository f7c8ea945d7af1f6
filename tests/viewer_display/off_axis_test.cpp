// The frusta: what the eye sees of a wall is exactly the wall.

#include "gi/scene/model/projection.h"
#include "tests/viewer_display/display_samples.h"
#include "viewer/displays/views.h"

#include <limits>

namespace viewer::test {
namespace {

gi::dvec3 corner_point(WallFrame const& wall, int corner) { return wall.point(corner % 2, corner / 2); }

/// (u, v) of a point seen by the camera, in doubles.
glm::dvec2 seen_at(gi::Camera const& camera, gi::dvec3 point)
{
    gi::dmat4 const& m = camera.world_from_camera;
    gi::dvec3 const to = point - gi::dvec3(m[3]);
    double const depth = -glm::dot(to, gi::dvec3(m[2]));
    gi::ViewTangents const t = *camera.off_axis;
    return {(glm::dot(to, gi::dvec3(m[0])) / depth - t.left) / (t.right - t.left),
            (glm::dot(to, gi::dvec3(m[1])) / depth - t.bottom) / (t.top - t.bottom)};
}

/// How far the corners of a wall, seen by a camera, are from those of its picture, in shares of the picture.
struct Misses {
    double tangents = 0; ///< in doubles
    double pixels = 0;   ///< through gi::project, in floats
    double rays = 0;     ///< through gi::camera_rays: difference of unit directions
};

Misses misses_of(gi::Camera const& camera, WallFrame const& wall, gi::dvec3 eye)
{
    constexpr int kWidth = 1920, kHeight = 1200;
    gi::CameraRays const rays = gi::camera_rays(camera, kWidth, kHeight, eye);
    Misses worst;
    for (int corner = 0; corner < 4; ++corner) {
        gi::dvec3 const p = corner_point(wall, corner);
        glm::dvec2 const expected(corner % 2, corner / 2);
        gi::vec3 const pixel = gi::Projection(rays)(gi::vec3(p - eye));
        gi::Ray const ray = rays.through({float(expected.x * kWidth), float((1 - expected.y) * kHeight)});
        worst.tangents = std::max(worst.tangents, glm::length(seen_at(camera, p) - expected));
        worst.pixels = std::max(
            {worst.pixels, std::abs(pixel.x / kWidth - expected.x), std::abs(1 - pixel.y / kHeight - expected.y)});
        worst.rays = std::max(worst.rays, glm::length(gi::dvec3(ray.direction) - glm::normalize(p - eye)));
    }
    return worst;
}

TEST(OffAxis, CornersOfTenThousandWallsAreCornersOfTheirViewports)
{
    std::mt19937 random(7);
    std::uniform_real_distribution<double> aside(-1.5, 1.5), away(0.1, 2.5);
    Misses worst;
    for (int i = 0; i < 10000;) {
        WallFrame const wall = wall_frame(random_wall(random));
        double const aspect = wall.width_m / wall.height_m;
        if (aspect < 0.25 || aspect > 4) continue;
        ++i;
        gi::dvec3 const eye = wall.point(0.5, 0.5) + aside(random) * wall.width_m * wall.right +
                              aside(random) * wall.height_m * wall.up +
                              away(random) * std::max(wall.width_m, wall.height_m) * wall.normal;
        auto const camera = off_axis_camera(eye, wall);
        ASSERT_TRUE(camera);
        Misses const misses = misses_of(*camera, wall, eye);
        worst.tangents = std::max(worst.tangents, misses.tangents);
        worst.pixels = std::max(worst.pixels, misses.pixels);
        worst.rays = std::max(worst.rays, misses.rays);
    }
    EXPECT_LT(worst.tangents, 1e-9);
    EXPECT_LT(worst.pixels, 1e-5);
    EXPECT_LT(worst.rays, 1e-6);
    std::printf("largest miss: tangents %.2g, gi::project %.2g, gi::camera_rays %.2g\n", worst.tangents,
                worst.pixels, worst.rays);
}

TEST(OffAxis, SliversAndGlancesMissByTheRoundingOfFloats)
{
    // Rays are floats: where a wall spans little of the tangents that reach it, their rounding is a larger share.
    std::mt19937 random(8);
    std::uniform_real_distribution<double> aside(-20, 20), away(-3, 2);
    for (int i = 0; i < 10000; ++i) {
        WallFrame const wall = wall_frame(random_wall(random));
        double const size = std::max(wall.width_m, wall.height_m);
        gi::dvec3 const eye = wall.point(0.5, 0.5) + size * (aside(random) * wall.right + aside(random) * wall.up +
                                                             std::pow(10, away(random)) * wall.normal);
        auto const camera = off_axis_camera(eye, wall);
        ASSERT_TRUE(camera);
        gi::ViewTangents const t = *camera->off_axis;
        double const reach =
            1 + std::max({std::abs(t.left), std::abs(t.right), std::abs(t.bottom), std::abs(t.top)});
        double const span = std::min(t.right - t.left, t.top - t.bottom);
        Misses const misses = misses_of(*camera, wall, eye);
        EXPECT_LT(misses.tangents, 1e-12 * reach * reach / span);
        EXPECT_LT(misses.pixels, 5e-7 * reach * reach / span) << reach << " " << span;
        EXPECT_LT(misses.rays, 1e-6);
    }
}

TEST(OffAxis, AMiddleEyeSeesAnOrdinaryPerspective)
{
    WallFrame const wall = wall_frame({{-1, -0.5, -2}, {1, -0.5, -2}, {-1, 0.5, -2}});
    auto const camera = off_axis_camera({0, 0, 0}, wall);
    ASSERT_TRUE(camera);
    EXPECT_EQ(*camera->off_axis, (gi::ViewTangents{-0.5, 0.5, -0.25, 0.25}));
    EXPECT_NEAR(camera->yfov_rad, 2 * std::atan(0.25), 1e-15);
    EXPECT_EQ(camera->world_from_camera, gi::dmat4(1));
}

TEST(OffAxis, BothEyesSeeAPointWhereGeometrySays)
{
    // Similar triangles: at depth z behind a wall at distance d, pictures of it lie ipd z / (d + z) apart.
    User const user{"", 0.063, {{0.2, 1.7, 1.2}, gi::dvec3{0}}, gi::dvec3{0}, -1};
    Eyes const eyes = eyes_of(user, resting_head(user));
    WallFrame const wall = wall_frame({{-2, 0, -1}, {2, 0, -1}, {-2, 2.5, -1}});
    auto const left = off_axis_camera(eyes.left, wall), right = off_axis_camera(eyes.right, wall);
    ASSERT_TRUE(left && right);
    double const distance = 2.2;
    for (double const z : {-2.0, -1.1, -0.3, 0.0, 0.7, 5.0, 1e3, 1e9}) {
        gi::dvec3 const point{0.4, 1.3, -1 - z};
        double const disparity = (seen_at(*right, point).x - seen_at(*left, point).x) * wall.width_m;
        EXPECT_NEAR(disparity, 0.063 * z / (distance + z), 1e-9) << z;
        EXPECT_NEAR(seen_at(*right, point).y, seen_at(*left, point).y, 1e-12) << z;
    }
}

TEST(OffAxis, CaveWallsShareTheRaysOfTheirEdges)
{
    for (char const* file : {"cave4.yaml", "cave5.yaml"}) {
        Display const d = shipped(file);
        std::vector<std::optional<RoomPose>> const heads{
            RoomPose{{0.3, 1.5, -0.4}, glm::angleAxis(0.7, glm::normalize(gi::dvec3{0.2, 1, 0.1}))}};
        auto const views = views_of(d, heads);
        int edges = 0;
        double worst = 0;
        for (DisplayView const& a : views)
            for (DisplayView const& b : views) {
                if (&a >= &b || a.eye != b.eye || a.wall == b.wall) continue;
                ASSERT_TRUE(a.camera && b.camera);
                WallFrame const first = wall_frame(d.walls[std::size_t(a.wall)].corners);
                gi::dvec3 const origin(a.camera->world_from_camera[3]);
                gi::CameraRays const from_a = gi::camera_rays(*a.camera, a.width_px, a.height_px, origin);
                gi::CameraRays const from_b = gi::camera_rays(*b.camera, b.width_px, b.height_px, origin);
                // The edges of the first wall that lie on the second one.
                for (int edge = 0; edge < 4; ++edge) {
                    auto const along = [&](double t) {
                        return edge == 0   ? first.point(t, 0)
                               : edge == 1 ? first.point(t, 1)
                               : edge == 2 ? first.point(0, t)
                                           : first.point(1, t);
                    };
                    auto const is_on_second = [&](gi::dvec3 p) {
                        glm::dvec2 const at = seen_at(*b.camera, p);
                        WallFrame const second = wall_frame(d.walls[std::size_t(b.wall)].corners);
                        return std::abs(glm::dot(p - second.lower_left, second.normal)) < 1e-9 && at.x > -1e-9 &&
                               at.x < 1 + 1e-9 && at.y > -1e-9 && at.y < 1 + 1e-9;
                    };
                    if (!is_on_second(along(0)) || !is_on_second(along(1))) continue;
                    ++edges;
                    for (int i = 0; i <= 100; ++i) {
                        gi::dvec3 const p = along(i / 100.0);
                        auto const ray = [&](gi::CameraRays const& rays, DisplayView const& v) {
                            glm::dvec2 const at = seen_at(*v.camera, p);
                            return rays.through({float(at.x * v.width_px), float((1 - at.y) * v.height_px)});
                        };
                        gi::Ray const ra = ray(from_a, a), rb = ray(from_b, b);
                        worst = std::max(worst, double(glm::length(ra.direction - rb.direction)));
                    }
                }
            }
        EXPECT_EQ(edges, std::string(file) == "cave4.yaml" ? 2 * 5 : 2 * 8) << file;
        EXPECT_LT(worst, 1e-6) << file;
    }
}

TEST(OffAxis, WhereTheEyeSeesNothingIsSaid)
{
    WallFrame const wall = wall_frame({{-1.5, 0, -1.5}, {1.5, 0, -1.5}, {-1.5, 3, -1.5}});
    double const nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    auto const expect = [&](gi::dvec3 eye, EyePlace place) {
        EXPECT_EQ(place_of(eye, wall), place) << name_of(place);
        EXPECT_EQ(off_axis_camera(eye, wall).has_value(), place == EyePlace::before);
    };
    expect({0, 1.7, 0}, EyePlace::before);
    expect({100, 1.7, 0}, EyePlace::before);    // far aside still sees it, at a glance
    expect({0, 1.7, -1.5}, EyePlace::too_near); // on the plane
    expect({0, 1.7, -1.5 + 2e-4}, EyePlace::too_near);
    expect({0, 1.7, -1.5 + 4e-4}, EyePlace::before);
    expect({0, 1.7, -1.5 - 2e-4}, EyePlace::too_near);
    expect({0, 1.7, -1.6}, EyePlace::behind);
    expect({0, nan, 0}, EyePlace::unknown);
    expect({inf, 0, 0}, EyePlace::unknown);
    expect({1e200, 0, 0}, EyePlace::unknown); // its square is not finite
}

TEST(OffAxis, WallsOfAllSizesAndPlaces)
{
    std::mt19937 random(3);
    for (double const scale : {1e-3, 1.0, 1e3})
        for (double const away : {0.0, 1e5, 5e6}) {
            WallCorners corners = random_wall(random, 1);
            for (gi::dvec3* p : {&corners.lower_left, &corners.lower_right, &corners.upper_left})
                *p = *p * scale + gi::dvec3{away, -away, away};
            WallFrame const wall = wall_frame(corners);
            gi::dvec3 const eye = wall.point(0.3, 1.4) + 0.7 * wall.width_m * wall.normal;
            auto const camera = off_axis_camera(eye, wall);
            ASSERT_TRUE(camera) << scale << " " << away;
            // Rounding of corners at `away` against their size.
            double const tolerance = 1e-9 + 1e-15 * away / (0.1 * scale);
            gi::CameraRays const rays = gi::camera_rays(*camera, 1000, 1000, eye);
            for (int corner = 0; corner < 4; ++corner) {
                gi::dvec3 const p = corner_point(wall, corner);
                EXPECT_LT(glm::length(seen_at(*camera, p) - glm::dvec2(corner % 2, corner / 2)), tolerance);
                gi::vec3 const pixel = gi::Projection(rays)(gi::vec3(p - eye));
                EXPECT_NEAR(pixel.x / 1000, corner % 2, 1e-5 + tolerance);
                EXPECT_NEAR(pixel.y / 1000, 1 - corner / 2, 1e-5 + tolerance);
            }
        }
}

TEST(OffAxis, WhatIsNoRectangleIsRefused)
{
    auto const refusal = [](WallCorners const& c) { return message_of([&] { wall_frame(c); }); };
    double const nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_NE(refusal({{0, 0, 0}, {1, 0, 0}, {0, nan, 0}}).find("not finite"), std::string::npos);
    EXPECT_NE(refusal({{0, 0, 0}, {1e8, 0, 0}, {0, 1, 0}}).find("farther than 10,000 km"), std::string::npos);
    EXPECT_NE(refusal({{1, 1, 1}, {1, 1, 1}, {0, 1, 0}}).find("no area"), std::string::npos);
    EXPECT_NE(refusal({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}).find("no area"), std::string::npos);
    EXPECT_NE(refusal({{0, 0, 0}, {1, 0, 0}, {0.1, 1, 0}}).find("meet at 84.29 degrees"), std::string::npos);
    EXPECT_EQ(refusal({{0, 0, 0}, {3, 0, 0}, {0.01, 3, 0}}), ""); // a centimetre off on 3 m
    EXPECT_NEAR(wall_frame({{0, 0, 0}, {3, 0, 0}, {0.01, 3, 0}}).skew_deg, 0.191, 1e-3);
}

} // namespace
} // namespace viewer::test
