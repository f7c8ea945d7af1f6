// Typed questions about participants.

#include "study/run/session.h"
#include "tests/study_run/support.h"

#include <gtest/gtest.h>

namespace study::test {
namespace {

ReadScript with_questions(std::string const& ask)
{
    return read_script(
        "schema: study/1\nid: t\nseed: 5\nparticipants: {count: 2, ask: " + ask +
            "}\nfactors: {q: [a, b]}\nsequence: [p]\nblocks: {p: {task: pair, pairs: {factor: q}}}\n",
        "t.yaml");
}

TEST(Asked, QuestionsHaveTypes)
{
    ReadScript const read = with_questions(
        "[hands, {id: age, text: How old, type: number, min: 18, max: 99, whole: true}, {id: eye, type: "
        "choice, choices: [left, right]}]");
    ASSERT_TRUE(read.mistakes.empty()) << read.mistakes.in_order()[0].what();
    auto const& ask = read.script.participants.ask;
    ASSERT_EQ(ask.size(), 3u);
    EXPECT_EQ(ask[0].text, "hands");
    EXPECT_EQ(flaw_of_answer(ask[0], "both"), "");
    EXPECT_EQ(flaw_of_answer(ask[1], "33"), "");
    EXPECT_EQ(flaw_of_answer(ask[1], ""), "") << "nobody must say";
    for (char const* const bad : {"17", "100", "33.5", "old", "nan"})
        EXPECT_EQ(flaw_of_answer(ask[1], bad), "write a whole number from 18 to 99") << bad;
    EXPECT_EQ(flaw_of_answer(ask[2], "left"), "");
    EXPECT_EQ(flaw_of_answer(ask[2], "up"), "choose one of: left, right");
}

TEST(Asked, MistakesAreTold)
{
    for (auto const& [ask, mentions] : {
             std::pair{"[{id: age, type: nubmer, min: 1, max: 2}]", "did you mean 'number'?"},
             {"[{id: age, type: number, min: 20}]", "has no 'max'"},
             {"[{id: age, type: number, min: 20, max: 10}]", "does not rise"},
             {"[{id: age, min: 20}]", "of a question without a number"},
             {"[{id: eye, type: choice, choices: [left]}]", "2 to 9 are possible"},
             {"[{id: eye, type: choice, choices: [left, left]}]", "'left' twice"},
             {"[{id: eye, type: choice}]", "has no 'choices'"},
             {"[{id: eye, choices: [a, b]}]", "choices of a question that has none"},
             {"[eye, {id: eye}]", "question 'eye' twice"},
             {"[{text: Why}]", "has no 'id'"},
             {"[{id: a, typ: text}]", "did you mean 'type'?"},
         }) {
        ReadScript const read = with_questions(ask);
        ASSERT_FALSE(read.mistakes.empty()) << ask;
        std::string all;
        for (ScriptError const& e : read.mistakes.in_order()) all += std::string(e.what()) + "\n";
        EXPECT_NE(all.find(mentions), std::string::npos) << ask << "\n" << all;
    }
}

} // namespace
} // namespace study::test
