#pragma once
// Small scripts and shipped ones.

#include "study/plan/plan.h"
#include "study/script/script_file.h"

#include <algorithm>
#include <fstream>
#include <gtest/gtest.h>
#include <iterator>
#include <string>
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

} // namespace study::test
