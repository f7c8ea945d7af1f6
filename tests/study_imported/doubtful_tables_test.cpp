// Tables that read well and may mean something else: what is said of them.

#include "study/analysis/result_tables.h"
#include "study/imported/table_doubts.h"
#include "study/imported/trial_table.h"

#include <fmt/format.h>
#include <gtest/gtest.h>
#include <sstream>

namespace study::test::doubtful {
namespace {

ColumnRoles with(std::string const& columns, std::vector<std::string> factors = {})
{
    ColumnRoles r;
    r.column = parse_roles(columns);
    r.factors = std::move(factors);
    return r;
}
ImportedTable imported(std::string const& text, ColumnRoles const& roles)
{
    return import_trials(read_delimited(text, "t.csv"), roles);
}
std::string notes_of(ImportedTable const& t)
{
    std::string all;
    for (std::string const& n : t.notes) all += n + "|";
    return all;
}
std::string responses_of(ImportedTable const& t)
{
    std::string all;
    for (RecordedSession const& s : t.sessions)
        for (JournalEntry const& e : s.record.entries)
            if (auto const* done = std::get_if<TrialDone>(&e)) all += done->response.substr(0, 1);
    return all;
}
std::string refusal_of(std::string const& text, ColumnRoles const& roles)
{
    try {
        imported(text, roles);
    } catch (ScriptError const& e) {
        return e.what();
    }
    return "accepted";
}
bool has(std::string const& text, std::string const& part) { return text.find(part) != std::string::npos; }

// ---------------------------------------------------------------------------------------------------- positions

TEST(PositionsOfChoices, CountFromOneOrFromZeroWhereTheProgramIsKnown)
{
    struct Case {
        char const *trial_type, *column, *answers, *read, *note;
    };
    for (Case const& c : {
             Case{"html-button-response", "response", "0 1 1", "fss", "0 is read as first, 1 as second (3 rows)"},
             Case{"image-button-response", "button_pressed", "1 0 0.0", "sff", "0 is read as first"},
             Case{"jspsych-html-button-response", "response", "1 1 1", "sss", "1 as second"},
             Case{"html-button-response", "response", "1 2 1", "fsf", ""}, // recoded: 0 does not occur
             Case{"html-keyboard-response", "response", "1 2 2", "fss", ""},
             Case{"html-keyboard-response", "response", "1 1 1", "fff",
                  "are all 1 (3 rows): they are read as first"},
             Case{"x", "choice", "2.0 1.0 1", "sff", ""},
             Case{"html-button-response", "response", "b a a", "sff", ""},
         }) {
        std::string table = fmt::format("a,b,trial_type,{}\n", c.column);
        std::istringstream answers(c.answers);
        for (std::string answer; answers >> answer;) table += fmt::format("a,b,{},{}\n", c.trial_type, answer);
        ImportedTable const t = imported(table, with(fmt::format("first=a,second=b,chosen={}", c.column)));
        EXPECT_EQ(responses_of(t), c.read) << table;
        EXPECT_TRUE(has(notes_of(t), c.note)) << notes_of(t);
        EXPECT_EQ(t.notes.empty(), *c.note == '\0') << notes_of(t);
    }
}

TEST(PositionsOfChoices, ThatMayMeanOppositesAreRefusedWithBothWays)
{
    auto const roles = with("first=a,second=b,chosen=c");
    for (char const* answers : {"x,y,0\nx,y,1\n", "x,y,0\nx,y,0\n", "x,y,0.0\nx,y,1.0\n"}) {
        std::string const said = refusal_of("a,b,c\n" + std::string(answers), roles);
        EXPECT_EQ(said.find("t.csv:2:5"), 0u) << said;
        EXPECT_TRUE(
            has(said, "use chosen_from_0=c if 0 means that the first was chosen, first_chosen=c if 1 does"))
            << said;
    }
    EXPECT_TRUE(has(refusal_of("a,b,c\nx,y,1\nx,y,0\nx,y,2\n", roles),
                    "t.csv:3:5: '0' in column 'c' (the column has 2, too (line 4)"));
    EXPECT_TRUE(
        has(refusal_of("a,b,c\nx,y,f\n", roles), "name the chosen item, or write first, second or neither"));
    EXPECT_EQ(responses_of(imported("a,b,c\n0,1,0\n0,1,1\n1,0,1\n", roles)), "fsf") << "names of items";
}

TEST(PositionsOfChoices, FromZeroAreARoleOfTheirOwn)
{
    auto const roles = with("first=a,second=b,chosen_from_0=c");
    EXPECT_EQ(responses_of(imported("a,b,c\nx,y,0\nx,y,1\nx,y,neither\nx,y,1.0\n", roles)), "fsns");
    EXPECT_TRUE(has(refusal_of("a,b,c\nx,y,2\n", roles), "t.csv:2:5: '2'"));
    EXPECT_TRUE(has(refusal_of("a,b,c\nx,y,1\n", with("first=a,second=b,chosen_from_0=c,chosen=c")),
                    "columns for 'chosen_from_0' and 'chosen'"));
    // The opposite of flags.
    EXPECT_EQ(responses_of(imported("a,b,c\nx,y,0\nx,y,1\n", with("first=a,second=b,first_chosen=c"))), "sf");
}

TEST(PositionsOfChoices, OfButtonsThatAreReadAsFlagsAreNamed)
{
    std::string const table = "a,b,trial_type,response\nx,y,html-button-response,0\nx,y,html-button-response,1\n";
    std::string const chosen = notes_of(imported(table, with("first=a,second=b,first_chosen=response")));
    EXPECT_TRUE(has(
        chosen,
        "first_chosen=response reads 1, the second button, as yes (2 rows); if button 0 is that of the first, use "
        "chosen_from_0=response"))
        << chosen;
    std::string const yes =
        notes_of(imported("s,trial_type,response\n1,html-button-response,0\n0,html-button-response,1\n",
                          with("signal=s,yes=response")));
    EXPECT_TRUE(has(yes, "if button 0 is that of yes, exchange 0 and 1")) << yes;
}

// ------------------------------------------------------------------------------------------- ids of participants

/// Answers of people numbered from 1 in each group, in random order of levels, group after group, or person after person.
std::string grouped(std::string const& factor, bool by_group, int first_old = 1, bool same_order = false)
{
    std::string table = fmt::format("id,{},level,correct\n", factor);
    std::vector<std::pair<int, int>> order; // group, person
    for (int a = 0; a < (by_group ? 2 : 4); ++a)
        for (int b = 0; b < (by_group ? 4 : 2); ++b) order.emplace_back(by_group ? a : b, by_group ? b : a);
    for (auto const& [group, person] : order)
        for (int i = 0; i < 12; ++i)
            table +=
                fmt::format("{},{},{},{}\n", person + (group == 1 ? first_old : 1), group == 0 ? "young" : "old",
                            1 + (same_order ? i : i * (3 + 2 * group) + person) % 4, (i * 5 + person) % 3 > 0);
    return table;
}
std::string const kGrouped = "participant=id,level=level,correct=correct";

TEST(IdsOfParticipants, ThatSeemToBeUsedForSeveralPeopleAreNamed)
{
    std::string const found = notes_of(imported(grouped("group", true), with(kGrouped, {"group"})));
    EXPECT_TRUE(has(
        found, "'group': 4 participants (1, 2, 3, 4) have several levels (old and young): it is taken as within "
               "participants; if an id was used for several people, 8 are analysed as 4: use "
               "participant=group+id"))
        << found;
    EXPECT_TRUE(
        has(notes_of(imported(grouped("Age group", false), with(kGrouped, {"Age group"}))), "8 are analysed as 4"))
        << "by its name, in any order";
    EXPECT_TRUE(has(notes_of(imported(grouped("dose", true), with(kGrouped, {"dose"}))), "8 are analysed as 4"))
        << "levels stand together";
    EXPECT_TRUE(has(notes_of(imported(grouped("dose", true, 3), with(kGrouped, {"dose"}))),
                    "rename one, or use participant=dose+id"))
        << "some ids are in both";
    EXPECT_EQ(notes_of(imported(grouped("dose", false), with(kGrouped, {"dose"}))), "")
        << "conditions of each person";
    EXPECT_EQ(notes_of(imported(grouped("dose", true, 1, true), with(kGrouped, {"dose"}))), "")
        << "from wide to long";
    EXPECT_EQ(notes_of(imported(grouped("group", true, 5), with(kGrouped, {"group"}))),
              "'group' differs between participants|");
}

TEST(IdsOfParticipants, MayBeSeveralColumns)
{
    ImportedTable const t =
        imported(grouped("group", true), with("participant=group+id,level=level,correct=correct", {"group"}));
    ASSERT_EQ(t.sessions.size(), 8u);
    EXPECT_EQ(t.sessions[0].plan.participant_id, "young+1");
    EXPECT_EQ(notes_of(t), "'group' differs between participants|");
    EXPECT_EQ(imported("a+b,i,v\n1,x,1\n2,x,2\n", with("participant=a+b,item=i,value=v")).sessions.size(), 2u)
        << "a column of that name";
    EXPECT_TRUE(has(refusal_of("a,i,v\n1,x,1\n", with("participant=a+b,item=i,value=v")), "no column 'b'"));
    ImportedTable const gaps = imported("g,a,i,v\nx,1,x,1\n,1,x,2\n", with("participant=g+a,item=i,value=v"));
    EXPECT_TRUE(has(notes_of(gaps), "1 of 2 rows left out: no 'g'"));
}

TEST(IdsOfParticipants, InSeveralFilesMayBeNestedInThese)
{
    auto const file = [](char const* name, int first) {
        return read_delimited(fmt::format("id,i,v\n1,x,{}\n2,x,3\n3,x,4\n", first), name);
    };
    DelimitedText const both = joined({file("in/young.csv", 1), file("in/old.csv", 2)});
    EXPECT_TRUE(has(
        notes_of(import_trials(both, with("participant=id,item=i,value=v"))),
        "3 of 3 ids (1, 2, 3) are in several files: they are taken as the same people; if each file numbers its "
        "own, use participant=file+id"));
    ImportedTable const nested = import_trials(both, with("participant=file+id,item=i,value=v", {"file"}));
    ASSERT_EQ(nested.sessions.size(), 6u);
    EXPECT_EQ(nested.sessions[3].plan.participant_id, "old+1");
    EXPECT_EQ(notes_of(nested), "'file' differs between participants|");
    EXPECT_EQ(nested.script.id, "young and old");
    // One file per person needs no word.
    EXPECT_EQ(notes_of(import_trials(
                  joined({read_delimited("id,i,v\na,x,1\n", "a.csv"), read_delimited("id,i,v\nb,x,2\n", "b.csv")}),
                  with("participant=id,item=i,value=v"))),
              "");
    DelimitedText const same_stem = joined({file("1/data.csv", 1), file("2/data.csv", 2)});
    EXPECT_EQ(import_trials(same_stem, with("participant=file+id,item=i,value=v")).sessions[0].plan.participant_id,
              "1/data.csv+1");
}

TEST(NamesOfTables, ThatDifferOnlyInWritingAreNamed)
{
    struct Case {
        char const *a, *b;
        bool are_similar;
    };
    for (Case const& c : {Case{"P1", "p1", true},
                          {"P 1", "P1", true},
                          {"P1\xc2\xa0", "P1", true},
                          {"P01", "P1", true},
                          {"007", "7", true},
                          {"3", "3.0", true},
                          {"\xc3\x89va", "\xc3\xa9va", true},
                          {"1.10", "1.1", false},
                          {"1.01", "1.1", false},
                          {"0", "00", true},
                          {"10", "1", false},
                          {"a", "b", false},
                          {"0.5", "5", false},
                          {"x0", "x", false}})
        EXPECT_EQ(!similar_names({c.a, c.b}).empty(), c.are_similar) << c.a << " " << c.b;
    EXPECT_EQ(similar_names_caution("items", {"A", "b", "a", "B "}),
              "items 'A' and 'a', 'b' and 'B ' differ only in case, blanks or zeros: they are taken as different; "
              "write what "
              "is the same in one way");
    std::string const notes =
        notes_of(imported("p,i,g,v\nP1,x,k,1\np1,X,K,2\nP2,x,k,3\n", with("participant=p,item=i,value=v", {"g"})));
    EXPECT_TRUE(has(notes, "participants 'P1' and 'p1' differ")) << notes;
    EXPECT_TRUE(has(notes, "items 'x' and 'X' differ")) << notes;
    EXPECT_TRUE(has(notes, "levels of 'g' 'k' and 'K' differ")) << notes;
}

// ------------------------------------------------------------------------------------------------ repeated rows

TEST(RepeatedRows, AreNamedWhereAllOrAllOfAPersonRepeat)
{
    std::string const roles = "participant=p,item=i,value=v";
    auto const rows = [](int first, int last, char const* number = "") {
        std::string text;
        for (int p = first; p <= last; ++p)
            for (int i = 0; i < 15; ++i)
                text += fmt::format("{},{},{},{}\n", p, char('a' + i), 1 + (i * p * p) % 7,
                                    *number != '\0' ? std::to_string(p * 15 + i) : "");
        return text;
    };
    std::string const head = "p,i,v,n\n", once = rows(1, 4);
    EXPECT_EQ(notes_of(imported(head + once, with(roles))), "");
    EXPECT_EQ(notes_of(imported(head + once + once, with(roles))),
              "60 of 120 rows are identical to an earlier one, and no row occurs less than 2 times: if the table "
              "was joined "
              "with itself, its trials count 2 times|");
    EXPECT_TRUE(has(notes_of(imported(head + once + rows(2, 2), with(roles))),
                    "15 of 75 rows are identical to an earlier one, among them each row of 1 participant (2)"));
    // Rows that are numbered on and on are repeated all the same; answers that repeat by chance are no doubt.
    std::string numbered;
    int n = 0;
    for (int copy = 0; copy < 2; ++copy)
        for (int k = 0; k < 60; ++k, ++n)
            numbered += fmt::format("{},{},{},{}\n", k / 15, char('a' + k % 15), k % 7, n);
    EXPECT_TRUE(has(notes_of(imported(head + numbered, with(roles))), "60 of 120 rows"));
    std::string chance = "p,l,c\n";
    for (int k = 0; k < 200; ++k) chance += fmt::format("{},{},{}\n", k % 4, k % 5, (k * 7 / 3) % 3 > 0);
    EXPECT_EQ(notes_of(imported(chance, with("participant=p,level=l,correct=c"))), "");
}

TEST(RepeatedRows, OfAFileThatIsGivenTwiceAreRefused)
{
    auto const refusal = [](char const* a, char const* b, char const* text_a, char const* text_b) {
        try {
            joined({read_delimited(text_a, a), read_delimited(text_b, b)});
        } catch (ScriptError const& e) {
            return std::string(e.what());
        }
        return std::string("accepted");
    };
    EXPECT_TRUE(has(refusal("a.csv", "a.csv", "p,v\n1,2\n", "p,v\n1,2\n"), "a.csv: the file is given twice"));
    EXPECT_TRUE(has(refusal("a.csv", "copy.csv", "p,v\n1,2\n", "p;v\r\n1;\"2\"\r\n"),
                    "copy.csv: the file has the same rows as 'a.csv'"));
    EXPECT_EQ(refusal("a.csv", "b.csv", "p,v\n1,2\n", "p,v\n1,3\n"), "accepted");
    EXPECT_EQ(refusal("a.csv", "b.csv", "p,v\n", "p,v\n"), "accepted") << "nothing counts twice";
}

// ------------------------------------------------------------------------------------------------ missing values

TEST(CodesOfMissingValues, AreFoundFarFromAllOthers)
{
    using enum NumberKind;
    struct Case {
        std::vector<double> numbers;
        NumberKind kind;
        std::vector<double> codes;
    };
    for (Case const& c : std::vector<Case>{
             {{1, 2, 7, -99, -99}, judgements, {-99}},
             {{1, 2, 7, 999}, judgements, {999}},
             {{1, 2, 5, 9}, judgements, {9}},
             {{1, 2, 7, -9}, judgements, {-9}},
             {{1, 2, 7, -1}, judgements, {-1}},
             {{-3, 0, 3, -9}, judgements, {-9}},
             {{-3, -1, 3}, judgements, {}},
             {{0, 1, -1}, judgements, {}},
             {{0, 50, 100, 99, 88}, judgements, {}},
             {{0.5, 50, 100, -99}, judgements, {-99}},
             {{1, 7, 88, 99}, judgements, {88, 99}},
             {{1, 8, 9, 10}, judgements, {}},
             {{99, 99}, judgements, {}},
             {{0.01, 0.02, 0.16, 99}, ratios, {99}},
             {{1, 3, 9}, ratios, {}},
             {{11, 33, 99}, ratios, {}},
             {{1, 10, 100, 999}, ratios, {}},
             {{20, 70, 31, -99}, ratios, {-99}},
             {{300, 700, 999}, times, {}},
             {{300, 2000, 9999}, times, {9999}},
             {{0.3, 2, 999}, times, {999}},
         }) {
        std::vector<double> found;
        for (MissingCode const& m : missing_codes(c.numbers, c.kind)) found.push_back(m.code);
        EXPECT_EQ(found, c.codes) << fmt::format("{}", fmt::join(c.numbers, " "));
    }
}

TEST(CodesOfMissingValues, AreNamedAndLeftOutByAnOption)
{
    std::string table = "p,i,v,rt\n";
    for (int p = 0; p < 4; ++p)
        for (int i = 0; i < 3; ++i)
            table += fmt::format("{},{},{},{}\n", p, "ABC"[i], p == 1 && i < 2 ? -99 : 2 + (p + 2 * i) % 5,
                                 p == 2 ? 9999 : 400 + 10 * p * i);
    ColumnRoles roles = with("participant=p,item=i,value=v,reaction_ms=rt");
    ImportedTable const t = imported(table, roles);
    EXPECT_EQ(
        notes_of(t),
        "-99 2 times in column 'v' is far from all others, which are from 2 to 6: if it stands for a missing "
        "value, use --missing -99|9999 3 times in column 'rt' is far from all others, which are from 400 to "
        "460: if it stands for a missing value, use --missing 9999|");
    std::string const json = to_json(analyze(Dataset{t.script, {}, t.sessions, t.notes}, {.draws = 0}));
    EXPECT_TRUE(has(json, "use --missing -99")) << "cautions of the results";
    roles.missing = {{"", "-99"}, {"", "9999"}, {"", "-1"}};
    std::string const told = notes_of(imported(table, roles));
    EXPECT_EQ(
        told,
        "2 of 12 rows left out: 'v' is -99|3 reaction times left out: 'rt' is 9999|--missing -1: no cell has it|");
    EXPECT_TRUE(has(refusal_of("l,c\n1,1\n1,-99\n", with("level=l,correct=c")), "use 1 and 0, or --missing -99"));
    // Of all columns only those of numbers, unless one is named.
    std::string const ids = "p,i,v\n99,A,3\n98,A,99.0\n97,A,4\n";
    roles = with("participant=p,item=i,value=v");
    roles.missing = {{"", "99"}};
    EXPECT_EQ(imported(ids, roles).sessions.size(), 2u);
    roles.missing = {{"p", "99"}};
    EXPECT_EQ(imported(ids, roles).sessions.size(), 2u);
    EXPECT_EQ(imported(ids, roles).sessions[0].plan.participant_id, "98");
    roles.missing = {{"q", "99"}};
    EXPECT_TRUE(has(refusal_of(ids, roles), "no column 'q'"));
}

} // namespace
} // namespace study::test::doubtful
