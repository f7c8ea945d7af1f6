// The bias of light by look-ups that a render measures of itself: its interval, that it is the bias of the picture, and what is said of it.

#include "gi/methods/paths/bias_control.h"

#include "gi/core/rng.h"
#include "tests/slhb/slhb_render.h"

namespace gi::test {
namespace {

TEST(BiasControl, IntervalsHoldTheTruthInNineteenOfTwenty)
{
    Pcg32 rng(3, 0);
    constexpr int kTrials = 2000, kPasses = 6;
    int held = 0;
    for (int trial = 0; trial < kTrials; ++trial) {
        BiasControl control;
        for (int k = 0; k < kPasses; ++k) {
            double const n = 100, exact = n * (0.5 + double(rng.uniform()));
            double const wrong = 0.03 * exact + n * 0.2 * (double(rng.uniform()) - 0.5);
            control.add({.looked_up = {exact + wrong, 0}, .exact = {exact, 0}, .paths = 100});
        }
        std::optional<LookUpBias> const bias = control.bias();
        ASSERT_TRUE(bias);
        EXPECT_EQ(bias->paths, 600u);
        EXPECT_EQ(bias->indirect.value, 0) << "no light, none wrong";
        held += std::abs(bias->direct.value - 0.03) <= bias->direct.error ? 1 : 0;
    }
    EXPECT_NEAR(double(held) / kTrials, 0.95, 0.02);
}

TEST(BiasControl, LightWhereThereIsNoneIsInfinitelyWrong)
{
    BiasControl control;
    for (int k = 0; k < 2; ++k) control.add({.looked_up = {1, 0}, .exact = {0, 0}, .paths = 10});
    EXPECT_FALSE(control.bias()) << "two passes";
    control.add({.looked_up = {1, 0}, .exact = {0, 0}, .paths = 10});
    EXPECT_TRUE(std::isinf(control.bias()->direct.value));
    Report report;
    report_bias(control.bias(), report);
    EXPECT_EQ(report.losses().size(), 1u);
}

char const* const kLoss =
    "pictures whose light by look-ups is wrong by more than 1 %: exact are --method paths and reference";

TEST(BiasControl, IsThatOfThePicture)
{
    World const world = world_of(village());
    Camera const camera = look_at({0, 10, 40}, {0, 2, -60}, 60);
    RenderSettings s = small_settings(48, 64, 2);
    SlhbSettings& slhb = s.of<SlhbSettings>();
    slhb.resolution = slhb.shadow_resolution = 256;
    slhb.levels = 1;
    slhb.confirm = Confirming::on;
    SlhbRun const looked_up = render_small(world, camera, s);
    ASSERT_TRUE(looked_up.result.look_up_bias);
    EXPECT_EQ(looked_up.losses.count(kLoss), 1u);
    slhb.exact = {.queries = true, .shadows = true};
    SlhbRun const exact = render_small(world, camera, s);
    LookUpBias const bias = *looked_up.result.look_up_bias;
    auto const differs = [&](char const* layer) {
        return mean_of(looked_up.result.picture, layer).mean / mean_of(exact.result.picture, layer).mean - 1;
    };
    EXPECT_GT(differs("L1"), 0.02);
    EXPECT_NEAR(bias.direct.value, differs("L1"), 1.5 * bias.direct.error + 0.005);
    EXPECT_NEAR(bias.indirect.value, differs("L2"), 1.5 * bias.indirect.error + 0.005);
}

TEST(BiasControl, IsSmallWhereRaysDecide)
{
    World const world = world_of(box_with_block_and_lamp());
    RenderSettings s = small_settings(48, 32, 3);
    s.of<SlhbSettings>().resolution = 128;
    s.of<SlhbSettings>().confirm = Confirming::on;
    SlhbRun const run = render_small(world, look_at({0.8, 0.5, 0.8}, {-0.3, -0.4, -0.3}, 70), s);
    ASSERT_TRUE(run.result.look_up_bias);
    LookUpBias const bias = *run.result.look_up_bias;
    EXPECT_LT(std::abs(bias.direct.value), 0.01 + bias.direct.error);
    EXPECT_LT(std::abs(bias.indirect.value), 0.01 + bias.indirect.error);
    EXPECT_EQ(run.losses.count(kLoss), 0u);
    s.of<SlhbSettings>().confirm = Confirming::off;
    EXPECT_FALSE(render_small(world, look_at({0.8, 0.5, 0.8}, {-0.3, -0.4, -0.3}, 70), s).result.look_up_bias);
}

} // namespace
} // namespace gi::test
