// Rays and their inverse, from telescopes to fish eyes, near and far from zero.

#include "gi/base/error.h"
#include "gi/scene/camera.h"

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
            vec3 const p = project(rays, ray.origin + 7.0f * ray.direction);
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
        vec3 const p = project(rays, ray.origin + 3.0f * ray.direction);
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
