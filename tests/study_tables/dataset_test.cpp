#include "gi/core/durable_file.h"
#include "gi/core/sha256.h"
#include "study/journal/entry_line.h"
#include "study/journal/journal_folders.h"
#include "study/script/script_error.h"
#include "study/script/script_file.h"
#include "study/tables/dataset.h"
#include "tests/study_tables/recorded.h"
#include "tests/viewer/run_program.h"

namespace study::test {
namespace {

namespace fs = std::filesystem;
using viewer::test::TemporaryFolder;

char const* const kText = R"(schema: study/1
id: t
seed: 5
participants: {count: 4}
factors: {method: [x, y]}
defaults: {stimulus_ms: 2000}
sequence: [which]
blocks: {which: {task: pair, pairs: {factor: method}}}
)";

/// Two participants and their script.
class Datasets : public testing::Test {
protected:
    Datasets()
    {
        Script const s = parse_script(kText, "t.yaml");
        gi::make_folder(dir / "code");
        gi::write_durably(dir / "code/t.yaml", kText);
        for (int const participant : {1, 2}) {
            RecordedSession r =
                record_session(s, participant, [](auto const&, TrialDone& t) { t.response = "first"; });
            auto& start = std::get<SessionStarted>(r.record.entries.front());
            start.script_sha256 = gi::sha256(kText);
            start.plan_sha256 = gi::sha256(plan_table(s, r.plan));
            std::string text;
            int line = 0;
            for (JournalEntry const& e : r.record.entries) text += entry_line(e, ++line) + "\n";
            fs::path const folder = session_folder(dir.path(), start.participant_id, 1);
            gi::make_folder(folder);
            gi::write_durably(folder / "journal.jsonl", text);
        }
    }
    Dataset read() const { return read_dataset(dir.path(), {}); }
    std::string refusal() const
    {
        try {
            read();
        } catch (gi::InputError const& e) {
            return e.what();
        }
        return {};
    }

    TemporaryFolder dir;
};

TEST_F(Datasets, AreReadWithoutARemark)
{
    EXPECT_EQ(read().sessions.size(), 2u);
    EXPECT_TRUE(read().remarks.empty());
}

TEST_F(Datasets, DoNotCountACopyTwice)
{
    for (char const* const copy : {"sub-P009", "sub-P001/ses-02", "sub-P001/ses-01-copy"}) {
        bool const is_session = std::string(copy).find('/') != std::string::npos;
        fs::copy(dir / (is_session ? "sub-P001/ses-01" : "sub-P001"), dir / copy, fs::copy_options::recursive);
        EXPECT_NE(
            refusal().find("this is the journal of participant P001 in session 1 (its folder is that of another"),
            std::string::npos)
            << refusal();
        fs::remove_all(dir / copy);
    }
    EXPECT_EQ(refusal(), "");
}

TEST_F(Datasets, SayWhoIsLeftOut)
{
    fs::remove(dir / "sub-P002/ses-01/beh/journal.jsonl");
    gi::make_folder(dir / "sub-P003");
    Dataset const d = read();
    EXPECT_EQ(d.sessions.size(), 1u);
    ASSERT_EQ(d.remarks.size(), 2u);
    EXPECT_NE(d.remarks[0].find("sub-P002/ses-01: beh/journal.jsonl is missing"), std::string::npos);
    EXPECT_NE(d.remarks[1].find("sub-P003: it has no session"), std::string::npos);
}

TEST_F(Datasets, RefuseAFolderThatIsNamedWrongly)
{
    fs::rename(dir / "sub-P001/ses-01", dir / "sub-P001/ses_01");
    EXPECT_NE(
        refusal().find("sub-P001/ses_01/beh/journal.jsonl: this is the journal of participant P001 in session"),
        std::string::npos)
        << refusal();
}

TEST_F(Datasets, RefuseWhatCannotBeRead)
{
    // For root everything is readable, but not a link to itself.
    for (char const* const name : {"sub-P003", "sub-P001/ses-02", "sub-P001/ses-01/beh/journal.jsonl"}) {
        bool const was_there = fs::exists(dir / name);
        if (was_there) fs::rename(dir / name, dir / "aside");
        fs::create_symlink(dir / name, dir / name);
        EXPECT_NE(refusal().find("cannot be read"), std::string::npos) << name << refusal();
        fs::remove(dir / name);
        if (was_there) fs::rename(dir / "aside", dir / name);
    }
    EXPECT_EQ(refusal(), "");
}

} // namespace
} // namespace study::test
