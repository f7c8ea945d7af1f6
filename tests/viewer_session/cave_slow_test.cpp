#include "tests/viewer_session/cave_seams.h"

#include <cstdlib>

namespace viewer::test {
namespace {

/// Rendered to convergence: every single pixel, though both sides' noise and the line to the edge add up.
TEST(Cave, EveryPixelAlongTheEdgesFitsItsNeighbour)
{
    char const* const asked = std::getenv("LIGHTWELL_CAVE_FRAMES");
    auto const seams = cave_seams(asked ? std::atoi(asked) : 1200);
    ASSERT_EQ(seams.size(), 5u);
    for (Seam const& s : seams) {
        auto const pixels = s.means_of(1);
        std::printf("%s: mean difference %.3f / 255, most %.3f, of the whole edge %.3f\n", s.walls.c_str(),
                    mean(pixels), most(pixels), s.bias());
        EXPECT_LE(most(pixels), 1.0) << s.walls;
    }
}

} // namespace
} // namespace viewer::test
