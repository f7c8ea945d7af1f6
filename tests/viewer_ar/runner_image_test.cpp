// The threads of a run: what comes out, what is counted, how it ends.

#include "ar/runtime/runner.h"

#include "ar/capture/clock.h"
#include "ar/markers/marker_map_file.h"
#include "ar/pipeline/synthesize.h"
#include "ar/runtime/loop_source.h"
#include "tests/viewer/run_program.h"

#include <atomic>
#include <map>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace viewer::test {
namespace {

class ArThreads : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        folder = std::make_unique<TemporaryFolder>();
        ar::SynthesizeOptions o;
        o.folder = folder->path();
        o.size_px = {240, 180};
        o.frames = 5;
        o.quality.paths = 1;
        o.quality.denoise = false;
        o.truth = false;
        gi::Report report;
        ar::synthesize(o, {}, report);
    }
    static void TearDownTestSuite() { folder.reset(); }

    static ar::Session session()
    {
        ar::Session s = ar::read_session(*folder / "session.yaml");
        s.render.paths = 2;
        s.render.resolution = 0.5;
        return s;
    }
    /// Numbered frames without markers, 100 per second.
    static ar::Session counted()
    {
        ar::Session s = session();
        s.frames.source = "counter";
        s.frames.options.size_px = {240, 180};
        s.frames.options.frames_per_s = 100;
        return s;
    }
    static std::uint64_t all_of(ar::RunSummary const& s)
    {
        return s.frames.size() + s.refused + s.overtaken + s.unfinished;
    }

    static inline std::unique_ptr<TemporaryFolder> folder;
    gi::Report report;
    gi::StopRequest stop;
    ar::RunSummary summary;
};

TEST_F(ArThreads, GiveWhatOneAloneGives)
{
    ar::Session s = session(); // what one frame leaves for the next is in it
    s.live_light = 2;
    s.smoothing = 0.5;
    ar::RunOptions o;
    o.pace = ar::Pace::fastest;
    o.poses = ar::read_poses(*folder / "poses.csv", {30}).poses;
    std::vector<cv::Mat> composites;
    ar::run_frames(
        s, o, [&](ar::RunFrame&, ar::FrameResult const& r) { composites.push_back(r.rgb); }, stop, report,
        summary);
    ASSERT_EQ(composites.size(), 5u);
    EXPECT_EQ(all_of(summary), 5u);

    ar::Pipeline pipeline(s, ar::load_camera(s.camera), ar::read_marker_map(s.markers), report);
    ar::OpenOptions open = s.frames.options;
    open.pace = ar::Pace::fastest;
    auto const source = ar::open_source(s.frames.source, open);
    for (std::size_t k = 0; k < composites.size(); ++k) {
        auto const frame = source->next(std::chrono::seconds(5));
        ASSERT_TRUE(frame);
        double const time_s = double(k) / 30;
        ar::FrameResult r =
            pipeline.find(*frame, time_s, ar::pose_at(o.poses, std::min(time_s, o.poses.back().time_s)));
        pipeline.add(r, *frame, time_s, stop);
        EXPECT_EQ(cv::norm(r.rgb, composites[k], cv::NORM_INF), 0) << "frame " << k;
        EXPECT_GT(cv::norm(r.rgb, r.camera, cv::NORM_INF), 20) << "something is there";
        EXPECT_FALSE(r.light.empty());
    }
}

TEST_F(ArThreads, GiveUpOldFramesForNewerOnes)
{
    std::atomic<int> taken{0};
    ar::RunOptions o;
    o.frames = 4;
    o.taken = [&](ar::Frame const&) { ++taken; };
    int const while_shown = 6; // more than all threads and what waits between them can hold
    ar::run_frames(
        counted(), o,
        [&](ar::RunFrame&, ar::FrameResult const&) {
            for (int const before = taken; taken < before + while_shown;)
                std::this_thread::sleep_for(std::chrono::milliseconds(1));
        },
        stop, report, summary);
    ASSERT_EQ(summary.frames.size(), 4u);
    EXPECT_GE(summary.overtaken, 4u);
    EXPECT_EQ(summary.source.delivered, std::uint64_t(taken));
    EXPECT_EQ(summary.source.delivered, all_of(summary));
    std::uint64_t told = 0;
    for (std::size_t k = 0; k < 4; ++k) {
        ar::RunFrame const& f = summary.frames[k];
        told += f.overtaken;
        if (k > 0) {
            EXPECT_GT(f.sequence - summary.frames[k - 1].sequence, f.overtaken);
        }
        ar::StageTimes const& t = f.times;
        EXPECT_NEAR(f.age_ms + t.decode_ms + t.detect_ms + t.pose_ms + t.wait_ms + t.light_ms + t.render_ms +
                        t.composite_ms,
                    f.latency_ms, 1e-6);
        EXPECT_GE(f.show_wait_ms, 0);
    }
    EXPECT_LE(told, summary.overtaken);
    EXPECT_NE(describe(summary).find("overtaken: "), std::string::npos);
}

TEST_F(ArThreads, WaitWhereNothingMayBeLost)
{
    ar::RunOptions o;
    o.pace = ar::Pace::fastest;
    o.find_poses_only = true;
    o.frames = 3;
    std::vector<std::uint64_t> seen;
    ar::run_frames(
        session(), o,
        [&](ar::RunFrame& f, ar::FrameResult const&) {
            seen.push_back(f.sequence);
            std::this_thread::sleep_for(std::chrono::milliseconds(20));
        },
        stop, report, summary);
    EXPECT_EQ(seen, (std::vector<std::uint64_t>{0, 1, 2}));
    EXPECT_EQ(summary.overtaken + summary.unfinished, 0u);
}

TEST_F(ArThreads, TakeFramesThatComeAgainAndAgain)
{
    ar::OpenOptions open = session().frames.options;
    open.pace = ar::Pace::fastest;
    ar::LoopSource source(ar::read_frames(*ar::open_source(session().frames.source, open), 3), 200);
    ar::RunOptions o;
    o.frames = 5;
    o.find_poses_only = true;
    std::map<std::uint64_t, cv::Mat> shown;
    ar::run_frames(
        session(), source, o, [&](ar::RunFrame& f, ar::FrameResult const& r) { shown[f.sequence] = r.camera; },
        stop, report, summary);
    ASSERT_EQ(shown.size(), 5u);
    EXPECT_EQ(summary.source.delivered, all_of(summary));
    for (auto const& [number, rgb] : shown) {
        std::uint64_t const k = number % 4, frame = k <= 2 ? k : 4 - k;
        cv::Mat bgr = cv::imread(*folder / ("frames/00000" + std::to_string(frame) + ".png"));
        cv::cvtColor(bgr, bgr, cv::COLOR_BGR2RGB);
        EXPECT_EQ(cv::norm(rgb, bgr, cv::NORM_INF), 0) << number;
    }
}

TEST_F(ArThreads, HandOnWhatIsThrown)
{
    auto const thrown = [&](ar::RunOptions const& o, auto const& shown) {
        ar::RunSummary mine;
        try {
            ar::run_frames(counted(), o, shown, stop, report, mine);
        } catch (std::runtime_error const& e) {
            return std::string(e.what());
        }
        return std::string();
    };
    auto const nothing = [](ar::RunFrame&, ar::FrameResult const&) {};
    ar::RunOptions o;
    EXPECT_EQ(thrown(o, [](ar::RunFrame&, ar::FrameResult const&) { throw std::runtime_error("shown"); }),
              "shown");
    o.taken = [](ar::Frame const& f) {
        if (f.sequence > 1) throw std::runtime_error("taken");
    };
    EXPECT_EQ(thrown(o, nothing), "taken");
    o.taken = {};
    o.idle = [] { throw std::runtime_error("idle"); };
    EXPECT_EQ(thrown(o, nothing), "idle");
}

TEST_F(ArThreads, EndWhenAsked)
{
    ar::RunOptions o;
    o.idle = [&] {
        if (!summary.frames.empty()) stop.request();
    };
    ar::run_frames(counted(), o, {}, stop, report, summary); // the counter never ends
    EXPECT_EQ(summary.source.delivered, all_of(summary));
}

} // namespace
} // namespace viewer::test
