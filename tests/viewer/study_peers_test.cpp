// Analyses of experiments beside those of psignifit, questplus, choix, statsmodels and scipy (from PyPI,
// by scripts/setup --tests), from the same tables.

#include "tests/viewer/run_program.h"

#include <cstdlib>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

TEST(StudyPeers, HaveTheSameNumbers)
{
    fs::path const source = LIGHTWELL_SOURCE_DIR, python = source / "build/python/bin/python";
    fs::path const data = source.parent_path() / "shared/data";
    if (!fs::exists(source / "build/python/statistics"))
        GTEST_SKIP() << "SKIPPED: the peers are not installed (scripts/setup --tests installs them from PyPI)";
    if (!fs::exists(data / "study") || !fs::exists(data / "perceptual"))
        GTEST_SKIP() << "SKIPPED: no reference data at " << data;
    TemporaryFolder const folder;
    std::string const command = "'" + python.string() + "' '" + (source / "tests/viewer/study_peers.py").string() +
                                "' '" LIGHTWELL_PROGRAM "' '" + data.string() + "' '" + folder.path().string() +
                                "' > '" + (folder / "out.txt").string() + "' 2>&1";
    int const status = std::system(command.c_str());
    EXPECT_EQ(status, 0) << file_text(folder / "out.txt");
    std::fputs(file_text(folder / "out.txt").c_str(), stdout);
}

} // namespace
} // namespace viewer::test
