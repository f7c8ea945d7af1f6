// Screenshots of every kind of window, by key and by request.

#include "gi/image_io/picture_file.h"
#include "tests/viewer_show/live_view.h"

#include <glm/vec2.hpp>

namespace viewer::test {
namespace {

class Screenshots : public OnScreen {
protected:
    static glm::ivec2 size_of(std::filesystem::path const& png)
    {
        gi::Picture const p = gi::read_picture(png);
        return {p.width, p.height};
    }
    /// Presses F2; the new files' names end in .png and .exr.
    static std::vector<std::filesystem::path> by_key(LiveView& view)
    {
        view.ask({{"do", "key"}, {"key", "F2"}});
        auto const files = [&] {
            std::vector<std::filesystem::path> found;
            for (auto const& f : std::filesystem::directory_iterator(view.folder().path()))
                if (f.path().filename().string().starts_with("lightwell_")) found.push_back(f.path());
            std::ranges::sort(found);
            return found;
        };
        EXPECT_TRUE(is_soon([&] {
            return view.ask({{"do", "stats"}}).value("message", "").starts_with("saved lightwell_");
        }));
        return files();
    }
};

TEST_F(Screenshots, OfAWindow)
{
    LiveView view("cornell --size 90x60" + kStill);
    view.settle();
    view.screenshot("shot.png");
    EXPECT_EQ(size_of(view.folder() / "shot.png"), glm::ivec2(90, 60));
    auto const files = by_key(view);
    ASSERT_EQ(files.size(), 2u);
    EXPECT_EQ(size_of(files[1]), glm::ivec2(90, 60));
    view.quit();
}

TEST_F(Screenshots, OfTwoWindowsHaveBoth)
{
    LiveView view("cornell --size 90x60 --set stereo=two-windows" + kStill);
    view.settle();
    view.screenshot("shot.png");
    EXPECT_EQ(size_of(view.folder() / "shot.png"), glm::ivec2(180, 60));
    EXPECT_EQ(by_key(view).size(), 3u) << "the windows, and each eye";
    view.quit();
}

} // namespace
} // namespace viewer::test
