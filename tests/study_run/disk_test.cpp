// Disks that are full, read-only, or must be left in peace.

#include "gi/core/durable_file.h"
#include "tests/study_run/support.h"

#include <fcntl.h>
#include <set>
#include <sys/mount.h>
#include <sys/resource.h>
#include <sys/stat.h>

namespace study::test {
namespace {

namespace fs = std::filesystem;

struct ChildResult {
    std::set<std::pair<int, int>> kept; ///< step and attempt of trials that were said to be on the disk
    std::string message;                ///< error message; empty = the session is complete
};

/// Runs a session in a child process, after `prepare`.
ChildResult run_in_child(Script const& s, SessionSettings settings, std::function<void()> const& prepare)
{
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe");
    pid_t const child = fork();
    if (child == 0) {
        prepare();
        settings.on_kept = [&](JournalEntry const& e) {
            if (auto const* const t = std::get_if<TrialDone>(&e))
                dprintf(ends[1], "kept %d %d\n", t->step, t->attempt);
        };
        TestPresenter p;
        settings.unix_s = [&] { // going on follows soon
            return (settings.start == SessionStart::begin ? 1795334400 : 1795335000) + p.clock_s;
        };
        p.on_show = [](TrialRequest const& r, TrialDone& t) {
            if (r.step_index % 5 == 2) t.response = t.response == "first" ? "second" : "first";
        };
        std::string const why = refusal(s, p, settings);
        if (!why.empty()) dprintf(ends[1], "refused %s\n", why.c_str());
        _exit(0);
    }
    close(ends[1]);
    std::string text;
    char chunk[4096];
    for (ssize_t n = 0; (n = read(ends[0], chunk, sizeof chunk)) > 0;) text.append(chunk, std::size_t(n));
    close(ends[0]);
    waitpid(child, nullptr, 0);
    ChildResult out;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) {
        std::istringstream words(line);
        std::string what;
        int step = 0, attempt = 0;
        if (words >> what >> step >> attempt && what == "kept") out.kept.emplace(step, attempt);
        if (line.starts_with("refused ")) out.message = line.substr(8);
    }
    return out;
}

std::vector<TrialDone> trials_in(fs::path const& dir) { return entries_of<TrialDone>(journal_in(dir)); }

/// Goes on after a failure and compares with a session that had none.
void expect_nothing_lost(Script const& s, fs::path const& dir, ChildResult const& cut,
                         std::vector<TrialDone> const& expected)
{
    std::set<std::pair<int, int>> found;
    if (fs::exists(journal_in(dir)))
        for (TrialDone const& t : trials_in(dir)) found.emplace(t.step, t.attempt);
    EXPECT_EQ(found, cut.kept);
    ChildResult const rest = run_in_child(s, settings_in(dir, SessionStart::go_on), [] {});
    EXPECT_EQ(rest.message, "");
    auto const trials = trials_in(dir);
    ASSERT_EQ(trials.size(), expected.size());
    for (std::size_t i = 0; i < trials.size(); ++i) {
        EXPECT_EQ(trials[i].step, expected[i].step);
        EXPECT_EQ(trials[i].level, expected[i].level);
    }
}

std::vector<TrialDone> undisturbed(Script const& s, fs::path const& dir)
{
    EXPECT_EQ(run_in_child(s, settings_in(dir), [] {}).message, "");
    return trials_in(dir);
}

TEST(Disk, FullAtTwentyMomentsLosesNothing)
{
    TemporaryFolder const dir;
    Script const s = adaptive_script();
    auto const expected = undisturbed(s, dir / "whole");
    std::uintmax_t const size = fs::file_size(journal_in(dir / "whole")),
                         plan = fs::file_size(journal_in(dir / "whole").parent_path() / "plan.tsv");
    int stopped = 0;
    for (int i = 0; i < 20; ++i) {
        fs::path const at = dir / ("full" + std::to_string(i));
        // Before the plan is written, then from early lines of the journal to its last ones.
        rlimit const limit{i == 0 ? 100 : rlim_t(double(plan) + double(size - plan) * i / 19.5), RLIM_INFINITY};
        ChildResult const cut = run_in_child(s, settings_in(at), [&] {
            std::signal(SIGXFSZ, SIG_IGN);
            setrlimit(RLIMIT_FSIZE, &limit);
        });
        EXPECT_NE(cut.message, "") << limit.rlim_cur;
        EXPECT_NE(cut.message.find("File too large"), std::string::npos) << cut.message;
        stopped += cut.message.find("the session stops") != std::string::npos;
        if (fs::exists(journal_in(at))) {
            EXPECT_EQ(read_journal(journal_in(at)).torn_bytes, 0u);
        }
        expect_nothing_lost(s, at, cut, expected);
    }
    EXPECT_EQ(stopped, 19);
}

TEST(Disk, OfATmpfsThatIsFullLosesNothing)
{
    TemporaryFolder const dir;
    fs::create_directory(dir / "small");
    if (mount("none", (dir / "small").c_str(), "tmpfs", 0, "size=64k") != 0)
        GTEST_SKIP() << "this user cannot mount";
    struct Unmount {
        fs::path at;
        ~Unmount() { umount2(at.c_str(), MNT_DETACH); }
    } const unmount{dir / "small"};
    Script const s = adaptive_script();
    auto const expected = undisturbed(s, dir / "whole");
    gi::write_durably(dir / "small/ballast", std::string(40000, 'x'));
    ChildResult const cut = run_in_child(s, settings_in(dir / "small"), [] {});
    EXPECT_NE(cut.message.find("No space left on device"), std::string::npos) << cut.message;
    EXPECT_GT(cut.kept.size(), 3u);
    fs::remove(dir / "small/ballast");
    expect_nothing_lost(s, dir / "small", cut, expected);
}

TEST(Disk, ThatIsReadOnlyIsSaidBeforeAnybodySitsDown)
{
    TemporaryFolder const dir;
    Script const s = adaptive_script();
    constexpr uid_t kNobody = 65534;
    chmod(dir.path().c_str(), 0555);
    ChildResult const cut = run_in_child(s, settings_in(dir / "data"), [&] {
        if (geteuid() == 0 && setuid(kNobody) != 0) _exit(1); // root may write anywhere
    });
    chmod(dir.path().c_str(), 0755);
    EXPECT_NE(cut.message.find("the folder cannot be made (Permission denied)"), std::string::npos) << cut.message;
    EXPECT_TRUE(fs::is_empty(dir.path()));
}

TEST(Disk, ThatBecameReadOnlyStopsGoingOn)
{
    TemporaryFolder const dir;
    fs::create_directory(dir / "small");
    if (mount("none", (dir / "small").c_str(), "tmpfs", 0, "") != 0) GTEST_SKIP() << "this user cannot mount";
    struct Unmount {
        fs::path at;
        ~Unmount() { umount2(at.c_str(), MNT_DETACH); }
    } const unmount{dir / "small"};
    Script const s = adaptive_script();
    rlimit const limit{6000, RLIM_INFINITY};
    run_in_child(s, settings_in(dir / "small"), [&] {
        std::signal(SIGXFSZ, SIG_IGN);
        setrlimit(RLIMIT_FSIZE, &limit);
    });
    mount("none", (dir / "small").c_str(), "tmpfs", MS_REMOUNT | MS_RDONLY, "");
    std::string const before = file_text(journal_in(dir / "small"));
    ChildResult const cut = run_in_child(s, settings_in(dir / "small", SessionStart::go_on), [] {});
    EXPECT_NE(cut.message.find("Read-only file system"), std::string::npos) << cut.message;
    EXPECT_EQ(file_text(journal_in(dir / "small")), before);
}

/// Bytes that this process has handed to write calls of any kind.
long written_bytes()
{
    std::istringstream io(file_text("/proc/self/io"));
    std::string key;
    long value = 0;
    while (io >> key >> value)
        if (key == "wchar:") return value;
    return -1;
}

TEST(Disk, IsNotWrittenToWhileSomethingIsShown)
{
    TemporaryFolder const dir;
    TestPresenter p;
    Script const s = adaptive_script();
    long between = 0, last = -1;
    p.on_show = [&](TrialRequest const&, TrialDone&) {
        struct stat before {
        }, after{};
        long const start = written_bytes();
        ASSERT_EQ(stat(journal_in(dir.path()).c_str(), &before), 0);
        std::this_thread::sleep_for(std::chrono::milliseconds(5)); // whatever another thread would do
        ASSERT_EQ(stat(journal_in(dir.path()).c_str(), &after), 0);
        EXPECT_EQ(written_bytes(), start);
        EXPECT_EQ(before.st_size, after.st_size);
        EXPECT_EQ(before.st_mtim.tv_nsec, after.st_mtim.tv_nsec);
        // And the entry of the trial before is there in full.
        EXPECT_EQ(read_journal(journal_in(dir.path())).torn_bytes, 0u);
        if (last >= 0) between += start - last;
        last = start;
    };
    run_session(s, 1, p, settings_in(dir.path()));
    EXPECT_GT(p.shown.size(), 20u);
    EXPECT_GT(between, 5000) << "the measure sees what is written between trials";
}

} // namespace
} // namespace study::test
