// Surfaces that are not flat: points and directions computed by hand, the faces of cubes that
// they need, and the resampled picture.

#include "tests/viewer_display/display_samples.h"
#include "tests/viewer_display/face_pictures.h"
#include "viewer/displays/views.h"

#include <numbers>

namespace viewer::test {
namespace {

constexpr double kPi = std::numbers::pi;

void expect_at(gi::dvec3 a, gi::dvec3 b, double tolerance = 1e-9)
{
    EXPECT_LT(glm::length(a - b), tolerance)
        << a.x << " " << a.y << " " << a.z << ", not " << b.x << " " << b.y << " " << b.z;
}

TEST(Surface, FisheyeIsEquidistant)
{
    // 180 degrees looking at the zenith, 1000 x 1000 px: r = f * theta with f = 500 px / (pi / 2). The direction
    // 30 degrees above the horizon in front is 60 degrees from the zenith: r = 500 * 60 / 90 = 333.333 px below
    // the middle, at v = 0.5 - 333.333 / 1000.
    Surface s;
    s.place.rotation_deg = {90, 0, 0};
    auto const in_front = surface_point(s, 1, {0.5, 0.5 - 1.0 / 3});
    ASSERT_TRUE(in_front && in_front->is_direction);
    expect_at(in_front->at, {0, std::sin(kPi / 6), -std::cos(kPi / 6)});
    // To the right, on the horizon, at the circle's edge.
    expect_at(surface_point(s, 1, {1, 0.5})->at, {1, 0, 0});
    EXPECT_FALSE(surface_point(s, 1, {0.95, 0.95})) << "outside the circle";
    // 1600 x 800: the circle has 800 px, so that u = 0.5 + 0.25 is the same edge.
    expect_at(surface_point(s, 2, {0.75, 0.5})->at, {1, 0, 0});
    EXPECT_FALSE(surface_point(s, 2, {0.76, 0.5}));
    s.circle = {0.5, 0, 0.5, 1}; // lower half of the circle cut off at its middle
    expect_at(surface_point(s, 2, {0.5, 0})->at, {0, 1, 0});
}

TEST(Surface, ADomeIsSeenFromWhereTheEyeIs)
{
    // Radius 5 m about (0, 1, 0). The zenith point is (0, 6, 0): from the eye at (3, 2,
    // 0) its direction is (-3, 4, 0) / 5.
    Surface s;
    s.place = {{0, 1, 0}, {90, 0, 0}};
    s.radius_m = 5;
    auto const zenith = surface_point(s, 1, {0.5, 0.5});
    ASSERT_TRUE(zenith && !zenith->is_direction);
    expect_at(zenith->at, {0, 6, 0});
    expect_at(direction_to(*zenith, {3, 2, 0}), {-0.6, 0.8, 0});
}

TEST(Surface, CylinderByAngleAndHeight)
{
    // 2 m radius, azimuths -90 to 90 degrees, heights 0 to 3 m: a quarter from the left is at -45 degrees, half
    // way up at 1.5 m: 2 * (sin -45, -, -cos 45).
    Surface s;
    s.type = SurfaceType::cylindrical;
    s.radius_m = 2;
    s.azimuths_deg = {-90, 90};
    s.heights_m = {0, 3};
    expect_at(surface_point(s, 2, {0.25, 0.5})->at, {-std::sqrt(2.0), 1.5, -std::sqrt(2.0)});
    expect_at(surface_point(s, 2, {1, 0})->at, {2, 0, 0});
}

TEST(Surface, EquirectangularByAngles)
{
    Surface s;
    s.type = SurfaceType::equirectangular;
    // A quarter from the right edge is 90 degrees to the right, a third from the top at 30 degrees upward.
    expect_at(surface_point(s, 2, {0.75, 2.0 / 3})->at, {std::cos(kPi / 6), 0.5, 0});
    expect_at(surface_point(s, 2, {0.5, 0.5})->at, {0, 0, -1});
}

TEST(Surface, SphericalMirrorByReflection)
{
    // A ball of 1 m about (0, 0, 0), a projector at (0, 0, 3) that looks along -z, a sphere of 10 m. The ray that
    // hits the ball where its normal is 45 degrees from the ray's reverse leaves at a right angle: at the point
    // (0, s, s), s = sqrt(1/2), a ray along -z becomes +y. A ray from the projector to that point is not along -z;
    // it has the tangent s / (3 - s). Its direction d = (0, s, s - 3) / |.|, the normal n = (0, s, s), the
    // reflected one d - 2 (d n) n.
    Surface s;
    s.type = SurfaceType::spherical_mirror;
    s.radius_m = 10;
    s.fov_deg = 360;
    s.mirror.radius_m = 1;
    s.mirror.projector.translation_m = {0, 0, 3};
    s.mirror.projector_tangents = {-1, 1, -1, 1};
    double const h = std::sqrt(0.5), tangent = h / (3 - h);
    auto const p = surface_point(s, 1, {0.5, 0.5 + tangent / 2});
    ASSERT_TRUE(p);
    gi::dvec3 const d = glm::normalize(gi::dvec3{0, h, h - 3}), n{0, h, h};
    gi::dvec3 const away = d - 2 * glm::dot(d, n) * n;
    EXPECT_NEAR(glm::length(p->at), 10, 1e-9);
    expect_at(glm::normalize(p->at - n), away, 1e-9);
    EXPECT_FALSE(surface_point(s, 1, {0.95, 0.5})) << "beside the ball";
    // A ray through the ball's centre returns to its origin.
    expect_at(surface_point(s, 1, {0.5, 0.5})->at, {0, 0, 10});
    s.fov_deg = 180; // only what is before the frame
    EXPECT_FALSE(surface_point(s, 1, {0.5, 0.5}));
}

std::vector<CubeFace> kinds(std::vector<FaceView> const& faces)
{
    std::vector<CubeFace> out;
    for (FaceView const& f : faces) out.push_back(f.face);
    return out;
}

TEST(CubeFaces, AsManyAsTheViewNeeds)
{
    Surface s;
    std::vector<gi::dvec3> const eye{gi::dvec3{0}};
    // 180 degrees: the front face and the near halves of the four beside it, with one eighth and 2 px more.
    auto const half = faces_for(s, {512, 512}, eye, 256);
    EXPECT_EQ(kinds(half),
              (std::vector{CubeFace::front, CubeFace::left, CubeFace::right, CubeFace::up, CubeFace::down}));
    EXPECT_NEAR(half[0].tangents.left, -1 - 4.0 / 256, 1e-12);
    EXPECT_NEAR(half[1].tangents.left, -0.125 - 4.0 / 256, 1e-12); // of the left face, the front is to its right
    EXPECT_EQ(half[0].width_px, 260);
    s.fov_deg = 80;
    EXPECT_EQ(kinds(faces_for(s, {512, 512}, eye, 256)), std::vector{CubeFace::front});
    s.fov_deg = 300;
    EXPECT_EQ(faces_for(s, {512, 512}, eye, 256).size(), 6u);
    // As fine as the viewport: 1000 px over 180 degrees are 3.14 mrad each; a face with 2 rad at this rate has
    // 637, and more because pixels beside each other on a circle are nearer.
    s.fov_deg = 180;
    EXPECT_NEAR(faces_for(s, {1000, 1000}, eye, 0)[0].width_px, 680, 43);
}

TEST(CubeFaces, ShowEveryDirectionWhereItIs)
{
    Surface s;
    s.fov_deg = 340;
    s.place = {{1, 2, 3}, {20, 30, 40}};
    auto const faces = faces_for(s, {256, 256}, std::vector{gi::dvec3{0}}, 128);
    std::mt19937 random(3);
    std::normal_distribution<double> normal;
    for (int i = 0; i < 2000; ++i) {
        gi::dvec3 const in_cube = glm::normalize(gi::dvec3{normal(random), normal(random), normal(random)});
        auto const place = place_in(faces, in_cube);
        ASSERT_TRUE(place);
        gi::Camera const camera = face_camera(s, faces[place->index], {0, 0, 0});
        gi::dvec3 const in_room = pose_of(s.place).rotation * in_cube;
        gi::dvec3 const seen = glm::transpose(glm::dmat3(camera.world_from_camera)) * in_room;
        ASSERT_LT(seen.z, 0);
        gi::ViewTangents const t = *camera.off_axis;
        EXPECT_NEAR(glm::mix(t.left, t.right, place->picture.x), seen.x / -seen.z, 1e-9);
        EXPECT_NEAR(glm::mix(t.bottom, t.top, place->picture.y), seen.y / -seen.z, 1e-9);
    }
}

/// A colour that encodes the direction.
glm::dvec3 colour_of(gi::dvec3 direction) { return 127.5 + 127.5 * direction; }

TEST(CubeFaces, AFisheyeOfColouredDirections)
{
    Surface s;
    s.place = {{0, 0, 0}, {90, 0, 0}};
    s.radius_m = 4;
    gi::dvec3 const eye{0.5, 0.2, -0.3};
    auto const faces = faces_for(s, {96, 96}, std::vector{eye}, 64);
    std::vector<BytePicture> pictures;
    for (FaceView const& face : faces) {
        gi::Camera const camera = face_camera(s, face, eye);
        BytePicture p{face.width_px, face.height_px, {}};
        for (int y = 0; y < p.height; ++y)
            for (int x = 0; x < p.width; ++x) {
                gi::ViewTangents const t = face.tangents;
                gi::dvec3 const d = glm::dmat3(camera.world_from_camera) *
                                    glm::normalize(gi::dvec3{glm::mix(t.left, t.right, (x + 0.5) / p.width),
                                                             glm::mix(t.top, t.bottom, (y + 0.5) / p.height), -1});
                for (int c = 0; c < 3; ++c) p.rgb.push_back(static_cast<unsigned char>(colour_of(d)[c] + 0.5));
            }
        pictures.push_back(std::move(p));
    }
    BytePicture const out = resample(s, {96, 96}, eye, faces, pictures);
    int lit = 0;
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 96; ++x) {
            auto const point = surface_point(s, 1, {(x + 0.5) / 96, 1 - (y + 0.5) / 96});
            for (int c = 0; c < 3; ++c) {
                double const expected = point ? colour_of(direction_to(*point, eye))[c] : 0;
                ASSERT_NEAR(out.rgb[std::size_t((y * 96 + x) * 3 + c)], expected, 1.6) << x << " " << y;
            }
            lit += point.has_value();
        }
    EXPECT_NEAR(lit, kPi * 48 * 48, 60);
}

TEST(CubeFaces, ViewsOfADomeInStereo)
{
    gi::Report report;
    Display const d = parse_display(R"(
windows: [{name: w, size_px: [400, 200]}]
users: [{name: u, head_position_m: [0, 1.7, 0]}]
walls:
  - {name: dome, window: w, stereo: side-by-side, projection: {type: fisheye, rotation_deg: [90, 0, 0], radius_m: 4}}
)",
                                    "d.yaml", report);
    auto const views = views_of(d, {});
    ASSERT_EQ(views.size(), 10u);
    EXPECT_EQ(views[0].name, "dome, left eye, front face");
    EXPECT_EQ(views[5].eye, Eye::right);
    EXPECT_EQ(views[7].partner, 2);
    EXPECT_EQ(views[7].face, views[2].face);
    EXPECT_NEAR(views[5].camera->world_from_camera[3].x - views[0].camera->world_from_camera[3].x, 0.063, 1e-12);
    EXPECT_EQ(views_of(d, {}).size(), 10u);
    // The number of faces does not change with the head.
    std::vector<std::optional<RoomPose>> const heads{RoomPose{{1, 1, 1}, {1, 0, 0, 0}}};
    EXPECT_EQ(views_of(d, heads).size(), 10u);
}

TEST(CubeFaces, WhatCannotBeIsRefusedWithItsPlace)
{
    gi::Report report;
    auto const message = [&](std::string const& projection, std::string const& more = "") {
        return message_of([&] {
            parse_display(
                "windows: [{name: w, size_px: [400, 200]}]\nusers: [{name: u, head_position_m: [0, 0, 0]}]\n"
                "walls:\n  - {name: d, window: w, " +
                    more + "projection: {" + projection + "}}\n",
                "d.yaml", report);
        });
    };
    for (auto const& [projection, part] :
         {std::pair{"type: dome", "d.yaml:4:45: 'dome' is no projection"},
          {"type: fisheye, fov_deg: 400", "d.yaml:4:63: a field of view of 400 degrees"},
          {"type: cylindrical", "radius_m is missing"},
          {"type: equirectangular, azimuths_deg: [0, 361]", "more than a full turn"},
          {"type: cylindrical, radius_m: 2, heights_m: [3, 1]", "heights_m from 3 to 1"},
          {"type: spherical-mirror, radius_m: 5", "a mirror of 0 m radius"},
          {"type: spherical-mirror, radius_m: 5, mirror_radius_m: 1", "the projector is within the mirror"},
          {"type: fisheye, circle: [0, 0, 0, 1]", "the circle is too small"},
          {"type: fisheye, radius: 2", "radius"}})
        EXPECT_NE(message(projection).find(part), std::string::npos) << message(projection);
    EXPECT_NE(message("type: fisheye", "blend: {left_m: 1}, ").find("a blend on a projection"), std::string::npos);
    EXPECT_NE(message("type: fisheye", "lower_left_m: [0, 0, 0], ").find("a projection and corners"),
              std::string::npos);
    EXPECT_NE(message("type: fisheye", "render_px: [4, 5], ").find("a face of a cube that is not square"),
              std::string::npos);
    EXPECT_NE(message("type: fisheye", "eye: both, ").find("'both' is no eye"), std::string::npos);
    EXPECT_NE(message("type: fisheye", "eye: left, stereo: rows, ").find("eye: left with stereo: rows"),
              std::string::npos);
}

} // namespace
} // namespace viewer::test
