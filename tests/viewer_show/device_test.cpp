// `lightwell view --device cuda`: frames by kernels, on the simulated device where there is none.

#include "gi/image_io/picture_file.h"
#include "gi/kernel/device.h"
#include "tests/viewer_show/live_view.h"

#include <fstream>

namespace viewer::test {
namespace {

class ViewDevice : public OnScreen {
protected:
    void SetUp() override
    {
        OnScreen::SetUp();
        if (!gi::device_present()) GTEST_SKIP() << "SKIPPED: no CUDA device, nor LIGHTWELL_DEVICE=simulated";
    }
    static double mean_of_shot(std::string const& arguments, Json* stats = nullptr)
    {
        LiveView view("cornell --size 160x120 --stats stats.json " + arguments + kStill);
        view.settle();
        view.screenshot("shot.png");
        view.quit();
        if (stats != nullptr) *stats = Json::parse(std::ifstream(view.folder() / "stats.json"));
        gi::Picture const shot = gi::read_picture(view.folder() / "shot.png");
        double sum = 0;
        for (float const v : shot.layers[0].data) sum += double(v);
        return sum / double(shot.layers[0].data.size());
    }
};

TEST_F(ViewDevice, ShowsWhatTheProcessorShows)
{
    for (std::string const method : {"paths", "slhb", "reference"}) {
        Json stats;
        double const expected = mean_of_shot("--method " + method),
                     found = mean_of_shot("--device cuda --method " + method, &stats);
        EXPECT_NEAR(found / expected, 1, 0.03) << method;
        Json const device = stats["report"].value("device", Json::object());
        EXPECT_GT(device.value("launches", 0), 0) << method;
        EXPECT_EQ(device.value("simulated", false), gi::is_device_simulated());
        EXPECT_TRUE(stats["report"]["losses"].empty()) << method << " " << stats["report"]["losses"];
    }
}

TEST_F(ViewDevice, FollowsAWalkTwoEyesAndAnAvatar)
{
    LiveView view("mirror --avatar avatar --device cuda --method paths --size 160x120 --stats stats.json "
                  "--set stereo=side-by-side --set panel=false");
    auto const frame = [&] { return view.ask({{"do", "stats"}}).value("frame", -1); };
    view.ask({{"do", "key"}, {"key", "a"}, {"action", "press"}});
    int const first = frame();
    EXPECT_TRUE(is_soon([&] { return frame() > first + 5; }));
    view.set("method", "slhb");
    int const then = frame();
    EXPECT_TRUE(is_soon([&] { return frame() > then + 5; }));
    view.quit();
    Json const stats = Json::parse(std::ifstream(view.folder() / "stats.json"));
    EXPECT_GT(stats["report"]["device"].value("launches", 0), 0);
}

} // namespace
} // namespace viewer::test
