#pragma once
// Small scripts and shipped ones.

#include "study/plan/plan.h"
#include "study/script/script_file.h"

#include <algorithm>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <string>
#include <tuple>
#include <vector>

namespace study::test {

inline std::string file_text(std::string const& file)
{
    std::ifstream in(file, std::ios::binary);
    EXPECT_TRUE(in) << file;
    return {std::istreambuf_iterator<char>(in), {}};
}

inline std::string example_text(std::string const& name)
{
    return file_text(LIGHTWELL_SOURCE_DIR "/data/study/" + name + ".yaml");
}

/// Everything but factors, blocks and sequence.
inline std::string const kHead = "schema: study/1\nid: t\nseed: 5\nparticipants: {count: 12}\n";

inline Script parse(std::string const& body) { return parse_script(kHead + body, "t.yaml"); }

/// What parse_script or, if that is content, make_plan says; empty = nothing.
inline std::string message_of(std::string const& text)
{
    try {
        make_plan(parse_script(text, "t.yaml"), 1);
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return {};
}

/// Trials of a phase of a block's first pass.
inline std::vector<Trial> trials_of(Plan const& plan, Phase phase, int block = 0, int pass = 0)
{
    std::vector<Trial> out;
    for (PlanStep const& step : plan.steps)
        if (step.kind == PlanStepKind::trial && step.block == block && step.pass == pass &&
            step.trial.phase == phase)
            out.push_back(step.trial);
    return out;
}

/// Main and catch trials in their order.
inline std::vector<Trial> run_of(Plan const& plan, int block = 0)
{
    std::vector<Trial> out;
    for (PlanStep const& step : plan.steps)
        if (step.kind == PlanStepKind::trial && step.block == block && step.pass == 0 &&
            step.trial.phase != Phase::practice)
            out.push_back(step.trial);
    return out;
}

/// Equal in all but the levels of trials that the sequence fixes: those of their stimuli are all there.
inline void expect_same(Plan const& a, Plan const& b)
{
    EXPECT_EQ(a.participant_id, b.participant_id);
    EXPECT_EQ(a.duration_us, b.duration_us);
    ASSERT_EQ(a.steps.size(), b.steps.size());
    for (std::size_t i = 0; i < a.steps.size(); ++i) {
        PlanStep const &x = a.steps[i], &y = b.steps[i];
        SCOPED_TRACE("step " + std::to_string(i + 1));
        EXPECT_EQ(std::tie(x.kind, x.block, x.pass, x.text, x.questionnaire, x.number, x.start_us, x.duration_us,
                           x.onset_us),
                  std::tie(y.kind, y.block, y.pass, y.text, y.questionnaire, y.number, y.start_us, y.duration_us,
                           y.onset_us));
        EXPECT_NEAR(x.seconds, y.seconds, 1e-6);
        Trial const &t = x.trial, &u = y.trial;
        EXPECT_EQ(std::tie(t.phase, t.repeat, t.stimuli, t.order, t.reference, t.answer, t.procedure, t.level,
                           t.is_noise, t.is_open_pair),
                  std::tie(u.phase, u.repeat, u.stimuli, u.order, u.reference, u.answer, u.procedure, u.level,
                           u.is_noise, u.is_open_pair));
        if (x.kind != PlanStepKind::trial) {
            EXPECT_EQ(x.levels, y.levels);
        }
    }
}

} // namespace study::test
