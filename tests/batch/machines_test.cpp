// Batches under mpirun and on HyperQueue (scripts/setup --tests installs its Python package).

#include "tests/batch/fake_programs.h"
#include "tests/batch/processes.h"
#include "tests/viewer_cluster/mpirun.h"

namespace viewer::test {
namespace {

using namespace std::chrono_literals;

void expect_each_once(FakePrograms const& p, std::size_t tasks)
{
    EXPECT_EQ(p.starts().size(), tasks);
    for (auto const& [task, n] : p.starts()) EXPECT_EQ(n, 1) << task;
}

TEST(BatchUnderMpirun, RanksShareTheTasks)
{
    if (!has_mpirun()) GTEST_SKIP() << "no mpirun";
    FakePrograms const p;
    p.sweep(20, 0.05, "ranks");
    Mpirun run(3, "", (p / "bin/lightwell-batch").string() + " batch m.yaml --cores 2", p.folder());
    EXPECT_EQ(run.wait(), 0) << run.text();
    EXPECT_NE(run.text().find("20 of 20 tasks done"), std::string::npos) << run.text();
    expect_each_once(p, 20);
    EXPECT_EQ(p.run("batch gather m.batch --out r").code, 0);
    EXPECT_EQ(file_text(p / "r/s/out-7.txt"), "none\n") << "a task is no rank";
}

TEST(BatchUnderMpirun, KilledRankCostsNothing)
{
    if (!has_mpirun()) GTEST_SKIP() << "no mpirun";
    FakePrograms const p;
    p.sweep(20, 0.2);
    Mpirun run(2, recovery_option(), (p / "bin/lightwell-batch").string() + " batch m.yaml --cores 2",
               p.folder());
    ASSERT_TRUE(wait_until([&] { return !(p.starts().size() < 3); }));
    for (int const rank : processes_with(p.folder(), {"lightwell-batch", "m.yaml", "--cores"}))
        if (file_text(fmt::format("/proc/{}/environ", rank)).find("OMPI_COMM_WORLD_RANK=1") != std::string::npos)
            kill(rank, SIGKILL);
    run.wait();
    EXPECT_NE(run.text().find("20 of 20 tasks done"), std::string::npos) << run.text();
    expect_each_once(p, 20);
}

TEST(BatchOnHyperQueue, RunsAndResumes)
{
    if (!has_hyperqueue()) GTEST_SKIP() << "scripts/setup --tests installs HyperQueue";
    FakePrograms const p;
    p.sweep(32, 0.05, "", "    cores: 1\n");
    p.write("f.yaml",
            file_text(p / "m.yaml") + "  f: {command: 'render {n} 0 wrong', over: {n: [99]}, outputs: x}\n");
    Outcome const o = p.run("batch m.yaml --on hyperqueue --hq-workers 1,2 --json");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(json_of(o)["done"], 32);
    expect_each_once(p, 32); // several by each process
    Outcome const more = p.run("batch f.yaml --store m.batch --on hyperqueue --hq-workers 2 --json");
    EXPECT_EQ(more.code, 1) << more.err;
    EXPECT_EQ(json_of(more)["done_before"], 32);
    ASSERT_EQ(json_of(more)["failures"].size(), 1u) << more.out;
    EXPECT_EQ(json_of(more)["failures"][0]["why"], "exit code 2");
}

TEST(BatchOnHyperQueue, KilledServerIsStartedAgain)
{
    if (!has_hyperqueue()) GTEST_SKIP() << "scripts/setup --tests installs HyperQueue";
    FakePrograms const p;
    p.sweep(16, 0.2);
    Program program(words("batch m.yaml --on hyperqueue --hq-workers 2 --json"), p.folder());
    ASSERT_TRUE(wait_until([&] { return !(p.starts().size() < 4); }));
    auto const servers = processes_with(p.folder(), {"python", "call.json"});
    ASSERT_EQ(servers.size(), 1u);
    kill(servers[0], SIGKILL);
    Outcome const o = program.wait();
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(json_of(o)["lost_workers"], 1);
    int repeated = 0;
    for (auto const& [task, n] : p.starts()) repeated += n - 1;
    EXPECT_EQ(p.starts().size(), 16u);
    EXPECT_LE(repeated, 2) << "the tasks that ran on its two cores";
}

TEST(BatchOnHyperQueue, ServerThatRunsIsUsedAndKeepsItsTasks)
{
    if (!has_hyperqueue()) GTEST_SKIP() << "scripts/setup --tests installs HyperQueue";
    FakePrograms const p;
    p.sweep(6, 0.3);
    p.write("server.py",
            "import sys, time\nfrom hyperqueue import LocalCluster\nfrom hyperqueue.cluster import WorkerConfig\n"
            "c = LocalCluster(sys.argv[1], WorkerConfig(cores=2))\nopen('ready', 'w')\ntime.sleep(60)\n");
    std::filesystem::create_directory(p / "server");
    pid_t const server = fork();
    if (server == 0) {
        if (chdir(p.folder().c_str()) != 0) _exit(1);
        execlp(std::getenv("LIGHTWELL_PYTHON"), std::getenv("LIGHTWELL_PYTHON"), "server.py",
               (p / "server").c_str(), nullptr);
        _exit(1);
    }
    ASSERT_TRUE(wait_until([&] { return !(!std::filesystem::exists(p / "ready")); }));
    std::string const options = " --on hyperqueue --hq-server-dir " + (p / "server").string();
    Program program(words("batch m.yaml" + options), p.folder());
    ASSERT_TRUE(wait_until([&] { return !(p.starts().size() < 2); }));
    program.send(SIGINT);
    EXPECT_EQ(program.wait().code, 130);
    ASSERT_TRUE(wait_until([&] { return !(p.starts().size() < 6); })); // its tasks continue
    EXPECT_EQ(p.run("batch resume m.batch" + options).code, 0);
    expect_each_once(p, 6);
    kill(server, SIGKILL);
    waitpid(server, nullptr, 0);
    p.sweep(8, 0);
    Outcome const lost = p.run("batch m.yaml" + options);
    EXPECT_EQ(lost.code, 2);
    EXPECT_NE(lost.err.find("the server of HyperQueue was lost"), std::string::npos) << lost.err;
}

TEST(BatchOnHyperQueue, MissingPackageIsTold)
{
    FakePrograms const p;
    p.sweep(1, 0);
    p.write("python", "#!/bin/sh\nexec python3 -S -E \"$@\"\n");
    std::filesystem::permissions(p / "python", std::filesystem::perms::owner_all);
    setenv("LIGHTWELL_PYTHON", (p / "python").c_str(), 1);
    Outcome const o = p.run("batch m.yaml --on hyperqueue");
    unsetenv("LIGHTWELL_PYTHON");
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("has no package hyperqueue"), std::string::npos) << o.err;
}

} // namespace
} // namespace viewer::test
