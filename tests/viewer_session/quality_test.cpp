// Steps of quality, and the settings that they stand for.

#include "viewer/engine/quality.h"

#include "gi/core/error.h"

#include <algorithm>
#include <gtest/gtest.h>

namespace viewer {
namespace {

Settings with(std::string const& quality)
{
    Settings s;
    for (Change const& c : changes_of({kQuality, quality})) set(s, c);
    return s;
}

TEST(Quality, StepsSetTheSameSettingsAndAreFoundByThem)
{
    std::vector<std::string> keys;
    for (std::size_t k = 0; k < quality_names().size(); ++k) {
        std::vector<std::string> of_step;
        for (Change const& c : changes_of({kQuality, quality_names()[k]})) of_step.push_back(c.key);
        if (k == 0) keys = of_step;
        EXPECT_EQ(of_step, keys) << quality_names()[k];
        EXPECT_EQ(quality_of(with(quality_names()[k])), k);
    }
    Settings by_hand = with("fine");
    set(by_hand, {"reuse", 5});
    EXPECT_FALSE(quality_of(by_hand));
}

TEST(Quality, NoStepIsFurtherFromExactThanTheOneBefore)
{
    std::vector<std::string> const caching{"on", "auto", "off"};
    auto const place = [&](Settings const& s) {
        return std::ranges::find(caching, get(s, "radiance_cache").get<std::string>()) - caching.begin();
    };
    for (std::size_t k = 1; k < quality_names().size(); ++k) {
        Settings const a = with(quality_names()[k - 1]), b = with(quality_names()[k]);
        EXPECT_LT(b.rate_hz, a.rate_hz);
        EXPECT_LE(b.reuse, a.reuse);
        EXPECT_GE(place(b), place(a));
        EXPECT_TRUE(b.denoise == a.denoise || b.denoise == "none");
        for (bool Settings::*const saves_time :
             {&Settings::share_eyes, &Settings::first_surfaces, &Settings::draw_surfaces, &Settings::reproject})
            EXPECT_LE(b.*saves_time, a.*saves_time);
    }
}

TEST(Quality, ExactPicturesAreTheMethodsOwn)
{
    Settings const s = with("exact");
    EXPECT_EQ(get(s, "radiance_cache"), "off");
    EXPECT_EQ(s.reuse, 1);
    EXPECT_EQ(s.denoise, "none");
    EXPECT_EQ(s.scale, 1);
    EXPECT_FALSE(s.share_eyes || s.first_surfaces || s.draw_surfaces || s.reproject);
    EXPECT_TRUE(s.refine);
    EXPECT_EQ(s.method, Settings{}.method);
}

TEST(Quality, WindowsBeginBalanced)
{
    Settings s;
    s.draw_surfaces = true;
    ASSERT_TRUE(quality_of(s));
    EXPECT_EQ(quality_names()[*quality_of(s)], "balanced");
}

TEST(Quality, IsGivenLikeASetting)
{
    Settings s;
    for (Change const& c : parse_changes(std::vector<std::string>{"quality=exact", "rate=7", "exposure=1"}))
        set(s, c);
    EXPECT_EQ(s.rate_hz, 7);
    EXPECT_EQ(s.exposure_ev, 1);
    EXPECT_EQ(s.denoise, "none");
    for (nlohmann::json const& wrong : {nlohmann::json("exakt"), nlohmann::json(3), nlohmann::json()}) try {
            changes_of({kQuality, wrong});
            FAIL() << wrong;
        } catch (gi::InputError const& e) {
            EXPECT_NE(e.suggestion().find("exact"), std::string::npos) << e.what();
        }
}

} // namespace
} // namespace viewer
