// Light that does not come holds nothing up: the walking user, his avatar and its mirror image are drawn at their
// newest poses in every shown picture, lit by the last light there is.

#include "tests/viewer_show/live_view.h"
#include "viewer/protocol/recording/recording.h"

namespace viewer::test {
namespace {

class StoppedLight : public OnScreen {
protected:
    struct Shown {
        int pictures = 0, changed = 0; ///< lit by the same light; of these, those that differ from the one before
        double seconds = 0;            ///< from the first to the last of them
    };
    /// What was shown for longest by one picture of light, while the next one takes 5 s.
    /// @param key  held for 3 s; empty = none
    static Shown longest(std::string const& scene, std::string const& key)
    {
        LiveView view(scene +
                      " --size 240x160 --record walk.lwr --hash-shown --set panel=false --set refine=false "
                      "--set play=false");
        view.settle();
        view.ask({{"do", "set"}, {"key", "rate"}, {"value", 0.2}});
        view.ask({{"do", "set"}, {"key", "play"}, {"value", true}});
        if (!key.empty()) view.ask({{"do", "key"}, {"key", key}, {"action", "press"}});
        sleep_ms(3000);
        view.quit();
        RecordingReader reader(view.folder().path() / "walk.lwr");
        Shown most, now;
        std::optional<ShownFrame> last;
        double first_s = 0;
        while (auto const record = reader.next_record()) {
            auto const* const shown = std::get_if<ShownFrame>(&*record);
            if (shown == nullptr || !shown->pixel_hash) continue;
            if (!last || last->moment.frame != shown->moment.frame) {
                now = {};
                first_s = shown->moment.display_s;
            } else {
                now.changed += *last->pixel_hash != *shown->pixel_hash;
            }
            ++now.pictures;
            now.seconds = shown->moment.display_s - first_s;
            if (now.pictures > most.pictures) most = now;
            last = *shown;
        }
        return most;
    }
};

TEST_F(StoppedLight, AWalkingUserSeesEveryPose)
{
    Shown const shown = longest("mirror --avatar avatar", "a");
    EXPECT_GT(shown.seconds, 1);
    EXPECT_GT(shown.pictures, 10);
    EXPECT_EQ(shown.changed, shown.pictures - 1);
}

TEST_F(StoppedLight, AnAvatarDancesOn)
{
    Shown const shown = longest("avatar", "");
    EXPECT_GT(shown.seconds, 1);
    EXPECT_GT(shown.pictures, 10);
    EXPECT_EQ(shown.changed, shown.pictures - 1);
}

} // namespace
} // namespace viewer::test
