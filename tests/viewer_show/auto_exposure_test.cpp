#include "viewer/app/auto_exposure.h"

#include <gtest/gtest.h>

namespace viewer::test {
namespace {

std::vector<ViewPicture> grey_views(float left, float right)
{
    std::vector<ViewPicture> views(2);
    for (std::size_t k = 0; k < 2; ++k) {
        views[k].picture.width = views[k].picture.height = 20;
        views[k].picture.add("color", 3).data.assign(1200, k == 0 ? left : right);
    }
    return views;
}

TEST(AutoExposure, PutsTheMeanInTheMiddle)
{
    EXPECT_NEAR(*metered_exposure_ev(grey_views(0.18f, 0.18f)), 0, 1e-6);
    EXPECT_NEAR(*metered_exposure_ev(grey_views(0.09f, 0.36f)), 0, 1e-6) << "of both eyes";
    EXPECT_NEAR(*metered_exposure_ev(grey_views(0.0018f, 0.0018f)), std::log2(100.0), 1e-6);
    EXPECT_EQ(*metered_exposure_ev(grey_views(1e8f, 1e8f)), -16);
    EXPECT_FALSE(metered_exposure_ev(grey_views(0, 0)));
    std::vector<float> lamp(1200, 0.18f);
    std::fill_n(lamp.begin(), 100, 1e6f);
    auto views = grey_views(0.18f, 0.18f);
    views[0].picture = {};
    views[0].picture.width = views[0].picture.height = 20;
    views[0].picture.add("color", 3).data = lamp;
    EXPECT_NEAR(*metered_exposure_ev(views), 0, 0.05) << "a lamp does not count";
}

TEST(AutoExposure, AdaptsWithinASecondAndRests)
{
    AutoExposure e;
    double ev = *e.see(grey_views(0.18f, 0.18f), 3, 0);
    EXPECT_NEAR(ev, 0, 1e-6) << "the first frame at once";
    auto const dark = grey_views(0.18f / 16, 0.18f / 16);
    ev = *e.see(dark, ev, 0.05);
    EXPECT_GT(ev, 0.1);
    EXPECT_LT(ev, 1) << "then step by step";
    int changes = 0;
    for (int i = 2; i < 80; ++i)
        if (auto const now = e.see(dark, ev, 0.05 * i)) {
            ev = *now;
            ++changes;
            if (i == 24) {
                EXPECT_NEAR(ev, 4, 0.3);
            }
        }
    EXPECT_NEAR(ev, 4, 0.02);
    EXPECT_LT(changes, 60) << "it rests";
    EXPECT_FALSE(e.see(grey_views(0.19f / 16, 0.19f / 16), ev, 9)) << "a little brighter";
}

} // namespace
} // namespace viewer::test
