// plan.tsv read again: the plan that it was written from, and what does not fit the script is refused.

#include "study/script/examples.h"
#include "tests/study_design/samples.h"

namespace study::test {
namespace {

TEST(ReadPlan, RestoresThePlansOfAllExamples)
{
    for (StudyExample const& example : study_examples()) {
        Script const s = parse_script(std::string(example.text), std::string(example.name));
        for (int p = 1; p <= std::min(s.participants.count, 4); ++p) {
            Plan const made = make_plan(s, p);
            std::string const table = plan_table(s, made);
            expect_same(read_plan(s, p, table, "plan.tsv"), made);
            EXPECT_EQ(plan_difference(table, table), "");
        }
    }
}

Script pairs_script()
{
    return parse(
        "factors: {q: [good, bad, worst]}\ndefaults: {stimulus_ms: 500}\nsequence: [{instructions: Look}, "
        "b]\nblocks: {b: {task: pair, pairs: {factor: q}, repeats: 2}}\n");
}

std::string replaced(std::string text, std::string const& from, std::string const& to)
{
    std::size_t const at = text.find(from);
    EXPECT_NE(at, std::string::npos) << from;
    return text.replace(at, from.size(), to);
}

TEST(ReadPlan, RefusesWhatDoesNotFitTheScript)
{
    Script const s = pairs_script();
    std::string const table = plan_table(s, make_plan(s, 1));
    auto const refusal = [&](std::string const& from, std::string const& to) -> std::string {
        try {
            read_plan(s, 1, replaced(table, from, to), "plan.tsv");
        } catch (ScriptError const& e) {
            return e.what();
        }
        return {};
    };
    EXPECT_NE(refusal("\tworst\t", "\tbest\t").find("the script has no level of q 'best'"), std::string::npos);
    EXPECT_NE(refusal("\torder\t", "\tsequence\t").find("it has no column 'order'"), std::string::npos);
    EXPECT_NE(refusal("2\ttrial\tb", "2\ttrial\tc")
                  .find("plan.tsv:3:1: this plan cannot be read (the script has no "
                        "block 'c') restore the file from a copy"),
              std::string::npos);
    EXPECT_NE(refusal("2\ttrial", "7\ttrial").find("it is not step 2"), std::string::npos);
    EXPECT_NE(refusal("instructions\t", "sleep\t").find("'sleep' is no kind"), std::string::npos);
    EXPECT_EQ(refusal("\n", "\r\n"), "");
}

TEST(ReadPlan, KnowsColumnsByTheirNames)
{
    Script const s = pairs_script();
    Plan const made = make_plan(s, 1);
    std::string later;
    std::istringstream in(plan_table(s, made));
    for (std::string line; std::getline(in, line);) later += "of another version\t" + line + "\n";
    expect_same(read_plan(s, 1, later, "plan.tsv"), made);
}

TEST(PlanDifference, CountsStepsAndNamesColumns)
{
    Script const s = pairs_script();
    Plan plan = make_plan(s, 1);
    std::string const table = plan_table(s, plan);
    PlanStep& third = plan.steps[2];
    third.trial.order = third.trial.order == "ab" ? "ba" : "ab";
    EXPECT_EQ(plan_difference(table, plan_table(s, plan)), "1 of 7 steps differ, the first is step 3 (order)");
    plan.steps.pop_back();
    EXPECT_EQ(plan_difference(table, plan_table(s, plan)), "2 of 7 steps differ, the first is step 3 (order)");
}

} // namespace
} // namespace study::test
