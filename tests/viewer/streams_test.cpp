// Standard output that cannot be written is one clear message and exit code 2; files are complete all the same.

#include "tests/viewer/run_program.h"

namespace viewer::test {
namespace {

/// Exit code and standard error of a shell's command line, in which lightwell is $L.
std::pair<int, std::string> shell(std::string const& command, std::filesystem::path const& folder)
{
    std::ofstream(folder / "script") << "L='" << program_path() << "'\nset -o pipefail\n{ " << command
                                     << "; } 2>err\n";
    int const status = std::system(("cd '" + folder.string() + "' && bash ./script").c_str());
    std::filesystem::remove(folder / "script");
    std::string const errors = file_text(folder / "err");
    std::filesystem::remove(folder / "err");
    return {WEXITSTATUS(status), errors};
}

TEST(Streams, ClosedFullAndBrokenOutputsAreTold)
{
    for (std::string const arguments : {"", " --json"})
        for (std::string const end : {" >&-", " >/dev/full", " | true"}) {
            TemporaryFolder const folder;
            auto const [code, errors] =
                shell("\"$L\" render cornell --size 16x16 --paths 1 --quiet --out a.exr" + arguments + end,
                      folder.path());
            EXPECT_EQ(code, 2) << end << errors;
            EXPECT_NE(errors.find("standard output cannot be written"), std::string::npos) << end << errors;
            EXPECT_EQ(errors.find("internal error"), std::string::npos) << errors;
            EXPECT_EQ(folder.files(), std::vector<std::string>{"a.exr"});
            EXPECT_EQ(run("compare a.exr a.exr", folder.path()).code, 0) << "the picture is damaged";
        }
}

/// A file that is opened gets the lowest free number, which may be that of a closed stream.
TEST(Streams, MessagesNeverEndUpInFiles)
{
    TemporaryFolder const folder;
    auto const call = "\"$L\" render cornell --size 16x16 --paths 1 --quiet --out a.exr --stats s.json";
    EXPECT_EQ(shell(std::string(call) + " <&- >&- 2>&-", folder.path()).first, 2);
    EXPECT_EQ(run("compare a.exr a.exr", folder.path()).code, 0) << "the picture is damaged";
    EXPECT_TRUE(file_text(folder / "s.json").starts_with("{"));
    EXPECT_TRUE(file_text(folder / "s.json").ends_with("}\n"));
}

TEST(Streams, MoreThreadsThanThereAreAreTold)
{
    TemporaryFolder const folder;
    Outcome const o =
        run_well("render cornell --size 16x16 --paths 1 --quiet --threads 999 --out a.exr", folder.path());
    EXPECT_TRUE(o.err.starts_with("note: --threads 999: ")) << o.err;
    EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << o.err;
}

} // namespace
} // namespace viewer::test
