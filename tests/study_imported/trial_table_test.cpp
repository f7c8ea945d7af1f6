// Tables of other programs: what they mean, and what is refused with its place.

#include "study/analysis/result_tables.h"
#include "study/imported/trial_table.h"
#include "study/report/page.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace study::test {
namespace {

ImportedTable imported(std::string const& text, ColumnRoles const& roles)
{
    return import_trials(read_delimited(text, "t.csv"), roles);
}
ColumnRoles with(std::string const& columns, std::vector<std::string> factors = {})
{
    ColumnRoles r;
    r.column = parse_roles(columns);
    r.factors = std::move(factors);
    return r;
}
void expect_refused(std::string const& text, ColumnRoles const& roles, std::string const& place,
                    std::string const& problem)
{
    try {
        imported(text, roles);
        ADD_FAILURE() << "accepted: " << text;
    } catch (ScriptError const& e) {
        std::string const what = e.what();
        EXPECT_EQ(what.find(place), 0u) << what;
        EXPECT_NE(what.find(problem), std::string::npos) << what;
    }
}

TEST(DelimitedText, ReadsQuotesOtherSeparatorsAndEmptyLines)
{
    DelimitedText const t = read_delimited("\xef\xbb\xbf"
                                           "a;b;c\r\n1;\"x; \"\"y\"\"\nz\"; 3 \n\n4;;6\n",
                                           "t.csv");
    ASSERT_EQ(t.rows.size(), 2u);
    EXPECT_EQ(t.rows[0][1].text, "x; \"y\"\nz");
    EXPECT_EQ(t.rows[0][2].text, "3");
    EXPECT_EQ(t.rows[1][0].place.line, 5);
    EXPECT_EQ(t.rows[1][2].place.column, 4);
    EXPECT_EQ(t.column("c"), 2);
    EXPECT_EQ(t.column("d"), -1);
}

TEST(DelimitedText, OfSeveralFilesIsJoinedByNames)
{
    DelimitedText const t = joined({read_delimited("a,b\n1,2\n", "1.csv"), read_delimited("b,c\n3,x\n", "2.csv")});
    ASSERT_EQ(t.rows.size(), 2u);
    EXPECT_EQ(t.rows[0][2].text, "");
    EXPECT_EQ(t.rows[1][0].text, "");
    EXPECT_EQ(t.rows[1][1].text, "3");
    EXPECT_EQ(t.files[std::size_t(t.rows[1][2].file)], "2.csv");
    ColumnRoles const roles = with("item=b,value=c");
    try {
        import_trials(t, roles);
        ADD_FAILURE();
    } catch (ScriptError const& e) {
        EXPECT_EQ(std::string(e.what()).find("2.csv:2:3: 'x'"), 0u) << e.what();
    }
}

TEST(DelimitedText, OfOneRowPerValueBecomesWide)
{
    DelimitedText const t = to_wide(
        read_delimited("who,trial,name,value\n1,0,level,0.5\n1,0,right,1\n1,1,right,0\n1,1,level,0.2\n", "l.csv"),
        "name", "value");
    ASSERT_EQ(t.rows.size(), 2u);
    ASSERT_EQ(t.columns.size(), 4u);
    EXPECT_EQ(t.rows[1][std::size_t(t.column("level"))].text, "0.2");
    EXPECT_EQ(t.rows[1][std::size_t(t.column("right"))].place.line, 4);
    EXPECT_THROW(to_wide(read_delimited("who,name,value\n1,a,1\n1,a,2\n", "l.csv"), "name", "value"), ScriptError);
    EXPECT_THROW(to_wide(t, "name", "value"), ScriptError);
}

/// Of values instead of names there are too many: a column of each would take rows times rows cells.
TEST(DelimitedText, HasAtMostAThousandNamesToBecomeWide)
{
    auto const table = [](int names) {
        std::string text = "who,name,value\n";
        for (int i = 0; i < names; ++i) text += fmt::format("1,n{},{}\n", i, i);
        return read_delimited(text, "l.csv");
    };
    EXPECT_EQ(to_wide(table(1000), "name", "value").columns.size(), 1001u);
    try {
        to_wide(table(1001), "name", "value");
        ADD_FAILURE();
    } catch (ScriptError const& e) {
        EXPECT_EQ(std::string(e.what()).find("l.csv:1:5: column 'name' has 1001 different texts"), 0u) << e.what();
    }
}

TEST(DelimitedText, BeginsAfterEmptyLinesAndMayEndLinesInCarriageReturns)
{
    DelimitedText const t = read_delimited("\r\n\n a;b\n\n1;2\n", "t.csv");
    ASSERT_EQ(t.columns, (std::vector<std::string>{"a", "b"}));
    ASSERT_EQ(t.rows.size(), 1u);
    EXPECT_EQ(t.rows[0][0].place.line, 5);
    DelimitedText const old = read_delimited("a,b\r1,2\r3,4\r", "t.csv");
    ASSERT_EQ(old.rows.size(), 2u);
    EXPECT_EQ(old.rows[1][1].text, "4");
    EXPECT_EQ(old.rows[1][1].place.line, 3);
}

TEST(DelimitedText, RefusesWhatIsNoTable)
{
    auto const refused = [](std::string const& text, std::string const& place) {
        try {
            read_delimited(text, "t.csv");
            ADD_FAILURE() << text;
        } catch (ScriptError const& e) {
            EXPECT_EQ(std::string(e.what()).find(place), 0u) << e.what();
        }
    };
    refused("", "t.csv:1:1");
    refused("only\n1\n", "t.csv:1:1");
    refused("a,b\n1\n", "t.csv:2:1");
    refused("a,b\n1,\"2\n", "t.csv:2:3");
}

TEST(TrialTable, OfPsychoPyLeavesOutOtherRowsAndFindsGroups)
{
    // A wide table as PsychoPy writes it: rows of instructions and practice, a blank last column.
    std::string text = "trials.thisN,contrast,key_resp.keys,key_resp.corr,key_resp.rt,block,participant,group,\n"
                       ",,space,,1.2,,1,old,\n"
                       "0,0.5,left,1,0.61,practice,1,old,\n";
    for (int p = 1; p <= 4; ++p)
        for (int i = 0; i < 30; ++i)
            text += std::to_string(i) +
                    (i % 3 == 0   ? ",0.1"
                     : i % 3 == 1 ? ",0.2"
                                  : ",0.4") +
                    ",left," + (i % 3 == 2 || (i * p) % 4 != 1 ? "1" : "0") + ",0.5,main," + std::to_string(p) +
                    (p < 3 ? ",old,\n" : ",young,\n");
    ColumnRoles roles =
        with("participant=participant,level=contrast,correct=key_resp.corr,reaction_s=key_resp.rt", {"group"});
    roles.only = {{"block", "main"}};
    roles.scale = Scale::log10;
    ImportedTable const t = imported(text, roles);
    EXPECT_EQ(t.sessions.size(), 4u);
    ASSERT_EQ(t.notes.size(), 2u);
    EXPECT_EQ(t.notes[0], "2 of 122 rows left out: 'block' is not main");
    EXPECT_EQ(t.notes[1], "'group' differs between participants");
    Analysis const a = analyze(t.script, t.sessions, {.replicates = 50, .permutations = 19});
    EXPECT_EQ(a.observers.at(0).counted, 30);
    EXPECT_EQ(a.observers[0].reaction_median_ms, 500);
    ASSERT_EQ(a.blocks.at(0).detections.size(), 6u) << "three levels in two groups";
    EXPECT_EQ(a.blocks[0].detections[0].trials, 20);
    bool has_group = false;
    for (EffectResult const& e : a.effects) has_group = has_group || e.effect == "group";
    EXPECT_TRUE(has_group);
}

TEST(TrialTable, OfChoicesTakesNamesSidesAndTies)
{
    ImportedTable const t = imported("who,a,b,choice\n1,x,y,x\n1,x,y,right\n1,y,x,neither\n2,y,x,2\n2,y,z,z\n",
                                     with("participant=who,first=a,second=b,chosen=choice"));
    ASSERT_EQ(t.sessions.size(), 2u);
    EXPECT_TRUE(t.script.blocks.at(0).may_tie);
    auto const response = [&](int s, int i) {
        return std::get<TrialDone>(t.sessions[std::size_t(s)].record.entries[std::size_t(i) + 1]).response;
    };
    EXPECT_EQ(response(0, 0), "first");
    EXPECT_EQ(response(0, 1), "second");
    EXPECT_EQ(response(0, 2), "neither");
    EXPECT_EQ(response(1, 0), "second");
    EXPECT_EQ(response(1, 1), "second");
}

TEST(TrialTable, OfChoicesWarnsWhereNamesMayBePositions)
{
    auto const cautions = [](std::string const& rows) {
        std::string all;
        for (std::string const& note : imported("a,b,c\n" + rows, with("first=a,second=b,chosen=c")).notes)
            all += note.substr(0, note.find(" may name")) + "|";
        return all;
    };
    EXPECT_EQ(cautions("2,1,1\n3,1,1\n2,3,2\n"), "answer '1' (2 of 3 rows)|answer '2' (1 of 3 rows)|");
    EXPECT_EQ(cautions("2,1,1\n3,1,3\n2,3,2\n"), "") << "3 is no position: names are meant";
    EXPECT_EQ(cautions("2,1,1\n2,3,3\n2,3,1\n"), "answer '1' (1 of 3 rows)|") << "not an item of the last pair";
    EXPECT_EQ(cautions("x,none,x\nx,y,none\n"), "answer 'none' (1 of 2 rows)|");
    EXPECT_EQ(cautions("x,y,1\ny,x,2\nx,y,none\n"), "");
    EXPECT_EQ(cautions("1,2,1\n1,2,2\n"), "") << "both mean the same";
}

TEST(TrialTable, OfYesAndNoKnowsSignalsAndHasDprime)
{
    std::string text = "s,signal,said\n";
    for (int i = 0; i < 50; ++i) text += std::string("1,1,") + (i < 40 ? "yes\n" : "no\n");
    for (int i = 0; i < 50; ++i) text += std::string("1,0,") + (i < 10 ? "yes\n" : "no\n");
    ImportedTable const t = imported(text, with("participant=s,signal=signal,yes=said"));
    Analysis const a = analyze(t.script, t.sessions, {.replicates = 50});
    ASSERT_EQ(a.blocks.at(0).detections.size(), 1u);
    EXPECT_NEAR(a.blocks[0].detections[0].dprime, 1.64, 0.05) << "2 z(0.8), log-linear";
}

TEST(TrialTable, OfSignalsAndCorrectAnswersIsYesAndNo)
{
    std::string text = "s,signal,right\n";
    for (int i = 0; i < 50; ++i) text += std::string("1,1,") + (i < 40 ? "1\n" : "0\n");
    for (int i = 0; i < 50; ++i) text += std::string("1,0,") + (i < 30 ? "1\n" : "0\n");
    auto roles = with("participant=s,signal=signal,correct=right");
    for (std::optional<Task> const task : {std::optional<Task>{}, std::optional(Task::yes_no)}) {
        roles.task = task;
        ImportedTable const t = imported(text, roles);
        EXPECT_EQ(t.script.blocks.at(0).task, Task::yes_no);
        Analysis const a = analyze(t.script, t.sessions, {.replicates = 50});
        DetectionResult const& d = a.blocks.at(0).detections.at(0);
        EXPECT_NEAR(d.dprime, 0.842 + 0.253, 0.04) << "z(0.8) - z(0.4)";
        EXPECT_EQ(d.correct, 70);
    }
    roles.task = Task::same_different;
    EXPECT_EQ(imported(text, roles).script.blocks.at(0).task, Task::same_different);
    ImportedTable const counts =
        imported("signal,k,n\n1,40,50\n0,30,50\n", with("signal=signal,correct_count=k,trials=n"));
    EXPECT_NEAR(analyze(counts.script, counts.sessions).blocks.at(0).detections.at(0).dprime, 1.095, 0.04);
}

TEST(TrialTable, OfConditionsHasHierarchicalModelsOfDprime)
{
    std::string text = "p,c,signal,yes\n";
    for (int p = 0; p < 3; ++p)
        for (int i = 0; i < 80; ++i) {
            bool const is_easy = i % 2 == 0, is_signal = i % 4 < 2;
            text += fmt::format("{},{},{},{}\n", p, is_easy ? "easy" : "hard", int(is_signal),
                                int((i / 4) % (is_easy ? 10 : 4) == p % 2 ? !is_signal : is_signal));
        }
    ImportedTable const t = imported(text, with("participant=p,signal=signal,yes=yes", {"c"}));
    Analysis const a = analyze(t.script, t.sessions, {.permutations = 0, .draws = 200});
    ASSERT_EQ(a.blocks.at(0).hierarchical.size(), 2u);
    EXPECT_EQ(a.blocks[0].hierarchical[0].parameter, "d'");
    EXPECT_GT(a.blocks[0].hierarchical[0].mean.value, a.blocks[0].hierarchical[1].mean.value);
}

TEST(TrialTable, OfSignalsOnlySaysWhyThereIsNoDprime)
{
    auto const notes = [](std::string const& text, ColumnRoles const& roles) {
        ImportedTable const t = imported(text, roles);
        Analysis const a = analyze(t.script, t.sessions, {.replicates = 50, .permutations = 19});
        std::string all;
        for (DetectionResult const& d : a.blocks.at(0).detections) all += d.note + "|";
        return all;
    };
    EXPECT_EQ(notes("s,y\n1,1\n1,0\n", with("signal=s,yes=y")),
              "no d': no trial is without a signal, so that the rate of false alarms is unknown|");
    EXPECT_EQ(notes("c,s,y\na,1,1\na,0,0\nb,0,1\nb,0,0\nd,0,0\n", with("signal=s,yes=y", {"c"})),
              "all answers to one kind of trial, or both, are right: d' has no upper limit|no d': no trial has a "
              "signal, so that "
              "the rate of hits is unknown (in 2 of 3 conditions)||");
}

TEST(TrialTable, RefusesPercentagesThatAreFractions)
{
    auto const roles = with("level=l,percent=p,trials=n");
    expect_refused("l,p,n\n1,1.0,40\n2,0.55,40\n3,0.75,40\n", roles, "t.csv:3:3", "multiply fractions by 100");
    expect_refused("l,p,n\n1,1e300,40\n", roles, "t.csv:2:3", "from 0 to 100");
    EXPECT_EQ(imported("l,p,n\n1,0,40\n2,1,40\n", roles).sessions.size(), 1u);
    EXPECT_EQ(imported("l,p,n\n1,0.5,40\n2,55,40\n", roles).sessions.size(), 1u);
}

TEST(TrialTable, RefusesCellsWithTheirPlace)
{
    auto const pairs = with("participant=p,first=a,second=b,chosen=c");
    expect_refused("p,a,b,c\n1,x,y,z\n", pairs, "t.csv:2:7", "neither 'x' nor 'y'");
    expect_refused("p,a,b,c\n1,x,x,x\n", pairs, "t.csv:2:5", "the same item");
    expect_refused("p,a,b\n1,x,y\n", pairs, "t.csv:1:1", "no column 'c'");
    auto const answers = with("participant=p,level=l,correct=c");
    expect_refused("p,l,c\n1,2,1\n1,much,0\n", answers, "t.csv:3:3", "'level' is a number");
    expect_refused("p,l,c\n1,2,3\n", answers, "t.csv:2:5", "1 or 0");
    expect_refused("p,l,c\n,,\n", answers, "t.csv: ", "no trials are left");
    auto logarithmic = answers;
    logarithmic.scale = Scale::log2;
    expect_refused("p,l,c\n1,0,1\n", logarithmic, "t.csv:2:3", "no logarithm");
    expect_refused("l,k,n\n1,5,4\n", with("level=l,correct_count=k,trials=n"), "t.csv:2:3",
                   "more than the 4 trials");
    expect_refused("l,k,n\n1,1.5,4\n", with("level=l,correct_count=k,trials=n"), "t.csv:2:3", "whole number");
    expect_refused("l,k,n\n1,5,3000000000\n", with("level=l,correct_count=k,trials=n"), "t.csv:2:5",
                   "at most 2000000 trials");
    expect_refused("i,v\nx,1e200\n", with("item=i,value=v"), "t.csv:2:3", "from -1e15 to 1e15");
    expect_refused("l,c,t\n1,1,0.5\n2,1,-3\n", with("level=l,correct=c,reaction_s=t"), "t.csv:3:5", "below 0");
    expect_refused("p,v\n1,2\n", with("participant=p,value=v"), "t.csv: ", "what was judged");
    expect_refused("p,v\n1,2\n", with("participant=p"), "t.csv: ", "unknown what these trials are");
    expect_refused(
        "p,c\n1,1\n",
        [] {
            auto r = with("participant=p,correct=c");
            r.task = Task::abx;
            return r;
        }(),
        "t.csv: ", "'signal' is missing");
    ColumnRoles matrix;
    matrix.is_matrix = true;
    expect_refused(",a,b\na,0,1\nc,2,0\n", matrix, "t.csv:3:1", "no column has this name");
    expect_refused(",a,b\na,0,x\nb,2,0\n", matrix, "t.csv:2:5", "number of choices");
}

TEST(TrialTable, RowsLeftOutAreToldByTheAnalysis)
{
    ImportedTable t =
        imported("w,a,b,c\n1,x,y,x\n2,x,y,\n3,x,y,y\n", with("participant=w,first=a,second=b,chosen=c"));
    Analysis const a = analyze(Dataset{t.script, {}, t.sessions, t.notes}, {});
    std::string const told = "1 of 3 rows left out: no 'c'";
    ASSERT_FALSE(a.cautions.empty());
    EXPECT_EQ(a.cautions[0], told);
    EXPECT_NE(to_json(a).find(told), std::string::npos);
    EXPECT_NE(report_page(t.script, t.sessions, a, {}).find("1 of 3 rows left out"), std::string::npos);
}

TEST(TrialTable, OneObserverWhoIsLeftOutIsToldInTheSingular)
{
    std::string ratings = "p,i,v\n4,a,1\n";
    for (int p = 1; p < 4; ++p) ratings += fmt::format("{0},a,{0}\n{0},b,{1}\n", p, p * p + 1);
    ImportedTable const rated = imported(ratings, with("participant=p,item=i,value=v"));
    std::string notes;
    Analysis const judged = analyze(rated.script, rated.sessions);
    for (std::string const& n : judged.blocks.at(0).scales.at(0).notes) notes += n;
    EXPECT_NE(notes.find("1 observer who did not judge every item is left out"), std::string::npos) << notes;

    std::string answers = "p,l,s,y\n"; // the third one always says yes
    for (int p = 0; p < 3; ++p)
        for (int i = 0; i < 120; ++i)
            answers += fmt::format("{},{},{},{}\n", p, 1 + i % 4, i % 2 ? 1 : int(i % 3 > 0),
                                   int(p == 2 || (i % 2 || i % 3 ? i % 4 > 1 || i % 5 == 0 : i % 7 == 0)));
    ImportedTable const seen = imported(answers, with("participant=p,level=l,signal=s,yes=y"));
    Analysis const a = analyze(seen.script, seen.sessions, {.permutations = 0, .draws = 0});
    EXPECT_NE(to_text(a).find("1 observer whose false alarms alone reach the proportion is left out"),
              std::string::npos)
        << to_text(a);
}

TEST(TrialTable, ItemsThatAreNotConnectedAreNamed)
{
    ImportedTable const t = imported("a,b,c\nx,y,x\ny,x,x\nfar,off,far\n", with("first=a,second=b,chosen=c"));
    Analysis const a = analyze(t.script, t.sessions);
    std::string const& refused = a.blocks.at(0).scales.at(0).refused;
    EXPECT_EQ(refused.find("item 'far' is not connected with item 'x'"), 0u) << refused;
}

TEST(TrialTable, NamesThatLookLikeNumbersAreWrittenAsRead)
{
    ImportedTable const t =
        imported("w,a,b,c\n001,1.10,1.1,1.1\n1,1.10,1.1,1.10\ntrue,1.10,1.1,1.1\n1e0,1.1,1.10,1.10\n",
                 with("participant=w,first=a,second=b,chosen=c"));
    Analysis const a = analyze(t.script, t.sessions);
    auto const j = nlohmann::json::parse(to_json(a));
    std::string people, items;
    for (auto const& row : j["tables"]["observers"]) people += row["participant"].get<std::string>() + " ";
    for (auto const& row : j["tables"]["scores"]) items += row["item"].get<std::string>() + " ";
    EXPECT_EQ(people, "001 1 true 1e0 ");
    EXPECT_EQ(items, "1.10 1.1 ");
    EXPECT_EQ(j["tables"]["observers"][0]["trials"], 1);
    EXPECT_TRUE(j["tables"]["observers"][0]["used"].get<bool>());
    std::string const text = to_text(a), page = report_page(t.script, t.sessions, a, {});
    EXPECT_EQ(text.find("1.100"), std::string::npos) << text;
    EXPECT_NE(text.find(" 1.10 "), std::string::npos) << text;
    EXPECT_EQ(page.find("1.100"), std::string::npos);
}

TEST(TrialTable, OfWinsKnowsNeitherOrderNorObservers)
{
    ColumnRoles roles;
    roles.is_matrix = true;
    ImportedTable const t = imported("-,a,b,c\na,0,9,8\nb,3,0,7\nc,4,5,0\n", roles);
    Analysis const a = analyze(t.script, t.sessions);
    EXPECT_EQ(a.observers.at(0).choices, 0);
    EXPECT_TRUE(std::isnan(a.observers[0].bias_p));
    EXPECT_EQ(a.observers[0].most_triads, 0);
    EXPECT_TRUE(a.blocks.at(0).agreement.empty());
    EXPECT_TRUE(a.transitions.empty());
    EXPECT_TRUE(a.cautions.empty()) << a.cautions[0];
    ScaleResult const& s = a.blocks[0].scales.at(0);
    EXPECT_TRUE(s.notes.empty()) << s.notes[0];
    EXPECT_GT(s.items.at(0).score.value, s.items.at(1).score.value);
    for (NamedValue const& f : s.facts) EXPECT_EQ(f.name.find("order effect"), std::string::npos);
}

TEST(TrialTable, OfCountsDoesNotKnowTheOrderOfTrials)
{
    auto const transitions = [](ImportedTable const& t) {
        return analyze(t.script, t.sessions, {.replicates = 50, .permutations = 19}).transitions.size();
    };
    EXPECT_EQ(transitions(imported("c,k,n\neasy,9,10\nhard,6,10\n", with("correct_count=k,trials=n", {"c"}))), 0u);
    EXPECT_GT(transitions(imported("c,k\neasy,1\nhard,0\neasy,1\nhard,1\n", with("correct=k", {"c"}))), 0u);

    auto const has_tracks = [](ImportedTable const& t) {
        return to_json(analyze(t.script, t.sessions, {.replicates = 50, .draws = 0})).find("\"tracks\"") !=
               std::string::npos;
    };
    EXPECT_FALSE(has_tracks(imported("l,k,n\n1,9,10\n2,6,10\n", with("level=l,correct_count=k,trials=n"))));
    EXPECT_TRUE(has_tracks(imported("l,k\n1,1\n2,0\n1,1\n2,1\n", with("level=l,correct=k"))));

    auto const triads = [](std::string const& rows) {
        ImportedTable const t = imported("a,b,x,y\n" + rows, with("first=a,second=b,first_wins=x,second_wins=y"));
        Analysis const a = analyze(t.script, t.sessions);
        EXPECT_TRUE(a.transitions.empty());
        return a.observers.at(0).most_triads;
    };
    EXPECT_EQ(triads("p,q,2,0\nq,r,1,0\nr,p,1,0\n"), 1);
    EXPECT_EQ(triads("p,q,2,1\nq,r,1,0\nr,p,1,0\n"), 0) << "which came first is unknown";
}

TEST(TrialTable, RolesOfAnotherTaskAndOfAMatrixAreRefused)
{
    ColumnRoles rating = with("value=v, item=i, first=a"); // `first` means nothing to a rating
    rating.task = Task::rating;
    EXPECT_EQ(imported("v,i,a\n1,x,p\n2,y,q\n", rating).sessions.size(), 1u);
    ColumnRoles matrix = with("", {"a"});
    matrix.is_matrix = true;
    expect_refused("-,a,b\na,0,3\nb,1,0\n", matrix, "t.csv", "--matrix with");
}

TEST(TrialTable, RefusesRolesThatDoNotExist)
{
    EXPECT_THROW(parse_roles("who=x"), ScriptError);
    EXPECT_THROW(parse_roles("level"), ScriptError);
    EXPECT_THROW(parse_roles("level=a,level=b"), ScriptError);
    EXPECT_EQ(parse_roles("level=a, value=b").at("value"), "b");
}

TEST(ImportedTable, OfLevelsHasItsScaleInUnitsOfTheLevelsAndNoDPrimeOfAnotherTask)
{
    std::string text = "p,x,k,n\n";
    for (char const* const p : {"a", "b", "c"})
        for (auto const& [level, right] : {std::pair(0.1, 11), {0.2, 13}, {0.5, 17}, {1.0, 22}})
            text += fmt::format("{},{},{},24\n", p, level, right + (*p == 'b'));
    AnalysisSettings settings;
    settings.draws = 0;
    auto const analysed = [&](Scale scale) {
        ColumnRoles roles = with("participant=p,level=x,correct_count=k,trials=n");
        roles.scale = scale;
        ImportedTable const t = imported(text, roles);
        return analyze(t.script, t.sessions, settings);
    };
    auto const scale_of = [](Analysis const& a) {
        auto const j = nlohmann::json::parse(to_json(a));
        return double(j["tables"]["curves"][0]["scale"]);
    };
    EXPECT_NEAR(scale_of(analysed(Scale::db)), 20 * scale_of(analysed(Scale::log10)), 1e-6);
    EXPECT_NEAR(scale_of(analysed(Scale::log2)), std::log2(10) * scale_of(analysed(Scale::log10)), 1e-6);
    auto const has_dprime = [](Analysis const& a) {
        return std::any_of(a.effects.begin(), a.effects.end(),
                           [](EffectResult const& e) { return e.measure == "d'"; }) ||
               std::isfinite(a.blocks.at(0).detections.at(0).dprime);
    };
    EXPECT_TRUE(has_dprime(analysed(Scale::log10)));
    settings.guess = 0.25;
    Analysis const four = analysed(Scale::log10);
    EXPECT_FALSE(has_dprime(four));
    EXPECT_NE(four.blocks.at(0).detections.at(0).note.find("no d'"), std::string::npos);
    expect_refused("y,k,s\n1,1,1\n", with("yes=y,correct=k,signal=s"), "t.csv:", "each of them tells the answer");
    expect_refused("x,k\n1e300,1\n", with("level=x,correct=k"), "t.csv:2:1", "1e300");
}

} // namespace
} // namespace study::test
