// Tables as other programs write them: PsychoPy, jsPsych, UXF, spreadsheets in several languages, R, pandas, NumPy.

#include "study/analysis/result_tables.h"
#include "study/imported/trial_table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <nlohmann/json.hpp>

namespace study::test {
namespace {

ColumnRoles roles_of(std::string const& columns, std::vector<std::string> factors = {})
{
    ColumnRoles r;
    r.column = parse_roles(columns);
    r.factors = std::move(factors);
    return r;
}

/// "p1 A 0.5|p1 B 1.5": participants, items and values of all ratings.
std::string ratings(ImportedTable const& t)
{
    std::string out;
    Factor const& items = t.script.factors.back();
    for (RecordedSession const& s : t.sessions)
        for (std::size_t i = 0; i < s.plan.steps.size(); ++i) {
            auto const& done = std::get<TrialDone>(s.record.entries[i + 1]);
            int const item = s.plan.steps[i].trial.stimuli.at(0).levels.back();
            out += fmt::format("{}{} {} {:.9g}", out.empty() ? "" : "|", s.plan.participant_id,
                               items.levels[std::size_t(item)].name, done.value.value_or(-1));
        }
    return out;
}
/// What a table with the columns who, item and value says; the message if it is refused.
std::string read(std::string const& text)
{
    try {
        return ratings(
            import_trials(read_delimited(text, "t.csv"), roles_of("participant=who,item=item,value=value")));
    } catch (ScriptError const& e) {
        return e.what();
    }
}
/// All its notes.
std::string notes_of(std::string const& text, ColumnRoles const& roles)
{
    std::string out;
    for (std::string const& note : import_trials(read_delimited(text, "t.csv"), roles).notes) out += note + "|";
    return out;
}
std::string notes_of(std::string const& text)
{
    return notes_of(text, roles_of("participant=who,item=item,value=value"));
}
bool has(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }

std::string utf16(std::string const& ascii, bool big, bool has_mark)
{
    std::string out = !has_mark ? "" : big ? "\xfe\xff" : "\xff\xfe";
    for (char const c : ascii) big ? (out += '\0') += c : (out += c) += '\0';
    return out;
}

std::string const kRows = "p1 A 0.5|p1 B 1.5|p2 A 2.25|p2 B 3";

TEST(OtherPrograms, WriteTheSameTableInManyWays)
{
    std::string const plain = "who,item,value\np1,A,0.5\np1,B,1.5\np2,A,2.25\np2,B,3\n";
    struct Case {
        char const* by;
        std::string text;
    };
    std::string const crlf = "who;item;value\r\np1;A;0,5\r\np1;B;1,5\r\np2;A;2,25\r\np2;B;3\r\n";
    std::string const cr = "who,item,value\rp1,A,0.5\rp1,B,1.5\rp2,A,2.25\rp2,B,3\r";
    std::string const tabs = "who\titem\tvalue\np1\tA\t0,5\np1\tB\t1,5\np2\tA\t2,25\np2\tB\t3\n";
    for (Case const& c : {
             Case{"PsychoPy", "who,item,value,\np1,A,0.5,\np1,B,1.5,\np2,A,2.25,\np2,B,3,\n"},
             Case{"jsPsych", "\"who\",\"item\",\"value\"\r\n\"p1\",\"A\",\"0.5\"\r\n\"p1\",\"B\",\"1.5\"\r\n"
                             "\"p2\",\"A\",\"2.25\"\r\n\"p2\",\"B\",\"3\""},
             Case{"UXF with a German culture", crlf},
             Case{"Excel, semicolons", "\xef\xbb\xbf" + crlf},
             Case{"Excel, sep=", "sep=;\r\n" + crlf},
             Case{"Excel, Unicode text", utf16(tabs, false, true)},
             Case{"UTF-16, big endian", utf16(tabs, true, true)},
             Case{"UTF-16 without a mark", utf16(crlf, false, false)},
             Case{"UTF-16, big endian, without a mark", utf16(plain, true, false)},
             Case{"Excel for Macintosh", cr},
             Case{"CR and LF mixed", "who,item,value\rp1,A,0.5\r\np1,B,1.5\np2,A,2.25\rp2,B,3"},
             Case{"tabs and decimal commas", tabs},
             Case{"quoted decimal commas", "who,item,value\np1,A,\"0,5\"\np1,B,\"1,5\"\np2,A,\"2,25\"\np2,B,3\n"},
             Case{"R, write.csv2",
                  "\"\";\"who\";\"item\";\"value\"\n\"1\";\"p1\";\"A\";0,5\n\"2\";\"p1\";\"B\";1,5\n"
                  "\"3\";\"p2\";\"A\";2,25\n\"4\";\"p2\";\"B\";3\n"},
             Case{"pandas", ",who,item,value\n0,p1,A,0.5\n1,p1,B,1.5\n2,p2,A,2.25\n3,p2,B,3.0\n"},
             Case{"NumPy", "# who,item,value\np1,A,0.5\np1,B,1.5\np2,A,2.25\np2,B,3\n"},
             Case{"comments", "# made on Monday, 3 o'clock \"sharp\n# who,item,value\np1,A,0.5\np1,B,1.5\n"
                              "# a break, of 5 min\np2,A,2.25\np2,B,3\n# end\n"},
             Case{"comments before the names", "# by X\nwho,item,value\np1,A,0.5\np1,B,1.5\np2,A,2.25\np2,B,3\n"},
             Case{"joined files", "who,item,value\np1,A,0.5\np1,B,1.5\n\nwho,item,value\np2,A,2.25\np2,B,3\n"},
             Case{"joined files with marks", "\xef\xbb\xbfwho,item,value\np1,A,0.5\np1,B,1.5\n\xef\xbb\xbfwho,"
                                             "item,value\np2,A,2.25\np2,B,3\n"},
             Case{"commas in names", "who\titem, shown\titem\tvalue\tx, y, z\np1\t1\tA\t0,5\t1\np1\t2\tB\t1,5\t\n"
                                     "p2\t1\tA\t2,25\t1\np2\t2\tB\t3\t1\n"},
             Case{"commas in names with semicolons",
                  "who;item;value;x, y, z, of, all\np1;A;0,5;1\np1;B;1,5;1\np2;A;2,25;1\np2;B;3;1\n"},
             Case{"trailing separators", "who,item,value,,\np1,A,0.5,,\np1,B,1.5\np2,A,2.25,,\np2,B,3,,\n"},
             Case{"more separators than columns", "who,item,value\np1,A,0.5,,\np1,B,1.5,\np2,A,2.25\np2,B,3\n"},
             Case{"equal names", "who,x,item,x,value\np1,1,A,2,0.5\np1,1,B,2,1.5\np2,1,A,2,2.25\np2,1,B,2,3\n"},
             Case{"signs and exponents", "who,item,value\np1,A,+0.5\np1,B,15e-1\np2,A,2.25E0\np2,B,3.\n"},
             Case{"exponents after decimal commas",
                  "who;item;value\np1;A;5,0e-1\np1;B;1,5E+00\np2;A;2,25\np2;B;3,0\n"},
         })
        EXPECT_EQ(read(c.text), kRows) << c.by;
}

TEST(OtherPrograms, HaveManyWordsForNothing)
{
    for (char const* word : {"", "NA", "NaN", "nan", ".", "None", "--", "n/a", "N/A", "#N/A", "null", "NULL",
                             "<NA>", "undefined", " -- ", "\"\""}) {
        std::string const text =
            fmt::format("who,item,value\np1,A,0.5\np1,B,1.5\np1,A,{}\np2,A,2.25\np2,B,3\n", word);
        EXPECT_EQ(read(text), kRows) << word;
        EXPECT_TRUE(has(notes_of(text), "1 of 5 rows left out: no 'value'")) << word;
    }
}

TEST(OtherPrograms, SkippedLinesAreCounted)
{
    EXPECT_TRUE(has(notes_of("who,item,value\np1,A,1\nwho,item,value\np1,B,2\nwho,item,value\np2,A,1\np2,B,2\n"),
                    "2 further lines of column names skipped (the first is line 3)|"));
    EXPECT_TRUE(has(notes_of("# x\nwho,item,value\np1,A,1\np1,B,2\n# y\n"), "2 lines of comments skipped|"));
    EXPECT_TRUE(has(notes_of("who,item,value\np1,A,1\np1,B\np1,B,2\n"),
                    "1 row ends before the last column (the first is line 3): the rest is missing|"));
    EXPECT_TRUE(
        has(read("who,item,value\np1,A,1\nitem,who,value\nA,p2,1\n"), "t.csv:3:1: column names in another order"));
    EXPECT_EQ(read("who,item,value\n#1,A,1\n#1,B,2\n"), "#1 A 1|#1 B 2") << "a participant";
}

TEST(OtherPrograms, DecimalsOfAColumnAreMarkedAlike)
{
    EXPECT_TRUE(has(read("who;item;value\np1;A;0,5\np1;B;1.5\n"),
                    "t.csv:3:6: '1.5' in column 'value' (the column has decimal commas too, '0,5' in line 2)"))
        << read("who;item;value\np1;A;0,5\np1;B;1.5\n");
    EXPECT_TRUE(has(read("who,item,value\np1,A,0.5\np1,B,\"1,5\"\n"), "t.csv:3:6: '1,5' in column 'value'"));
    EXPECT_TRUE(has(read("who;item;value\np1;A;1.234,5\np1;B;1\n"), "t.csv:2:6: '1.234,5'"));
    EXPECT_TRUE(has(read("who,item,value\np1,A,\"1,234,567\"\np1,B,1\n"), "nothing between thousands"));
    EXPECT_TRUE(
        has(read("who,item,value\np1,A,\"1,234\"\np1,B,987\n"),
            "t.csv:2:6: '1,234' in column 'value' (it may have a decimal comma, or one between thousands)"));
    EXPECT_EQ(read("who,item,value\np1,A,\"1,234\"\np1,B,\"0,9\"\n"), "p1 A 1.234|p1 B 0.9")
        << "the other one tells";
    EXPECT_EQ(read("who;item;value\np1;A;1,234\np1;B;0\n"), "p1 A 1.234|p1 B 0") << "semicolons tell";
    EXPECT_TRUE(has(read("who,item,value\np1,A,0,5\np1,B,1\n"), "t.csv:2:1: 4 cells in a table of 3 columns"));
    // Columns, and files, may differ.
    std::string const two = "who;item;value;reaction\np1;A;0,5;0.7\np1;B;1,5;0.8\n";
    EXPECT_EQ(ratings(import_trials(read_delimited(two, "t.csv"),
                                    roles_of("participant=who,item=item,value=value,reaction_s=reaction"))),
              "p1 A 0.5|p1 B 1.5");
    EXPECT_EQ(ratings(import_trials(joined({read_delimited("who;item;value\np1;A;0,5\np1;B;1,5\n", "1.csv"),
                                            read_delimited("who,item,value\np2,A,2.25\np2,B,3\n", "2.csv")}),
                                    roles_of("participant=who,item=item,value=value"))),
              kRows);
    // Levels of a factor are in numeric order, under the names that they have.
    ImportedTable const t =
        import_trials(read_delimited("who;dose;item;value\np1;10,5;A;1\np1;9,5;A;2\n", "t.csv"),
                      roles_of("participant=who,item=item,value=value", {"dose"}));
    EXPECT_EQ(t.script.factors.at(0).levels.at(0).name, "9,5");
    // Answers of spreadsheets in other languages, and halves for ties.
    ImportedTable const pairs =
        import_trials(read_delimited("a;b;first\nx;y;WAHR\nx;y;falso\nx;y;1,0\nx;y;0,5\n", "t.csv"),
                      roles_of("first=a,second=b,first_chosen=first"));
    std::string answers;
    for (int i = 1; i <= 4; ++i)
        answers += std::get<TrialDone>(pairs.sessions[0].record.entries[std::size_t(i)]).response + " ";
    EXPECT_EQ(answers, "first second first neither ");
}

TEST(OtherPrograms, EqualColumnsCannotBeNamed)
{
    EXPECT_TRUE(
        has(read("who,item,value,value\np1,A,1,2\np1,B,1,2\n"), "t.csv:1:16: two columns are named 'value'"));
    auto const table = read_delimited("who,item,value,who\np1,A,1,2\n", "t.csv");
    EXPECT_THROW(import_trials(table, roles_of("item=item,value=value", {"who"})), ScriptError);
    EXPECT_THROW(to_wide(read_delimited("who,name,name,value\n1,a,b,1\n", "l.csv"), "name", "value"), ScriptError);
    DelimitedText const both =
        joined({read_delimited("a,x,x\n1,2,3\n", "1.csv"), read_delimited("x,a,x\n5,4,6\n", "2.csv")});
    ASSERT_EQ(both.columns, (std::vector<std::string>{"a", "x", "x"}));
    EXPECT_EQ(both.rows[1][0].text + both.rows[1][1].text + both.rows[1][2].text, "456");
}

TEST(OtherPrograms, SaveInSeveralEncodings)
{
    std::string const latin = "who,item,value\nBj\xf6rn,A,1\nBj\xf6rn,\x80 5,2\n";
    EXPECT_EQ(read(latin), "Bj\xc3\xb6rn A 1|Bj\xc3\xb6rn \xe2\x82\xac 5 2");
    EXPECT_TRUE(has(notes_of(latin), "t.csv:2:3: the text is not UTF-8: it is read as Windows-1252"));
    EXPECT_TRUE(has(read("who,item,value\n\xc3\xb6,A,1\n\xf6,B,2\n"), "t.csv:3:1: the text is not UTF-8"));
    EXPECT_TRUE(has(read("who,item,value\n\x81,A,1\n"), "t.csv:2:1: the text is neither UTF-8 nor Windows-1252"));
    EXPECT_TRUE(has(read(std::string("who,item,value\np,x\0,1\n", 22)), "t.csv:2:4: a zero byte"));
    EXPECT_EQ(read("who,item,value\n\xf0\x9f\x98\x80,A,1\n"), "\xf0\x9f\x98\x80 A 1");
    std::string smile = utf16("who,item,value\n", false, true);
    smile += std::string("\x3d\xd8\x00\xde", 4) + utf16(",A,1\n", false, false);
    EXPECT_EQ(read(smile), "\xf0\x9f\x98\x80 A 1");
    EXPECT_TRUE(has(read(smile + "\n"), "the text ends within a character"));
    EXPECT_TRUE(
        has(read(utf16("who,item,value\n", false, true) + std::string("\x3d\xd8,\0A\0", 6)), "t.csv:2:1: half"));
}

TEST(OtherPrograms, CautionsOfUnitsAndIdsAreInTheResults)
{
    ColumnRoles const seconds = roles_of("participant=who,item=item,value=value,reaction_s=rt");
    std::string const ms = "who,item,value,rt\np1,A,1,595\np1,B,2,612\np2,A,1,480\np2,B,2,700\n";
    std::string const caution = "reaction times in column 'rt' have a median of 603500 ms: they seem to be in "
                                "milliseconds, which reaction_ms=rt would say";
    EXPECT_TRUE(has(notes_of(ms, seconds), caution)) << notes_of(ms, seconds);
    EXPECT_FALSE(has(notes_of("who,item,value,rt\np1,A,1,0.595\np1,B,2,12\n", seconds), "seem"));
    ColumnRoles const milliseconds = roles_of("participant=who,item=item,value=value,reaction_ms=rt");
    EXPECT_TRUE(
        has(notes_of("who,item,value,rt\np1,A,1,0.595\np1,B,2,0.6\n", milliseconds), "seem to be in seconds"));
    EXPECT_FALSE(has(notes_of(ms, milliseconds), "seem"));

    std::string groups = "who,group,item,value\n";
    for (char const* row : {"p1,old", "p2,old", "p3,old", "p3,young", "p4,young", "p5,young"})
        groups += fmt::format("{},A,1\n{},B,2\n", row, row);
    ColumnRoles const by_group = roles_of("participant=who,item=item,value=value", {"group"});
    EXPECT_TRUE(has(notes_of(groups, by_group),
                    "'group': 1 participant (p3) has several levels (old and young), the "
                    "other 4 have one each: it is taken as within participants"));
    char const* const both = "p1,x,A,1\np1,y,A,2\np2,x,A,1\np2,y,A,2\n";
    EXPECT_TRUE(has(notes_of("who,group,item,value\n" + std::string(both), by_group), "4 are analysed as 2"))
        << "nobody is in two groups";
    EXPECT_FALSE(has(notes_of("who,light,item,value\n" + std::string(both),
                              roles_of("participant=who,item=item,value=value", {"light"})),
                     "taken"));

    ImportedTable const t = import_trials(read_delimited(ms, "t.csv"), seconds);
    Dataset const records{t.script, {}, t.sessions, t.notes};
    auto const json = nlohmann::json::parse(to_json(analyze(records, {.replicates = 50, .permutations = 19})));
    EXPECT_TRUE(has(json.at("cautions").dump(), "seem to be in milliseconds"));
}

} // namespace
} // namespace study::test
