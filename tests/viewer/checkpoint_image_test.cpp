// A killed render continues from its last state to the same picture as an uninterrupted one.

#include "tests/viewer/checkpoint.h"

namespace viewer::test {
namespace {

void expect_the_same_picture(std::string const& call, int kills, double most_seconds)
{
    TemporaryFolder const undisturbed;
    run_well(call + " --out a.exr --quiet", undisturbed.path());
    KilledRender const r = render_with_kills(call, "1ms", kills, most_seconds, 3);
    EXPECT_TRUE(r.picture == file_text(undisturbed / "a.exr")) << "resumed and undisturbed pictures differ";
    EXPECT_FALSE(r.has_leftovers);
}

TEST(Checkpoint, AKilledRenderGoesOn)
{
    expect_the_same_picture("render cornell --size 48x48 --paths 300 --threads 2", 3, 0.1);
}

TEST(Checkpoint, SoDoesOneByLookUps)
{
    expect_the_same_picture("render cornell --method slhb --size 32x32 --paths 200 --threads 2", 2, 0.1);
}

TEST(Checkpoint, ItsFileAndSizeAreToldBefore)
{
    TemporaryFolder const folder;
    Outcome const o =
        run_well("render cornell --size 32x32 --paths 100 --quiet --checkpoint 1ms --out a.exr", folder.path());
    EXPECT_NE(o.err.find("a.exr.state"), std::string::npos) << o.err;
    EXPECT_NE(o.err.find("bytes"), std::string::npos) << o.err;
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.exr"});
}

TEST(Checkpoint, ItsFileCanBeNamed)
{
    TemporaryFolder const folder;
    std::string const call =
        "render cornell --size 64x64 --paths 100000 --quiet --checkpoint 1ms --state x.state --png a.png";
    Program program(words(call), folder.path());
    wait_for_state(program, folder / "x.state");
    program.send(SIGINT);
    EXPECT_EQ(program.wait().code, 130);
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.png", "x.state"}));
    EXPECT_EQ(run(call, folder.path()).code, 2) << "would destroy what is unfinished";
}

/// The kernel and the shell both tell it.
TEST(Checkpoint, OneTerminalThatClosesMayTellItOftenWhileItIsSaved)
{
    TemporaryFolder const folder;
    Program program(words("render cornell --size 160x120 --paths 100000 --quiet --checkpoint 1ms --out a.exr"),
                    folder.path());
    wait_for_state(program, folder / "a.exr.state");
    while (program.runs()) {
        program.send(SIGHUP);
        std::this_thread::sleep_for(std::chrono::milliseconds(2));
    }
    program.wait();
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.exr", "a.exr.state"}));
}

TEST(Checkpoint, OffLeavesItToInterruptions)
{
    TemporaryFolder const folder;
    Program program(words("render cornell --size 16x16 --paths 10000000 --quiet --checkpoint off --out a.exr"),
                    folder.path());
    ASSERT_TRUE(program.wait_until_catches(SIGINT, true));
    std::this_thread::sleep_for(std::chrono::milliseconds(300));
    EXPECT_TRUE(folder.files().empty());
    program.send(SIGINT);
    EXPECT_EQ(program.wait().code, 130);
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.exr", "a.exr.state"}));
}

} // namespace
} // namespace viewer::test
