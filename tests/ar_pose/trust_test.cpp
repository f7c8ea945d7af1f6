// Which pose is shown, for how long, and how strongly, when estimates cannot be trusted.

#include "ar/pose/trust.h"

#include "ar/pose/fused.h"
#include "ar/pose/tracker.h"
#include "gi/core/quantile.h"
#include "tests/ar_pose/synthetic.h"

#include <gtest/gtest.h>
#include <limits>

namespace ar::test {
namespace {

gi::RigidPose at_x(double x_m) { return {{x_m, 0, 0}, {1, 0, 0, 0}}; }

OfferedPose trusted(double x_m) { return {at_x(x_m), {}, true}; }
OfferedPose doubtful() { return {{}, {}, true}; }

TEST(Trust, HoldsThenFadesAndComesBack)
{
    PoseTrust trust({0.3, 0.1, 0.2});
    EXPECT_EQ(trust.next(0, trusted(1)).shown, 1) << "there is nothing to fade in from";
    UsedPose u = trust.next(0.05, doubtful());
    EXPECT_EQ(u.state, PoseState::held);
    EXPECT_EQ(u.shown, 1);
    EXPECT_EQ(u.world_from_camera->position.x, 1);
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
    EXPECT_EQ(u.world_from_camera->position.x, 2);
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
    EXPECT_EQ(u.world_from_camera->position.x, 1.2) << "held where it was shown last: no jump back";
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

/// Errors of what is shown of a camera that circles a single small marker, 5 s long.
struct OneMarker {
    /// Largest change of the error from a frame to the next, both tracked: of the camera, and of where a point 0.1
    /// m above the marker is seen, at its distance.
    double camera_jump_m = 0, seen_jump_m = 0;
    std::vector<double> error_m, unused_m;
};

enum class Fusion { none, frames };

OneMarker circle(double least_confidence, Fusion fusion, double side_m, double away_m)
{
    CameraModel const camera = camera_640();
    std::mt19937 random(7);
    PoseTrackerSettings settings;
    settings.least_confidence = least_confidence;
    PoseTracker tracker(settings);
    PoseTrust trust({least_confidence, 0.1, 0.2});
    PoseFusion fused;
    OneMarker m;
    std::optional<glm::dvec3> last;
    glm::dvec2 last_seen{0};
    int last_k = 0;
    for (int k = 0; k < 150; ++k) {
        double const t = k / 30.0, turn = 0.6 * t;
        // From above, where the two poses that fit a marker are nearly the same, to the side and back.
        double const tilt = glm::radians(6 + 30 * std::pow(std::sin(0.5 * t), 2));
        gi::RigidPose const truth = looking(
            away_m * glm::dvec3(std::sin(tilt) * std::sin(turn), std::cos(tilt), std::sin(tilt) * std::cos(turn)),
            {0, 0, 0});
        PoseEstimate e =
            estimate_pose(sight(one_marker(side_m), camera, truth, 0.15, random), camera, tracker.expected(t));
        if (fusion == Fusion::frames) e = fused.next(t, e);
        Taken const taken = tracker.add(t, e);
        OfferedPose offered;
        offered.is_estimated = e.found();
        bool const confident = e.found() && e.confidence >= least_confidence;
        if (confident && !(taken == Taken::jump && e.ambiguous)) offered.trusted = e.world_from_camera;
        UsedPose const used = trust.next(t, offered);
        if (e.found() && !confident)
            m.unused_m.push_back(glm::length(e.world_from_camera.position - truth.position));
        if (used.state != PoseState::tracked) continue;
        glm::dvec3 const is = used.world_from_camera->position;
        m.error_m.push_back(glm::length(is - truth.position));
        glm::dvec3 const point(0, 0.1, 0), off = is - truth.position;
        auto const here = project(camera, inverse(*used.world_from_camera) * point),
                   there = project(camera, inverse(truth) * point);
        glm::dvec2 const seen = (*here - *there) * (glm::length(truth.position - point) / camera.fx);
        if (last && last_k == k - 1) {
            m.camera_jump_m = std::max(m.camera_jump_m, glm::length(off - *last));
            m.seen_jump_m = std::max(m.seen_jump_m, glm::length(seen - last_seen));
        }
        last = off;
        last_seen = seen;
        last_k = k;
    }
    return m;
}

void print(char const* what, OneMarker const& m)
{
    auto const [a, b] = std::pair(gi::sorted_values(m.error_m), gi::sorted_values(m.unused_m));
    auto const at = [](std::vector<double> const& v, double p) {
        return v.empty() ? 0 : 1e3 * gi::quantile_of_sorted(v, p);
    };
    std::printf("%-22s %3zu shown, median %6.1f mm, 95 %% %6.1f mm, largest jump of the camera %6.1f mm, of what "
                "is seen %5.1f mm; %3zu unused, median %6.1f mm\n",
                what, a.size(), at(a, 0.5), at(a, 0.95), 1e3 * m.camera_jump_m, 1e3 * m.seen_jump_m, b.size(),
                at(b, 0.5));
}

TEST(Trust, OneMarkerDoesNotJump)
{
    for (auto const& [side_m, away_m] : {std::pair(0.05, 1.6), std::pair(0.08, 1.2), std::pair(0.12, 1.2)}) {
        SCOPED_TRACE(side_m);
        std::printf("a marker of %.0f mm from %.1f m\n", 1e3 * side_m, away_m);
        double const least = TrustSettings{}.least_confidence;
        OneMarker const all = circle(0, Fusion::none, side_m, away_m),
                        some = circle(least, Fusion::none, side_m, away_m),
                        fused = circle(least, Fusion::frames, side_m, away_m);
        print("all", all);
        print("trusted", some);
        print("fused and trusted", fused);
        EXPECT_GT(all.seen_jump_m, 0.01) << "else there is nothing to test";
        EXPECT_LT(some.seen_jump_m, 0.01);
        EXPECT_LT(fused.seen_jump_m, 0.01);
        EXPECT_LT(fused.camera_jump_m, 0.5 * all.camera_jump_m);
        EXPECT_GE(fused.error_m.size(), some.error_m.size());
    }
}

} // namespace
} // namespace ar::test
