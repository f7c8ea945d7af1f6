#include "study/journal/journal_file.h"

#include "gi/core/crc32.h"
#include "study/journal/entry_fields.h"
#include "study/journal/entry_line.h"
#include "study/script/script_error.h"
#include "tests/study_record/samples.h"

#include <bit>
#include <cmath>
#include <gtest/gtest.h>
#include <limits>
#include <nlohmann/json.hpp>

namespace study::test {
namespace {

std::string journal_of(std::vector<JournalEntry> const& entries)
{
    std::string text;
    for (JournalEntry const& e : entries)
        text += entry_line(e, int(std::count(text.begin(), text.end(), '\n')) + 1) + "\n";
    return text;
}

std::string message_of(std::string const& text)
{
    try {
        parse_journal(text, "journal.jsonl");
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return {};
}

/// A line with another content and the checksum that fits it.
std::string with_sum(std::string line)
{
    line.resize(line.rfind(",\"crc32\""));
    char sum[32];
    std::snprintf(sum, sizeof sum, ",\"crc32\":\"%08x\"}", gi::crc32(line));
    return line + sum;
}

std::string replaced(std::string text, std::string const& from, std::string const& to)
{
    EXPECT_NE(text.find(from), std::string::npos) << from;
    return text.replace(text.find(from), from.size(), to);
}

TEST(Journal, BringsBackEveryKindOfEntry)
{
    auto const entries = entries_of_every_kind();
    std::string const text = journal_of(entries);
    JournalText const back = parse_journal(text, "x");
    EXPECT_EQ(back.torn_bytes, 0u);
    EXPECT_EQ(back.good_bytes, text.size());
    ASSERT_EQ(back.record.entries.size(), entries.size());
    EXPECT_EQ(journal_of(back.record.entries), text);
    auto const& trial = std::get<TrialDone>(back.record.entries[2]);
    auto const& sent = std::get<TrialDone>(entries[2]);
    EXPECT_EQ(trial.level, sent.level);
    EXPECT_TRUE(std::signbit(*trial.value));
    EXPECT_EQ(trial.response_s, 5e-324);
    EXPECT_EQ(trial.is_correct, false);
    EXPECT_EQ(trial.shown[1].letter, 'r');
    EXPECT_EQ(std::get<SessionStarted>(back.record.entries[0]).seed, 18446744073709551615u);
    EXPECT_EQ(std::get<SessionStarted>(back.record.entries[0]).about[0].second, "GPU \"x\"");
    EXPECT_FALSE(std::get<TrialDone>(back.record.entries[3]).is_correct.has_value());
    EXPECT_FALSE(std::get<QuestionnaireDone>(back.record.entries[5]).answers[1].has_value());
    EXPECT_EQ(std::get<ParticipantAsked>(back.record.entries[6]).answers[1].second,
              "normal\n\t\"quoted\" \\ \xe2\x82\xac");
}

TEST(Journal, LinesAreJsonForAnyProgram)
{
    for (JournalEntry const& e : entries_of_every_kind()) {
        auto const j = nlohmann::json::parse(entry_line(e, 5));
        EXPECT_EQ(j.at("n"), 5);
        EXPECT_TRUE(j.at("kind").is_string());
    }
}

TEST(Journal, BringsBackEveryBitOfADouble)
{
    Random random(4);
    for (int i = 0; i < 20000; ++i) {
        double const v = std::bit_cast<double>((std::uint64_t(random.next()) << 32) | random.next());
        StepDone step;
        step.start_s = v;
        auto const back = std::get<StepDone>(entry_of_line(entry_line(step, 1), 1));
        if (std::isnan(v))
            EXPECT_TRUE(std::isnan(back.start_s));
        else
            EXPECT_EQ(std::bit_cast<std::uint64_t>(back.start_s), std::bit_cast<std::uint64_t>(v)) << v;
    }
    StepDone const endless{0, std::numeric_limits<double>::infinity(), -std::numeric_limits<double>::infinity(),
                           ""};
    auto const back = std::get<StepDone>(entry_of_line(entry_line(endless, 1), 1));
    EXPECT_EQ(back.start_s, endless.start_s);
    EXPECT_EQ(back.end_s, endless.end_s);
}

TEST(Journal, KeepsNotesThatAreNotUtf8)
{
    auto const back = std::get<NoteTaken>(entry_of_line(entry_line(NoteTaken{0, "note",
                                                                             "a\xff"
                                                                             "b"},
                                                                   1),
                                                        1));
    EXPECT_EQ(back.text, "a\xef\xbf\xbd"
                         "b");
}

TEST(Journal, CutAnywhereLosesOnlyTheLineThatWasCut)
{
    auto const entries = entries_of_every_kind();
    std::string const text = journal_of(entries);
    for (std::string const room : {"", "\n", "\n\n\n\n\n\n"})
        for (std::size_t size = 0; size <= text.size(); ++size) {
            // Within the room for more lines the end of a whole one needs none of its own.
            bool const lacks_its_end = !room.empty() && size < text.size() && text[size] == '\n';
            std::string const cut = text.substr(0, size) + room;
            JournalText const back = parse_journal(cut, "x");
            std::size_t const lines =
                std::size_t(std::count(text.begin(), text.begin() + std::ptrdiff_t(size), '\n')) + lacks_its_end;
            ASSERT_EQ(back.record.entries.size(), lines) << size;
            ASSERT_EQ(back.good_bytes + back.torn_bytes + back.room_bytes, cut.size());
            std::size_t const whole = size == 0 ? 0 : text.substr(0, size).rfind('\n') + 1;
            ASSERT_EQ(back.torn_bytes, lacks_its_end ? 0 : size - whole) << size;
        }
}

TEST(Journal, EndsWhereALossOfPowerLeftWhatWasThereBefore)
{
    std::string const text = journal_of({StepDone{1, 0, 1, ""}});
    EXPECT_EQ(parse_journal(text + std::string(300, '\0'), "x").torn_bytes, 300u);
    EXPECT_EQ(parse_journal(text + std::string(300, '\0') + "\n", "x").torn_bytes, 300u);
    EXPECT_EQ(parse_journal(text + std::string(300, '\0') + "\n", "x").good_bytes, text.size());
    // The beginning of a line is still empty lines, its end is there.
    std::string const next = entry_line(NoteTaken{1, "note", std::string(500, 'a')}, 2);
    JournalText const half = parse_journal(text + std::string(200, '\n') + next.substr(200) + "\n\n\n", "x");
    EXPECT_EQ(half.good_bytes, text.size());
    EXPECT_EQ(half.torn_bytes, next.size());
    EXPECT_EQ(half.room_bytes, 3u);
    EXPECT_THROW(parse_journal(text + "\n" + next + "\n" + next + "\n", "x"), gi::InputError)
        << "an empty line within";
    EXPECT_EQ(parse_journal("\n\n\n", "x").room_bytes, 3u);
}

TEST(Journal, AnyChangeOfAnyByteIsSeen)
{
    std::string const text =
        journal_of({StepDone{1, 0, 1, ""}, NoteTaken{1, "note", "abc"}, StepDone{2, 1, 2, ""}});
    for (std::size_t i = 0; i + 1 < text.size(); ++i) {
        std::string changed = text;
        changed[i] = char(changed[i] ^ 1);
        EXPECT_TRUE(!message_of(changed).empty() || parse_journal(changed, "x").torn_bytes > 0) << i;
    }
}

TEST(Journal, SaysWhichLineIsWrongAndWhy)
{
    std::string const one = entry_line(StepDone{1, 0, 1, ""}, 1), two = entry_line(StepDone{2, 1, 2, ""}, 2),
                      three = entry_line(StepDone{3, 1, 2, ""}, 3);
    EXPECT_EQ(
        message_of(one + "\n" + three + "\n"),
        "journal.jsonl:2:1: this line of a journal cannot be read (its number is 3, it should be 2: lines are "
        "missing or duplicated) restore the file from a copy, nothing of it has been changed");
    EXPECT_NE(
        message_of(one + "\n" + replaced(two, "\"step\":2", "\"step\":9") + "\n" + three + "\n").find(":2:1:"),
        std::string::npos);
    EXPECT_NE(message_of(one + "\nnothing\n" + two + "\n").find("no checksum"), std::string::npos);
    EXPECT_NE(message_of(one + "\n" + with_sum(replaced(two, "\"step\":2", "\"step\":\"2\"")) + "\n")
                  .find("'step' has another type"),
              std::string::npos);
    EXPECT_NE(message_of(one + "\n" + with_sum(replaced(two, "\"step\":2", "\"step\":3000000000")) + "\n")
                  .find("'step' has another type"),
              std::string::npos);
    EXPECT_NE(message_of(with_sum(replaced(one, ",\"reason\":\"\"", "")) + "\n").find("no 'reason'"),
              std::string::npos);
}

TEST(Journal, OfANewerVersionIsRefusedAsSuch)
{
    std::string const one = entry_line(StepDone{1, 0, 1, ""}, 1);
    for (auto const& [from, to] :
         {std::pair("step_done", "dance_done"), std::pair("\"step\":1", "\"hop\":2,\"step\":1")}) {
        std::string const message = message_of(with_sum(replaced(one, from, to)) + "\n");
        EXPECT_NE(message.find("a newer version wrote it"), std::string::npos) << message;
    }
    std::string const first = entry_line(SessionStarted{}, 1);
    EXPECT_NE(message_of(with_sum(replaced(first, "journal/1", "journal/2")) + "\n").find("'journal/2'"),
              std::string::npos);
}

TEST(Journal, FieldsHaveNamesOfTheirOwn)
{
    // A field that had the name of the frame (n, kind, crc32) or of another one would be written over it.
    for (JournalEntry const& e : entries_of_every_kind())
        std::visit(
            [](auto const& entry) {
                std::vector<std::string> names{"n", "kind", "format", "crc32"};
                Fields<std::remove_cvref_t<decltype(entry)>>::visit(
                    entry, [&](char const* name, auto const&) { names.emplace_back(name); });
                std::sort(names.begin(), names.end());
                EXPECT_EQ(std::adjacent_find(names.begin(), names.end()), names.end());
            },
            e);
}

} // namespace
} // namespace study::test
