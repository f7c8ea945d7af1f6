// The panel in a small window, and the quality that it and the remote control set.

#include "tests/viewer_show/input.h"

#include <algorithm>

namespace viewer::test {
namespace {

/// Shares of a window with a black picture: of its pixels that the panel covers, and of its width.
struct Cover {
    double pixels = 0, width = 0;
};
Cover cover(std::vector<unsigned char> const& window, glm::ivec2 size)
{
    int count = 0, right = 0;
    for (int y = 0; y < size.y; ++y)
        for (int x = 0; x < size.x; ++x) {
            unsigned char const* const rgb = &window[3 * std::size_t(y * size.x + x)];
            if (rgb[0] + rgb[1] + rgb[2] == 0) continue;
            ++count;
            right = std::max(right, x + 1);
        }
    return {double(count) / (size.x * size.y), double(right) / size.x};
}

TEST_F(Input, ThePanelOfASmallWindowLeavesMostOfIt)
{
    open("cornell --size 640x480 --set exposure=-32 --set refine=false", "Lightwell: cornell");
    NEED_KEYS();
    window->point_at({600, 400}); // over a line of the panel it would be explained, in a wide box
    auto const now = [&] { return cover(window->picture(), {640, 480}); };
    EXPECT_TRUE(is_soon([&] { return now().pixels > 0.1; })) << "there is no panel";
    view->settle();
    // A slow machine still says in the middle of the window what it builds.
    EXPECT_TRUE(is_soon([&] { return now().width < 0.4; }));
    Cover const open = now();
    EXPECT_GT(open.pixels, 0.1);
    EXPECT_LT(open.pixels, 0.4);
    window->point_at({20, 20}); // the triangle in its title
    sleep_ms(100);
    window->press_button(1);
    sleep_ms(100);
    window->release_button(1);
    EXPECT_TRUE(is_soon([&] { return now().pixels < 0.05; })) << "it cannot be folded away";
    view->quit();
}

TEST_F(Input, QualityIsSetAsTheChangesThatItMakes)
{
    open("cornell --size 64x48 --set quality=fast --record walk.lwr", "Lightwell: cornell");
    auto const get = [&](char const* key) { return view->ask({{"do", "get"}, {"key", key}}).at("value"); };
    EXPECT_EQ(get("quality"), "fast");
    EXPECT_EQ(get("radiance_cache"), "on");
    view->set("quality", "exact");
    EXPECT_EQ(get("quality"), "exact");
    EXPECT_EQ(get("denoise"), "none");
    EXPECT_EQ(get("reuse"), 1);
    view->set("exposure", 1);
    EXPECT_EQ(get("quality"), "exact");
    view->set("rate", 3);
    EXPECT_TRUE(get("quality").is_null());
    Json const wrong = view->answer({{"do", "set"}, {"key", "quality"}, {"value", "best"}});
    EXPECT_NE(wrong.value("error", "").find("no such step"), std::string::npos) << wrong;
    view->set("refine", false);
    view->settle();
    view->quit();
    Outcome const o = run_well("view --replay walk.lwr", view->folder().path());
    EXPECT_NE(o.out.find(" 0 not, 0 unknown"), std::string::npos) << o.out;
}

} // namespace
} // namespace viewer::test
