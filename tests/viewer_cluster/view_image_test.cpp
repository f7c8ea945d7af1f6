// `mpirun -n N lightwell view`, as far as it comes without screens.

#include "tests/viewer_cluster/mpirun.h"

namespace viewer::test {
namespace {

TEST(ViewByRanks, TooFewForTheWindowsAreRefusedOnce)
{
    if (!has_mpirun()) GTEST_SKIP() << "no mpirun here: several machines are not tested";
    TemporaryFolder const folder;
    Mpirun mpirun(2, "",
                  LIGHTWELL_PROGRAM " view cornell --display " LIGHTWELL_SOURCE_DIR "/data/displays/cave4.yaml",
                  folder.path());
    EXPECT_EQ(mpirun.wait(std::chrono::seconds(60)), 2);
    std::string const said = mpirun.text();
    std::string const problem = "windows 'right', 'floor' belong to ranks 2, 3, but there are 2 ranks";
    EXPECT_NE(said.find(problem), std::string::npos) << said;
    EXPECT_EQ(said.find(problem), said.rfind(problem)) << "said once\n" << said;
    EXPECT_NE(said.find("start with mpirun -n 4"), std::string::npos) << said;
}

} // namespace
} // namespace viewer::test
