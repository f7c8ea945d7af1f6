#include "ar/calibration/collector.h"

#include <gtest/gtest.h>

namespace ar::test {
namespace {

CameraModel const kCamera{LensModel::pinhole, {640, 480}, 525, 525, 320, 240, {}};

BoardView board_at(cv::Vec3d const& turn, glm::dvec3 at)
{
    BoardView v;
    gi::RigidPose const p = pose_of(turn, {at.x, at.y, at.z}) * gi::RigidPose{{-0.12, -0.075, 0}, {1, 0, 0, 0}};
    for (int i = 0; i < 54; ++i) {
        glm::dvec3 const m(0.03 * (i % 9), 0.03 * (i / 9), 0);
        auto const px = project(kCamera, p * m);
        if (!px || px->x < 0 || px->y < 0 || px->x > 639 || px->y > 479) continue;
        v.board_m.push_back(m);
        v.pixels.push_back(*px);
    }
    return v;
}

TEST(Collector, TakesWhatIsNewAndAsksForWhatIsMissing)
{
    Collector c(kCamera.size_px, ViewSource::stills, LensModel::pinhole, 8);
    EXPECT_EQ(c.next(), "show the board in the upper left of the picture");
    EXPECT_TRUE(c.offer(board_at({0, 0, 0}, {-0.12, -0.1, 0.5})).taken);
    EXPECT_FALSE(c.offer(board_at({0, 0.02, 0}, {-0.12, -0.1, 0.5})).taken);
    EXPECT_EQ(c.counts().alike, 1);
    EXPECT_EQ(c.next(), "show the board in the upper right of the picture");
    for (glm::dvec3 const at : {glm::dvec3(0.12, -0.1, 0.5), {-0.12, 0.1, 0.5}, {0.12, 0.1, 0.5}, {0, 0, 0.35}})
        EXPECT_TRUE(c.offer(board_at({0, 0, 0.05}, at)).taken);
    EXPECT_EQ(c.next(), "turn the board so that it faces left in the picture, by about 30 degrees");
    EXPECT_FALSE(c.live()) << "parallel boards fit any focal length";
    Offer const turned = c.offer(board_at({0, -0.5, 0}, {0, 0, 0.5}));
    EXPECT_TRUE(turned.taken) << turned.why;
    EXPECT_NE(c.next(), "turn the board so that it faces left in the picture, by about 30 degrees");
    for (cv::Vec3d const& turn : {cv::Vec3d(0, 0.5, 0), {0.5, 0, 0}, {-0.5, 0, 0}})
        EXPECT_TRUE(c.offer(board_at(turn, {0, 0, 0.6})).taken);
    EXPECT_TRUE(c.enough()) << c.next();
    ASSERT_TRUE(c.live());
    EXPECT_NEAR(c.live()->camera.fx, 525, 0.1);
    EXPECT_LT(c.offer(board_at({0.1, 0.1, 0}, {0, 0, 0.7})).rms_px.value_or(1), 0.01);
    EXPECT_GT(cv::sum(c.coverage())[0], 40);
}

TEST(Collector, WaitsUntilTheBoardIsStill)
{
    Collector c(kCamera.size_px, ViewSource::live, LensModel::pinhole);
    EXPECT_EQ(c.offer(board_at({0, 0, 0}, {0, 0, 0.5})).why, "hold the board still");
    EXPECT_EQ(c.offer(board_at({0, 0, 0}, {0.01, 0, 0.5})).why, "hold the board still");
    EXPECT_TRUE(c.offer(board_at({0, 0, 0}, {0.0105, 0, 0.5})).taken);
    EXPECT_FALSE(c.offer({}).taken);
    EXPECT_EQ(c.counts().too_few_points, 1);
    EXPECT_EQ(c.counts().moving, 2);
}

} // namespace
} // namespace ar::test
