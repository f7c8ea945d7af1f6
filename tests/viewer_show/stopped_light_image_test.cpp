// Light that does not come holds nothing up: a walking user, his avatar and its mirror image are drawn at their
// newest poses in every shown picture, lit by the last light there is.

#include "tests/viewer_show/live_view.h"
#include "viewer/protocol/recording/recording.h"

namespace viewer::test {
namespace {

class StoppedLight : public OnScreen {};

TEST_F(StoppedLight, AWalkingUserSeesEveryPose)
{
    LiveView view("mirror --avatar avatar --size 240x160 --record walk.lwr --hash-shown --set panel=false "
                  "--set refine=false");
    view.settle();
    view.ask({{"do", "set"}, {"key", "rate"}, {"value", 0.2}}); // Hz: the next picture of light waits for 5 s
    view.ask({{"do", "key"}, {"key", "a"}, {"action", "press"}});
    sleep_ms(4000);
    view.quit();
    // Of what one picture of light has lit for longest, from the first change on.
    RecordingReader reader(view.folder().path() / "walk.lwr");
    int most = 0, pictures = 0, changed = 0, most_changed = 0;
    std::optional<ShownFrame> last;
    while (auto const record = reader.next_record()) {
        auto const* const shown = std::get_if<ShownFrame>(&*record);
        if (shown == nullptr || !shown->pixel_hash) continue;
        if (!last || last->moment.frame != shown->moment.frame) pictures = changed = 0;
        bool const other = last && *last->pixel_hash != *shown->pixel_hash;
        if (pictures > 0 || other) {
            ++pictures;
            changed += other;
        }
        if (pictures > most) std::tie(most, most_changed) = std::tuple(pictures, changed);
        last = *shown;
    }
    std::cout << most << " pictures were lit by one picture of light, " << most_changed << " differed\n";
    EXPECT_GT(most, 5);
    EXPECT_GE(most_changed, most - 1);
}

} // namespace
} // namespace viewer::test
