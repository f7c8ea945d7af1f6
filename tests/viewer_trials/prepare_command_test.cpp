// lightwell study prepare, which needs no window.

#include "tests/viewer/run_program.h"

#include <fmt/format.h>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

std::string script(std::string const& settings, int stimulus_ms)
{
    return fmt::format(R"(schema: study/1
id: x
seed: 1
participants: {{count: 1}}
factors: {{bounces: [0, 1]}}
defaults: {{settings: {{method: slhb, paths: 1, {}}}, stimulus_ms: {}, stimuli: prepared}}
sequence: [b]
blocks:
  b: {{task: rating, prompt: how, scale: {{min: 1, max: 7}}, cross: [bounces]}}
)",
                       settings, stimulus_ms);
}

void write(fs::path const& file, std::string const& text) { std::ofstream(file) << text; }

std::string const kPrepare = "study prepare x.yaml --size 64x48 --font 8 --threads 1 --out ";

TEST(PrepareCommand, MakesDamagedStimuliAnew)
{
    TemporaryFolder const folder;
    write(folder / "x.yaml", script("scene: cornell", 100));
    EXPECT_NE(run_well(kPrepare + "out", folder.path()).out.find("2 rendered"), std::string::npos);
    for (auto const& entry : fs::directory_iterator(folder / "out")) {
        fs::resize_file(entry.path() / "00000_0.exr", 300);
        break;
    }
    EXPECT_NE(run_well(kPrepare + "out", folder.path()).out.find("1 rendered, 1 existed already"),
              std::string::npos);
    EXPECT_NE(run_well(kPrepare + "out", folder.path()).out.find("0 rendered, 2 existed already"),
              std::string::npos);
}

TEST(PrepareCommand, PartsMakeTheWholeAndSoDoTasksOfABatch)
{
    TemporaryFolder const folder;
    write(folder / "x.yaml", script("scene: cornell", 100));
    for (char const* const part : {"1/3", "2/3", "3/3"}) // the third has none
        run_well(kPrepare + "out --part " + part, folder.path());
    EXPECT_NE(run_well(kPrepare + "out", folder.path()).out.find("0 rendered, 2 existed already"),
              std::string::npos);
    for (char const* const part : {"0/3", "4/3", "1", "x/3", "1/"})
        EXPECT_EQ(run(kPrepare + "no --part " + part, folder.path()).code, 2) << part;
    EXPECT_FALSE(fs::exists(folder / "no"));
    write(folder / "b.yaml", "batch: b\nstimuli:\n  s: {script: x.yaml, size: 64x48, font: 8, parts: 3}\n");
    run_well("batch b.yaml", folder.path());
    run_well("batch gather b.batch --out gathered", folder.path());
    EXPECT_NE(run_well(kPrepare + "gathered/s/stimuli", folder.path()).out.find("0 rendered, 2 existed already"),
              std::string::npos);
}

TEST(PrepareCommand, AFileIsNoFolder)
{
    TemporaryFolder const folder;
    write(folder / "x.yaml", script("scene: cornell", 100));
    write(folder / "file", "");
    for (char const* const out : {"file", "file/in"}) {
        Outcome const o = run(kPrepare + out, folder.path());
        EXPECT_EQ(o.code, 2) << o.err;
        EXPECT_NE(o.err.find("the folder cannot be made"), std::string::npos) << o.err;
    }
}

TEST(PrepareCommand, CtrlCLeavesWhatIsComplete)
{
    TemporaryFolder const folder;
    write(folder / "x.yaml", script("scene: cornell, camera: \"path:orbit\"", 600000));
    Program program(words(kPrepare + "out"), folder.path());
    ASSERT_TRUE(program.wait_until_catches(SIGINT, true));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    program.send(SIGINT);
    Outcome const o = program.wait();
    EXPECT_EQ(o.code, 130) << o.err;
    EXPECT_NE(o.err.find("interrupted: complete stimuli are kept"), std::string::npos) << o.err;
    EXPECT_TRUE(fs::is_empty(folder / "out")) << "none was";
}

TEST(PrepareCommand, ScenesLieBesideTheScript)
{
    TemporaryFolder const folder;
    fs::create_directories(folder / "study");
    write(folder / "study/room.yaml", "models: [{generate: {kind: cornell}}]\n");
    write(folder / "study/x.yaml", script("scene: room.yaml", 100));
    std::string const rest = " --size 64x48 --font 8 --threads 1 --out out";
    EXPECT_NE(run_well("study prepare study/x.yaml" + rest, folder.path()).out.find("2 rendered"),
              std::string::npos);
    fs::rename(folder / "study/room.yaml", folder / "room.yaml");
    EXPECT_NE(
        run_well("study prepare study/x.yaml" + rest, folder.path()).out.find("0 rendered, 2 existed already"),
        std::string::npos)
        << "or in the current folder";
    fs::remove(folder / "room.yaml");
    Outcome const o = run("study prepare study/x.yaml" + rest, folder.path());
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("study/x.yaml: block b, "), std::string::npos) << o.err;
    EXPECT_NE(o.err.find("there is no scene 'room.yaml'"), std::string::npos) << o.err;
}

} // namespace
} // namespace viewer::test
