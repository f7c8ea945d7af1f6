// kill -9 at random moments of sessions that a real process runs.

#include "tests/study_simulate/support.h"

#include "study/journal/journal_file.h"

#include <chrono>
#include <fcntl.h>
#include <fmt/format.h>
#include <nlohmann/json.hpp>
#include <set>

namespace study::test {
namespace {

namespace fs = std::filesystem;
using viewer::test::program_path;
using viewer::test::run_well;

/// A child whose standard output comes through a pipe.
class PipedChild {
public:
    PipedChild(std::vector<std::string> arguments, fs::path const& folder)
    {
        arguments.insert(arguments.begin(), program_path());
        std::vector<char*> argv;
        for (std::string& a : arguments) argv.push_back(a.data());
        argv.push_back(nullptr);
        int ends[2];
        if (pipe2(ends, O_CLOEXEC) != 0) throw std::runtime_error("no pipe");
        posix_spawn_file_actions_t actions;
        posix_spawn_file_actions_init(&actions);
        posix_spawn_file_actions_addchdir_np(&actions, folder.c_str());
        posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
        int const error = posix_spawn(&pid_, argv[0], &actions, nullptr, argv.data(), environ);
        posix_spawn_file_actions_destroy(&actions);
        close(ends[1]);
        if (error != 0) throw std::runtime_error("cannot run " + program_path());
        out_.reset(fdopen(ends[0], "r"));
    }
    ~PipedChild() { kill_and_wait(); }
    PipedChild(PipedChild const&) = delete;
    PipedChild& operator=(PipedChild const&) = delete;

    /// The next line; none at the end.
    std::optional<std::string> line()
    {
        char text[512];
        if (std::fgets(text, sizeof text, out_.get()) == nullptr) return {};
        return std::string(text);
    }
    void kill_and_wait()
    {
        if (pid_ <= 0) return;
        kill(pid_, SIGKILL);
        waitpid(pid_, nullptr, 0);
        pid_ = 0;
    }

private:
    struct Close {
        void operator()(std::FILE* f) const { std::fclose(f); }
    };
    pid_t pid_ = 0;
    std::unique_ptr<std::FILE, Close> out_;
};

/// "P001 step 12 attempt 1" as it is printed once it is on the disk; "P001 step 3" of what is no trial.
std::set<std::string> kept_in(SessionRecord const& record, std::string const& id)
{
    std::set<std::string> out;
    for (JournalEntry const& e : record.entries) {
        if (auto const* const t = std::get_if<TrialDone>(&e))
            out.insert(fmt::format("{} step {} attempt {}", id, t->step + 1, t->attempt));
        if (auto const* const s = std::get_if<StepDone>(&e))
            out.insert(fmt::format("{} step {}", id, s->step + 1));
        if (auto const* const q = std::get_if<QuestionnaireDone>(&e))
            out.insert(fmt::format("{} step {}", id, q->step + 1));
    }
    return out;
}

std::string name_of_line(std::string const& line) { return line.substr(0, line.find_first_of(":\n")); }

/// Everything of the trials that a session decides or an observer answers, line by line.
std::string table_of(SessionRecord const& record)
{
    std::string table;
    for (JournalEntry const& e : record.entries)
        if (auto const* const t = std::get_if<TrialDone>(&e)) {
            std::string letters;
            for (StimulusShown const& s : t->shown) letters += s.letter + s.settings_sha256.substr(0, 8);
            table += fmt::format("{} {} {} {} {} {} {} {} {}\n", t->step, t->attempt, letters,
                                 t->level.value_or(-1), t->response, t->value.value_or(-1),
                                 t->is_correct ? int(*t->is_correct) : -1, t->is_valid, t->reason);
        }
    return table;
}

TEST(Killed, AtAHundredMomentsLosesNothingAndGoesOnInTheSameOrder)
{
    constexpr int kKills = 100;
    TemporaryFolder const dir;
    run_well("study example visibility2026 --out v.yaml", dir.path());
    Random random(20261122);
    int kills = 0, parts = 0, torn = 0, reported = 0;
    // A simulated session takes so little time that many end before they are killed.
    for (int seed = 11; seed < 51 && kills < kKills; ++seed) {
        std::string const of_seed = std::to_string(seed), whole = "whole" + of_seed, cut = "cut" + of_seed;
        run_well("study simulate v.yaml --out " + whole + " --seed " + of_seed, dir.path());
        for (int participant = 1; participant <= 24 && kills < kKills; ++participant) {
            std::string const id = fmt::format("P{:03}", participant);
            fs::path const folder = session_folder(dir / cut, id, 1), journal = folder / "journal.jsonl";
            for (bool is_complete = false; !is_complete;) {
                PipedChild child({"study", "simulate", "v.yaml", "--out", cut, "--seed", of_seed, "--resume",
                                  "--each", "--participants", std::to_string(participant)},
                                 dir.path());
                std::set<std::string> said;
                bool const will_kill = kills < kKills;
                // Most die between two lines somewhere in a session, some before they have written anything.
                std::size_t const lines = random.below(8) == 0 ? 0 : random.below(30);
                bool has_ended = false;
                while (!has_ended && (!will_kill || said.size() < lines)) {
                    auto const line = child.line();
                    if (line && line->find(" step ") != std::string::npos) {
                        said.insert(name_of_line(*line));
                        if (said.size() % 16 == 5) {
                            EXPECT_NO_THROW(read_journal(journal)) << "while it is written";
                        }
                    }
                    has_ended = !line;
                }
                if (!has_ended) {
                    std::uint32_t const wait_us = lines == 0 ? random.below(40000) : random.below(700);
                    std::this_thread::sleep_for(std::chrono::microseconds(wait_us));
                    child.kill_and_wait();
                    ++kills;
                    while (auto const line = child.line()) // what it had said before it died
                        if (line->ends_with("\n") && line->find(" step ") != std::string::npos)
                            said.insert(name_of_line(*line));
                }
                reported += int(said.size());
                ++parts;
                if (!fs::exists(journal)) {
                    EXPECT_TRUE(said.empty());
                    continue;
                }
                JournalText const text = read_journal(journal);
                torn += text.torn_bytes > 0;
                std::set<std::string> const kept = kept_in(text.record, id);
                for (std::string const& line : said) EXPECT_TRUE(kept.contains(line)) << line << " was lost";
                if (fs::exists(folder / "session.json")) {
                    is_complete =
                        nlohmann::json::parse(file_text(folder / "session.json")).at("complete").get<bool>();
                    EXPECT_EQ(file_text(folder / "plan.tsv"),
                              file_text(session_folder(dir / whole, id, 1) / "plan.tsv"));
                }
            }
            EXPECT_EQ(table_of(read_journal(journal).record),
                      table_of(read_journal(session_folder(dir / whole, id, 1) / "journal.jsonl").record))
                << id;
        }
    }
    EXPECT_EQ(kills, kKills);
    EXPECT_GT(reported, 1500);
    fmt::print("{} kills, {} parts, {} torn lines, {} lines reported as kept\n", kills, parts, torn, reported);
}

} // namespace
} // namespace study::test
