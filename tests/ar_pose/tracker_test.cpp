#include "ar/pose/tracker.h"

#include "gi/core/error.h"
#include "gi/core/rotation.h"
#include "tests/ar_pose/synthetic.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <limits>
#include <numbers>

namespace ar::test {
namespace {

PoseEstimate found(gi::RigidPose const& pose, double sigma_m = 0.001, double sigma_deg = 0.05)
{
    PoseEstimate e;
    e.failure = PoseFailure::none;
    e.world_from_camera = pose;
    e.position_sigma_m = glm::dvec3(sigma_m);
    e.rotation_sigma_deg = glm::dvec3(sigma_deg);
    e.confidence = 1;
    return e;
}

PoseEstimate nothing() { return {}; }

struct Noise {
    std::mt19937 random{21};
    std::normal_distribution<double> n{0, 1};

    gi::RigidPose on(gi::RigidPose const& p, double m, double deg)
    {
        double const r = glm::radians(deg);
        glm::dvec3 const turn = r * glm::dvec3(n(random), n(random), n(random));
        return {p.position + m * glm::dvec3(n(random), n(random), n(random)),
                glm::normalize(p.rotation * gi::exp_rotation(turn))};
    }
};

/// Half a metre to and fro in 4 s, looking about by 20 degrees.
gi::RigidPose walk(double t)
{
    double const w = 2 * std::numbers::pi / 4;
    return {{0.25 * std::sin(w * t), 1.5 + 0.03 * std::sin(2 * w * t), 0.15 * std::cos(w * t)},
            gi::exp_rotation({0.1 * std::sin(w * t), 0.35 * std::sin(0.7 * w * t), 0})};
}

double rms(std::vector<double> const& v)
{
    double sum = 0;
    for (double x : v) sum += x * x;
    return std::sqrt(sum / double(v.size()));
}

TEST(Tracker, SteadiesAtRest)
{
    Noise noise;
    PoseTracker tracker;
    gi::RigidPose const truth{{1, 2, 3}, gi::exp_rotation({0.1, 0.2, 0})};
    std::vector<double> in_mm, out_mm, in_deg, out_deg;
    for (int i = 0; i < 600; ++i) {
        gi::RigidPose const seen = noise.on(truth, 0.001, 0.05);
        tracker.add(i / 30.0, found(seen));
        if (i < 60) continue;
        gi::RigidPose const shown = *tracker.at(i / 30.0).world_from_camera;
        in_mm.push_back(1e3 * glm::length(seen.position - truth.position));
        out_mm.push_back(1e3 * glm::length(shown.position - truth.position));
        in_deg.push_back(angle_between_deg(seen.rotation, truth.rotation));
        out_deg.push_back(angle_between_deg(shown.rotation, truth.rotation));
    }
    fmt::print("jitter at rest, 30 Hz: {:.3f} mm {:.4f} deg in, {:.3f} mm {:.4f} deg out\n", rms(in_mm),
               rms(in_deg), rms(out_mm), rms(out_deg));
    EXPECT_LT(rms(out_mm), 0.75 * rms(in_mm));
    EXPECT_LT(rms(out_deg), 0.75 * rms(in_deg));
}

/// The time by which the walk must be shifted to fit best what is shown of it, s.
double lag_s(PoseTracker& tracker, double hz)
{
    std::vector<std::pair<double, glm::dvec3>> shown;
    for (int i = 0; i < int(12 * hz); ++i) {
        double const t = i / hz;
        tracker.add(t, found(walk(t)));
        if (t > 2) shown.emplace_back(t, tracker.at(t).world_from_camera->position);
    }
    double best = 0, least = 1e9;
    for (double lag = -0.1; lag < 0.2; lag += 0.001) {
        double sum = 0;
        for (auto const& [t, p] : shown) {
            glm::dvec3 const d = p - walk(t - lag).position;
            sum += glm::dot(d, d);
        }
        if (sum < least) {
            least = sum;
            best = lag;
        }
    }
    return best;
}

TEST(Tracker, IsNotBehindAWalk)
{
    PoseTracker tracker;
    double const lag = lag_s(tracker, 30);
    fmt::print("lag on a walk of 0.25 m each way in 4 s, 30 Hz: {:.1f} ms\n", 1e3 * lag);
    EXPECT_LT(std::abs(lag), 0.015);
}

TEST(Tracker, PredictsAWalk)
{
    for (double const ahead : {0.0, 0.033, 0.066, 0.1}) {
        Noise noise;
        PoseTracker tracker;
        std::vector<double> held_mm, mm, deg;
        for (int i = 0; i < 600; ++i) {
            double const t = i / 30.0;
            gi::RigidPose const seen = noise.on(walk(t), 0.001, 0.05);
            tracker.add(t, found(seen));
            if (i < 60) continue;
            gi::RigidPose const p = *tracker.at(t + ahead).world_from_camera, truth = walk(t + ahead);
            mm.push_back(1e3 * glm::length(p.position - truth.position));
            deg.push_back(angle_between_deg(p.rotation, truth.rotation));
            held_mm.push_back(1e3 * glm::length(seen.position - truth.position));
        }
        fmt::print("walk, {:.0f} ms ahead: {:.2f} mm {:.3f} deg rms (not predicted {:.2f} mm)\n", 1e3 * ahead,
                   rms(mm), rms(deg), rms(held_mm));
        EXPECT_LT(rms(mm), ahead > 0.03 ? 0.5 * rms(held_mm) : 3);
        EXPECT_LT(rms(mm), 3 + 120 * ahead);
    }
}

TEST(Tracker, PredictsOnlySoFarAndThenIsLost)
{
    PoseTrackerSettings settings;
    PoseTracker tracker(settings);
    EXPECT_FALSE(tracker.at(0).world_from_camera);
    for (int i = 0; i <= 30; ++i) tracker.add(i / 30.0, found({{i / 30.0, 0, 0}, {1, 0, 0, 0}}));
    EXPECT_EQ(tracker.at(1.0).age_s, 0);
    EXPECT_NEAR(tracker.at(1.09).age_s, 0.09, 1e-12);
    EXPECT_NEAR(tracker.at(1.09).world_from_camera->position.x, 1.09, 0.01);
    EXPECT_NEAR(tracker.at(1.4).world_from_camera->position.x, 1.1, 0.01);
    EXPECT_FALSE(tracker.at(1.6).world_from_camera);
    for (int i = 31; i < 60; ++i) tracker.add(i / 30.0, nothing());
    EXPECT_EQ(tracker.counts().missed, 29u);
    gi::RigidPose const elsewhere{{-3, 0, 2}, {1, 0, 0, 0}};
    tracker.add(2.0, found(elsewhere));
    EXPECT_EQ(tracker.counts().recoveries, 1u);
    EXPECT_EQ(tracker.at(2.0).age_s, 0);
    EXPECT_EQ(tracker.at(2.0).world_from_camera->position, elsewhere.position);
    tracker.add(1.5, found(elsewhere));
    tracker.add(std::numeric_limits<double>::quiet_NaN(), found(elsewhere));
    EXPECT_EQ(tracker.counts().late, 2u);
    EXPECT_FALSE(tracker.at(std::numeric_limits<double>::quiet_NaN()).world_from_camera);
}

TEST(Tracker, BelievesAJumpOnlyWhenItLasts)
{
    PoseTracker tracker;
    gi::RigidPose const here{{0, 1, 0}, {1, 0, 0, 0}}, there{{2, 1, 0}, gi::exp_rotation({0, 1, 0})};
    int i = 0;
    for (; i < 20; ++i) tracker.add(i / 30.0, found(here));
    tracker.add(i++ / 30.0, found(there));
    EXPECT_LT(glm::length(tracker.at(i / 30.0).world_from_camera->position - here.position), 1e-6);
    tracker.add(i++ / 30.0, found(here));
    EXPECT_EQ(tracker.counts().jumps_refused, 1u);
    EXPECT_EQ(tracker.counts().jumps_believed, 0u);
    for (int k = 0; k < 3; ++k) tracker.add(i++ / 30.0, found(there));
    EXPECT_EQ(tracker.counts().jumps_believed, 1u);
    EXPECT_LT(glm::length(tracker.at((i - 1) / 30.0).world_from_camera->position - there.position), 1e-6);
}

TEST(Tracker, OfATripodAveragesAndNoticesThatItWasMoved)
{
    Noise noise;
    PoseTrackerSettings settings;
    settings.motion = CameraMotion::tripod;
    PoseTracker tracker(settings);
    gi::RigidPose const first{{1, 2, 3}, gi::exp_rotation({0.1, 0.5, 0})},
        second{{1.02, 2, 3}, gi::exp_rotation({0.1, 0.51, 0})};
    double t = 0;
    for (int i = 0; i < 300; ++i, t += 1 / 30.0) {
        bool const wrong = i % 10 == 9; // an estimate in ten is far off
        tracker.add(t,
                    found(noise.on(wrong ? gi::RigidPose{first.position + glm::dvec3(0.3), first.rotation} : first,
                                   0.001, 0.05)));
    }
    StillPose const still = *tracker.still().pose();
    EXPECT_EQ(still.left_out, 30u);
    double const off = glm::length(still.world_from_camera.position - first.position);
    fmt::print("tripod, 270 estimates of 1 mm and 0.05 deg a side: {:.3f} mm {:.4f} deg off\n", 1e3 * off,
               angle_between_deg(still.world_from_camera.rotation, first.rotation));
    EXPECT_LT(off, 0.0003);
    EXPECT_LT(glm::length(still.position_sigma_m), 0.0002);
    EXPECT_EQ(tracker.counts().moves, 0u);
    for (int i = 0; i < 60; ++i, t += 1 / 30.0) tracker.add(t, found(noise.on(second, 0.001, 0.05)));
    EXPECT_EQ(tracker.counts().moves, 1u);
    EXPECT_LT(glm::length(tracker.at(t).world_from_camera->position - second.position), 0.001);
    EXPECT_TRUE(tracker.at(t + 100).world_from_camera); // covered, not moved
}

TEST(Tracker, RefusesSettingsThatMeanNothing)
{
    PoseTrackerSettings s;
    s.lost_after_s = 0;
    EXPECT_THROW(PoseTracker{s}, gi::InputError);
    s = {};
    s.position.min_cutoff_hz = std::numeric_limits<double>::quiet_NaN();
    EXPECT_THROW(PoseTracker{s}, gi::InputError);
}

} // namespace
} // namespace ar::test
