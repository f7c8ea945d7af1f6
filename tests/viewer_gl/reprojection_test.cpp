#include "gi/scene/model/projection.h"
#include "tests/viewer_gl/stereo_check.h"
#include "tests/viewer_gl/surfaceless.h"
#include "viewer/devices/gl/reprojection.h"

#include <chrono>
#include <cstring>
#include <epoxy/gl.h>
#include <glm/gtc/matrix_transform.hpp>

namespace viewer::test {
namespace {

using Reproject = Surfaceless;
using gi::dvec3;
using gi::vec3;

constexpr glm::ivec2 kSize{320, 240};

struct Rgba {
    std::vector<float> values;
    vec3 rgb(std::size_t i) const { return {values[4 * i], values[4 * i + 1], values[4 * i + 2]}; }
    float per_m(std::size_t i) const { return values[4 * i + 3]; }
};

Rgba read_floats(ShownPicture const& picture)
{
    Rgba out;
    out.values.resize(4 * std::size_t(picture.size_px.x * picture.size_px.y));
    glGetTextureImage(picture.texture, 0, GL_RGBA, GL_FLOAT, GLsizei(4 * out.values.size()), out.values.data());
    return out;
}

gi::Camera camera_at(dvec3 place, double yaw_deg = 0, double pitch_deg = 0)
{
    gi::Camera camera;
    camera.yfov_rad = 1.0;
    gi::dmat4 m = glm::translate(gi::dmat4(1), place);
    m = glm::rotate(m, glm::radians(yaw_deg), dvec3(0, 1, 0));
    camera.world_from_camera = glm::rotate(m, glm::radians(pitch_deg), dvec3(1, 0, 0));
    return camera;
}

/// A wall at z = -4 and, where wanted, a board at z = -2 before it, with the pattern of the room.
struct Flat {
    enum class Board { none, there };
    Board board;
    dvec3 wall_normal{0, 0, 1};

    bool on_board(vec3 p) const { return std::abs(p.x) < 0.5f && std::abs(p.y) < 0.4f; }

    /// 0 = nothing, 1 = wall, 2 = board.
    int hit(gi::Ray const& ray, vec3& point, vec3& color) const
    {
        if (board == Board::there && ray.direction.z < 0) {
            point = ray.origin + (-2 - ray.origin.z) / ray.direction.z * ray.direction;
            color = soft_pattern(2 * point.x, 2 * point.y, {1, 0.2f, 0.1f});
            if (on_board(point)) return 2;
        }
        vec3 const n(wall_normal);
        float const down = glm::dot(ray.direction, n);
        if (!(down < -1e-3f)) return color = vec3(0), 0;
        point = ray.origin + glm::dot(vec3(0, 0, -4) - ray.origin, n) / down * ray.direction;
        color = soft_pattern(point.x, point.y, {0.2f, 0.6f, 1});
        return 1;
    }

    RoomPicture seen_by(gi::Camera const& camera) const
    {
        RoomPicture out{kSize, {}, {}};
        gi::CameraRays const rays = gi::camera_rays(camera, kSize.x, kSize.y, dvec3{0});
        for (int y = 0; y < kSize.y; ++y)
            for (int x = 0; x < kSize.x; ++x) {
                vec3 point{0}, color{0};
                int const what = hit(rays.through({float(x) + 0.5f, float(y) + 0.5f}), point, color);
                for (int k = 0; k < 3; ++k) out.rgb.push_back(color[k]);
                out.depth_m.push_back(what == 0 ? 0 : gi::Projection(rays)(point).z);
            }
        return out;
    }
};

struct Errors {
    double largest = 0, mean = 0; ///< of radiance, over the pixels that A saw
    double largest_depth = 0;     ///< relative, of the same pixels
    int compared = 0, wrong_surface = 0, holes = 0, black = 0;
};

/// @param border_px pixels about edges of depth in B are left out: they mix two surfaces
Errors compare(Flat const& scene, gi::Camera const& a, gi::Camera const& b, Rgba const& got)
{
    Errors e;
    gi::CameraRays const from_a = gi::camera_rays(a, kSize.x, kSize.y, dvec3{0}),
                         from_b = gi::camera_rays(b, kSize.x, kSize.y, dvec3{0});
    auto const surface = [&](int x, int y) {
        vec3 p, c;
        return scene.hit(from_b.through({float(x) + 0.5f, float(y) + 0.5f}), p, c);
    };
    for (int y = 2; y < kSize.y - 2; ++y)
        for (int x = 2; x < kSize.x - 2; ++x) {
            std::size_t const i = std::size_t(y * kSize.x + x);
            e.black += got.rgb(i) == vec3(0);
            vec3 point{0}, color;
            int const what = scene.hit(from_b.through({float(x) + 0.5f, float(y) + 0.5f}), point, color);
            vec3 const in_a = gi::Projection(from_a)(point);
            bool const inside = in_a.z > 0 && in_a.x > 1 && in_a.y > 1 && in_a.x < float(kSize.x) - 1 &&
                                in_a.y < float(kSize.y) - 1;
            if (what == 0 || !inside) continue;
            bool edge = false;
            for (int d = -2; d <= 2; ++d) edge = edge || surface(x + d, y) != what || surface(x, y + d) != what;
            vec3 again, ignored;
            int const in_picture_a = scene.hit(from_a.through({in_a.x, in_a.y}), again, ignored);
            bool const hidden = in_picture_a != what;
            if (hidden) {
                // Board: red over blue. What is stretched must be wall.
                e.holes += 1;
                e.wrong_surface += !edge && got.rgb(i).x > got.rgb(i).z;
                continue;
            }
            // Nearly hidden in A: half of the pixel is the other surface.
            vec3 p1, c1;
            for (int d = 0; d < 25; ++d)
                edge = edge || scene.hit(from_a.through({in_a.x + float(d % 5 - 2), in_a.y + float(d / 5 - 2)}),
                                         p1, c1) != what;
            if (edge) continue;
            double const error = double(gi::max_component(glm::abs(got.rgb(i) - color)));
            e.largest = std::max(e.largest, error);
            double const depth = double(gi::Projection(from_b)(point).z);
            e.largest_depth = std::max(e.largest_depth, std::abs(double(got.per_m(i)) * depth - 1));
            e.mean += error;
            e.compared += 1;
        }
    e.mean /= std::max(e.compared, 1);
    return e;
}

Errors reproject(Flat const& scene, gi::Camera const& a, gi::Camera const& b, std::string const& name)
{
    RoomPicture const picture = scene.seen_by(a);
    PictureTexture texture;
    texture.upload(kSize, picture.rgb, picture.depth_m);
    Reprojection pass;
    ShownPicture const shown = pass.draw(texture, a, b, kSize);
    Errors const e = compare(scene, a, b, read_floats(shown));
    std::cout << name << ": largest error " << e.largest << ", mean " << e.mean << " of " << e.compared
              << " pixels; holes " << e.holes << ", of the wrong surface " << e.wrong_surface << "\n";
    DisplayPass display;
    TextureTarget const target(TextureTarget::Format::bytes, kSize);
    display.draw(target.target(), {shown, {}}, {}, {});
    keep_picture("reprojected_" + name, kSize, read_bytes(target.target()));
    return e;
}

TEST_F(Reproject, SamePlaceGivesTheSameBits)
{
    gi::Camera plain = camera_at({1.25, -0.5, 3}, 17, -9);
    gi::Camera off_axis = plain;
    off_axis.off_axis = gi::ViewTangents{-0.37, 0.61, -0.2, 0.55};
    for (gi::Camera const& camera : {plain, off_axis, room_eye(0.03, 1.3)}) {
        RoomPicture picture = room_seen_by(camera, {333, 217});
        picture.rgb[6] = 1e-38f;
        PictureTexture texture;
        texture.upload(picture.size, picture.rgb, picture.depth_m);
        Reprojection pass;
        Rgba const got = read_floats(pass.draw(texture, camera, camera, picture.size));
        for (std::size_t i = 0; i < picture.depth_m.size(); ++i) {
            ASSERT_EQ(std::memcmp(&got.values[4 * i], &picture.rgb[3 * i], 3 * sizeof(float)), 0) << i;
            ASSERT_EQ(got.per_m(i), picture.depth_m[i] > 0 ? 1 / picture.depth_m[i] : 0) << i;
        }
    }
}

TEST_F(Reproject, ASmallStepOfTheCameraIsNotRoundedAway)
{
    // Moved by less than any pixel shows: still the same picture, through the search.
    gi::Camera const a = camera_at({0, 0, 0}), b = camera_at({1e-7, 0, 0});
    Errors const e = reproject({Flat::Board::none, {0, 0, 1}}, a, b, "tiny");
    EXPECT_LT(e.largest, 1e-5);
}

TEST_F(Reproject, TurningIsExact)
{
    // What is left is the bilinear filter of a pattern whose second derivatives are at most 2 per m2, with pixels
    // of 0.018 m: 2 * 0.25 * 16 * 0.018^2 / 8 at most.
    Flat const scene{Flat::Board::none, {0, 0, 1}};
    gi::Camera const a = camera_at({0, 0, 0});
    EXPECT_LT(reproject(scene, a, camera_at({0, 0, 0}, 5, -3), "turned").largest, 4e-4);
    gi::Camera wider = camera_at({0, 0, 0}, -2, 1);
    wider.off_axis = gi::ViewTangents{-0.3, 0.5, -0.4, 0.2};
    EXPECT_LT(reproject(scene, a, wider, "turned_off_axis").largest, 4e-4);
    // Without depth, too.
    RoomPicture const picture = scene.seen_by(a);
    PictureTexture texture;
    texture.upload(kSize, picture.rgb);
    Reprojection pass;
    gi::Camera const b = camera_at({0, 0, 0}, 5, -3);
    EXPECT_LT(compare(scene, a, b, read_floats(pass.draw(texture, a, b, kSize))).largest, 4e-4);
}

TEST_F(Reproject, PlanesAreFoundBetweenPixels)
{
    gi::Camera const a = camera_at({0, 0, 0});
    for (dvec3 const& normal : {dvec3{0, 0, 1}, glm::normalize(dvec3{0.5, 0.2, 1})}) {
        Flat const scene{Flat::Board::none, normal};
        for (dvec3 const& step : {dvec3{0.1, 0, 0}, {0, -0.05, 0}, {0.03, 0.04, -0.1}, {0, 0, 0.2}}) {
            Errors const e = reproject(scene, a, camera_at(step, 2, 1), "plane");
            EXPECT_GT(e.compared, 40000);
            EXPECT_LT(e.largest, 2e-3) << step.x << " " << step.y << " " << step.z;
            EXPECT_LT(e.largest_depth, 1e-4);
            EXPECT_EQ(e.black, 0);
        }
    }
}

TEST_F(Reproject, TwoDepthsHideEachOther)
{
    Flat const scene{Flat::Board::there, {0, 0, 1}};
    gi::Camera const a = camera_at({0, 0, 0});
    int number = 0;
    for (dvec3 const& step : {dvec3{0.064, 0, 0}, {-0.03, 0.05, 0}, {0, 0, -0.15}, {0.1, -0.1, 0.05}}) {
        Errors const e = reproject(scene, a, camera_at(step), "two_depths_" + std::to_string(number++));
        EXPECT_GT(e.compared, 40000);
        EXPECT_LT(e.largest, 2e-3);
        EXPECT_LT(e.largest_depth, 1e-3);
        EXPECT_EQ(e.wrong_surface, 0);
        EXPECT_EQ(e.black, 0);
    }
}

TEST_F(Reproject, OutsideThePictureItsEdgeIsStretched)
{
    Flat const scene{Flat::Board::none, {0, 0, 1}};
    gi::Camera const a = camera_at({0, 0, 0});
    RoomPicture const picture = scene.seen_by(a);
    PictureTexture texture;
    texture.upload(kSize, picture.rgb, picture.depth_m);
    Reprojection pass;
    for (double const yaw : {30.0, 120.0, 179.0}) {
        Rgba const got = read_floats(pass.draw(texture, a, camera_at({0.05, 0, 0}, yaw), kSize));
        for (std::size_t i = 0; i < got.values.size() / 4; ++i) {
            EXPECT_TRUE(gi::all_finite(got.rgb(i)));
            EXPECT_NE(got.rgb(i), vec3(0));
            EXPECT_TRUE(std::isfinite(got.per_m(i)) && got.per_m(i) >= 0);
        }
    }
}

TEST_F(Reproject, RoomIsLookedAt)
{
    gi::Camera const a = room_eye(0, 4.0 / 3);
    gi::Camera b = a;
    b.world_from_camera = camera_at({0.12, 1.56, 0.9}, 4, -2).world_from_camera;
    RoomPicture const before = room_seen_by(a, kSize), truth = room_seen_by(b, kSize);
    PictureTexture texture;
    texture.upload(kSize, before.rgb, before.depth_m);
    Reprojection pass;
    ShownPicture const shown = pass.draw(texture, a, b, kSize);
    Rgba const got = read_floats(shown);
    double moved = 0, still = 0;
    for (std::size_t i = 0; i < truth.depth_m.size(); ++i)
        for (std::size_t k = 0; k < 3; ++k) {
            moved += std::abs(double(got.values[4 * i + k] - truth.rgb[3 * i + k]));
            still += std::abs(double(before.rgb[3 * i + k] - truth.rgb[3 * i + k]));
        }
    double const n = 3 * double(truth.depth_m.size());
    std::cout << "room, 13 cm and 4 degrees: mean error " << moved / n << ", " << still / n
              << " if the old picture stayed\n";
    EXPECT_LT(moved, 0.15 * still);
    DisplayPass display;
    TextureTarget const target(TextureTarget::Format::bytes, kSize);
    display.draw(target.target(), {shown, {}}, {}, {});
    keep_picture("room_reprojected", kSize, read_bytes(target.target()));
    PictureTexture real;
    real.upload(kSize, truth.rgb);
    display.draw(target.target(), {real.shown(), {}}, {}, {});
    keep_picture("room_truth", kSize, read_bytes(target.target()));
}

TEST_F(Reproject, RefusesWhatItCannot)
{
    Reprojection pass;
    PictureTexture texture;
    gi::Camera parallel;
    parallel.orthographic = true;
    EXPECT_THROW(pass.draw(texture, {}, {}, kSize), gi::InputError);
    texture.upload({1, 1}, std::vector<float>(3));
    EXPECT_THROW(pass.draw(texture, parallel, {}, kSize), gi::InputError);
    EXPECT_THROW(pass.draw(texture, {}, parallel, kSize), gi::InputError);
}

TEST_F(Reproject, TimeIsStated)
{
    glm::ivec2 const size{640, 480};
    gi::Camera const a = room_eye(0, 4.0 / 3);
    gi::Camera b = a;
    b.world_from_camera[3].x += 0.02;
    RoomPicture const picture = room_seen_by(a, size);
    PictureTexture texture;
    texture.upload(size, picture.rgb, picture.depth_m);
    Reprojection pass;
    for (auto const& [name, to] : {std::pair{"same place", a}, {"moved by 2 cm", b}}) {
        double best = 1e9;
        for (int i = 0; i < 5; ++i) {
            auto const start = std::chrono::steady_clock::now();
            pass.draw(texture, a, to, size);
            glFinish();
            best = std::min(
                best, std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - start).count());
        }
        std::cout << "reprojection, 640x480, least of 5, " << name << ": " << best << " ms\n";
    }
}

} // namespace
} // namespace viewer::test
