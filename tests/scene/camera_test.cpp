// Rays and their inverse, from telescopes to fish eyes, near and far from zero.

#include "gi/core/error.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/model/projection.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

vec3 unit_to(dvec3 from, dvec3 at) { return vec3(glm::normalize(at - from)); }

TEST(Camera, MiddleLooksForwardAndTopLeftIsTopLeft)
{
    dvec3 const from{1, 2, 3}, at{4, 2, -1};
    CameraRays const rays = camera_rays(look_at(from, at, 90), 200, 100, dvec3{0});
    Ray const middle = rays.through({100, 50});
    EXPECT_LT(glm::distance(middle.direction, unit_to(from, at)), 1e-6f);
    EXPECT_LT(glm::distance(middle.origin, vec3(from)), 1e-6f);
    EXPECT_GT(rays.through({100, 0}).direction.y, 0.7f);
    vec3 const right = glm::cross(unit_to(from, at), vec3{0, 1, 0});
    EXPECT_LT(glm::dot(rays.through({0, 50}).direction, right), -0.8f);
}

TEST(Camera, FieldOfViewIsVerticalAndFull)
{
    for (double const fov : {0.001, 1.0, 45.0, 120.0, 179.0}) {
        CameraRays const rays = camera_rays(look_at({0, 0, 0}, {0, 0, -1}, fov), 300, 100, dvec3{0});
        vec3 const top = rays.through({150, 0}).direction;
        double const half = std::atan2(double(top.y), -double(top.z));
        EXPECT_NEAR(half, 0.5 * glm::radians(fov), 1e-6 * glm::radians(fov)) << fov;
        vec3 const side = rays.through({300, 50}).direction;
        EXPECT_NEAR(double(side.x) / -double(side.z), 3 * std::tan(half), 1e-5 * 3 * std::tan(half)) << fov;
    }
}

TEST(Camera, ProjectIsTheInverse)
{
    for (double const fov : {0.01, 45.0, 170.0})
        for (vec2 const pixel : {vec2{0, 0}, vec2{63.5f, 20.25f}, vec2{640, 480}}) {
            CameraRays const rays = camera_rays(look_at({1, 2, 3}, {-2, 0, 1}, fov), 640, 480, dvec3{0});
            Ray const ray = rays.through(pixel);
            vec3 const p = Projection(rays)(ray.origin + 7.0f * ray.direction);
            // A pixel of the narrowest view is 4e-7 rad: float positions cannot say more than a part of it.
            float const tolerance = fov < 1 ? 4.0f : 0.02f;
            EXPECT_NEAR(p.x, pixel.x, tolerance) << fov;
            EXPECT_NEAR(p.y, pixel.y, tolerance) << fov;
            EXPECT_NEAR(p.z, 7 * glm::dot(ray.direction, rays.forward), 1e-4f) << fov;
        }
}

TEST(Camera, OrthographicRaysAreParallel)
{
    Camera c = look_at({0, 5, 0}, {0, 0, 0}, 45);
    c.orthographic = true;
    c.ymag_m = 2;
    CameraRays const rays = camera_rays(c, 100, 100, dvec3{0});
    for (vec2 const pixel : {vec2{0, 0}, vec2{100, 100}, vec2{25, 75}}) {
        Ray const ray = rays.through(pixel);
        EXPECT_LT(glm::distance(ray.direction, vec3{0, -1, 0}), 1e-6f);
        vec3 const p = Projection(rays)(ray.origin + 3.0f * ray.direction);
        EXPECT_NEAR(p.x, pixel.x, 1e-3f);
        EXPECT_NEAR(p.y, pixel.y, 1e-3f);
        EXPECT_NEAR(p.z, 3, 1e-5f);
    }
    EXPECT_NEAR(glm::distance(rays.through({0, 0}).origin, rays.through({0, 100}).origin), 4, 1e-5f);
}

TEST(Camera, FarFromTheOriginNothingIsLost)
{
    dvec3 const far{1e6, -2e6, 3e6};
    CameraRays const near_rays = camera_rays(look_at({1, 2, 3}, {0, 0, 0}, 40), 64, 64, dvec3{0});
    CameraRays const far_rays = camera_rays(look_at(far + dvec3{1, 2, 3}, far, 40), 64, 64, far);
    for (vec2 const pixel : {vec2{0, 0}, vec2{64, 0}, vec2{32, 32}}) {
        EXPECT_LT(glm::distance(near_rays.through(pixel).direction, far_rays.through(pixel).direction), 1e-6f);
        EXPECT_LT(glm::distance(near_rays.through(pixel).origin, far_rays.through(pixel).origin), 1e-6f);
    }
}

TEST(Camera, LookingStraightUpOrDownHasSomeUp)
{
    for (double const y : {1.0, -1.0}) {
        Camera const c = look_at({0, 0, 0}, {0, y, 0}, 45);
        glm::dmat3 const m(c.world_from_camera);
        EXPECT_NEAR(glm::determinant(m), 1, 1e-12);
        EXPECT_LT(glm::distance(-m[2], dvec3{0, y, 0}), 1e-12);
    }
}

Camera with_lens(Camera camera, double radius_m, double focus_m)
{
    camera.aperture_radius_m = radius_m;
    camera.focus_distance_m = focus_m;
    return camera;
}

/// Thin lens: from the rim, a point at depth d is seen r |1 / f - 1 / d| beside its place, in tangents.
TEST(Lens, SpreadsWhatIsOutOfFocusAsAThinLensDoes)
{
    constexpr double kRadius = 0.1, kFocus = 3;
    constexpr int kSize = 200;
    Camera const camera = with_lens(look_at({1, 2, 3}, {4, 2, -1}, 40), kRadius, kFocus);
    CameraRays const rays = camera_rays(camera, 2 * kSize, kSize, dvec3{0});
    double const radius_px = kRadius * kSize / (2 * std::tan(glm::radians(20.0)));
    for (double const depth : {0.5, 2.9, 3.0, 4.0, 100.0})
        for (vec2 const disk : {vec2{1, 0}, vec2{0, -1}, vec2{0.6f, 0.8f}, vec2{0}}) {
            Ray const ray = rays.through({130, 40});
            vec3 const point = ray.origin + float(depth) / glm::dot(ray.direction, rays.forward) * ray.direction;
            CameraRays const at = rays.at_lens(disk);
            EXPECT_FALSE(at.has_lens());
            EXPECT_NEAR(glm::distance(at.origin, rays.origin), kRadius * double(glm::length(disk)), 1e-6);
            vec3 const seen = Projection(at)(point);
            double const aside_px = radius_px * (1 / kFocus - 1 / depth);
            EXPECT_NEAR(seen.x, 130 + double(disk.x) * aside_px, 0.01) << depth;
            EXPECT_NEAR(seen.y, 40 - double(disk.y) * aside_px, 0.01) << depth;
            EXPECT_NEAR(seen.z, depth, 1e-4 * depth);
        }
}

TEST(Lens, NonsenseIsRefused)
{
    double const nan = std::numeric_limits<double>::quiet_NaN(), inf = std::numeric_limits<double>::infinity();
    Camera const camera = look_at({1, 2, 3}, {4, 2, -1}, 40);
    auto const rays = [](Camera const& c) { return camera_rays(c, 10, 10, dvec3{0}); };
    for (double const bad : {-1.0, nan, inf}) {
        EXPECT_THROW(rays(with_lens(camera, bad, 1)), InputError) << bad;
        EXPECT_THROW(rays(with_lens(camera, 0.1, bad)), InputError) << bad;
    }
    EXPECT_THROW(rays(with_lens(camera, 0.1, 0)), InputError);
    Camera flat = with_lens(camera, 0.1, 1);
    flat.orthographic = true;
    EXPECT_THROW(rays(flat), InputError);
    flat.aperture_radius_m = 0;
    EXPECT_FALSE(rays(flat).has_lens());
    EXPECT_FALSE(rays(with_lens(camera, 0, 1)).has_lens());
}

TEST(Camera, NonsenseIsRefused)
{
    double const nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(look_at({1, 1, 1}, {1, 1, 1}, 45), InputError);
    EXPECT_THROW(look_at({nan, 1, 1}, {1, 1, 1}, 45), InputError);
    EXPECT_THROW(look_at({0, 1, 1}, {1, 1e308 * 10, 1}, 45), InputError);
    for (double const fov : {0.0, -5.0, 180.0, nan}) EXPECT_THROW(look_at({0, 0, 0}, {1, 0, 0}, fov), InputError);
}

} // namespace
} // namespace gi::test
