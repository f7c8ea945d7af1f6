// Composites for two eyes: each from its own camera, both of the same moment.

#include "viewer/camera_view/hmd_run.h"

#include "ar/capture/open_source.h"
#include "ar/markers/marker_map_file.h"
#include "gi/core/error.h"
#include "tests/viewer/run_program.h"

#include <glm/gtc/quaternion.hpp>

namespace viewer::test {
namespace {

TEST(HeadPaths, AreInterpolatedAndHeldAtTheirEnds)
{
    HeadPath path;
    EXPECT_FALSE(path.at(1));
    for (int i = 0; i <= 10; ++i)
        path.add(5 + 0.01 * i, {{0.2 * i, 1.6, 0}, glm::angleAxis(0.1 * i, glm::dvec3(0, 1, 0))});
    auto const between = path.at(5.035);
    ASSERT_TRUE(between);
    EXPECT_NEAR(between->position.x, 0.7, 1e-9);
    EXPECT_NEAR(ar::angle_between_deg(between->rotation, {1, 0, 0, 0}), glm::degrees(0.35), 1e-9);
    EXPECT_NEAR(path.at(1)->position.x, 0, 1e-12);
    EXPECT_NEAR(path.at(9)->position.x, 2, 1e-12);
    path.add(8, {}); // what is older than two seconds is forgotten
    EXPECT_EQ(path.at(5), path.at(8));
}

class TwoCameras : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        made_ = new TemporaryFolder;
        run_well("ar synthesize desk --frames 2 --size 64x48 --paths 1 --no-truth", made_->path());
    }
    static void TearDownTestSuite() { delete made_; }
    TwoCameras() : folder_(*made_)
    {
        session_ = ar::read_session(folder_ / "desk/session.yaml");
        session_.hmd.emplace().right = {(folder_ / "desk/frames").string(), folder_ / "desk/camera.yaml",
                                        gi::RigidPose{{0.06, 0, 0}, glm::angleAxis(0.05, glm::dvec3(0, 1, 0))}};
        options_.pace = ar::Pace::fastest;
        options_.poses = ar::read_poses(folder_ / "desk/poses.csv", {30}).poses;
    }
    std::shared_ptr<PassThroughFrame const> last(PassThrough& p) const
    {
        while (!p.has_ended()) std::this_thread::sleep_for(std::chrono::milliseconds(2));
        p.end();
        p.rethrow();
        return p.newest();
    }

    static inline TemporaryFolder* made_ = nullptr;
    TemporaryFolder const& folder_;
    ar::Session session_;
    PassThroughOptions options_;
    gi::Report report_;
};

TEST_F(TwoCameras, AreEachCompositedFromWhereTheyAre)
{
    PassThrough pass_through(session_, options_, report_);
    auto const made = last(pass_through);
    ASSERT_TRUE(made);
    PassThroughCounts const counts = pass_through.counts();
    EXPECT_EQ(counts.frames, 2u);
    EXPECT_EQ(counts.poses.found(), 2u);
    EXPECT_EQ(counts.alone, 0u);
    EXPECT_EQ(made->sequence, 1u);
    ASSERT_EQ(made->rgb.size(), 2u);

    // The right one is what one camera at that place would have made of these frames.
    gi::StopRequest const stop;
    ar::Pipeline alone(session_, ar::load_camera(session_.camera), ar::read_marker_map(session_.markers), report_);
    ar::OpenOptions open = session_.frames.options;
    open.pace = ar::Pace::fastest;
    auto const source = ar::open_source(session_.frames.source, open);
    ar::FrameResult r;
    for (int f = 0; f < 2; ++f) {
        auto const frame = source->next(std::chrono::seconds(5));
        ASSERT_TRUE(frame);
        double const time_s = f / open.frames_per_s;
        r = alone.find(*frame, time_s,
                       options_.poses[std::size_t(f)].world_from_camera * session_.hmd->right->left_from_right);
        alone.add(r, *frame, time_s, stop);
    }
    EXPECT_EQ(cv::norm(r.rgb, made->rgb[1], cv::NORM_INF), 0);
    EXPECT_GT(cv::norm(made->rgb[0], made->rgb[1], cv::NORM_INF), 20);
}

TEST_F(TwoCameras, WithoutAPoseBothPassTheirFrames)
{
    options_.poses = {{100, {}}, {101, {}}};
    PassThrough pass_through(session_, options_, report_);
    auto const made = last(pass_through);
    ASSERT_TRUE(made);
    EXPECT_EQ(pass_through.counts().poses.found(), 0u);
    EXPECT_EQ(cv::norm(made->rgb[0], made->rgb[1], cv::NORM_INF), 0);
}

TEST_F(TwoCameras, OfAnotherSizeThanTheirCalibrationAreRefused)
{
    run_well("ar synthesize small --frames 1 --size 48x36 --paths 1 --no-truth", folder_.path());
    session_.hmd->right->source = (folder_ / "small/frames").string();
    EXPECT_THROW(PassThrough(session_, options_, report_), gi::InputError);
}

} // namespace
} // namespace viewer::test
