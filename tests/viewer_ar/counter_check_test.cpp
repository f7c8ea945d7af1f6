// The check of the chain has to notice what it is there for.

#include "ar/runtime/counter_check.h"

#include "ar/capture/counter_source.h"
#include "gi/scene/model/scene.h"
#include "tests/viewer/run_program.h"

#include <opencv2/imgproc.hpp>

namespace viewer::test {
namespace {

class CounterChecks : public testing::Test {
protected:
    CounterChecks() : session_(ar::make_counter_session(folder_.path(), {320, 240}, 30, report_)) {}

    /// What the camera of frame `number` would show with the ball of frame `ball`.
    cv::Mat shown(std::uint32_t number, std::uint32_t ball) const
    {
        cv::Mat rgb(240, 320, CV_8UC3, cv::Scalar(100, 80, 96));
        ar::draw_counter(rgb, number);
        glm::dvec2 const at = ball_from(session_.camera, session_.camera_at(ball / session_.rate_hz));
        cv::circle(rgb, {int(std::lround(at.x)), int(std::lround(at.y))}, 14, cv::Scalar::all(255), cv::FILLED);
        return rgb;
    }
    /// Captured at 100 s + number / 30, shown 60 ms later.
    static ar::RunFrame record(std::uint32_t number)
    {
        ar::RunFrame f;
        f.sequence = number;
        f.captured_steady_s = 100 + number / 30.0;
        f.age_ms = 5;
        f.times.render_ms = 30;
        f.latency_ms = 35;
        f.show_wait_ms = 20;
        f.present_ms = 5;
        f.swapped_ms = 60;
        return f;
    }
    ar::CounterVerdict verdict(ar::RunFrame const& f, cv::Mat const& picture, double late_s = 0)
    {
        ar::CounterCheck check(session_);
        double const s = *f.captured_steady_s + 0.06 + late_s;
        check.add(f, picture, true, s - 0.004, s + 0.001);
        return check.verdict();
    }

    TemporaryFolder folder_;
    gi::Report report_;
    ar::CounterSession session_;
};

TEST_F(CounterChecks, AcceptWhatBelongsTogether)
{
    for (std::uint32_t const n : {0u, 7u, 25u, 26u, 1000u, 100000u})
        EXPECT_TRUE(verdict(record(n), shown(n, n)).good()) << n;
    cv::Mat larger;
    cv::resize(shown(7, 7), larger, {}, 1.5, 1.5);
    EXPECT_TRUE(verdict(record(7), larger).good());
}

TEST_F(CounterChecks, NoticeThingsOfAnotherFrame)
{
    ar::CounterVerdict const v = verdict(record(7), shown(7, 8));
    EXPECT_EQ(v.misplaced, 1);
    EXPECT_NEAR(v.most_off_px, 0.02 * 320, 1);
    EXPECT_EQ(v.other + v.unread + v.mistimed, 0);
}

TEST_F(CounterChecks, NoticeAPictureOfAnotherFrame)
{
    ar::CounterVerdict const v = verdict(record(7), shown(6, 6));
    EXPECT_EQ(v.other, 1);
    EXPECT_EQ(v.misplaced, 0);
    EXPECT_EQ(verdict(record(7), cv::Mat(240, 320, CV_8UC3, cv::Scalar::all(0))).unread, 1);
}

TEST_F(CounterChecks, NoticeTimesThatDoNotAddUp)
{
    ar::RunFrame f = record(7);
    f.times.render_ms += 1;
    EXPECT_EQ(verdict(f, shown(7, 7)).mistimed, 1) << "stages";
    f = record(7);
    f.present_ms += 1;
    EXPECT_EQ(verdict(f, shown(7, 7)).mistimed, 1) << "until the swap";
    EXPECT_EQ(verdict(record(7), shown(7, 7), 0.1).mistimed, 1) << "another clock";
}

} // namespace
} // namespace viewer::test
