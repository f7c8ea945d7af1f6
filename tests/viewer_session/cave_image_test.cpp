#include "tests/viewer_session/cave_seams.h"

namespace viewer::test {
namespace {

/// While there is noise yet: on average.
TEST(Cave, WallsAreContinuousAcrossTheirEdges)
{
    auto const seams = cave_seams(48);
    ASSERT_EQ(seams.size(), 5u);
    for (Seam const& s : seams) {
        auto const means = s.means_of(4); // pixels along the edge: less noise, and still far less than an edge
        std::printf("%s: mean difference %.3f / 255, most %.3f, of the whole edge %.3f\n", s.walls.c_str(),
                    mean(means), most(means), s.bias());
        EXPECT_LE(mean(means), 1.0) << s.walls;
        EXPECT_LE(s.bias(), 0.3) << s.walls;
    }
}

} // namespace
} // namespace viewer::test
