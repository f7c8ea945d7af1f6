// Anticipations never count, and the exclusions name them.

#include "tests/study_analysis/made_sessions.h"

namespace study::test {
namespace {

TEST(Anticipations, NeverCountAndAreNamed)
{
    for (char const* const on_bad : {"keep", "repeat_at_end"}) {
        Script const s = parse_script(std::string("schema: study/1\nid: t\nseed: 5\nparticipants: {count: 2}\n"
                                                  "timing: {on_bad_trial: ") +
                                          on_bad +
                                          "}\nfactors: {q: [a, b]}\nsequence: [p]\nblocks:\n  p: {task: pair, "
                                          "pairs: {factor: q}}\n",
                                      "t.yaml");
        MadeSession made(s, "P001");
        for (int i = 0; i < 6; ++i) {
            TrialDone& done = made.add(0, {{0}, {1}}, "first");
            if (i != 2) continue;
            done.is_valid = false;
            done.reason = kAnticipation;
        }
        std::vector<RecordedSession> const sessions{made.finished()};
        Analysis const a = analyze(s, sessions);
        ASSERT_EQ(a.observers.size(), 1u);
        EXPECT_EQ(a.observers[0].counted, 5) << on_bad;
        EXPECT_EQ(a.observers[0].invalid, 1) << on_bad;
        ASSERT_EQ(a.exclusions.size(), 1u);
        EXPECT_EQ(a.exclusions[0].why, "invalid: anticipation");
        EXPECT_EQ(a.exclusions[0].trials, 1);
    }
}

} // namespace
} // namespace study::test
