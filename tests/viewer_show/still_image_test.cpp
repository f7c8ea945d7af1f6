// After everything has stood still, what is shown no longer flickers.

#include "gi/filter/tone_map.h"
#include "gi/image_io/picture_file.h"
#include "tests/viewer_show/live_view.h"
#include "viewer/protocol/recording/recording.h"

#include <fmt/format.h>
#include <numeric>

namespace viewer::test {
namespace {

class StillPicture : public OnScreen {};

/// Root mean square of the differences of each shown picture from the one before, in bytes, after the first pictures that
/// were rendered since the last motion.
std::vector<double> flicker(LiveView& view, std::size_t first)
{
    run_well("view --replay walk.lwr --shown --out s_%03d.png", view.folder().path());
    RecordingReader reader(view.folder().path() / "walk.lwr");
    std::vector<ShownFrame> shown;
    std::vector<std::size_t> rendered; // pictures before each that was shown; some are shown again and again
    std::size_t pictures = 0;
    while (auto const record = reader.next_record()) {
        pictures += std::holds_alternative<RecordedFrame>(*record) ? 1 : 0;
        if (auto const* const s = std::get_if<ShownFrame>(&*record)) {
            shown.push_back(*s);
            rendered.push_back(pictures);
        }
    }
    std::size_t still = shown.size() - 1;
    while (still > 0 && shown[still - 1].moment.views == shown.back().moment.views) --still;
    std::vector<double> rms;
    std::vector<float> last;
    for (std::size_t k = still; k < shown.size(); ++k) {
        if (rendered[k] < rendered[still] + first) continue;
        std::vector<float> const now =
            gi::tone_map(gi::read_picture(view.folder() / fmt::format("s_{:03}.png", k)).layers[0], {});
        double sum = 0;
        for (std::size_t i = 0; i < last.size(); ++i) sum += std::pow(255 * (double(now[i]) - double(last[i])), 2);
        if (!last.empty()) rms.push_back(std::sqrt(sum / double(last.size())));
        last = now;
    }
    return rms;
}

TEST_F(StillPicture, DoesNotFlicker)
{
    constexpr int kFirst = 12, kJudged = 24; // a number of pictures, as a busy machine makes fewer in a time
    for (auto const& [scene, wanted] : {std::pair("cornell", 1.0), std::pair("ring", 1.0)}) {
        LiveView view(std::string(scene) +
                      " --size 240x160 --record walk.lwr --hash-shown --set panel=false --set play=false");
        auto const frames = [&] { return view.ask({{"do", "stats"}}).value("frame", 0); };
        is_soon([&] { return frames() > 3; });
        view.ask({{"do", "key"}, {"key", "w"}, {"action", "press"}});
        sleep_ms(400);
        view.ask({{"do", "key"}, {"key", "w"}, {"action", "release"}});
        int const since = frames();
        ASSERT_TRUE(is_soon([&] { return frames() >= since + kFirst + kJudged; }));
        view.quit();
        std::vector<double> const rms = flicker(view, kFirst);
        ASSERT_GT(rms.size(), std::size_t(kJudged / 2));
        double const mean = std::accumulate(rms.begin(), rms.end(), 0.0) / double(rms.size());
        std::cout << scene << ": " << mean << " of 255 in " << rms.size() << " pictures\n";
        EXPECT_LE(mean, wanted) << scene;
    }
}

} // namespace
} // namespace viewer::test
