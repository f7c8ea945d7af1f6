// Moving cameras: through their keys, smoothly, and exactly where the curve is known.

#include "gi/scene/model/camera_path.h"

#include "gi/core/error.h"
#include "gi/scene/load/load.h"

#include <gtest/gtest.h>

namespace gi::test {
namespace {

constexpr double kFov = 0.8;

dquat about(dvec3 axis, double angle) { return glm::angleAxis(angle, glm::normalize(axis)); }

CameraKey key(double time_s, dvec3 from, dquat rotation)
{
    CameraKey k;
    k.time_s = time_s;
    k.from = from;
    k.rotation = rotation;
    return k;
}

/// Uneven in time, place, rotation and field of view.
CameraPath winding()
{
    CameraPath path;
    path.keys = {key(-1, {0, 0, 0}, about({0, 1, 0}, 0.3)), key(0.5, {4, 1, -2}, about({1, 1, 0}, 1.9)),
                 key(0.75, {3, 2, 5}, about({0, 0, 1}, -1.2)), key(4, {-6, 0, 1}, about({1, 0, 2}, 2.8)),
                 key(5, {-6, 3, 1}, about({1, 0, 2}, -0.4))};
    double fov = 0.3;
    for (CameraKey& k : path.keys) k.fov_rad = fov += 0.35;
    return path;
}

dvec3 place(Camera const& c) { return dvec3(c.world_from_camera[3]); }

double difference(dmat4 const& a, dmat4 const& b)
{
    double most = 0;
    for (int i = 0; i < 4; ++i)
        for (int j = 0; j < 4; ++j) most = std::max(most, std::abs(a[i][j] - b[i][j]));
    return most;
}

TEST(CameraPath, PassesThroughItsKeys)
{
    CameraPath const path = winding();
    for (CameraKey const& k : path.keys) {
        Camera const c = camera_at(path, k.time_s, kFov);
        EXPECT_EQ(place(c), k.from);
        EXPECT_EQ(c.yfov_rad, *k.fov_rad);
        dmat4 wanted = glm::mat4_cast(k.rotation);
        wanted[3] = glm::dvec4(k.from, 1);
        EXPECT_LT(difference(c.world_from_camera, wanted), 1e-14);
    }
}

TEST(CameraPath, IsContinuousWithItsVelocity)
{
    for (bool const looks_at : {false, true}) {
        CameraPath path = winding();
        if (looks_at)
            for (CameraKey& k : path.keys) k.at = k.from + dvec3{1, 0.2 * k.time_s, -3};
        constexpr double kStep = 1e-5;
        auto const at = [&](double t) {
            Camera const c = camera_at(path, t, kFov);
            dmat4 m = c.world_from_camera;
            m[0][3] = c.yfov_rad; // along with the rest
            return m;
        };
        for (std::size_t i = 1; i + 1 < path.keys.size(); ++i) {
            double const t = path.keys[i].time_s;
            EXPECT_LT(difference(at(t - 1e-9), at(t)), 1e-6);
            dmat4 const before = (at(t) - at(t - kStep)) / kStep, after = (at(t + kStep) - at(t)) / kStep;
            EXPECT_LT(difference(before, after), 0.02) << "at " << t << " s, looks at " << looks_at;
        }
    }
}

TEST(CameraPath, KeysOnAParabolaAreJoinedByIt)
{
    auto const parabola = [](double t) { return dvec3{1 + 2 * t, -3 * t * t, 0.5 * t * t - t}; };
    CameraPath path;
    for (double const t : {0.0, 0.3, 1.0, 1.1, 4.0}) path.keys.push_back(key(t, parabola(t), dquat(1, 0, 0, 0)));
    for (double t = 0; t <= 4; t += 0.01)
        EXPECT_LT(glm::length(place(camera_at(path, t, kFov)) - parabola(t)), 1e-12) << t;
}

TEST(CameraPath, ASteadyTurnStaysSteady)
{
    CameraPath path;
    for (double const t : {0.0, 0.2, 1.0, 1.5}) path.keys.push_back(key(t, {}, about({1, 2, 3}, 1.7 * t)));
    for (double t = 0; t <= 1.5; t += 0.01) {
        dmat4 const wanted = glm::mat4_cast(about({1, 2, 3}, 1.7 * t));
        EXPECT_LT(difference(camera_at(path, t, kFov).world_from_camera, wanted), 1e-12) << t;
    }
}

TEST(CameraPath, TakesTheShorterWayRound)
{
    CameraPath path;
    dquat const turned = about({0, 1, 0}, 0.4);
    path.keys = {key(0, {}, dquat(1, 0, 0, 0)), key(1, {}, -turned)}; // the same rotation
    dmat4 const wanted = glm::mat4_cast(about({0, 1, 0}, 0.2));
    EXPECT_LT(difference(camera_at(path, 0.5, kFov).world_from_camera, wanted), 1e-14);
}

TEST(CameraPath, KeepsThePointItLooksAtInTheMiddle)
{
    CameraPath path = winding();
    dvec3 const point{0.5, -8, 2};
    for (CameraKey& k : path.keys) k.at = point;
    for (double t = -2; t < 6; t += 0.1) {
        dmat4 const m = camera_at(path, t, kFov).world_from_camera;
        EXPECT_LT(glm::length(glm::normalize(point - dvec3(m[3])) + dvec3(m[2])), 1e-12) << t;
        EXPECT_NEAR(m[0].y, 0, 1e-12) << "upright";
    }
}

TEST(CameraPath, RestsBeforeAndAfter)
{
    CameraPath const path = winding();
    EXPECT_EQ(camera_at(path, -9, kFov).world_from_camera, camera_at(path, -1, kFov).world_from_camera);
    EXPECT_EQ(camera_at(path, 1e6, kFov).world_from_camera, camera_at(path, 5, kFov).world_from_camera);
    CameraPath one;
    one.keys = {key(3, {1, 2, 3}, dquat(1, 0, 0, 0))};
    for (double const t : {0.0, 3.0, 9.0}) EXPECT_EQ(place(camera_at(one, t, kFov)), dvec3(1, 2, 3));
    EXPECT_EQ(camera_at(one, 0, kFov).yfov_rad, kFov);
}

TEST(CameraPath, FieldsOfViewStayBetweenThoseOfTheKeys)
{
    CameraPath path = winding();
    double const fovs[]{1e-4, 3.1, 1.5, 1.4, 1e-3};
    for (std::size_t i = 0; i < 5; ++i) path.keys[i].fov_rad = fovs[i];
    for (std::size_t i = 0; i + 1 < 5; ++i)
        for (double u = 0; u <= 1; u += 0.01) {
            double const t = glm::mix(path.keys[i].time_s, path.keys[i + 1].time_s, u);
            double const fov = camera_at(path, t, kFov).yfov_rad;
            EXPECT_GE(fov, std::min(fovs[i], fovs[i + 1]) - 1e-12) << t;
            EXPECT_LE(fov, std::max(fovs[i], fovs[i + 1]) + 1e-12) << t;
        }
}

TEST(CameraPathFile, ReadsPointsAndRotations)
{
    CameraPath const path = parse_camera_path(R"(keys:
  - {time_s: 0, from: [0, 1, 2], at: [0, 1, -5], fov: 50}
  - {time_s: 1.5, from: [1, 1, 2], rotation: {degrees: 90}, fov: 40}
  - {time_s: 2, from: [1, 1, 2], rotation: [0, 90, 0], fov: 40}
)",
                                              "p.yaml");
    ASSERT_EQ(path.keys.size(), 3u);
    EXPECT_DOUBLE_EQ(*path.keys[0].fov_rad, glm::radians(50.0));
    EXPECT_LT(glm::length(path.keys[0].rotation - dquat(1, 0, 0, 0)), 1e-15);
    // Unturned, cameras look along -z; a quarter to the left, along -x. One of these keys has no point to look at.
    dmat4 const m = camera_at(path, 1.5, kFov).world_from_camera;
    EXPECT_LT(glm::length(-dvec3(m[2]) - dvec3(-1, 0, 0)), 1e-15);
    EXPECT_LT(difference(m, camera_at(path, 2, kFov).world_from_camera), 1e-15);
}

TEST(CameraPathFile, SaysWhereItIsWrong)
{
    struct Wrong {
        char const *text, *place, *problem;
    };
    for (Wrong const w : {
             Wrong{"keys: [", "p.yaml:1:", "not YAML"},
             {"[]", "p.yaml:1:1", "path is not a map"},
             {"points: []", "p.yaml:1:1", "keys"},
             {"{}", "p.yaml:1:1", "no keys"},
             {"keys: []", "p.yaml:1:7", "no keys"},
             {"keys:\n  - {from: [0, 0, 0], at: [1, 0, 0]}", "p.yaml:2:5", "no time_s"},
             {"keys:\n  - {time_s: 0, at: [1, 0, 0]}", "p.yaml:2:5", "no from"},
             {"keys:\n  - {time_s: 0, from: [0, 0, 0]}", "p.yaml:2:5", "at or rotation"},
             {"keys:\n  - {time_s: 0, from: [0, 0, 0], at: [1, 0, 0], rotation: [0, 0, 0]}", "p.yaml:2:5",
              "at or rotation"},
             {"keys:\n  - {time_s: 0, from: [0, 0, 0], at: [0, 0, 0]}", "p.yaml:2:5", "no direction"},
             {"keys:\n  - {time_s: nan, from: [0, 0, 0], at: [1, 0, 0]}", "p.yaml:2:14", "time_s"},
             {"keys:\n  - {time_s: 0, from: [0, inf, 0], at: [1, 0, 0]}", "p.yaml:2:", "from[1]"},
             {"keys:\n  - {time_s: 0, from: [0, 0, 0], at: [1, 0, 0], fov: 180}", "p.yaml:2:", "fov is 180"},
             {"keys:\n  - {time_s: 0, from: [0, 0, 0], to: [1, 0, 0]}", "p.yaml:2:", "unknown key 'to'"},
             {"keys:\n  - {time_s: 0, from: [0, 0, 0], rotation: {axis: [0, 0, 0], degrees: 4}}",
              "p.yaml:2:", "axis is zero"},
             {"keys:\n  - {time_s: 2, from: [0, 0, 0], at: [1, 0, 0]}\n  - {time_s: 2, from: [0, 0, 0], at: [1, "
              "0, 0]}",
              "p.yaml:3:14", "after one at 2 s"},
             {"keys:\n  - {time_s: 0, from: [0, 0, 0], at: [1, 0, 0]}\n"
              "  - {time_s: 2, from: [0, 0, 0], at: [1, 0, 0], fov: 40}",
              "p.yaml:3:5", "fov"},
         }) {
        try {
            parse_camera_path(w.text, "p.yaml");
            ADD_FAILURE() << "accepted: " << w.text;
        } catch (InputError const& e) {
            std::string const message = e.what();
            EXPECT_TRUE(message.starts_with(w.place)) << w.text << "\n" << message;
            EXPECT_NE(message.find(w.problem), std::string::npos) << w.text << "\n" << message;
        }
    }
}

TEST(CameraPathFile, APathThroughThePointItLooksAtIsRefused)
{
    CameraPath const path = parse_camera_path(
        "keys:\n  - {time_s: 0, from: [0, 0, 1], at: [0, 0, 0]}\n  - {time_s: 2, from: [0, 0, -1], at: [0, 0, 0]}",
        "p.yaml");
    EXPECT_THROW(camera_at(path, 1, kFov), InputError);
}

TEST(CameraPathFile, TheExampleLoads)
{
    CameraPath const path = load_camera_path(LIGHTWELL_SOURCE_DIR "/data/camera_path.yaml");
    EXPECT_GE(path.keys.size(), 3u);
    for (double t = 0; t < 9; t += 0.1) EXPECT_NO_THROW(camera_at(path, t, kFov));
}

} // namespace
} // namespace gi::test
