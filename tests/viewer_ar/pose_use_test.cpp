// The poses that frames are shown with.

#include "ar/pipeline/pose_use.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

ar::PoseEstimate estimate(glm::dvec3 position_m, double confidence = 1)
{
    ar::PoseEstimate e;
    e.failure = ar::PoseFailure::none;
    e.world_from_camera.position = position_m;
    e.confidence = confidence;
    return e;
}

/// Offered by an estimate after ten frames of a camera at rest.
ar::OfferedPose offered_after_rest(ar::PoseUse const& use, ar::PoseEstimate const& e)
{
    ar::PoseTracker track(tracker_settings(use));
    for (int k = 0; k < 10; ++k) track.add(k / 30.0, estimate({0, 0, 1}));
    ar::Taken const taken = track.add(10 / 30.0, e);
    return ar::offered_pose(use, track, 10 / 30.0, e, taken);
}

TEST(PosesShown, AreNotThoseRefusedAsJumps)
{
    ar::PoseUse use;
    ar::PoseEstimate jump = estimate({2, 0, 1});
    EXPECT_EQ(offered_after_rest(use, jump).trusted->position.x, 2) << "a clear one stands: frames may be stills";
    jump.ambiguous = true;
    EXPECT_FALSE(offered_after_rest(use, jump).trusted);
    use.filtered = true;
    EXPECT_NEAR(offered_after_rest(use, jump).trusted->position.x, 0, 1e-9);
}

TEST(PosesShown, AreNotThoseOfNoConfidence)
{
    ar::PoseUse use;
    for (double const confidence : {0.28, 0.1, 0.008}) {
        ar::OfferedPose const offered = offered_after_rest(use, estimate({0.1, 0, 1}, confidence));
        EXPECT_FALSE(offered.trusted);
        EXPECT_TRUE(offered.is_estimated);
    }
    EXPECT_TRUE(offered_after_rest(use, estimate({0, 0, 1}, 0.6)).trusted);
    use.trust.least_confidence = 0.05;
    EXPECT_TRUE(offered_after_rest(use, estimate({0, 0, 1}, 0.1)).trusted);
    use.filtered = true;
    EXPECT_FALSE(offered_after_rest(use, estimate({0, 0, 1}, 0.01)).trusted);
}

TEST(PosesShown, ArePredictedOnlyOnRequest)
{
    ar::PoseUse use;
    EXPECT_FALSE(offered_after_rest(use, {}).predicted);
    use.predict_s = 0.1;
    EXPECT_TRUE(offered_after_rest(use, {}).predicted);
    EXPECT_FALSE(offered_after_rest(use, {}).is_estimated);
}

} // namespace
} // namespace viewer::test
