// Paths of a head: those in the program, a file, and files that are none.

#include "viewer/bench/shown/head_path.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "tests/viewer/run_program.h"

#include <algorithm>

namespace viewer::test {
namespace {

TEST(HeadPath, RecordedOnesBeginAtTheFirstCamera)
{
    std::vector<std::string> const names = head_path_names();
    EXPECT_TRUE(std::ranges::find(names, "walk") != names.end());
    for (std::string const& name : names) {
        HeadPath const path(name);
        EXPECT_GT(path.seconds(), 5) << name;
        EXPECT_LT(glm::length(gi::dvec3(path.at(0)[3])), 0.2) << name;
        EXPECT_FALSE(path.moves(path.seconds() + 1)) << name;
    }
}

TEST(HeadPath, OfAFileIsInterpolated)
{
    TemporaryFolder const folder;
    gi::write_text(folder / "p.csv", "time_s,x_m,y_m,z_m,yaw_deg,pitch_deg\n0,0,0,0,0,0\n2,1,0,-3,90,0\n");
    HeadPath const path(folder / "p.csv");
    EXPECT_EQ(path.seconds(), 2);
    EXPECT_TRUE(path.moves(1));
    EXPECT_LT(glm::length(gi::dvec3(path.at(1)[3]) - gi::dvec3(0.5, 0, -1.5)), 1e-12);
    EXPECT_LT(glm::length(gi::dvec3(path.at(9)[2]) - gi::dvec3(1, 0, 0)), 1e-12) << "turned to the left";
}

TEST(HeadPath, RefusesWhatIsNone)
{
    TemporaryFolder const folder;
    auto const refusal = [&](std::string const& text) -> std::string {
        gi::write_text(folder / "p.csv", text);
        try {
            HeadPath const path(folder / "p.csv");
        } catch (gi::InputError const& e) {
            return e.what();
        }
        return "";
    };
    EXPECT_NE(refusal("time_s,x\n0,0,0,0,0,0\n1,1,1\n").find("p.csv:3:"), std::string::npos);
    EXPECT_NE(refusal("time_s,x\n1,0,0,0,0,0\n1,1,0,0,0,0\n").find("not after"), std::string::npos);
    EXPECT_NE(refusal("").find("fewer than two"), std::string::npos);
    EXPECT_THROW(HeadPath("nowhere"), gi::InputError);
}

} // namespace
} // namespace viewer::test
