// Answers outside of min_response_ms and max_response_ms: invalid, with a reason,
// repeated, and not for procedures.

#include "study/run/trial.h"
#include "tests/study_run/support.h"

#include <gtest/gtest.h>

namespace study::test {
namespace {

Script limited(std::string const& limits, std::string const& timing = "timing: {vsync: record}\n")
{
    return parse(timing + "factors: {q: [a, b, c]}\nsequence: [p]\nblocks:\n  p: {task: pair, pairs: {factor: q}" +
                 limits + "}\n");
}

TrialDone judged(Script const& s, double reaction_ms)
{
    TrialDone done;
    done.response = "first";
    done.reaction_ms = reaction_ms;
    judge(s, make_plan(s, 1).steps[0], done);
    return done;
}

TEST(ResponseLimits, HaveReasons)
{
    EXPECT_EQ(judged(limited(""), 55).reason, "anticipation");
    EXPECT_FALSE(judged(limited(""), 55).is_valid);
    EXPECT_TRUE(judged(limited(""), 101).is_valid);
    EXPECT_TRUE(judged(limited(""), 1e6).is_valid);
    EXPECT_TRUE(judged(limited(", min_response_ms: 0"), 1).is_valid);
    EXPECT_EQ(judged(limited(", min_response_ms: 200, max_response_ms: 900"), 199).reason, "anticipation");
    EXPECT_EQ(judged(limited(", min_response_ms: 200, max_response_ms: 900"), 901).reason, "too_slow");
    EXPECT_TRUE(judged(limited(", min_response_ms: 200, max_response_ms: 900"), 500).is_valid);
}

TEST(ResponseLimits, OfTheScriptAreChecked)
{
    for (char const* const limits : {", min_response_ms: 900, max_response_ms: 900", ", timeout_ms: 80",
                                     ", min_response_ms: -1", ", max_response_ms: never"})
        EXPECT_THROW(limited(limits), ScriptError) << limits;
}

TEST(ResponseLimits, TrialsAreRepeatedAndDoNotReachProcedures)
{
    Script const s = adaptive_script();
    TemporaryFolder const usual_dir, early_dir;
    auto const levels = [&](TemporaryFolder const& dir, bool is_early) {
        TestPresenter p;
        p.on_show = [&](TrialRequest const& r, TrialDone& done) {
            done.reaction_ms = 700;
            // Now and then an early answer, which is also wrong.
            if (is_early && r.attempt == 1 && r.step_index % 5 == 0 && r.step->trial.phase != Phase::practice) {
                done.reaction_ms = 55;
                done.response = done.response == "first" ? "second" : "first";
            }
        };
        run_session(s, 1, p, settings_in(dir.path()));
        std::vector<double> valid;
        int early = 0;
        for (TrialDone const& t : entries_of<TrialDone>(journal_in(dir.path()))) {
            early += t.reason == "anticipation";
            if (t.is_valid && t.level) valid.push_back(*t.level);
        }
        EXPECT_EQ(early > 0, is_early);
        std::sort(valid.begin(), valid.end());
        return valid;
    };
    EXPECT_EQ(levels(usual_dir, false), levels(early_dir, true)) << "the early wrong answers moved a procedure";
}

} // namespace
} // namespace study::test
