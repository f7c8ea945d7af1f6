// Which pose is shown, for how long, and how strongly, when estimates cannot be trusted.

#include "ar/pose/trust.h"

#include "ar/pose/tracker.h"
#include "tests/ar_pose/synthetic.h"

#include <gtest/gtest.h>
#include <limits>

namespace ar::test {
namespace {

Pose at_x(double x_m) { return {{1, 0, 0, 0}, {x_m, 0, 0}}; }

OfferedPose trusted(double x_m) { return {at_x(x_m), {}, true}; }
OfferedPose doubtful() { return {{}, {}, true}; }

TEST(Trust, HoldsThenFadesAndComesBack)
{
    PoseTrust trust({0.3, 0.1, 0.2});
    EXPECT_EQ(trust.next(0, trusted(1)).shown, 1) << "there is nothing to fade in from";
    UsedPose u = trust.next(0.05, doubtful());
    EXPECT_EQ(u.state, PoseState::held);
    EXPECT_EQ(u.shown, 1);
    EXPECT_EQ(u.world_from_camera->position_m.x, 1);
    EXPECT_EQ(trust.next(0.1, {}).state, PoseState::held);
    u = trust.next(0.15, {});
    EXPECT_EQ(u.state, PoseState::fading);
    EXPECT_NEAR(u.shown, 0.75, 1e-9);
    EXPECT_NEAR(trust.next(0.25, doubtful()).shown, 0.25, 1e-9);
    u = trust.next(0.35, doubtful());
    EXPECT_EQ(u.state, PoseState::uncertain);
    EXPECT_FALSE(u.world_from_camera);
    EXPECT_EQ(u.shown, 0);
    EXPECT_EQ(trust.next(0.4, {}).state, PoseState::lost);
    u = trust.next(0.45, trusted(2));
    EXPECT_EQ(u.state, PoseState::tracked);
    EXPECT_NEAR(u.shown, 0.25, 1e-9);
    EXPECT_EQ(u.world_from_camera->position_m.x, 2);
    EXPECT_EQ(trust.next(1, trusted(2)).shown, 1);
    EXPECT_EQ(trust.counts()[std::size_t(PoseState::tracked)], 3u);
    EXPECT_EQ(trust.counts()[std::size_t(PoseState::fading)], 2u);
}

TEST(Trust, FadesNoLongerThanItsFrameIsLate)
{
    // A frame long after the last one: only the time after the holding counts.
    PoseTrust trust({0.3, 0.5, 1});
    trust.next(0, trusted(1));
    EXPECT_NEAR(trust.next(0.75, {}).shown, 0.75, 1e-9);
    EXPECT_EQ(trust.next(5, {}).state, PoseState::lost);
}

TEST(Trust, PredictsBeforeItHolds)
{
    PoseTrust trust({0.3, 0.1, 0});
    trust.next(0, trusted(1));
    OfferedPose predicted;
    predicted.predicted = at_x(1.2);
    EXPECT_EQ(trust.next(0.05, predicted).state, PoseState::predicted);
    UsedPose const u = trust.next(0.1, {});
    EXPECT_EQ(u.state, PoseState::held);
    EXPECT_EQ(u.world_from_camera->position_m.x, 1.2) << "held where it was shown last: no jump back";
    EXPECT_EQ(trust.next(0.2, {}).state, PoseState::lost) << "at once without fading";
}

TEST(Trust, StandsTimesThatAreNone)
{
    PoseTrust trust;
    double const nan = std::numeric_limits<double>::quiet_NaN();
    EXPECT_EQ(trust.next(nan, {}).state, PoseState::lost);
    EXPECT_EQ(trust.next(3, trusted(1)).state, PoseState::tracked);
    EXPECT_EQ(trust.next(nan, {}).state, PoseState::held);
    EXPECT_EQ(trust.next(1, {}).state, PoseState::held) << "time does not run backwards";
}

/// What is shown of a camera that circles a single small marker: the largest step between frames shown one after
/// another, beyond the camera's own, and the largest error.
struct OneMarker {
    double most_jump_m = 0, most_error_m = 0;
    int shown = 0, below = 0;
    double most_unused_error_m = 0;
};

OneMarker circle(double least_confidence)
{
    CameraModel const camera = camera_640();
    std::mt19937 random(7);
    TrackerSettings settings;
    settings.least_confidence = least_confidence;
    PoseTracker tracker(settings);
    PoseTrust trust({least_confidence, 0.1, 0.2});
    OneMarker m;
    std::optional<glm::dvec3> last, last_true;
    for (int k = 0; k < 150; ++k) {
        double const t = k / 30.0, turn = 0.6 * t;
        // From above, where its two poses are close together, to the side and back.
        double const tilt = glm::radians(6 + 30 * std::pow(std::sin(0.5 * t), 2));
        Pose const truth = looking(
            1.6 * glm::dvec3(std::sin(tilt) * std::sin(turn), std::cos(tilt), std::sin(tilt) * std::cos(turn)),
            {0, 0, 0});
        PoseEstimate const e =
            estimate_pose(sight(one_marker(0.05), camera, truth, 0.15, random), camera, tracker.expected(t));
        Taken const taken = tracker.add(t, e);
        OfferedPose offered;
        offered.is_estimated = e.found();
        bool const confident = e.found() && e.confidence >= least_confidence;
        if (confident && !(taken == Taken::jump && e.ambiguous)) offered.trusted = e.world_from_camera;
        UsedPose const used = trust.next(t, offered);
        if (e.found() && !confident) {
            ++m.below;
            m.most_unused_error_m =
                std::max(m.most_unused_error_m, glm::length(e.world_from_camera.position_m - truth.position_m));
        }
        if (used.state == PoseState::tracked) {
            ++m.shown;
            m.most_error_m =
                std::max(m.most_error_m, glm::length(used.world_from_camera->position_m - truth.position_m));
            if (last)
                m.most_jump_m = std::max(m.most_jump_m, glm::length((used.world_from_camera->position_m - *last) -
                                                                    (truth.position_m - *last_true)));
            last = used.world_from_camera->position_m;
            last_true = truth.position_m;
        }
    }
    return m;
}

TEST(Trust, OneMarkerDoesNotJump)
{
    OneMarker const all = circle(0), some = circle(TrustSettings{}.least_confidence);
    std::printf(
        "all: jumps of %.3f m, errors of %.3f m; trusted: %.3f m, %.3f m, %d frames, %d not used (up to %.3f m)\n",
        all.most_jump_m, all.most_error_m, some.most_jump_m, some.most_error_m, some.shown, some.below,
        some.most_unused_error_m);
    EXPECT_GT(all.most_jump_m, 0.1) << "else there is nothing to test";
    EXPECT_GT(some.below, 10);
    EXPECT_LT(some.most_jump_m, 0.1 * all.most_jump_m);
}

} // namespace
} // namespace ar::test
