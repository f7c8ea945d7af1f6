// A wand by OSC in front of two walls: it opens the menu where it points, clicks in it, navigates and selects.

#include "gi/image_io/picture_file.h"
#include "tests/viewer_show/live_view.h"
#include "viewer/devices/tracking/osc.h"
#include "viewer/devices/tracking/udp_socket.h"

#include <atomic>
#include <fmt/format.h>
#include <fstream>
#include <mutex>
#include <thread>

namespace viewer::test {
namespace {

/// A free UDP port of the loopback.
int free_port() { return UdpReceiver("127.0.0.1", 0).port(); }

/// Sends a wand's state 50 times a second.
class SentWand {
public:
    explicit SentWand(int port) : sender_("127.0.0.1", port), thread_([this] { run(); })
    {
        now_.body = "wand";
        now_.buttons = 0;
        now_.axes = {0, 0};
    }
    ~SentWand()
    {
        ends_ = true;
        thread_.join();
    }
    template <class Change>
    void change(Change const& change)
    {
        std::lock_guard const lock(mutex_);
        change(now_);
    }
    void buttons(std::uint32_t held)
    {
        change([&](TrackerSample& s) { s.buttons = held; });
        sleep_ms(150);
    }
    /// From 2 m in front of the wall to this point of it.
    void point_at(double x_m, double y_m)
    {
        change([&](TrackerSample& s) { s.pose.position = {x_m, y_m, 1}; });
        sleep_ms(400);
    }

private:
    void run()
    {
        for (std::uint64_t frame = 1; !ends_; ++frame) {
            std::vector<unsigned char> packet;
            {
                std::lock_guard const lock(mutex_);
                if (!now_.body.empty()) {
                    now_.measured_s =
                        std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count();
                    packet = format_osc({now_}, frame);
                }
            }
            if (!packet.empty()) sender_.send(packet);
            sleep_ms(20);
        }
    }

    UdpSender sender_;
    std::mutex mutex_;
    TrackerSample now_;
    std::atomic<bool> ends_ = false;
    std::thread thread_;
};

class WandMenu : public OnScreen {
protected:
    void SetUp() override
    {
        OnScreen::SetUp();
        if (IsSkipped()) return;
        int const port = free_port();
        std::ofstream(folder_ / "room.yaml") << fmt::format(R"(walls:
  - {{name: front, window: w, viewport_fraction: [0, 0, 0.5, 1], stereo: side-by-side,
     lower_left_m: [-1, 0, -1], lower_right_m: [1, 0, -1], upper_left_m: [-1, 2, -1]}}
  - {{name: right, window: w, viewport_fraction: [0.5, 0, 0.5, 1], gain: 0.9,
     lower_left_m: [1, 0, -1], lower_right_m: [1, 0, 1], upper_left_m: [1, 2, -1]}}
windows:
  - {{name: w, size_px: [960, 480]}}
users:
  - {{name: u, head_position_m: [0, 1, 0.9]}}
trackers:
  - {{name: wand, type: osc, port: {}, body: wand, wand: {{buttons: [select, menu, brighter]}}}}
)",
                                                            port);
        wand.emplace(port);
        view.emplace("cornell --display " + (folder_ / "room.yaml").string() +
                     " --set refine=false --set reproject=false --set paths=1 --set scale=1 --set bounces=1");
    }
    gi::Picture picture(std::string const& name)
    {
        std::string const file = fmt::format("{}{}.png", name, ++shots_);
        view->screenshot(file);
        if (char const* const keep = std::getenv("LIGHTWELL_TEST_PICTURES"))
            std::filesystem::copy_file(view->folder() / file, std::string(keep) + "/" + file);
        return gi::read_picture(view->folder() / file);
    }
    /// Pixels of a rectangle that differ between two pictures, as a share.
    static double changed(gi::Picture const& a, gi::Picture const& b, glm::ivec2 from, glm::ivec2 to)
    {
        auto const &x = a.find("color")->data, &y = b.find("color")->data;
        int n = 0;
        for (int r = from.y; r < to.y; ++r)
            for (int c = from.x; c < to.x; ++c) {
                std::size_t const at = 3 * (std::size_t(r) * std::size_t(a.width) + std::size_t(c));
                n += std::abs(x[at] - y[at]) + std::abs(x[at + 1] - y[at + 1]) > 0.02f;
            }
        return double(n) / ((to.x - from.x) * (to.y - from.y));
    }
    double setting(char const* key) { return view->ask({{"do", "get"}, {"key", key}}).at("value").get<double>(); }

    TemporaryFolder folder_;
    std::optional<SentWand> wand;
    std::optional<LiveView> view;
    int shots_ = 0;
};

TEST_F(WandMenu, OpensWhereTheWandPointsAndIsOperatedByIt)
{
    wand->point_at(0, 1);
    wand->buttons(0);
    view->settle();
    gi::Picture const before = picture("wand_closed");
    wand->buttons(2);
    wand->buttons(0);
    wand->point_at(-0.3, 1.42); // near the top left corner, where the panel's first lines are
    sleep_ms(500);
    gi::Picture const open = picture("wand_open");
    // 0.75 m x 0.95 m in the middle of the front wall, in each eye's half of 240 px for 2 m.
    for (int const eye : {0, 240}) {
        EXPECT_GT(changed(before, open, {eye + 78, 130}, {eye + 162, 350}), 0.5)
            << "no menu in the half at " << eye;
        EXPECT_LT(changed(before, open, {eye, 0}, {eye + 70, 480}), 0.1);
    }
    EXPECT_LT(changed(before, open, {480, 0}, {960, 480}), 0.1) << "on the other wall";

    // A click on one of the headings unfolds it, whatever stands at which height.
    bool unfolds = false;
    for (double y = 1.3; y > 0.75 && !unfolds; y -= 0.06) {
        wand->point_at(0.1, y);
        wand->buttons(1);
        wand->buttons(0);
        wand->point_at(-0.3, 1.42);
        unfolds = changed(open, picture("wand_clicked"), {78, 130}, {162, 350}) > 0.1;
    }
    EXPECT_TRUE(unfolds);
    auto const position = [&] { return view->ask({{"do", "camera"}}).at("position"); };
    Json const at = position();
    wand->change([](TrackerSample& w) { w.axes = {0, 1}; });
    sleep_ms(300);
    EXPECT_EQ(position(), at) << "pointing at the menu, the joystick scrolls it";
    wand->change([](TrackerSample& w) { w.axes = {0, 0}; });
    wand->point_at(0, 1);
    wand->buttons(2);
    wand->buttons(0);
    view->settle();
    EXPECT_LT(changed(before, picture("wand_closed"), {0, 0}, {480, 480}), 0.1) << "it does not close";
}

TEST_F(WandMenu, OtherButtonsAndTheJoystickAct)
{
    wand->point_at(0, 1);
    double const exposure = setting("exposure");
    wand->buttons(4);
    wand->buttons(0);
    EXPECT_TRUE(is_soon([&] { return setting("exposure") == exposure + 0.25; }));
    auto const z = [&] { return view->ask({{"do", "camera"}}).at("position").at(2).get<double>(); };
    double const start = z();
    wand->change([](TrackerSample& s) { s.axes = {0, 1}; });
    EXPECT_TRUE(is_soon([&] { return std::abs(z() - start) > 0.05; }));
    wand->change([](TrackerSample& s) { s.body.clear(); }); // the sender is gone, its joystick held forward
    sleep_ms(600);
    double const stopped = z();
    sleep_ms(300);
    EXPECT_EQ(z(), stopped);
}

} // namespace
} // namespace viewer::test
