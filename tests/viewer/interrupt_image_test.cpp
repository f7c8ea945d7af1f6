// Ctrl-C keeps the paths rendered so far; --resume then makes the same file as an uninterrupted render.

#include "tests/viewer/checkpoint.h"

namespace viewer::test {
namespace {

constexpr char const* kLongRender =
    "render cornell --size 48x48 --paths 160 --quiet --threads 2 --checkpoint 1ms --out a.exr";

/// kLongRender without interruption.
std::string const& whole_picture()
{
    static std::string const picture = [] {
        TemporaryFolder const folder;
        run_well(kLongRender, folder.path());
        return file_text(folder / "a.exr");
    }();
    return picture;
}

void interrupt_and_resume(int signal, int code)
{
    TemporaryFolder const folder;
    Program program(words(kLongRender), folder.path());
    ASSERT_TRUE(program.wait_until_catches(signal, true));
    wait_for_state(program, folder / "a.exr.state");
    program.send(signal);
    Outcome const o = program.wait();
    EXPECT_EQ(o.code, code) << o.err;
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.exr", "a.exr.state"}));
    EXPECT_LT(o.err.find("interrupted: saving the state and the color"),
              o.err.find("command with --resume continues"))
        << "what takes its time is said first\n"
        << o.err;
    EXPECT_NE(o.err.find("--resume"), std::string::npos) << o.err;
    Outcome const again = run(kLongRender, folder.path());
    EXPECT_EQ(again.code, 2) << "would destroy what is unfinished";
    EXPECT_NE(again.err.find("--resume"), std::string::npos) << again.err;
    std::string const part = file_text(folder / "a.exr");
    EXPECT_TRUE(part.starts_with("\x76\x2f\x31\x01"));

    run_well(std::string(kLongRender) + " --resume", folder.path());
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.exr"});
    EXPECT_TRUE(file_text(folder / "a.exr") == whole_picture()) << "resumed and undisturbed pictures differ";
}

TEST(Interrupt, ControlC) { interrupt_and_resume(SIGINT, 130); }

TEST(Interrupt, Terminate) { interrupt_and_resume(SIGTERM, 143); }

TEST(Interrupt, ClosedTerminal) { interrupt_and_resume(SIGHUP, 129); }

/// The kernel and the shell both tell of a closed terminal.
TEST(Interrupt, AClosedTerminalMayBeToldTwice)
{
    TemporaryFolder const folder;
    Program program(words(kLongRender), folder.path());
    wait_for_state(program, folder / "a.exr.state");
    program.send(SIGHUP);
    program.send(SIGHUP);
    EXPECT_EQ(program.wait().code, 129);
    EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.exr", "a.exr.state"}));
}

TEST(Interrupt, NohupGoesOn)
{
    TemporaryFolder const folder;
    auto const before = std::signal(SIGHUP, SIG_IGN); // as nohup does
    Program program(words("render cornell --size 32x32 --paths 32 --quiet --out a.exr"), folder.path());
    std::signal(SIGHUP, before);
    ASSERT_TRUE(program.wait_until_catches(SIGINT, true));
    program.send(SIGHUP);
    EXPECT_EQ(program.wait().code, 0);
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.exr"});
}

TEST(Interrupt, ASecondControlCEndsAtOnce)
{
    TemporaryFolder const folder;
    Program program(words("render cornell --size 2048x2048 --paths 64 --out a.exr"), folder.path());
    ASSERT_TRUE(program.wait_until_catches(SIGINT, true));
    program.send(SIGINT);
    ASSERT_TRUE(program.wait_until_catches(SIGINT, false)); // the first has been taken
    program.send(SIGINT);
    EXPECT_EQ(program.wait(std::chrono::seconds(10)).signal, SIGINT);
    EXPECT_TRUE(folder.files().empty()) << testing::PrintToString(folder.files());
}

/// The picture of a complete render is not yet there: its paths are kept, and all of it is made from them. If the signal
/// comes late, it is complete. (tests/viewer/render_picture_test.cpp interrupts at every moment.)
TEST(Interrupt, WhileTheCompletePictureIsWritten)
{
    TemporaryFolder const folder, undisturbed;
    std::string const call = "render cornell --size 400x300 --paths 1 --bounces 0 --quiet --out a.exr";
    Program program(words(call), folder.path());
    while (program.runs() && !std::filesystem::exists(folder / ".a.exr.tmp"))
        std::this_thread::sleep_for(std::chrono::milliseconds(1));
    program.send(SIGINT);
    if (Outcome const o = program.wait(); o.code == 130) {
        EXPECT_EQ(folder.files(), (std::vector<std::string>{"a.exr", "a.exr.state"}));
        EXPECT_LT(file_text(folder / "a.exr").size(), 400u * 300 * 13) << "only color: the state has the rest";
        run_well(call + " --resume", folder.path());
    }
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.exr"});
    run_well(call, undisturbed.path());
    EXPECT_TRUE(file_text(folder / "a.exr") == file_text(undisturbed / "a.exr"));
}

/// Removes the folder of `--out gone/a.exr` while `call` renders. Returns what the program says then.
Outcome render_without_folder(std::string const& call, TemporaryFolder const& folder)
{
    std::filesystem::create_directory(folder / "gone");
    Program program(words(call), folder.path());
    EXPECT_TRUE(program.wait_until_catches(SIGINT, true));
    std::filesystem::remove_all(folder / "gone");
    return program.wait();
}

TEST(Interrupt, PathsOfAPictureThatCannotBeWrittenAreKept)
{
    TemporaryFolder const folder;
    std::string const call = "render cornell --size 48x48 --paths 96 --quiet --out gone/a.exr";
    Outcome const o = render_without_folder(call + " --state a.state", folder);
    EXPECT_EQ(o.code, 2) << o.err;
    EXPECT_NE(o.err.find("all paths are kept in 'a.state'"), std::string::npos) << o.err;
    EXPECT_EQ(folder.files(), std::vector<std::string>{"a.state"});
    std::filesystem::create_directory(folder / "gone");
    run_well(call + " --state a.state --resume", folder.path());
    EXPECT_EQ(folder.files(), std::vector<std::string>{"gone"});
    std::string const resumed = file_text(folder / "gone" / "a.exr");
    run_well(call, folder.path());
    EXPECT_TRUE(resumed == file_text(folder / "gone" / "a.exr")) << "kept and undisturbed pictures differ";
}

TEST(Interrupt, NeitherPictureNorStateCanBeWritten)
{
    TemporaryFolder const folder;
    Outcome const o =
        render_without_folder("render cornell --size 48x48 --paths 96 --quiet --out gone/a.exr", folder);
    EXPECT_EQ(o.code, 2) << o.err;
    EXPECT_NE(o.err.find("checkpoints that could not be written"), std::string::npos) << o.err;
    EXPECT_EQ(o.err.find("are kept"), std::string::npos) << o.err;
    EXPECT_TRUE(folder.files().empty());
}

TEST(Interrupt, DenoisingIsLeftToTheResumedRender)
{
    TemporaryFolder const folder, undisturbed;
    std::string const call = std::string(kLongRender) + " --denoise atrous";
    Program program(words(call), folder.path());
    wait_for_state(program, folder / "a.exr.state");
    program.send(SIGINT);
    Outcome const o = program.wait();
    EXPECT_EQ(o.code, 130) << o.err;
    EXPECT_NE(o.err.find("not denoised"), std::string::npos) << o.err;
    run_well(call + " --resume", folder.path());
    run_well(call, undisturbed.path());
    EXPECT_TRUE(file_text(folder / "a.exr") == file_text(undisturbed / "a.exr"));
}

TEST(Interrupt, AnotherRendersStateIsRefused)
{
    TemporaryFolder const folder;
    Program program(words(kLongRender), folder.path());
    wait_for_state(program, folder / "a.exr.state");
    program.send(SIGINT);
    ASSERT_EQ(program.wait().code, 130);
    std::string const state = file_text(folder / "a.exr.state"), picture = file_text(folder / "a.exr");
    Outcome const o = run(std::string(kLongRender) + " --resume --seed 5", folder.path());
    EXPECT_EQ(o.code, 2);
    EXPECT_NE(o.err.find("belongs to another render"), std::string::npos) << o.err;
    EXPECT_TRUE(file_text(folder / "a.exr.state") == state);
    EXPECT_TRUE(file_text(folder / "a.exr") == picture);
}

} // namespace
} // namespace viewer::test
