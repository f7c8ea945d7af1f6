#include "study/script/script_file.h"
#include "study/tables/bids.h"
#include "study/tables/events.h"
#include "study/tables/export.h"
#include "tests/study_tables/recorded.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>
#include <sqlite3.h>

namespace study::test {
namespace {

char const* const kScript = R"(schema: study/1
id: t
seed: 5
participants: {count: 4, ask: [age, hands]}
factors:
  scene: [hall]
  trial: [x, y]
reference: {scene: hall}
defaults: {stimulus_ms: 2000}
sequence: [{instructions: "Look."}, {questionnaire: mood}, look-here]
blocks:
  look-here:
    task: pair
    prompt: "Which?"
    pairs: {factor: trial, order: fixed}
    cross: [scene]
    repeats: 2
questionnaires:
  mood:
    scale: {min: 1, max: 5}
    items: [{id: good, text: "I am well."}, {id: bad, text: "I am not.", reverse: true}]
    scales: {mood: {items: [good, bad], score: mean}}
)";

Script script() { return parse_script(kScript, "t.yaml"); }

/// A session whose participant always prefers x; the second trial fails once and is repeated.
RecordedSession session(Script const& s)
{
    int trials = 0;
    RecordedSession r = record_session(s, 1, [&](PlanStep const&, TrialDone& done) {
        done.response = "first";
        if (++trials == 2) {
            done.is_valid = false;
            done.reason = "dropped\tframes";
            done.shown[0].frames_dropped = 3;
        }
    });
    TrialDone again = std::get<TrialDone>(r.record.entries.at(r.record.entries.size() - 2));
    again.attempt = 2;
    again.is_valid = true;
    again.reason.clear();
    for (StimulusShown& stimulus : again.shown) stimulus.frames_dropped = 0, stimulus.onset_s += 10;
    r.record.entries.insert(r.record.entries.end() - 1, again);
    return r;
}

TEST(Events, HaveARowPerTrialWithEveryFactor)
{
    Script const s = script();
    RecordedSession const r = session(s);
    EXPECT_EQ(
        tsv_text(events_table(s, trial_rows(s, r), 0)),
        "onset\tduration\tresponse_time\ttrial\tblock\tpass\tpart\tphase\tattempt\trepeat\tscene\tfactor_trial\t"
        "cond_a\tcond_b\tcond_"
        "more\treference\torder\tlevel\tprocedure\tselected\tresponse\tvalue\tanswer\tcorrect\tdevice\t"
        "response_uncertainty_ms\tonset_method\tonset_uncertainty_ms\tframes_planned\tframes_shown\tframes_"
        "dropped\t"
        "render_ms_mean\trender_ms_p99\tsettings_sha256\tbookkeeping_ms\tvalid\treason\tanalysis\n"
        "23.500000\t4.500000\t0.500000\t1\tlook-here\t1\t1\tmain\t1\t1\thall\tn/a\tx\ty\tn/a\tn/a\tab\tn/a\tn/a\t"
        "n/a\tfirst\tn/a\tn/a\tn/a\tkey:left\t0\tswap_finish\t8.4\t240\t240\t0\t4\t8\tabc\t0\ttrue\tn/a\tcounted\n"
        "33.500000\t4.500000\t0.500000\t2\tlook-here\t1\t1\tmain\t1\t2\thall\tn/a\tx\ty\tn/a\tn/a\tab\tn/a\tn/a\t"
        "n/a\tfirst\tn/a\tn/a\tn/a\tkey:left\t0\tswap_finish\t8.4\t240\t240\t3\t4\t8\tabc\t0\tfalse\tdropped "
        "frames\t"
        "repeated later\n"
        "43.500000\t4.500000\t0.500000\t2\tlook-here\t1\t1\trepeat\t2\t2\thall\tn/a\tx\ty\tn/a\tn/a\tab\tn/a\tn/"
        "a\t"
        "n/a\tfirst\tn/a\tn/a\tn/a\tkey:left\t0\tswap_finish\t8.4\t240\t240\t0\t4\t8\tabc\t0\ttrue\tn/"
        "a\tcounted\n");
}

TEST(Events, HaveARowPerStimulusBesideThem)
{
    Script const s = script();
    Table const t = stimuli_table(s, trial_rows(s, session(s)), 0);
    ASSERT_EQ(t.rows.size(), 6u);
    EXPECT_EQ(t.rows[3],
              (std::vector<std::string>{"36.000000", "2.000000", "2", "1", "1", "2", "b", "hall", "y", "n/a",
                                        "swap_finish", "8.4", "120", "120", "0", "4", "8", "abc"}));
}

/// Only where frames were shown that are not finished pictures: other tables are as they were.
TEST(Events, SayWhichFramesWereShownAndHowOldTheirLightWas)
{
    Script const s = script();
    RecordedSession r = session(s);
    Table const exact = stimuli_table(s, trial_rows(s, r), 0);
    TrialDone& last = std::get<TrialDone>(r.record.entries.at(r.record.entries.size() - 2));
    last.shown[1].frames_kind = "shown";
    last.shown[1].frames_drawn = 117;
    last.shown[1].light_age_ms = 81.25;
    Table const t = stimuli_table(s, trial_rows(s, r), 0);
    ASSERT_EQ(t.columns.size(), exact.columns.size() + 3);
    std::vector<std::string> names;
    for (std::size_t k = exact.columns.size(); k < t.columns.size(); ++k) names.push_back(t.columns[k].name);
    EXPECT_EQ(names, (std::vector<std::string>{"frames_kind", "frames_drawn", "light_age_ms"}));
    auto const end_of = [](std::vector<std::string> const& row) {
        return std::vector<std::string>(row.end() - 3, row.end());
    };
    EXPECT_EQ(end_of(t.rows.at(4)), (std::vector<std::string>{"exact", "n/a", "n/a"}));
    EXPECT_EQ(end_of(t.rows.at(5)), (std::vector<std::string>{"shown", "117", "81.25"}));
}

TEST(Questionnaires, HaveAnswersAndScores)
{
    Script const s = script();
    EXPECT_EQ(tsv_text(questionnaires_table(s, session(s))),
              "start\ttime_taken\tquestionnaire\ttime_point\tscene\tfactor_"
              "trial\tkind\titem\traw\treversed\tscored\ttext\n"
              "11.000000\t9.000000\tmood\t1\tn/a\tn/a\titem\tgood\t1\tfalse\t1\tn/a\n"
              "11.000000\t9.000000\tmood\t1\tn/a\tn/a\titem\tbad\t1\ttrue\t5\tn/a\n"
              "11.000000\t9.000000\tmood\t1\tn/a\tn/a\tscore\tmood\tn/a\tn/a\t3\tn/a\n");
}

constexpr char const* kTyped = "\"Ça\", she said,\n<b>łódź</b>";

/// A session in which a text was typed.
RecordedSession typed(Script const& s)
{
    RecordedSession r{make_plan(s, 1), {}};
    r.record.entries.emplace_back(started(s, r.plan));
    r.record.entries.emplace_back(QuestionnaireDone{0, 1, 2, {{}, 4.0}, {kTyped, ""}});
    return r;
}

Script text_script()
{
    return parse_script(R"(schema: study/1
id: t
seed: 1
participants: {count: 1}
sequence: [{questionnaire: q}]
blocks: {}
questionnaires: {q: {items: [{id: why, text: "Why?", type: text, lines: 3}, {id: sure, text: "Sure?"}]}}
)",
                        "t.yaml");
}

TEST(Questionnaires, HaveTextsWithTheirQuotesAndLineEnds)
{
    Script const s = text_script();
    Table const t = questionnaires_table(s, typed(s));
    ASSERT_EQ(t.rows.size(), 2u);
    EXPECT_EQ(t.rows[0].back(), kTyped);
    EXPECT_NE(tsv_text(t).find("item\twhy\tn/a\tn/a\tn/a\t\"Ça\", she said, <b>łódź</b>\n"), std::string::npos)
        << tsv_text(t);
    EXPECT_NE(csv_text(t).find("n/a,\"\"\"Ça\"\", she said,\n<b>łódź</b>\"\n"), std::string::npos) << csv_text(t);
    RecordedSession without = typed(s);
    std::get<QuestionnaireDone>(without.record.entries.back()).texts.clear();
    EXPECT_THROW(questionnaires_table(s, without), ScriptError);

    auto const file = std::filesystem::path(testing::TempDir()) / "lightwell_texts.sqlite";
    std::filesystem::remove(file);
    write_sqlite(file, export_tables(s, {typed(s)}));
    sqlite3* db = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &db), SQLITE_OK);
    std::string found;
    auto const keep = [](void* out, int, char** values, char**) {
        *static_cast<std::string*>(out) += values[0];
        return 0;
    };
    sqlite3_exec(db, "SELECT text FROM questionnaires WHERE item = 'why'", keep, &found, nullptr);
    sqlite3_close(db);
    EXPECT_EQ(found, kTyped);
}

TEST(Sessions, OfTwoPartsGoOnInTime)
{
    Script const s = script();
    RecordedSession r = session(s);
    SessionStarted again = started(s, r.plan);
    again.part = 2;
    again.clock_s = 7;
    again.gap_s = 1000;
    // In the middle: the second trial and all after it, of a clock that starts anew.
    auto& entries = r.record.entries;
    for (std::size_t i = 0; i < entries.size(); ++i)
        if (auto* done = std::get_if<TrialDone>(&entries[i]); done && done->step == 3) {
            for (std::size_t k = i; k < entries.size(); ++k)
                if (auto* later = std::get_if<TrialDone>(&entries[k]))
                    for (StimulusShown& stimulus : later->shown) stimulus.onset_s -= 120;
            entries.insert(entries.begin() + std::ptrdiff_t(i), again);
            break;
        }
    Table const t = events_table(s, trial_rows(s, r), 0);
    EXPECT_EQ(t.rows.at(0).at(0), "23.500000");
    // The first part ended at 28 s, 1000 s passed, and the trial began 6.5 s after the second start.
    EXPECT_EQ(t.rows.at(1).at(0), "1034.500000");
    EXPECT_EQ(t.rows.at(1).at(6), "2");
}

TEST(Sessions, OfAnotherExperimentAreRefused)
{
    Script const s = script();
    RecordedSession r = session(s);
    std::get<SessionStarted>(r.record.entries[0]).experiment = "other";
    EXPECT_THROW(start_of(s, r), gi::InputError);
    r.record.entries.clear();
    EXPECT_THROW(start_of(s, r), gi::InputError);
    TrialDone nowhere;
    nowhere.step = 99;
    r.record.entries = {started(s, r.plan), nowhere};
    EXPECT_THROW(trial_rows(s, r), gi::InputError);
}

TEST(BidsFiles, AreNamedAsTheStandardWantsThem)
{
    Script const s = script();
    std::vector<RecordedSession> const sessions{session(s)};
    std::vector<std::string> names;
    for (TextFile const& f : session_files(s, sessions[0])) names.push_back(f.path);
    for (TextFile const& f : dataset_files(s, sessions, "0.1.0")) names.push_back(f.path);
    std::string const stem = "sub-P001/ses-01/beh/sub-P001_ses-01_task-";
    EXPECT_EQ(names,
              (std::vector<std::string>{
                  stem + "lookhere_events.tsv", stem + "lookhere_events.json",
                  stem + "lookhere_acq-stimuli_events.tsv", stem + "lookhere_acq-stimuli_events.json",
                  stem + "questionnaires_beh.tsv", stem + "questionnaires_beh.json", stem + "session_events.tsv",
                  stem + "session_events.json", "sub-P001/ses-01/beh/session.json", "dataset_description.json",
                  "participants.tsv", "participants.json", "README.md", ".bidsignore"}));
}

TEST(BidsFiles, DescribeEveryColumn)
{
    Script const s = script();
    std::map<std::string, std::string> files;
    for (TextFile const& f : session_files(s, session(s))) files[f.path] = f.text;
    for (auto const& [path, text] : files) {
        if (!path.ends_with(".tsv")) continue;
        auto const about = nlohmann::json::parse(files.at(path.substr(0, path.size() - 4) + ".json"));
        std::istringstream line(text.substr(0, text.find('\n')));
        for (std::string column; std::getline(line, column, '\t');)
            EXPECT_TRUE(about.contains(column) && about[column].contains("Description")) << path << ": " << column;
    }
}

TEST(BidsFiles, KeepWhatParticipantsWereAskedAndNothingElse)
{
    Script const s = script();
    RecordedSession r = session(s);
    r.record.entries.insert(r.record.entries.begin() + 1,
                            ParticipantAsked{{{"age", "30-39"}, {"hands", "two\nof them"}, {"name", "Ann"}}});
    EXPECT_EQ(tsv_text(participants_table(s, {r})),
              "participant_id\tnumber\tsessions\tcomplete\tsimulated\tasked_age\thands\n"
              "sub-P001\t1\t1\ttrue\tfalse\t30-39\ttwo of them\n");
}

TEST(Cells, AreTheSameInEveryLocaleAndNeverBreakARow)
{
    EXPECT_EQ(cell(0.1), "0.1");
    EXPECT_EQ(cell(double(NAN)), "n/a");
    EXPECT_EQ(cell(std::string_view("a\tb\nc\x01")), "a\tb\nc ");
    EXPECT_EQ(tsv_text({{{"a", ""}}, {{"a\tb\nc"}}}), "a\na b c\n");
    EXPECT_EQ(cell(std::string_view("")), "n/a");
    EXPECT_EQ(seconds_cell(1.0 / 3), "0.333333");
    EXPECT_EQ(label_of("ab", {"ab", "abx2"}), "abx3");
    EXPECT_EQ(label_of("é_-"), "x");
    Table const t{{{"a", ""}, {"b,c", ""}}, {{"x \"y\"", "n/a"}}};
    EXPECT_EQ(csv_text(t, "NA"), "a,\"b,c\"\n\"x \"\"y\"\"\",NA\n");
}

TEST(Exports, SayWhatWasChosen)
{
    Script const s = script();
    auto const tables = export_tables(s, {session(s)});
    auto const& t = tables.at(0).table;
    ASSERT_EQ(t.rows.size(), 3u);
    std::vector<std::string> const end(t.rows[0].end() - 4, t.rows[0].end());
    EXPECT_EQ(end, (std::vector<std::string>{"x", "y", "x", "pair"}));
    auto const files = export_files(s, tables);
    EXPECT_EQ(files.front().path, "data/study-t_description-trials_data.csv");
    ASSERT_EQ(files.back().path, "analysis.py");
    EXPECT_NE(files.back().text.find("fit_pairs(d, [\"x\", \"y\"]"), std::string::npos);
    TextFile const& r = files.at(files.size() - 2);
    ASSERT_EQ(r.path, "analysis.R");
    EXPECT_NE(r.text.find("levels <- c(\"x\", \"y\")"), std::string::npos);
}

TEST(Exports, AreADatabaseToo)
{
    Script const s = script();
    auto const file = std::filesystem::path(testing::TempDir()) / "lightwell_export.sqlite";
    std::filesystem::remove(file);
    write_sqlite(file, export_tables(s, {session(s)}));
    sqlite3* db = nullptr;
    ASSERT_EQ(sqlite3_open(file.c_str(), &db), SQLITE_OK);
    std::string found;
    auto const keep = [](void* out, int n, char** values, char**) {
        for (int i = 0; i < n; ++i)
            *static_cast<std::string*>(out) += (values[i] ? values[i] : "NULL") + std::string(" ");
        return 0;
    };
    sqlite3_exec(db,
                 "SELECT count(*), typeof(onset), typeof(frames_shown), max(level) FROM trials "
                 "WHERE analysis = 'counted'",
                 keep, &found, nullptr);
    sqlite3_close(db);
    EXPECT_EQ(found, "2 real integer NULL ");
}

TEST(Exports, DoNotReplaceWhatIsNoDatabase)
{
    auto const file = std::filesystem::path(testing::TempDir()) / "lightwell_no_database.sqlite";
    std::filesystem::remove(file);
    EXPECT_NO_THROW(check_may_become_sqlite(file));
    write_sqlite(file, export_tables(script(), {session(script())}));
    EXPECT_NO_THROW(check_may_become_sqlite(file));
    std::ofstream(file) << "participants";
    EXPECT_THROW(check_may_become_sqlite(file), gi::InputError);
    std::filesystem::remove(file);
}

} // namespace
} // namespace study::test
