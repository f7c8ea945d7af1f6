// Fifty kills at moments of chance, also while a state is being written.

#include "tests/viewer/checkpoint.h"

namespace viewer::test {
namespace {

TEST(CheckpointSlow, FiftyKillsLoseAtMostAnIntervalEach)
{
    std::string const call = "render cornell --size 96x64 --paths 6000 --threads 2";
    TemporaryFolder const undisturbed;
    run_well(call + " --out a.exr --quiet", undisturbed.path(), std::chrono::seconds(600));
    KilledRender const r = render_with_kills(call, "200ms", 50, 0.9, 11);
    EXPECT_EQ(r.kills, 50);
    // An interval, or 50 times what a write takes (30 ms where the disk is busy), and the pass that ends after it.
    EXPECT_LE(r.longest_loss_s, std::max(0.2, 50 * 0.03) + 0.6);
    EXPECT_FALSE(r.has_leftovers);
    EXPECT_TRUE(r.picture == file_text(undisturbed / "a.exr")) << "resumed and undisturbed pictures differ";
    std::printf("%d kills, %d before the first state; longest loss %.2f s\n", r.kills, r.without_state,
                r.longest_loss_s);
}

} // namespace
} // namespace viewer::test
