// Pictures of a head that stands still fade in by steps, and are then exact; others are shown at once.

#include "tests/viewer_gl/surfaceless.h"
#include "viewer/app/presenter.h"

#include <algorithm>

namespace viewer::test {
namespace {

constexpr glm::ivec2 kSize{32, 24};

class StillFadeTest : public Surfaceless {
protected:
    void SetUp() override
    {
        Surfaceless::SetUp();
        if (IsSkipped()) return;
        window_.emplace(TextureTarget::Format::bytes, kSize);
        presenter_.emplace(std::vector<WallSettings>{});
        settings_.fades = true;
    }
    void TearDown() override
    {
        presenter_.reset();
        window_.reset();
        Surfaceless::TearDown();
    }

    /// @param radiance  of all pixels; the right eye, if there is one, has 1 less that  @param eye_x  of the camera, m
    /// @return the red byte in the middle of the left side
    int show(std::uint64_t number, int still_frames, float radiance, double eye_x = 0)
    {
        auto frame = std::make_shared<LiveFrame>();
        ViewCommand view{"window", {}, kSize.x, kSize.y, -1};
        view.camera.yfov_rad = 1;
        view.camera.world_from_camera[3].x = eye_x;
        frame->command.views.assign(std::size_t(std::max(0, panes_[0].right) + 1), view);
        frame->command.frame = number;
        frame->result.still_frames = still_frames;
        gi::Picture picture{kSize.x, kSize.y, {}, {}};
        for (float& c : picture.add("color", 3).data) c = radiance;
        for (float& d : picture.add("depth", 1).data) d = 2;
        frame->result.views.push_back({picture, {}, {}, {}});
        if (frame->command.views.size() > 1) {
            for (float& c : picture.layers[0].data) c = 1 - radiance;
            frame->result.views.push_back({picture, {}, {}, {}});
            frame->command.views[1].camera.world_from_camera[3].x += 0.06;
        }
        presenter_->take(frame, panes_);
        cameras_.clear();
        for (ViewCommand const& v : frame->command.views) cameras_.push_back(v.camera);
        return again();
    }

    int again()
    {
        presenter_->draw(window_->target(), {0, 0}, panes_, settings_, cameras_);
        return read_bytes(window_->target())[3 * std::size_t(kSize.x * kSize.y / 2)];
    }

    std::vector<Pane> panes_{{{0, 0}, kSize, StereoMode::off, 0, -1}};
    std::optional<TextureTarget> window_;
    std::optional<Presenter> presenter_;
    PresentSettings settings_;
    std::vector<gi::Camera> cameras_;
};

TEST_F(StillFadeTest, PicturesThatRefineFadeIn)
{
    EXPECT_EQ(show(1, 1, 0), 0); // the first is there at once
    EXPECT_FALSE(presenter_->fades());
    int last = show(2, 2, 1);
    for (int step = 2; step <= StillFade::kSteps / 2; ++step) {
        EXPECT_TRUE(presenter_->fades()) << step;
        EXPECT_GT(last, 0);
        int const next = again();
        EXPECT_NEAR(next - last, 2 * 255.0 / StillFade::kSteps, 1.5) << step;
        last = next;
    }
    EXPECT_EQ(last, 255);
    EXPECT_FALSE(presenter_->fades());
}

TEST_F(StillFadeTest, WhatMovedBeforeIsShownAtOnce)
{
    show(1, 1, 0);
    EXPECT_EQ(show(2, 1, 1), 255);
    EXPECT_FALSE(presenter_->fades());
}

TEST_F(StillFadeTest, ANewPictureGoesOnFromWhatIsShown)
{
    show(1, 1, 0);
    show(2, 2, 1);
    int const last = again(), next = show(3, 3, 0);
    EXPECT_GT(last, 0);
    EXPECT_LE(next, last);
    EXPECT_NEAR(next, last, 3 * 255.0 / StillFade::kSteps);
}

TEST_F(StillFadeTest, APaneThatShowsSomethingElseForgetsItsFade)
{
    show(1, 1, 0);
    show(2, 2, 1);
    EXPECT_TRUE(presenter_->fades());
    settings_.fades = false;
    EXPECT_EQ(again(), 255);
    EXPECT_FALSE(presenter_->fades());
}

TEST_F(StillFadeTest, WhatIsTheMeanOfManyPicturesTakesFewerSteps)
{
    show(1, StillFade::kSteps / 4 - 1, 0);
    show(2, StillFade::kSteps / 4, 1);
    again();
    again();
    EXPECT_EQ(again(), 255);
}

TEST_F(StillFadeTest, OtherViewsAndExposuresAreShownAtOnce)
{
    show(1, 1, 0);
    EXPECT_EQ(show(2, 2, 1, 0.5), 255);
    EXPECT_GT(show(3, 2, 0, 0.5), 0);
    EXPECT_TRUE(presenter_->fades());
    settings_.tone.exposure_ev = 1;
    EXPECT_EQ(again(), 0);
    EXPECT_FALSE(presenter_->fades());
}

TEST_F(StillFadeTest, BothEyesFadeInForStereo)
{
    panes_[0].right = 1;
    std::size_t const middle = 3 * std::size_t(kSize.x * kSize.y / 2);
    struct Mode {
        StereoMode stereo;
        std::size_t right; ///< a byte that shows the right eye alone
    };
    for (bool const swapped : {false, true})
        for (auto const [stereo, right] : {Mode{StereoMode::side_by_side, middle + 3 * std::size_t(kSize.x - 1)},
                                           Mode{StereoMode::anaglyph_red_cyan, middle + 1}}) {
            panes_[0].stereo = stereo;
            settings_.swap_eyes = swapped;
            int const first = show(1, 1, 0), sign = swapped ? -1 : 1;
            EXPECT_EQ(first, swapped ? 255 : 0);
            int last = show(2, 2, 1);
            for (int step = 2; step <= StillFade::kSteps / 2; ++step) {
                EXPECT_TRUE(presenter_->fades()) << step;
                int const next = again();
                EXPECT_NEAR(sign * (next - last), 2 * 255.0 / StillFade::kSteps, 1.5) << step;
                EXPECT_NEAR(read_bytes(window_->target())[right], 255 - next, 1) << step;
                last = next;
            }
            EXPECT_EQ(last, 255 - first);
            EXPECT_FALSE(presenter_->fades());
            show(3, 1, 0.5f); // something moved: at once
            EXPECT_FALSE(presenter_->fades());
        }
}

TEST_F(StillFadeTest, AMomentOfRanksThatIsDrawnAgainIsNoStep)
{
    show(1, 1, 0);
    settings_.moment_number = 7;
    int const first = show(2, 2, 1);
    EXPECT_EQ(again(), first);
    settings_.moment_number = 8;
    EXPECT_GT(again(), first);
}

TEST_F(StillFadeTest, WallsFadeInBeforeTheyAreBent)
{
    presenter_.emplace(std::vector<WallSettings>(1));
    panes_[0].wall = panes_[0].of_wall = 0;
    EXPECT_EQ(show(1, 1, 0), 0);
    EXPECT_NEAR(show(2, 2, 1), 2 * 255.0 / StillFade::kSteps, 1.5);
    EXPECT_TRUE(presenter_->fades());
    panes_[0].stereo = StereoMode::side_by_side; // both eyes have the one view
    show(3, 1, 0);
    show(4, 2, 1);
    std::vector<unsigned char> const row = read_bytes(window_->target());
    EXPECT_NEAR(row[0], 2 * 255.0 / StillFade::kSteps, 1.5);
    EXPECT_EQ(row[0], row[3 * std::size_t(kSize.x - 1)]);
}

TEST_F(StillFadeTest, WithoutFadesPicturesAreThereAtOnce)
{
    settings_.fades = false;
    show(1, 1, 0);
    EXPECT_EQ(show(2, 2, 1), 255);
}

} // namespace
} // namespace viewer::test
