// Cameras by trackers: what recorded and live ones say of a motion that is known.

#include "viewer/camera_view/camera_tracker.h"

#include "ar/scene/session_file.h"
#include "gi/core/error.h"
#include "tests/viewer/run_program.h"
#include "tests/viewer_tracking/pose_checks.h"
#include "viewer/devices/tracking/tracker_hub.h"

#include <fmt/format.h>

namespace viewer::test {
namespace {

void write_poses(std::filesystem::path const& file, std::string const& text) { std::ofstream(file) << text; }

std::string const kSession = "schema: ar/1\nframes: {source: f}\ncamera: c.yaml\nmarkers: m.yaml\n";

std::string pose_refusal(std::string const& more)
{
    try {
        ar::parse_session(kSession + more, "folder/s.yaml");
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return "";
}

/// A sensor that goes along x at 1 m/s and turns about y at 1 rad/s.
RoomPose sensor_at(double t) { return {{t, 1.5, 0}, glm::angleAxis(t, gi::dvec3(0, 1, 0))}; }

TEST(TrackedCameras, KeysAreReadAndRefusedWithTheirPlace)
{
    ar::Session const s = ar::parse_session(
        kSession + "pose: {display: room.yaml, tracker: head, offset_s: 0.5, camera_from_sensor: {position_m: [0, "
                   "-0.05, 0]}, world_from_room: {rotation_deg: [0, 90, 0]}}\n",
        "folder/s.yaml");
    ASSERT_TRUE(s.tracked);
    EXPECT_EQ(s.tracked->display, "folder/room.yaml");
    EXPECT_EQ(s.tracked->tracker, "head");
    EXPECT_EQ(s.tracked->camera_from_sensor.position, glm::dvec3(0, -0.05, 0));
    EXPECT_EQ(s.tracked->camera_from_sensor.rotation, glm::dquat(0, 1, 0, 0)) << "as heads look";
    EXPECT_NEAR(ar::angle_between_deg(s.tracked->world_from_room.rotation, {1, 0, 0, 0}), 90, 1e-9);
    EXPECT_NE(pose_refusal("pose: {trackr: x}\n").find("s.yaml:5:"), std::string::npos);
    EXPECT_NE(pose_refusal("pose: {camera_from_sensor: {position: [0, 0, 0]}}\n").find("s.yaml:5:"),
              std::string::npos);
    EXPECT_NE(pose_refusal("pose: {offset_s: soon}\n").find("s.yaml:5:"), std::string::npos);
}

TEST(TrackedCameras, OfHeadsetsAreReadAndRefusedWithTheirPlace)
{
    ar::Session const s = ar::parse_session(
        kSession + "hmd: {plane_m: 2, head_from_camera: {position_m: [0, 0.02, -0.05]}, right: {source: right, "
                   "camera: right.yaml, left_from_right: {position_m: [0.064, 0, 0]}}}\n",
        "folder/s.yaml");
    ASSERT_TRUE(s.hmd && s.hmd->right);
    EXPECT_EQ(s.hmd->plane_m, 2);
    EXPECT_EQ(s.hmd->right->source, "folder/right");
    EXPECT_EQ(s.hmd->right->calibration, "folder/right.yaml");
    EXPECT_EQ(s.hmd->right->left_from_right, (gi::RigidPose{{0.064, 0, 0}, {1, 0, 0, 0}}));
    EXPECT_EQ(s.hmd->head_from_camera.rotation, glm::dquat(0, 1, 0, 0));
    EXPECT_NE(pose_refusal("hmd: {plane_m: 0}\n").find("s.yaml:5:"), std::string::npos);
    EXPECT_NE(pose_refusal("hmd: {right: {source: right}}\n").find("no 'camera'"), std::string::npos);
}

class RecordedTrackers : public testing::Test {
protected:
    RecordedTrackers()
    {
        std::string text = "time_s,body,x_m,y_m,z_m,qx,qy,qz,qw\n";
        for (int i = 0; i <= 50; ++i) {
            RoomPose const p = sensor_at(0.02 * i);
            for (char const* body : {"camera", "other"})
                text +=
                    fmt::format("{:.6f},{},{},{},{},{},{},{},{}\n", 7 + 0.02 * i, body, p.position.x, p.position.y,
                                p.position.z, p.rotation.x, p.rotation.y, p.rotation.z, p.rotation.w);
        }
        write_poses(folder_ / "walk.csv", text);
    }
    ar::TrackerUse room(std::string const& tracker) const
    {
        write_poses(
            folder_ / "room.yaml",
            "windows: [{name: w, size_px: [64, 48]}]\nwalls: [{name: w, window: w, lower_left_m: [-1, 0, 0], "
            "lower_right_m: [1, 0, 0], upper_left_m: [-1, 1, 0]}]\ntrackers: [" +
                tracker + "]\nusers: [{name: a, head_position_m: [0, 1.7, 0], head_tracker: sensor}]\n");
        ar::TrackerUse t;
        t.display = folder_ / "room.yaml";
        return t;
    }
    TemporaryFolder folder_;
    gi::Report report_;
};

TEST_F(RecordedTrackers, SayWhereTheCameraIsByTheTimeOfFrames)
{
    ar::TrackerUse t = room("{name: sensor, type: file, file: walk.csv, body: camera}");
    t.camera_from_sensor.position = {0, -0.1, 0}; // 0.1 m above the camera, whose y is down
    t.world_from_room = {{0, 0, 1}, glm::angleAxis(glm::radians(90.0), glm::dvec3(0, 1, 0))};
    t.offset_s = 0.2;
    CameraTracker const camera(t, report_);
    EXPECT_FALSE(camera.is_live());
    auto const p = ar::pose_at(camera.recorded(), 0.31);
    ASSERT_TRUE(p);
    // Half a metre along x is half a metre along -z of the world, which begins at z = 1.
    EXPECT_LT(glm::length(p->position - glm::dvec3(0, 1.4, 0.49)), 1e-4);
    glm::dvec3 const ahead = p->rotation * glm::dvec3(0, 0, 1), down = p->rotation * glm::dvec3(0, 1, 0);
    double const angle = 0.51 + glm::radians(90.0);
    EXPECT_LT(glm::length(ahead - glm::dvec3(-std::sin(angle), 0, -std::cos(angle))), 1e-6);
    EXPECT_LT(glm::length(down - glm::dvec3(0, -1, 0)), 1e-9);
}

TEST_F(RecordedTrackers, ThatCannotBeAreRefused)
{
    auto const problem = [&](std::string const& tracker, std::string const& name = "") {
        ar::TrackerUse t = room(tracker);
        t.tracker = name;
        try {
            CameraTracker const camera(t, report_);
        } catch (gi::InputError const& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    EXPECT_NE(problem("{name: sensor, type: file, file: walk.csv, body: nobody}").find("no body 'nobody'"),
              std::string::npos);
    EXPECT_NE(problem("{name: sensor, type: fake}").find("move no camera"), std::string::npos);
    EXPECT_NE(problem("{name: sensor, type: fake}", "sensr").find("one of sensor"), std::string::npos);
    EXPECT_THROW(CameraTracker(ar::TrackerUse{}, report_), gi::InputError) << "no display";
}

/// Samples of the motion at 100 Hz, until a moment.
class KnownTracker : public Tracker {
public:
    void poll(double now_s, std::vector<TrackerSample>& samples) override
    {
        for (; next_ * 0.01 <= now_s; ++next_) {
            TrackerSample s;
            s.body = "head";
            s.pose = sensor_at(next_ * 0.01);
            s.measured_s = s.received_s = next_ * 0.01;
            samples.push_back(s);
        }
    }
    TrackerCounts counts() const override { return {}; }
    std::string description() const override { return "known"; }

private:
    int next_ = 0;
};

TEST(TrackedCameras, LiveOnesAreAskedForTheMomentOfTheExposure)
{
    TrackerSettings settings;
    settings.filter.enabled = false;
    settings.prediction.smooth_s = 0;
    std::vector<std::unique_ptr<Tracker>> sources;
    sources.push_back(std::make_unique<KnownTracker>());
    auto hub = std::make_unique<TrackerHub>(std::vector{settings}, std::move(sources), Polling::by_caller);
    for (int i = 0; i <= 200; ++i) hub->poll(0.005 * i);
    CameraTracker camera(ar::TrackerUse{}, std::move(hub));
    ASSERT_TRUE(camera.is_live());
    for (double const t : {0.905, 0.95, 0.9871}) { // the past: between samples
        auto const p = camera.at(t);
        ASSERT_TRUE(p) << t;
        EXPECT_NEAR(p->position.x, t, 1e-3);
        EXPECT_NEAR(std::asin(-(p->rotation * glm::dvec3(0, 0, 1)).x), t, 2e-3);
    }
    auto const soon = camera.at(1.03); // predicted
    ASSERT_TRUE(soon);
    EXPECT_NEAR(soon->position.x, 1.03, 0.01);
    EXPECT_FALSE(camera.at(3)) << "lost";
    EXPECT_NE(camera.describe().find("5 frames, 4 with a pose"), std::string::npos) << camera.describe();
}

} // namespace
} // namespace viewer::test
