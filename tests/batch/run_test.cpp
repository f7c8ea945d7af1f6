// Batches as they run: real processes, a script as the program of their tasks.

#include "tests/batch/fake_programs.h"
#include "tests/support/refused_calls.h"
#include "viewer/batch/child.h"
#include "viewer/batch/store.h"

#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;
using namespace std::chrono_literals;

std::string tree_text(fs::path const& folder)
{
    std::map<std::string, std::string> files;
    for (auto const& entry : fs::recursive_directory_iterator(folder))
        if (entry.is_regular_file())
            files[entry.path().lexically_relative(folder).string()] = file_text(entry.path());
    std::string all;
    for (auto const& [name, text] : files) all += name + "\n" + text;
    return all;
}

/// pid, name, state, parent, ...; empty = there is no such process
std::vector<std::string> words_of_stat(int process)
{
    return words(file_text(fmt::format("/proc/{}/stat", process)));
}

bool is_ended(int process)
{
    auto const stat = words_of_stat(process);
    return stat.empty() || stat.at(2) == "Z";
}

TEST(BatchRun, RunsAllTasksOnceAndGathersAndJoinsThem)
{
    FakePrograms const p;
    p.write("m.yaml", "batch: m\nsweeps:\n  s:\n    command: render {n} 0\n    over: {n: 1..6}\n"
                      "    outputs: [\"out-{n}.txt\", \"table-{n}.csv\"]\n    stdout: \"said-{n}.json\"\n"
                      "    merge: [all.csv, all.jsonl]\n");
    Outcome const first = p.run("batch m.yaml --cores 3");
    EXPECT_EQ(first.code, 0) << first.err;
    EXPECT_NE(first.out.find("6 of 6 tasks done"), std::string::npos) << first.out;
    Outcome const again = p.run("batch m.yaml --json");
    EXPECT_EQ(json_of(again)["done_before"], 6);
    EXPECT_EQ(p.starts(), (std::map<int, int>{{1, 1}, {2, 1}, {3, 1}, {4, 1}, {5, 1}, {6, 1}}));
    EXPECT_EQ(p.run("batch gather m.batch --out r").code, 0);
    EXPECT_EQ(file_text(p / "r/s/said-3.json"), "{\"n\": 3}\n");
    EXPECT_TRUE(file_text(p / "r/s/all.csv").starts_with("n,frame,value\n1,1,1\n1,1,2\n2,2,1\n"));
    EXPECT_TRUE(file_text(p / "r/s/all.jsonl").starts_with("{\"n\":\"1\",\"result_n\":1}\n"));
    EXPECT_TRUE(fs::is_empty(p / "m.batch/work")) << "folders of tasks are removed";
}

TEST(BatchRun, AnotherManifestFindsWhatIsDoneInTheStore)
{
    FakePrograms const p;
    p.sweep(3, 0);
    EXPECT_EQ(p.run("batch m.yaml --store s").code, 0);
    p.sweep(5, 0, "", "    cores: 2\n");
    EXPECT_EQ(json_of(p.run("batch plan m.yaml --store s --json"))["done"], 3);
    EXPECT_EQ(json_of(p.run("batch m.yaml --store s --json"))["done_before"], 3);
    EXPECT_EQ(p.starts().size(), 5u);
    for (auto const& [task, n] : p.starts()) EXPECT_EQ(n, 1) << task;
    EXPECT_EQ(json_of(p.run("batch status s --json"))["batches"].size(), 2u);
}

TEST(BatchRun, FailureIsRepeatedAndItsReasonRecorded)
{
    FakePrograms const p;
    struct Case {
        std::string word, how, why;
        int starts;
    };
    for (Case const& c : std::vector<Case>{
             {"fail", "    retries: 2\n", "exit code 1", 3},
             {"wrong", "    retries: 2\n", "exit code 2", 1},
             {"segv", "    retries: 1\n", "SIGSEGV (Segmentation fault)", 2},
             {"nothing", "    retries: 2\n", "it made no 'out-1.txt'", 1},
             {"hang", "    retries: 0\n    limit: 0.2s\n", "longer than 0.2 s", 1},
             {"eat", "    retries: 0\n    memory: 100MB\n", "more than 100 MB of memory", 1},
         }) {
        p.write("starts", "");
        p.sweep(1, 0, c.word, c.how);
        Outcome const o = p.run("batch m.yaml --json");
        EXPECT_EQ(o.code, 1) << c.word;
        nlohmann::json const j = json_of(o);
        ASSERT_EQ(j["failures"].size(), 1u) << c.word;
        EXPECT_EQ(j["failures"][0]["why"], c.why);
        EXPECT_EQ(j["failures"][0]["attempts"], c.starts) << c.word;
        EXPECT_EQ(p.starts().at(1), c.starts) << c.word;
        EXPECT_NE(o.err.find("failed: s n=1 (task 0, attempt "), std::string::npos) << o.err;
        if (c.word == "fail") {
            EXPECT_NE(o.err.find("it said: it cannot"), std::string::npos) << o.err;
        }
    }
    p.write("starts", "");
    p.sweep(1, 0, "fail_once");
    EXPECT_EQ(p.run("batch m.yaml").code, 0);
    EXPECT_EQ(p.starts().at(1), 2);
}

TEST(BatchRun, TaskSeesItsInputsAndNothingElse)
{
    FakePrograms const p;
    p.write("data/in.txt", "input");
    p.sweep(1, 0, "links", "    inputs: data\n");
    EXPECT_EQ(p.run("batch m.yaml").code, 0);
    EXPECT_EQ(p.run("batch gather m.batch --out r").code, 0);
    EXPECT_EQ(file_text(p / "r/s/out-1.txt"), "input");
    p.sweep(1, 0, "links", "    retries: 0\n");
    EXPECT_EQ(p.run("batch m.yaml --store t").code, 1) << "data is not among its inputs";
}

TEST(BatchRun, ChangedInputIsToldInsteadOfUsed)
{
    FakePrograms const p;
    p.write("data/in.txt", "input");
    p.sweep(1, 0, "links", "    inputs: data\n    retries: 0\n");
    p.write("bin/keep", "");
    fs::rename(p / "bin/lightwell", p / "bin/kept"); // the task cannot start yet
    EXPECT_EQ(p.run("batch m.yaml").code, 1);
    fs::rename(p / "bin/kept", p / "bin/lightwell");
    p.write("data/in.txt", "other");
    Outcome const o = p.run("batch resume m.batch");
    EXPECT_EQ(o.code, 1);
    EXPECT_NE(o.err.find("has changed since the batch was planned"), std::string::npos) << o.err;
    EXPECT_EQ(p.run("batch m.yaml").code, 0) << "a new plan has the new content";
}

TEST(BatchRun, TasksGetTheirCores)
{
    FakePrograms const p;
    p.sweep(2, 0, "cores", "    cores: 1\n");
    EXPECT_EQ(p.run("batch m.yaml").code, 0);
    EXPECT_EQ(p.run("batch gather m.batch --out r").code, 0);
    EXPECT_EQ(file_text(p / "r/s/out-1.txt"), "1\n");
    p.sweep(1, 0, "", "    gpus: 64\n");
    Outcome const o = p.run("batch m.yaml");
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("it needs 64 GPUs"), std::string::npos) << o.err;
}

TEST(BatchRun, LossesThatTasksReportAreTold)
{
    FakePrograms const p;
    p.sweep(1, 0, "lost");
    Outcome const o = p.run("batch m.yaml");
    EXPECT_EQ(o.code, 0);
    EXPECT_NE(o.err.find("1 tasks report losses"), std::string::npos) << o.err;
    EXPECT_NE(p.run("batch status m.batch --messages").out.find("lost: triangles: 3"), std::string::npos);
}

TEST(BatchRun, OnlyTheEndOfWhatATaskSaysIsKept)
{
    FakePrograms const p;
    p.sweep(1, 0, "talk");
    EXPECT_EQ(p.run("batch m.yaml").code, 0);
    std::string const told = p.run("batch status m.batch --messages").out;
    EXPECT_NE(told.find("..."), std::string::npos);
    EXPECT_NE(told.find("100000"), std::string::npos) << told;
    EXPECT_LT(told.size(), 8000u);
}

TEST(BatchRun, InterruptEndsSoonAndKeepsWhatIsFinished)
{
    FakePrograms const p;
    p.sweep(6, 0.3, "", "");
    p.write("h.yaml", file_text(p / "m.yaml") + "  h:\n    command: render {n} 0 hang\n    over: {n: 100..101}\n"
                                                "    outputs: [\"out-{n}.txt\"]\n");
    Program program(words("batch h.yaml --cores 4"), p.folder());
    ASSERT_TRUE(wait_until([&] { return !(p.starts().size() < 8); }));
    std::this_thread::sleep_for(400ms); // the short ones are done
    auto const before = std::chrono::steady_clock::now();
    program.send(SIGINT);
    Outcome const o = program.wait();
    std::chrono::duration<double> const took = std::chrono::steady_clock::now() - before;
    EXPECT_EQ(o.code, 130);
    EXPECT_LT(took.count(), 0.5);
    EXPECT_NE(o.out.find("6 of 8 tasks done"), std::string::npos) << o.out;
    nlohmann::json const j = json_of(p.run("batch status h.batch --json"))["batches"][0];
    EXPECT_EQ(j["waiting"], 2);
    EXPECT_EQ(j["running"], 0);
}

TEST(BatchRun, KilledWorkerCostsOneTaskAndKilledRunnerNone)
{
    FakePrograms const p;
    p.sweep(6, 1.5); // seconds: the first task is still running below
    Program program(words("batch m.yaml --cores 2 --json"), p.folder());
    ASSERT_TRUE(wait_until([&] { return !(p.starts().size() < 2); }));
    std::istringstream first(file_text(p / "starts"));
    int task = 0, script = 0;
    first >> task >> script;
    int const worker = std::stoi(words_of_stat(script).at(3));
    kill(worker, SIGKILL);
    ASSERT_TRUE(wait_until([&] { return !(p.starts().size() < 3); }));
    EXPECT_TRUE(wait_until([&] { return is_ended(script); })) << "a task ends with its worker";
    program.send(SIGKILL);
    program.wait();
    Outcome const o = p.run("batch resume m.batch --json");
    EXPECT_EQ(o.code, 0) << o.err;
    int repeated = 0;
    for (auto const& [n, times] : p.starts()) repeated += times - 1;
    EXPECT_EQ(p.starts().size(), 6u);
    EXPECT_EQ(repeated, 1) << "that of the killed worker; those of the killed runner go on";
    EXPECT_EQ(json_of(o)["repeated_attempts"], 1);
}

TEST(BatchRun, OutputsAreTheSameWithOneTwoAndSixTasksAtATime)
{
    FakePrograms const p;
    p.sweep(12, 0);
    std::set<std::string> results;
    for (int const cores : {1, 2, 6}) {
        EXPECT_EQ(p.run(fmt::format("batch m.yaml --store s{} --cores {}", cores, cores)).code, 0);
        EXPECT_EQ(p.run(fmt::format("batch gather s{} --out r{}", cores, cores)).code, 0);
        results.insert(tree_text(p / fmt::format("r{}", cores)));
    }
    EXPECT_EQ(results.size(), 1u);
}

TEST(BatchRun, TwoRunnersShareAStore)
{
    FakePrograms const p;
    p.sweep(12, 0.05);
    Program one(words("batch m.yaml --cores 2"), p.folder());
    Program two(words("batch m.yaml --cores 2"), p.folder());
    EXPECT_EQ(one.wait().code, 0);
    EXPECT_EQ(two.wait().code, 0);
    EXPECT_EQ(p.starts().size(), 12u);
    for (auto const& [task, n] : p.starts()) EXPECT_EQ(n, 1) << task;
}

TEST(BatchRun, WrongCallsAreToldInOneLine)
{
    FakePrograms const p;
    p.sweep(1, 0);
    for (auto const& [call, part] :
         std::vector<std::pair<std::string, std::string>>{{"batch", "no manifest"},
                                                          {"batch none.yaml", "there is no such file"},
                                                          {"batch m.yaml --store bin", "it holds other files"},
                                                          {"batch status bin", "is no store of a batch"},
                                                          {"batch m.yaml --on slurm", "--on"},
                                                          {"batch render atrium", "render without --frames"}}) {
        Outcome const o = p.run(call);
        EXPECT_EQ(o.code, 2) << call;
        EXPECT_NE(o.err.find(part), std::string::npos) << call << "\n" << o.err;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
    }
}

/// tests/data/old/7d477989/store is that of an earlier version, whose task is done.
TEST(BatchRun, StoreOfAnEarlierVersionIsShownAndGathered)
{
    FakePrograms const p;
    fs::copy(fs::path(LIGHTWELL_SOURCE_DIR) / "tests/data/old/7d477989/store", p / "s",
             fs::copy_options::recursive);
    auto const status = json_of(p.run("batch status s --json"));
    EXPECT_EQ(status["batches"].size(), 1u) << status;
    Outcome const o = p.run("batch gather s --out r");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(fs::file_size(p / "r/s/r-1.exr"), 5620u);
    Outcome const resumed = p.run("batch resume s");
    EXPECT_EQ(resumed.code, 2);
    EXPECT_NE(resumed.err.find("planned by another version of the program (it was lightwell 0.1.0 (git 7d477989)"),
              std::string::npos)
        << resumed.err;
    EXPECT_NE(resumed.err.find("use that one, or call lightwell batch with the manifest again"),
              std::string::npos);
    EXPECT_TRUE(p.starts().empty());
}

TEST(BatchRun, StoreOfAnotherFormatIsRefusedWithTheWayOut)
{
    FakePrograms const p;
    batch::Store::open_or_make(p / "s");
    p.write("s/format", "batch-store/2\n");
    Outcome const o = p.run("batch status s");
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("is a store of another version (its format is 'batch-store/2') use the version that made "
                         "it, or another store"),
              std::string::npos)
        << o.err;
}

TEST(BatchRun, PlanOfAnotherVersionIsRefused)
{
    FakePrograms const p;
    batch::Batch b;
    b.name = "old";
    b.program = "lightwell 0.0.1";
    b.tasks.emplace_back().outputs = {"x"};
    batch::give_keys(b);
    batch::Store::open_or_make(p / "s").keep(b);
    Outcome const o = p.run("batch resume s");
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("planned by another version of the program"), std::string::npos) << o.err;
}

TEST(BatchRun, OneFolderThatCannotBeMadeDoesNotKeepTheOthersOfItsProcessFromRunning)
{
    FakePrograms const p;
    p.sweep(3, 0);
    ASSERT_EQ(p.run("batch plan m.yaml").code, 0);
    EXPECT_EQ(p.run("batch m.yaml").code, 0);
    batch::Store const store = batch::Store::open(p / "m.batch");
    std::string const id = store.batches().front();
    auto const tasks = store.batch(id).tasks;
    fs::remove_all(p / "m.batch/results");
    p.write("m.batch/work/" + tasks[0].key, "a file");
    Outcome const o = p.run("batch work m.batch " + id + " 0 1 2");
    EXPECT_EQ(o.code, 1);
    EXPECT_NE(o.err.find("cannot make the folder of a task"), std::string::npos) << o.err;
    EXPECT_FALSE(store.result(tasks[0].key));
    EXPECT_TRUE(wait_until([&] { return store.result(tasks[1].key) && store.result(tasks[2].key); }));
}

TEST(BatchRun, FailedPublicationIsToldAndNotMadeUpForInSecret)
{
    FakePrograms const p;
    p.sweep(1, 0);
    EXPECT_EQ(p.run("batch m.yaml").code, 0);
    batch::Store const store = batch::Store::open(p / "m.batch");
    std::string const key = store.batch(store.batches().front()).tasks[0].key;
    fs::path const results = p / "m.batch/results" / key.substr(0, 2);
    fs::remove_all(results);
    fs::remove_all(p / "m.batch/objects");
    p.write("m.batch/results/" + key.substr(0, 2), "a file");
    Outcome const o = p.run("batch m.yaml");
    EXPECT_EQ(o.code, 1);
    EXPECT_NE(o.out.find("0 of 1 tasks done, 1 failed"), std::string::npos) << o.out << o.err;
    EXPECT_NE(o.err.find("failed: s n=1"), std::string::npos) << o.err;
    EXPECT_TRUE(fs::is_empty(p / "m.batch/work"));
    fs::remove(results);
    EXPECT_EQ(p.run("batch resume m.batch").code, 0);
    EXPECT_EQ(p.starts().at(1), 3);
}

TEST(BatchRun, ProgramThatIsMissingLeavesNothingOpen)
{
    TemporaryFolder const folder;
    auto const open = [] {
        auto const all = fs::directory_iterator("/proc/self/fd");
        return std::distance(begin(all), end(all));
    };
    auto const before = open();
    batch::ChildCall const call{
        .program = folder / "none", .arguments = {}, .folder = folder.path(), .standard_output = "/dev/null"};
    gi::StopRequest const stop;
    for (int i = 0; i < 3; ++i) EXPECT_THROW(batch::run_child(call, stop), gi::InputError);
    EXPECT_EQ(open(), before);
}

/// On a kernel before 5.3, or where a container forbids it.
TEST(BatchRun, TaskWhoseEndCannotBeWaitedForIsEndedAtOnce)
{
    TemporaryFolder const folder;
    int const code = gi::test::in_child_without({SYS_pidfd_open}, ENOSYS, [&] {
        alarm(20);
        batch::ChildCall const call{.program = "/bin/sleep",
                                    .arguments = {"100"},
                                    .folder = folder.path(),
                                    .standard_output = "/dev/null"};
        try {
            batch::run_child(call, gi::StopRequest());
        } catch (gi::InputError const&) {
            return ::waitpid(-1, nullptr, 0) < 0 && errno == ECHILD ? 7 : 6;
        }
        return 1;
    });
    if (code == gi::test::kNotPermitted) GTEST_SKIP() << "seccomp is not permitted";
    EXPECT_EQ(code, 7);
}

} // namespace
} // namespace viewer::test
