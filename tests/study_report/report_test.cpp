#include "gi/core/html/plot.h"
#include "study/report/figures.h"
#include "tests/study_analysis/made_sessions.h"

#include <cmath>
#include <fmt/format.h>
#include <limits>

namespace study::test {
namespace {

std::size_t count(std::string const& text, std::string const& what)
{
    std::size_t n = 0;
    for (std::size_t at = text.find(what); at != std::string::npos; at = text.find(what, at + 1)) ++n;
    return n;
}

/// What every page has to be, whatever it is of.
void expect_sound(std::string const& page)
{
    for (char const* tag : {"figure", "table", "svg", "section", "ul", "li", "tr", "h2", "h3", "p", "text", "div"})
        EXPECT_EQ(count(page, std::string("<") + tag + ">") + count(page, std::string("<") + tag + " "),
                  count(page, std::string("</") + tag + ">"))
            << tag;
    EXPECT_EQ(page.find("<script"), std::string::npos);
    EXPECT_EQ(page.find("src="), std::string::npos) << "nothing is fetched";
    EXPECT_EQ(page.find("http"), std::string::npos) << "nothing is fetched";
    for (char const* bad : {"=\"nan", "=\"-nan", "=\"inf", " nan", ",nan", ">nan", ">inf"})
        EXPECT_EQ(page.find(bad), std::string::npos) << bad;
}

Script all_tasks()
{
    return parse_script(R"(schema: study/1
id: odd
title: "<script>alert(1)</script> & \"quotes\" 'n' <b>"
seed: 3
participants: {count: 4}
factors: {scene: [hall, yard], method: [exact, fast.x+1, bad-one]}
reference: {method: exact}
defaults: {stimulus_ms: 500}
sequence: [which, rate, rank, size]
blocks:
  which: {task: pair, prompt: "<i>Which & why?</i>", pairs: {factor: method}, cross: [scene]}
  rate: {task: rating, cross: [scene, method], scale: {min: 1, max: 5}}
  rank: {task: ranking, rank: {factor: method}, cross: [scene]}
  size: {task: magnitude, cross: [scene, method]}
)",
                        "odd.yaml");
}

RecordedSession session_of(Script const& s, int participant)
{
    int n = participant;
    return record_session(s, participant, [&](PlanStep const& step, TrialDone& done) {
        ++n;
        switch (s.blocks[std::size_t(step.block)].task) {
        case Task::pair:
            done.response = n % 3 ? "first" : "second";
            break;
        case Task::ranking:
            done.response = n % 2 ? "abc" : "bac";
            break;
        default:
            done.value = 1 + n % 5;
        }
    });
}

TEST(Report, OfEveryTaskIsAPageThatEscapesWhatScriptsSay)
{
    Script const s = all_tasks();
    std::vector<RecordedSession> sessions;
    for (int p = 1; p <= 4; ++p) sessions.push_back(session_of(s, p));
    std::get<TrialDone>(sessions[0].record.entries.at(3)).is_valid = false;
    std::get<TrialDone>(sessions[0].record.entries.at(3)).reason = "<b>odd & strange</b>";
    Analysis const a = analyze(s, sessions);
    ASSERT_EQ(a.blocks.size(), 4u);
    for (BlockResult const& b : a.blocks) {
        ASSERT_FALSE(b.scales.empty()) << b.name;
        EXPECT_EQ(b.scales[0].refused, "") << b.name;
    }
    std::string const page = report_page(s, sessions, a, {"lightwell", {}, {}});
    expect_sound(page);
    EXPECT_NE(page.find("&lt;script&gt;alert(1)&lt;/script&gt; &amp; &quot;quotes&quot;"), std::string::npos);
    EXPECT_NE(page.find("&lt;i&gt;Which &amp; why?&lt;/i&gt;"), std::string::npos);
    EXPECT_NE(page.find("&lt;b&gt;odd &amp; strange&lt;/b&gt;"), std::string::npos);
    EXPECT_NE(page.find("fast.x+1"), std::string::npos);
}

TEST(Report, ListsTypedAnswers)
{
    Script const s = parse_script(R"(schema: study/1
id: t
seed: 1
participants: {count: 1}
sequence: [{questionnaire: q}]
blocks: {}
questionnaires: {q: {items: [{id: why, text: "Why <i>?", type: text, lines: 3}]}}
)",
                                  "t.yaml");
    RecordedSession session{make_plan(s, 1), {}};
    session.record.entries.emplace_back(started(s, session.plan));
    session.record.entries.emplace_back(QuestionnaireDone{0, 1, 2, {{}}, {"<b>\"łódź\"</b> &\nmore"}});
    std::vector<RecordedSession> const sessions{session};
    std::string const page = report_page(s, sessions, analyze(s, sessions), {"lightwell", {}, {}});
    expect_sound(page);
    EXPECT_NE(page.find("q: Why &lt;i&gt;?"), std::string::npos);
    EXPECT_NE(page.find("&lt;b&gt;&quot;łódź&quot;&lt;/b&gt; &amp;\nmore"), std::string::npos);
}

TEST(Report, OfOneObserverOrOfASessionWithoutTrialsSaysSo)
{
    Script const s = all_tasks();
    std::vector<RecordedSession> sessions{session_of(s, 1)};
    std::string const one = report_page(s, sessions, analyze(s, sessions), {"lightwell", {}, {}});
    expect_sound(one);
    EXPECT_NE(one.find("one observer: intervals, if any, apply to this person only"), std::string::npos);
    sessions[0].record.entries.resize(1);
    std::string const none = report_page(s, sessions, analyze(s, sessions), {"lightwell", {}, {}});
    expect_sound(none);
    EXPECT_NE(none.find("1 of 1 sessions are not complete"), std::string::npos);
    expect_sound(report_page(s, {}, analyze(s, {}), {"lightwell", {}, {}}));
}

TEST(SimulatedTruth, GivesTheLevelOfAShareOfRightAnswers)
{
    SimulatedTruth const t = read_truth(R"({"quality_jod": {"m": {"a": 0, "b": -1.5}}, "lapse": 0,
      "varied": {"points": {"threshold": 100, "slope": 2, "function": "weibull"},
                 "size": {"threshold": 5, "slope": 2, "function": "normal"}}})",
                                        "truth.json");
    EXPECT_EQ(t.quality_jod.at("m").at("b"), -1.5);
    // Of the Weibull function half is reached where (x/a)^b = log 2; turned round where higher is harder.
    EXPECT_NEAR(true_level(t, "points", false, 0.5, 0.75), 100 * std::sqrt(std::log(2.0)), 1e-9);
    EXPECT_NEAR(true_level(t, "points", true, 0.5, 0.75), 100 / std::sqrt(std::log(2.0)), 1e-9);
    EXPECT_NEAR(true_level(t, "size", false, 0.5, 0.75), 5, 1e-9);
    EXPECT_TRUE(std::isnan(true_level(t, "nothing", false, 0.5, 0.75)));
    EXPECT_THROW(read_truth("{", "truth.json"), gi::InputError);
}

TEST(Intervals, ThatAreOpenGoToTheBorder)
{
    double const none = std::numeric_limits<double>::quiet_NaN();
    gi::RowPlot p({"a"}, {0, 10}, "x", 100);
    p.estimate(5, 4, none, p.row(0));
    std::string const svg = p.svg("t");
    EXPECT_NE(svg.find(fmt::format("x1=\"{:.1f}\"", p.x(4))), std::string::npos) << svg;
    EXPECT_NE(svg.find(fmt::format("x2=\"{:.1f}\"", p.right())), std::string::npos) << svg;
}

TEST(Histogram, OfValuesThatHardlyDifferIsDrawn)
{
    // As the intervals of a display that keeps its pace.
    std::string const drawn = histogram({16, 16 + 1e-12, 16 + 2e-12, 17}, "ms", "Intervals");
    EXPECT_NE(drawn.find("4 values"), std::string::npos);
    EXPECT_LT(drawn.size(), 20000u);
    EXPECT_EQ(histogram({16, 16}, "ms", "Intervals"), "");
}

} // namespace
} // namespace study::test
