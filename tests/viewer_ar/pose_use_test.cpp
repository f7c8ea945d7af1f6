// The poses that frames are shown with.

#include "ar/pipeline/pose_use.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

ar::PoseEstimate estimate(glm::dvec3 position_m)
{
    ar::PoseEstimate e;
    e.failure = ar::PoseFailure::none;
    e.world_from_camera.position_m = position_m;
    e.confidence = 1;
    return e;
}

/// Ten frames of a camera at rest, then one of a jump.
ar::Pose shown_of_a_jump(ArPoseUse const& use)
{
    ar::PoseTracker track(use.tracker);
    for (int k = 0; k < 10; ++k) track.add(k / 30.0, estimate({0, 0, 1}));
    ar::PoseEstimate jump = estimate({2, 0, 1});
    track.add(10 / 30.0, jump);
    EXPECT_EQ(track.counts().jumps_refused, 1u);
    EXPECT_FALSE(use_pose(use, track, 10 / 30.0, jump));
    return jump.world_from_camera;
}

TEST(PosesShown, AreNotThoseRefusedAsJumps)
{
    ArPoseUse use;
    EXPECT_EQ(shown_of_a_jump(use).position_m.x, 2); // as it was estimated
    use.filtered = true;
    EXPECT_NEAR(shown_of_a_jump(use).position_m.x, 0, 1e-9);
}

TEST(PosesShown, ArePredictedOnlyOnRequest)
{
    ArPoseUse use;
    ar::PoseTracker track(use.tracker);
    for (int k = 0; k < 10; ++k) track.add(k / 30.0, estimate({0, 0, 1}));
    ar::PoseEstimate none;
    none.failure = ar::PoseFailure::too_few_points;
    track.add(10 / 30.0, none);
    EXPECT_FALSE(use_pose(use, track, 10 / 30.0, none));
    EXPECT_FALSE(none.found());
    use.predict_s = 0.1;
    EXPECT_TRUE(use_pose(use, track, 10 / 30.0, none));
    EXPECT_TRUE(none.found());
}

} // namespace
} // namespace viewer::test
