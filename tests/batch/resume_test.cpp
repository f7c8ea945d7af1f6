// Files left by interrupted attempts, and how the next attempts continue from them.

#include "tests/batch/fake_programs.h"
#include "viewer/batch/resume.h"

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

std::vector<std::string> resumable(std::string const& command, std::vector<std::string> const& outputs = {})
{
    batch::Task task;
    task.command = words(command);
    task.outputs = outputs;
    return batch::resumable_files(task);
}

TEST(BatchResume, OnlyExactStatesAreGoneOnFrom)
{
    using Files = std::vector<std::string>;
    EXPECT_EQ(resumable("render a --out a.exr"), Files{"a.exr.state"});
    EXPECT_EQ(resumable("render a --png a.png -o b.exr"), Files{"b.exr.state"});
    EXPECT_EQ(resumable("render a --png a.png"), Files{"a.png.state"});
    EXPECT_EQ(resumable("render a --out=a.exr --state=s --method slhb"), Files{"s"});
    Files const frames{"f_0.exr", "f_1.exr"};
    EXPECT_EQ(resumable("render a --frames 0:2@8 --out f_%d.exr --method lpv", frames), frames);
    for (char const* const other :
         {"render a --out a.exr --resume", "render a --out a.exr --budget 2s", "render a --out a.exr --shutter 1",
          "render a --out a.exr --method lpv", "render a --out a.exr --method slhb --radiance-cache on",
          "render a --frames 0:2@8 --reuse 4 --out f_%d.exr", "render a --frames 0:2@8 --png f_%d.png",
          "render a --frames 0:2@8 --out f_%d.exr --stats s",
          "render a --frames 0:2@8 --out f_%d.exr --half --png f_%d.png", "render a --out a.exr --state /s",
          "render a --out b/../../a.exr", "bench sweep --out a", ""})
        EXPECT_EQ(resumable(other, frames), Files{}) << other;
}

/// `render N --out out-N.txt`: writes its calls down, and does with its state what $HOW says.
constexpr char const* kCutScript = R"(#!/bin/sh
echo "$2 $*" >> "$STARTS"
case "$*" in
  *--resume)
    if [ -e extra ]; then exit 2; fi
    case "$HOW" in
      damaged) exit 2 ;;
      cut) kill -KILL $$ ;;
      *) cat out-$2.txt.state > out-$2.txt; echo "resumed" >> out-$2.txt ;;
    esac ;;
  *)
    if [ "$HOW" = damaged ] && [ -e "$DAMAGED" ]; then echo "anew" > out-$2.txt; exit 0; fi
    touch "$DAMAGED" extra
    echo "half" > out-$2.txt.state
    case "$HOW" in
      sleep) trap 'exit 143' TERM; sleep 100 & wait ;;
      *) kill -KILL $$ ;;
    esac ;;
esac
)";

struct ResumeTest : testing::Test {
    ResumeTest()
    {
        p.write("bin/lightwell", kCutScript);
        p.write("m.yaml", "batch: m\nsweeps:\n  s:\n    command: render {n} --out out-{n}.txt\n"
                          "    over: {n: [7]}\n    outputs: \"out-{n}.txt\"\n    retries: 1\n");
        setenv("DAMAGED", (p / "damaged").c_str(), 1);
    }
    std::string output() const
    {
        EXPECT_EQ(p.run("batch gather m.batch --out r --replace").code, 0);
        return file_text(p / "r/s/out-7.txt");
    }
    FakePrograms p;
};

TEST_F(ResumeTest, KilledTaskGoesOnFromItsState)
{
    setenv("HOW", "kill", 1);
    Outcome const o = p.run("batch m.yaml --json");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(output(), "half\nresumed\n");
    EXPECT_EQ(p.starts().at(7), 2);
    EXPECT_TRUE(fs::is_empty(p / "m.batch/work"));
}

TEST_F(ResumeTest, WhatIsOfNoUseIsLeftOutAndCostsNoRetry)
{
    setenv("HOW", "damaged", 1);
    Outcome const o = p.run("batch m.yaml --json");
    EXPECT_EQ(o.code, 0) << o.err;
    EXPECT_EQ(output(), "anew\n");
    EXPECT_NE(p.run("batch status m.batch --messages").out.find("begun anew"), std::string::npos);
    EXPECT_EQ(p.starts().at(7), 3);
}

TEST_F(ResumeTest, TaskThatWasCutTooOftenGoesOnWhenTheBatchIsResumed)
{
    setenv("HOW", "cut", 1);
    EXPECT_NE(p.run("batch m.yaml --json").code, 0);
    EXPECT_EQ(p.starts().at(7), 2);
    setenv("HOW", "kill", 1);
    EXPECT_EQ(p.run("batch resume m.batch").code, 0);
    EXPECT_EQ(output(), "half\nresumed\n");
    EXPECT_TRUE(fs::is_empty(p / "m.batch/work"));
}

TEST_F(ResumeTest, InterruptedBatchKeepsStates)
{
    setenv("HOW", "sleep", 1);
    Program program(words("batch m.yaml"), p.folder());
    ASSERT_TRUE(wait_until([&] { return fs::exists(p / "damaged"); }));
    std::this_thread::sleep_for(std::chrono::milliseconds(100));
    program.send(SIGINT);
    EXPECT_EQ(program.wait().code, 130);
    EXPECT_EQ(p.run("batch resume m.batch").code, 0);
    EXPECT_EQ(output(), "half\nresumed\n");
    EXPECT_TRUE(fs::is_empty(p / "m.batch/work"));
}

} // namespace
} // namespace viewer::test
