// Both eyes' pictures as shown by an OpenXR runtime with a real compositor: screenshots of its window under Xvfb.

#include "gi/image_io/picture_file.h"
#include "tests/viewer_xr/monado.h"
#include "tests/viewer_xr/remote_driver.h"

namespace viewer::test {
namespace {

enum class Colour { black, red, green, blue, white, other };

Colour colour_of(gi::vec3 c)
{
    auto const is = [&](gi::vec3 wanted) { return glm::distance(c, wanted) < 0.15f; };
    if (is({0, 0, 0})) return Colour::black;
    if (is({1, 0, 0})) return Colour::red;
    if (is({0, 1, 0})) return Colour::green;
    if (is({0, 0, 1})) return Colour::blue;
    return is({1, 1, 1}) ? Colour::white : Colour::other;
}

/// Where a colour is in one eye's part of the window, as shares of its width and height from the top left.
struct Seen {
    double share = 0;
    glm::dvec2 middle{0};
};

/// A photograph of a screen with the window of the compositor at its top left.
class Photograph {
public:
    Photograph(std::string const& display, std::filesystem::path const& file)
    {
        Child import({"import", "-window", "root", file.string()}, file.parent_path(), "import",
                     {"DISPLAY=" + display});
        if (import.wait(Seconds(20)) != 0) throw std::runtime_error("no photograph: " + import.err());
        gi::Picture const picture = gi::read_picture(file);
        gi::Layer const& layer = *picture.find("color");
        width_ = picture.width;
        for (std::size_t i = 0; i < picture.pixels(); ++i) {
            colours_.push_back(colour_of(gi::rgb(layer, i)));
            if (colours_.back() == Colour::black) continue;
            right_ = std::max(right_, int(i) % width_ + 1);
            bottom_ = std::max(bottom_, int(i) / width_ + 1);
        }
    }

    glm::ivec2 window() const { return {right_, bottom_}; }
    /// In a window of this size, two eyes beside each other.
    Seen find(glm::ivec2 window, int eye, Colour colour) const
    {
        int const w = window.x / 2;
        Seen seen;
        int count = 0;
        for (int y = 0; y < window.y; ++y)
            for (int x = 0; x < w; ++x) {
                if (colours_[std::size_t(y * width_ + eye * w + x)] != colour) continue;
                ++count;
                seen.middle += glm::dvec2((x + 0.5) / w, (y + 0.5) / window.y);
            }
        seen.share = double(count) / (w * window.y);
        if (count > 0) seen.middle /= count;
        return seen;
    }

private:
    int width_ = 0, right_ = 0, bottom_ = 0;
    std::vector<Colour> colours_;
};

class Composited : public Monado {
protected:
    void SetUp() override
    {
        Monado::SetUp();
        if (IsSkipped()) return;
        x_server_.emplace(
            std::vector<std::string>{"Xvfb", "-displayfd", "1", "-screen", "0", "1280x800x24", "-nolisten", "tcp"},
            folder.path(), "xvfb");
        if (!wait_for([&] { return x_server_->out().ends_with('\n') || !x_server_->is_running(); }, Seconds(20)) ||
            !x_server_->is_running())
            GTEST_SKIP() << "SKIPPED: no Xvfb: " << x_server_->err();
        display = ":" + words(x_server_->out()).at(0);
    }

    /// The head at (0, 1.6, 0) turned about +Y (positive: to the left);
    /// views wider than the display, each lopsided.
    static void look(RemoteDriver& remote, double heading_rad)
    {
        float const s = float(std::sin(heading_rad / 2)), c = float(std::cos(heading_rad / 2));
        remote.set_head({{0, s, 0, c}, {0, 1.6f, 0}});
        remote.set_eyes({RemoteEye{{-1.1f, 0.9f, 1.0f, -0.95f}, {{0, 0, 0, 1}, {-0.03f, 0, 0}}},
                         RemoteEye{{-0.95f, 1.05f, 0.9f, -1.05f}, {{0, 0, 0, 1}, {0.03f, 0, 0}}}});
        remote.send_all();
    }
    /// Across the display of an eye, which shows 85 degrees of what the picture holds:
    /// something at a tangent to the right, 0 to 1.
    static double across(double tangent) { return 0.5 + 0.5 * tangent / std::tan(glm::radians(42.5)); }
    bool shows_picture(Child& client)
    {
        return wait_for([&] { return client.out().find("counting") != std::string::npos; }, Seconds(30));
    }
    /// Kept for people where the variable LIGHTWELL_TEST_PICTURES names a folder.
    Photograph photograph(std::string const& name)
    {
        Photograph const photo(display, folder / (name + ".png"));
        if (char const* keep = std::getenv("LIGHTWELL_TEST_PICTURES"))
            std::filesystem::copy_file(folder / (name + ".png"), std::filesystem::path(keep) / (name + ".png"),
                                       std::filesystem::copy_options::overwrite_existing);
        return photo;
    }

    /// By a shader per pixel: its other way interpolates turned pictures between the corners of the display.
    std::vector<std::string> compositor_environment() const
    {
        return {"DISPLAY=" + display, "XRT_COMPOSITOR_COMPUTE=1"};
    }

    std::string display;

private:
    std::optional<Child> x_server_;
};

class EachGraphics : public Composited, public ::testing::WithParamInterface<char const*> {};

INSTANTIATE_TEST_SUITE_P(Paths, EachGraphics, ::testing::Values("glx", "egl"),
                         [](auto const& path) { return std::string(path.param); });

/// Each eye has its own colour; the ball, 2 m ahead, is where each of them sees it; the sky is above.
TEST_P(EachGraphics, EyesSeeTheirOwnPictures)
{
    int const port = free_port();
    start_service({"--remote", std::to_string(port), "--compositor", "xcb"}, compositor_environment());
    RemoteDriver remote(port);
    look(remote, 0);
    Child client(client_call(std::string("--frames 10000 --every 5 --patience 100 --graphics ") + GetParam()),
                 folder.path(), "client", {"DISPLAY=" + display});
    ASSERT_TRUE(shows_picture(client)) << client.out() << client.err();
    std::this_thread::sleep_for(Seconds(2));
    Photograph const photo = photograph(std::string("eyes_") + GetParam());
    glm::ivec2 const window = photo.window();
    ASSERT_GT(window.x, 300);
    ASSERT_GT(window.y, 150);
    for (int eye = 0; eye < 2; ++eye) {
        Seen const ball = photo.find(window, eye, Colour::white), sky = photo.find(window, eye, Colour::blue);
        EXPECT_NEAR(ball.middle.x, across(eye == 0 ? 0.015 : -0.015), 0.005) << eye;
        EXPECT_NEAR(ball.middle.y, 0.5, 0.01) << eye;
        EXPECT_GT(sky.share, 0.2) << eye;
        EXPECT_LT(sky.middle.y, 0.3) << eye;
        EXPECT_GT(photo.find(window, eye, eye == 0 ? Colour::red : Colour::green).share, 0.5) << eye;
        EXPECT_EQ(photo.find(window, eye, eye == 0 ? Colour::green : Colour::red).share, 0) << eye;
    }
}

/// One picture is drawn; the head turns; the ball moves as it should although nobody draws: the runtime knows for
/// which pose the picture was drawn.
TEST_F(Composited, PicturesFollowTheHeadWhileNoneIsDrawn)
{
    int const port = free_port();
    start_service({"--remote", std::to_string(port), "--compositor", "xcb"}, compositor_environment());
    RemoteDriver remote(port);
    look(remote, 0);
    Child client(client_call("--frames 10000 --every 100000 --patience 100 --graphics glx"), folder.path(),
                 "client", {"DISPLAY=" + display});
    ASSERT_TRUE(shows_picture(client)) << client.out() << client.err();
    std::this_thread::sleep_for(Seconds(2));
    glm::ivec2 const window = photograph("before_turn").window();
    double const turn_rad = 0.15;
    look(remote, turn_rad);
    std::this_thread::sleep_for(Seconds(2));
    Photograph const photo = photograph("after_turn");
    for (int eye = 0; eye < 2; ++eye) {
        Seen const ball = photo.find(window, eye, Colour::white);
        double const seen_rad = std::atan(eye == 0 ? 0.015 : -0.015);
        EXPECT_NEAR(ball.middle.x, across(std::tan(seen_rad + turn_rad)), 0.01) << eye;
        EXPECT_NEAR(ball.middle.y, 0.5, 0.01) << eye;
        EXPECT_GT(ball.share, 0.005) << eye;
    }
}

/// The runtime moves its space under a picture that was drawn before; the head has not moved,
/// so nothing is to be seen of it.
TEST_F(Composited, PicturesStayWhereTheRuntimeRecentres)
{
    int const port = free_port();
    start_service({"--remote", std::to_string(port), "--compositor", "xcb"}, compositor_environment());
    RemoteDriver remote(port);
    double const turn_rad = 0.15;
    look(remote, turn_rad);
    Child client(client_call("--frames 10000 --every 100000 --patience 100 --graphics glx --seated"),
                 folder.path(), "client", {"DISPLAY=" + display});
    ASSERT_TRUE(shows_picture(client)) << client.out() << client.err();
    std::this_thread::sleep_for(Seconds(2));
    Photograph const before = photograph("before_recentre");
    Child control({kScript, "client", "--dir", runtime_folder(), "--", control_program(), "-c"}, folder.path(),
                  "ctl");
    ASSERT_EQ(control.wait(Seconds(10)), 0) << control.out() << control.err();
    std::this_thread::sleep_for(Seconds(2));
    Photograph const after = photograph("after_recentre");
    for (int eye = 0; eye < 2; ++eye) {
        Seen const ball = before.find(before.window(), eye, Colour::white);
        Seen const then = after.find(before.window(), eye, Colour::white);
        EXPECT_GT(ball.share, 0.005);
        EXPECT_NEAR(then.middle.x, ball.middle.x, 0.003);
        EXPECT_NEAR(then.middle.y, ball.middle.y, 0.003);
    }
}

} // namespace
} // namespace viewer::test
