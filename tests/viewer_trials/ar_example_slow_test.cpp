// The shipped experiment with an AR session, from nothing.

#include "tests/viewer/run_program.h"

namespace viewer::test {
namespace {

/// The shipped one runs from what the project makes.
TEST(ArExample, NeedsOnlyWhatItsHeadSays)
{
    TemporaryFolder const folder;
    run_well("ar synthesize desk --frames 1 --size 64x48 --paths 1", folder.path());
    run_well("study example ar_paths --out ar_paths.yaml", folder.path());
    Outcome const early = run("study check ar_paths.yaml", folder.path());
    EXPECT_EQ(early.code, 2) << "the desk has too few frames";
    EXPECT_NE(early.err.find("there is no frame 11"), std::string::npos) << early.err;
    run_well("ar synthesize desk12 --frames 12 --size 64x48 --paths 2", folder.path());
    std::filesystem::remove_all(folder / "desk");
    std::filesystem::rename(folder / "desk12", folder / "desk");
    run_well("study check ar_paths.yaml", folder.path());
    run_well("study simulate ar_paths.yaml --participants 1 --out simulated", folder.path());
    Outcome const made = run("study prepare ar_paths.yaml --size 320x180 --out prepared", folder.path());
    ASSERT_EQ(made.code, 0) << made.err;
    EXPECT_NE(made.out.find("12 stimuli, 12 rendered"), std::string::npos) << made.out;
}

} // namespace
} // namespace viewer::test
