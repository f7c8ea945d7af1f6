// A still picture is interrupted at any ask for a stop, and goes on bit for bit.

#include "viewer/offline/render_picture.h"

#include "gi/core/error.h"
#include "gi/methods/registry.h"
#include "gi/scene/load/load.h"
#include "gi/scene/model/world.h"
#include "tests/support/stop_at_ask.h"
#include "tests/viewer/run_program.h"

namespace viewer::test {
namespace {

class StillPictureTest : public testing::Test {
protected:
    StillEnd render(bool resume, gi::StopRequest const& stop)
    {
        StillPicture still{settings};
        still.settings.resume = resume;
        still.filter.denoiser = gi::Denoiser::atrous;
        still.trace = [&](gi::RenderSettings const& s, gi::StopRequest const& by, gi::Report& r) {
            return gi::find_method("reference").render(world, world.cameras[0], s, by, {}, r);
        };
        still.write = [&](gi::PictureRows const& rows, PictureParts what, gi::RenderResult const&) {
            parts.push_back(what);
            if (fails) throw gi::InputError("the disk is full", "", "");
            picture = rows.whole(what == PictureParts::complete ? &stop : nullptr);
        };
        gi::Report report;
        return render_picture(std::move(still), stop, report);
    }
    bool has_state() const { return std::filesystem::exists(settings.checkpoint); }

    TemporaryFolder const folder;
    gi::Report loading;
    gi::World const world = gi::build_world(std::make_shared<gi::Scene const>(gi::load_scene("cornell", loading)),
                                            std::nullopt, loading);
    gi::RenderSettings settings{
        .width = 24, .height = 16, .paths = 6, .bounces = 2, .checkpoint = folder / "a.state"};
    bool fails = false;
    std::vector<PictureParts> parts;
    gi::Picture picture;
};

TEST_F(StillPictureTest, GoesOnAfterAStopAtAnyAsk)
{
    gi::test::StopAtAsk never(gi::test::StopAtAsk::kNoAsk, {});
    EXPECT_EQ(render(false, never).result.end, gi::RenderEnd::paths);
    gi::Picture const whole = picture;
    EXPECT_FALSE(has_state());
    std::uint64_t const asks = never.asks();
    int interrupted = 0;
    for (std::uint64_t ask = 1; ask < asks; ask += 1 + asks / 12) {
        gi::test::StopAtAsk stop(ask, {});
        parts.clear();
        StillEnd const left = render(false, stop);
        if (left.result.end == gi::RenderEnd::interrupted) {
            ++interrupted;
            EXPECT_TRUE(left.result.resumable && has_state()) << ask;
            EXPECT_EQ(parts.back(), PictureParts::color_so_far) << ask;
            EXPECT_TRUE(picture.find("color") != nullptr && picture.find("L1") == nullptr) << ask;
            EXPECT_THROW(check_state(settings, "resume"), gi::InputError);
            EXPECT_EQ(render(true, never).result.end, gi::RenderEnd::paths);
        }
        EXPECT_FALSE(has_state()) << ask;
        ASSERT_EQ(picture.layers.size(), whole.layers.size()) << ask;
        for (std::size_t k = 0; k < whole.layers.size(); ++k)
            EXPECT_TRUE(picture.layers[k].data == whole.layers[k].data)
                << whole.layers[k].name << " after " << ask;
    }
    EXPECT_GT(interrupted, 5);
}

TEST_F(StillPictureTest, PathsAreKeptOfAPictureThatCannotBeWritten)
{
    gi::StopRequest const never;
    fails = true;
    StillEnd const end = render(false, never);
    EXPECT_THROW(std::rethrow_exception(end.failure), gi::InputError);
    EXPECT_TRUE(end.result.resumable && has_state());
    fails = false;
    EXPECT_EQ(render(true, never).result.paths, settings.paths);
    EXPECT_FALSE(has_state());
}

TEST_F(StillPictureTest, WithoutAStateAllLayersAreWritten)
{
    settings.checkpoint.clear();
    gi::test::StopAtAsk stop(20, {});
    StillEnd const end = render(false, stop);
    EXPECT_EQ(end.result.end, gi::RenderEnd::interrupted);
    EXPECT_FALSE(end.result.resumable);
    EXPECT_EQ(parts, std::vector{PictureParts::all_so_far});
    EXPECT_NE(picture.find("L1"), nullptr);
}

TEST_F(StillPictureTest, SaysIfThereIsNoStateToResume)
{
    EXPECT_TRUE(check_state(settings, "resume"));
    settings.resume = true;
    EXPECT_FALSE(check_state(settings, "resume"));
}

} // namespace
} // namespace viewer::test
