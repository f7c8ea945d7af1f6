// Manifests: the tasks that they give, and the reports of their mistakes.

#include "viewer/batch/manifest.h"

#include "tests/viewer/run_program.h"
#include "viewer/batch/former_command.h"
#include "viewer/batch/from_command.h"

namespace viewer::batch {
namespace {

namespace fs = std::filesystem;
using test::TemporaryFolder;

std::vector<std::string> const kCommands{"render", "study", "bench"};

struct ManifestTest : testing::Test {
    Batch read(std::string const& text)
    {
        ReadManifest r = read_manifest("schema: batch/2\n" + text, (folder / "m.yaml").string(), kCommands);
        for (gi::InputError const& e : r.mistakes.in_order()) ADD_FAILURE() << e.what();
        r.batch.program = "p";
        give_keys(r.batch);
        return r.batch;
    }
    std::vector<std::string> mistakes(std::string const& text)
    {
        std::vector<std::string> out;
        for (gi::InputError const& e : read_manifest(text, "m.yaml", kCommands).mistakes.in_order())
            out.push_back(e.what());
        return out;
    }
    void write(std::string const& name, std::string const& text) { std::ofstream(folder / name) << text; }

    TemporaryFolder folder;
};

TEST_F(ManifestTest, ThatOfTheThesisHasATaskForEachTableAndModel)
{
    std::ifstream in(fs::path(LIGHTWELL_SOURCE_DIR) / "data/batch/thesis.yaml");
    std::string const text{std::istreambuf_iterator<char>(in), {}};
    ReadManifest const r = read_manifest(text, "thesis.yaml", kCommands);
    EXPECT_TRUE(r.mistakes.in_order().empty());
    EXPECT_EQ(r.batch.tasks.size(), 9u + 1 + 6 + 3 + 6);
}

/// Without a schema, or of batch/1: for version 0.1.
TEST_F(ManifestTest, OfVersion01NameMethodsAsThatDid)
{
    using Words = std::vector<std::string>;
    EXPECT_EQ(current_command({"render", "a", "--method", "slhb"}), (Words{"render", "a", "--method", "slhb_0_1"}));
    EXPECT_EQ(current_command({"render", "a", "--method=lpv"}), (Words{"render", "a", "--method=lpv"}));
    EXPECT_EQ(current_command({"render", "a"}), (Words{"render", "a", "--method", "reference"}));
    EXPECT_EQ(current_command({"bench", "sweep", "--methods", "slhb:stored,reference,slhb,vpl_slhb"}),
              (Words{"bench", "sweep", "--methods", "slhb_0_1:stored,reference,slhb_0_1,vpl_slhb"}));
    EXPECT_EQ(current_command({"bench", "pictures", "--out", "a"}),
              (Words{"bench", "pictures", "--out", "a", "--methods", "reference,slhb_0_1,vpl_slhb"}));
    EXPECT_EQ(current_command({"bench", "pictures", "--interactive"}).back(), "reference,slhb_0_1");
    EXPECT_EQ(current_command({"bench", "pictures", "--methods", "lpv"}).back(), "lpv");
    EXPECT_EQ(current_command({"view", "--replay", "a.lwr", "--set", "method=slhb"}).back(), "method=slhb_0_1");
    std::string const rest = "batch: b\nsweeps:\n  s:\n    command: render cornell --out {p}.exr --seed {p}\n    over: {p: 1}\n"
                             "    outputs: '{p}.exr'\n";
    auto const last = [&](std::string const& schema) {
        return read_manifest(schema + rest, "m.yaml", kCommands).batch.tasks.at(0).command.back();
    };
    EXPECT_EQ(last(""), "reference");
    EXPECT_EQ(last("schema: batch/1\n"), "reference");
    EXPECT_EQ(last("schema: batch/2\n"), "1");
    EXPECT_EQ(mistakes("schema: batch/3\n" + rest).size(), 1u);
}

TEST_F(ManifestTest, SweepIsTheProductOfItsParameters)
{
    Batch const b =
        read("batch: b\nsweeps:\n  s:\n    command: render {scene} --paths {paths} --out {scene}-{paths}.exr\n"
             "    over: {scene: [a, b], paths: [1, 4, 16]}\n    outputs: [\"{scene}-{paths}.exr\"]\n");
    ASSERT_EQ(b.tasks.size(), 6u);
    EXPECT_EQ(b.tasks[1].command, (std::vector<std::string>{"render", "a", "--paths", "4", "--out", "a-4.exr"}));
    EXPECT_EQ(b.tasks[3].parameters, (std::vector<Parameter>{{"scene", "b"}, {"paths", "1"}}));
    EXPECT_EQ(b.tasks[5].outputs, std::vector<std::string>{"b-16.exr"});
}

TEST_F(ManifestTest, SweepCanZipItsParametersAndCountRanges)
{
    Batch const b =
        read("batch: b\nsweeps:\n  s:\n    command: [render, \"{a} {{x}}\", \"{b}\"]\n    combine: zip\n"
             "    over: {a: 1..3, b: [x, y, z]}\n    outputs: [\"{a}.exr\"]\n");
    ASSERT_EQ(b.tasks.size(), 3u);
    EXPECT_EQ(b.tasks[2].command, (std::vector<std::string>{"render", "3 {x}", "z"}));
}

TEST_F(ManifestTest, SequenceIsSplitAfterSoManyFrames)
{
    Batch const b =
        read("batch: b\nretries: 3\nsequences:\n  w:\n    command: render a --frames {frames} --out f_%03d.exr\n"
             "    frames: 2:7@30000/1001\n    frames_per_task: 2\n    outputs: [f_%03d.exr]\n    cores: all\n"
             "    memory: 2GiB\n    limit: 3min\n");
    ASSERT_EQ(b.tasks.size(), 3u);
    EXPECT_EQ(b.tasks[0].command[3], "2:4@30000/1001");
    EXPECT_EQ(b.tasks[2].command[3], "6:7@30000/1001");
    EXPECT_EQ(b.tasks[1].outputs, (std::vector<std::string>{"f_004.exr", "f_005.exr"}));
    EXPECT_EQ(b.tasks[0].resources, (Resources{Resources::kAllCores, 0, std::uint64_t(2) << 30}));
    EXPECT_EQ(b.tasks[0].retries, 3);
    EXPECT_EQ(b.tasks[0].limit_s, 180);
}

TEST_F(ManifestTest, StudiesAndStimuliAreTasksOfTheirCommands)
{
    write("s.yaml", "x");
    Batch const b = read("batch: b\nsimulated:\n  power: {script: s.yaml, seeds: 1..3, participants: 1..4}\n"
                         "stimuli:\n  faces: {script: s.yaml, size: 640x480, parts: 2}\n");
    ASSERT_EQ(b.tasks.size(), 5u);
    EXPECT_EQ(b.tasks[0].command, test::words("study prepare s.yaml --size 640x480 --out stimuli --part 1/2"));
    EXPECT_EQ(b.tasks[4].command, test::words("study simulate s.yaml --participants 1..4 --seed 3 --out seed-3"));
    EXPECT_EQ(b.tasks[4].outputs, std::vector<std::string>{"seed-3/"});
    EXPECT_EQ(b.files.size(), 1u);
}

TEST_F(ManifestTest, KeyDependsOnCommandInputsOutputsAndProgramAndOnNothingElse)
{
    write("in.txt", "one");
    auto const text = [](std::string const& how) {
        return "batch: b\nsweeps:\n  s:\n    command: render {n}\n    over: {n: [1]}\n    inputs: in.txt\n"
               "    outputs: [a]\n" +
               how;
    };
    Batch b = read(text(""));
    std::string const key = b.tasks[0].key;
    EXPECT_EQ(read(text("    cores: 4\n    retries: 7\n")).tasks[0].key, key);
    b.program = "other";
    EXPECT_NE(key_of(b.tasks[0], b), key);
    b.program = "p";
    b.tasks[0].outputs = {"b"};
    EXPECT_NE(key_of(b.tasks[0], b), key);
    write("in.txt", "two");
    EXPECT_NE(read(text("")).tasks[0].key, key);
    write("in.txt", "one");
    EXPECT_EQ(read(text("")).tasks[0].key, key);
}

TEST_F(ManifestTest, FolderIsAllFilesInIt)
{
    std::filesystem::create_directories(folder / "data/deep");
    write("data/a", "1");
    write("data/deep/b", "2");
    Batch const b =
        read("batch: b\nsweeps:\n  s:\n    command: render {n}\n    over: {n: [1]}\n    inputs: [data]\n"
             "    outputs: [a]\n");
    ASSERT_EQ(b.files.size(), 2u);
    EXPECT_EQ(b.files[0].name, "data/a");
    EXPECT_EQ(b.files[1].name, "data/deep/b");
}

TEST_F(ManifestTest, AllMistakesAreToldAtOnceWithTheirPlaces)
{
    auto const m = mistakes("batch: b\nretris: 1\nsweeps:\n  s:\n    command: rendr {n}\n    over: {n: [1]}\n"
                            "    outputs: [a]\n  t:\n    command: render {m} --x {k}\n    over: {m: [1]}\n"
                            "    outputs: [../a]\n    memory: 4\n");
    ASSERT_EQ(m.size(), 4u) << testing::PrintToString(m);
    EXPECT_EQ(m[0], "m.yaml:2:1: unknown key 'retris' in manifest (it would be ignored) did you mean 'retries'?");
    EXPECT_TRUE(m[1].starts_with("m.yaml:5:14: there is no command 'rendr'")) << m[1];
    EXPECT_TRUE(m[1].ends_with("did you mean 'render'?")) << m[1];
    EXPECT_TRUE(m[2].starts_with("m.yaml:9:14: there is no parameter 'k'")) << m[2];
    EXPECT_TRUE(m[3].starts_with("m.yaml:12:13: '4' is no amount of memory")) << m[3];
}

TEST_F(ManifestTest, EachMistakeSaysWhatToDo)
{
    std::string const head = "batch: b\nsweeps:\n  s:\n    over: {n: [1, 2]}\n";
    struct Case {
        std::string text, part;
    };
    for (Case const& c : std::vector<Case>{
             {head + "    command: render {n}\n    outputs: [a]\n", "two tasks have the output 'a'"},
             {head + "    command: render {n} | tee\n    outputs: [\"{n}\"]\n", "no shell reads it"},
             {head + "    command: render {n}\n    outputs: [\"/{n}\"]\n", "cannot be an output"},
             {head + "    command: render {n}\n    outputs: [\"../{n}\"]\n", "cannot be an output"},
             {head + "    command: render {n\n    outputs: [\"{n}\"]\n", "'{' without '}'"},
             {head + "    command: render {n}\n    outputs: [\"{n}\"]\n    inputs: none.glb\n",
              "there is no input"},
             {head + "    command: render {n}\n    outputs: [\"{n}\"]\n    merge: a.exr\n", "cannot be merged"},
             {head + "    command: render {n}\n", "outputs"},
             {"batch: b\n", "the batch has no tasks"},
             {"batch: b\nsequences:\n  s: {command: render a, frames: '0:2@24', outputs: f_%d.exr}\n",
              "does not use {frames}"},
             {"batch: b\nsequences:\n  s: {command: 'render {frames}', frames: '0-2', outputs: f_%d.exr}\n",
              "--frames '0-2' is not understood"},
             {"batch: b\nsweeps:\n  s: {command: 'render {a}', over: {a: 1..999999, b: 1..999}, outputs: f}\n",
              "tasks (at most 1000000 are possible)"},
             {"batch: b\nsweeps:\n  s: {command: 'render {a}', combine: zip, over: {a: 1..3, b: 1..2}, outputs: "
              "f}\n",
              "'a' has 3 values, 'b' has 2"},
             {"- 1\n", "not a map"}}) {
        auto const m = mistakes(c.text);
        ASSERT_FALSE(m.empty()) << c.text;
        EXPECT_NE(m[0].find(c.part), std::string::npos) << c.text << m[0];
        EXPECT_TRUE(m[0].starts_with("m.yaml:")) << m[0];
    }
}

TEST(BatchFromCommand, RenderIsSplitAndItsFilesAreInputs)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "s.glb") << "scene";
    std::string const scene = std::filesystem::canonical(folder / "s.glb").string();
    Batch const b = batch_of_render(
        test::words("render " + scene + " --frames 0:5@24 --out pictures/f_%02d.exr --png=g_%d.png"), 3);
    ASSERT_EQ(b.tasks.size(), 2u);
    EXPECT_EQ(b.tasks[1].command,
              test::words("render " + scene + " --frames 3:5@24 --out f_%02d.exr --png=g_%d.png"));
    EXPECT_EQ(b.tasks[1].outputs, (std::vector<std::string>{"f_03.exr", "f_04.exr", "g_3.png", "g_4.png"}));
    ASSERT_EQ(b.files.size(), 1u);
    EXPECT_EQ(b.files[0].name, scene);
    for (char const* const bad :
         {"render a --out f_%d.exr", "render a --frames 0:2@24", "render a --frames 0:2@24 --reuse 4",
          "render a --frames 0:2@24 --out f_%d.exr --video v.mkv"})
        EXPECT_THROW(batch_of_render(test::words(bad), 1), gi::InputError) << bad;
}

TEST(BatchFromCommand, BenchIsSplitByItsScenes)
{
    Batch const b = batch_of_bench(test::words("bench sweep --scene cornell,atrium --budgets 20ms --out x"));
    ASSERT_EQ(b.tasks.size(), 2u);
    EXPECT_EQ(b.tasks[1].command, test::words("bench sweep --scene atrium --budgets 20ms --out atrium"));
    EXPECT_EQ(b.tasks[1].resources.cores, Resources::kAllCores);
    EXPECT_THROW(batch_of_bench(test::words("bench rays --out x")), gi::InputError);
    EXPECT_EQ(batch_of_bench(test::words("bench sweep --scene cornell -o x")).tasks[0].command,
              test::words("bench sweep --scene cornell --out cornell"));
}

/// A folder that is called like the command is no input.
TEST(BatchFromCommand, NamesOfCommandsAreNoFiles)
{
    TemporaryFolder const folder;
    fs::create_directory(folder / "sweep");
    fs::path const before = fs::current_path();
    fs::current_path(folder.path());
    Batch const b = batch_of_bench(test::words("bench sweep --scene cornell --out x"));
    fs::current_path(before);
    EXPECT_TRUE(b.files.empty());
    EXPECT_EQ(b.tasks[0].command[1], "sweep");
}

} // namespace
} // namespace viewer::batch
