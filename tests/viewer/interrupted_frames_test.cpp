// --frames interrupted at every moment at which a stop request is asked for: while the world is built, in a pass, while a
// frame is denoised or written. The frames before it are kept, whole; the one that was interrupted is rendered again.

#include "gi/core/error.h"
#include "gi/image_io/picture_rows.h"
#include "tests/support/stop_at_ask.h"
#include "tests/viewer/run_program.h"
#include "viewer/offline/frame_sequence.h"

#include <set>

namespace viewer::test::interrupted_frames {
namespace {

using gi::test::StopAtAsk;

constexpr char const* kState = "f_0-2.exr.state";

RenderOptions three_frames(TemporaryFolder const& folder, std::string const& size, std::string const& filter)
{
    RenderOptions o;
    o.scene = "cornell";
    o.method = "reference";
    o.size = size;
    o.paths = 2;
    o.settings.bounces = 0;
    o.settings.threads = 1;
    o.denoise = filter;
    o.layers = {"color"};
    o.quiet = true;
    o.frames = "0:3@8";
    o.out = folder / "f_%d.exr";
    return o;
}

FramesEnd render(RenderOptions o, gi::StopRequest& stop)
{
    gi::RenderSettings const settings = make_settings(o);
    Cluster cluster({"test", "frames", 0});
    RankWork work(cluster, stop);
    gi::Report report;
    return render_frames(o, settings, make_denoise_settings(o, settings), camera_choice(o), work, report);
}

/// How often a stop is asked for while nothing interrupts.
std::uint64_t asks_of(std::string const& size, std::string const& filter)
{
    TemporaryFolder const folder;
    StopAtAsk never;
    EXPECT_TRUE(render(three_frames(folder, size, filter), never).complete);
    return never.asks();
}

void expect_to_be_whole(TemporaryFolder const& folder, TemporaryFolder const& undisturbed, int frames)
{
    for (int k = 0; k < frames; ++k) {
        std::string const name = "f_" + std::to_string(k) + ".exr";
        EXPECT_TRUE(file_text(folder / name) == file_text(undisturbed / name)) << name;
    }
}

/// @param tiles  of a picture: each of them asks once or twice more
void interrupt_at_every_ask(std::string const& size, std::string const& filter, std::uint64_t tiles)
{
    TemporaryFolder const undisturbed;
    StopAtAsk never;
    ASSERT_TRUE(render(three_frames(undisturbed, size, filter), never).complete);
    std::vector<std::string> const all{"f_0.exr", "f_1.exr", "f_2.exr"};
    ASSERT_EQ(undisturbed.files(), all);
    std::set<int> complete;
    for (std::uint64_t ask = 1; ask <= never.asks(); ++ask) {
        SCOPED_TRACE("ask " + std::to_string(ask) + " of " + std::to_string(never.asks()));
        TemporaryFolder const folder;
        RenderOptions o = three_frames(folder, size, filter);
        StopAtAsk stop(ask), none;
        FramesEnd const end = render(o, stop);
        std::vector<std::string> const files = folder.files();
        if (end.complete) { // it came after the last row
            EXPECT_EQ(files, all);
            continue;
        }
        EXPECT_LE(stop.asks(), ask + 2 * tiles + gi::test::asks_until_noticed()) << "something was begun after it";
        ASSERT_FALSE(files.empty());
        int const frames = int(files.size()) - 1;
        complete.insert(frames);
        std::vector<std::string> kept{kState};
        kept.insert(kept.end(), all.begin(), all.begin() + std::min(frames, 2));
        ASSERT_EQ(files, kept) << "nothing is half-written";
        ASSERT_FALSE(end.notes.empty());
        EXPECT_NE(end.notes[0].find(std::to_string(frames) + " of 3 frames are complete"), std::string::npos);
        expect_to_be_whole(folder, undisturbed, frames);
        if (ask % 16 == 0) {
            EXPECT_THROW(render(o, none), gi::InputError) << "new frames would replace them";
        }
        o.resume = true;
        EXPECT_TRUE(render(o, none).complete);
        EXPECT_EQ(folder.files(), all);
        expect_to_be_whole(folder, undisturbed, 3);
    }
    EXPECT_EQ(complete, (std::set<int>{0, 1, 2}));
}

TEST(InterruptedFrames, WhileTheyAreDenoisedKeepWhatIsCompleteAndGoOn)
{
    interrupt_at_every_ask("8x4", "atrous", 1);
}

/// Files of three blocks of rows.
TEST(InterruptedFrames, WhileTheyAreWrittenKeepWhatIsCompleteAndGoOn)
{
    constexpr int kRows = 2 * gi::kRowsAtOnce + 1;
    interrupt_at_every_ask("8x" + std::to_string(kRows), "none", (kRows + 15) / 16);
}

/// What takes long asks on its way: passes for each tile, of 16 x 16 pixels, the filter for each row.
TEST(InterruptedFrames, LongWorkAsksOnItsWay)
{
    std::uint64_t const small = asks_of("16x16", "none");
    EXPECT_GE(asks_of("256x16", "none"), small + 3 * 15);
    EXPECT_GE(asks_of("16x16", "atrous"), small + 3 * 16);
}

} // namespace
} // namespace viewer::test::interrupted_frames
