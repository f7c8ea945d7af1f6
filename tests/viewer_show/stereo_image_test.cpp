// The window's pixels in every stereo mode, compared with the pictures of the two eyes.

#include "gi/filter/tone_map.h"
#include "gi/image_io/picture_file.h"
#include "tests/viewer_show/live_view.h"
#include "tests/viewer_show/x/x_window.h"
#include "viewer/displays/compose.h"

#include <fmt/format.h>

namespace viewer::test {
namespace {

using Bytes = std::vector<unsigned char>;

constexpr glm::ivec2 kSize{320, 240};
constexpr double kEyeDistance_m = 0.063; // what the viewer starts with
constexpr double kCornellBack_m = 0.5592;

/// The GPU's pow and the CPU's differ in the last bits: a value this near to the border between two bytes,
/// in units of a byte, may become either. (Seen: 1 to 4 of 230,400 bytes.)
constexpr float kEitherByte = 0.01f;

/// A picture in the display's bytes; low and high are the two bytes allowed, where both are.
struct Eye {
    Bytes low, nearest, high;
};

Eye eye_of(gi::Layer const& color, float exposure_ev)
{
    Eye eye;
    for (float const v : gi::tone_map(color, {exposure_ev, gi::ToneCurve::srgb})) {
        eye.low.push_back((unsigned char)(255 * v + 0.5f - kEitherByte));
        eye.nearest.push_back((unsigned char)(255 * v + 0.5f));
        eye.high.push_back((unsigned char)(255 * v + 0.5f + kEitherByte));
    }
    return eye;
}

/// Of the X server's picture and of screenshots; counts, since a list of 100,000 bytes helps nobody.
struct Difference {
    std::size_t differing = 0;
    int most = 0;
};

Difference difference(Bytes const& a, Bytes const& b)
{
    if (a.size() != b.size()) return {std::max(a.size(), b.size()), 1000};
    Difference d;
    for (std::size_t i = 0; i < a.size(); ++i) {
        d.differing += a[i] != b[i];
        d.most = std::max(d.most, std::abs(int(a[i]) - int(b[i])));
    }
    return d;
}

/// From what is allowed.
Difference difference(Bytes const& a, Eye const& allowed)
{
    if (a.size() != allowed.low.size()) return {a.size(), 1000};
    Difference d;
    for (std::size_t i = 0; i < a.size(); ++i) {
        int const off = std::max({0, allowed.low[i] - a[i], a[i] - allowed.high[i]});
        d.differing += off > 0;
        d.most = std::max(d.most, off);
    }
    return d;
}

Eye composed(StereoMode mode, Eye const& left, Eye const& right, glm::ivec2 at = {0, 0})
{
    auto const of = [&](Bytes Eye::*form) { return compose_stereo(mode, left.*form, right.*form, kSize, at); };
    // Dubois' matrices have negative elements, so that low ones do not give low ones.
    if (mode == StereoMode::anaglyph_dubois) {
        Eye all{of(&Eye::nearest), of(&Eye::nearest), of(&Eye::nearest)};
        for (auto const l : {&Eye::low, &Eye::high})
            for (auto const r : {&Eye::low, &Eye::high}) {
                Bytes const one = compose_stereo(mode, left.*l, right.*r, kSize, at);
                for (std::size_t i = 0; i < one.size(); ++i) {
                    all.low[i] = std::min(all.low[i], one[i]);
                    all.high[i] = std::max(all.high[i], one[i]);
                }
            }
        return all;
    }
    return {of(&Eye::low), of(&Eye::nearest), of(&Eye::high)};
}

/// Folder for pictures to look at: LIGHTWELL_TEST_PICTURES; empty = none are kept.
void keep(std::filesystem::path const& file, std::string const& name)
{
    char const* const folder = std::getenv("LIGHTWELL_TEST_PICTURES");
    if (folder != nullptr && *folder != '\0') std::filesystem::copy_file(file, std::string(folder) + "/" + name);
}

/// A PNG of 8 bits, read back exactly: decoding to linear light and encoding again gives the same byte.
Bytes png_bytes(std::filesystem::path const& file)
{
    gi::Picture const p = gi::read_picture(file);
    return gi::tone_map_bytes(*p.find("color"), {});
}

class Stereo : public OnScreen {
protected:
    void SetUp() override
    {
        OnScreen::SetUp();
        if (IsSkipped()) return;
        view.emplace("cornell --size 320x240" + kStill);
        window.emplace("Lightwell: cornell");
    }

    void set_mode(StereoMode mode)
    {
        view->set("stereo", name_of(mode));
        view->settle();
    }
    /// Of an eye as saved by the viewer.
    Eye eye(int number, float exposure_ev = 0)
    {
        std::string const file = fmt::format("eye{}_{}.exr", number, ++shots_);
        frame = view->screenshot(file, number);
        gi::Picture const p = gi::read_exr(view->folder() / file);
        eye_px = {p.width, p.height};
        return eye_of(*p.find("color"), exposure_ev);
    }
    Bytes shown(std::string const& name)
    {
        std::string const file = fmt::format("shown_{}.png", ++shots_);
        EXPECT_EQ(view->screenshot(file), frame) << "of another frame than the eyes";
        keep(view->folder() / file, name + ".png");
        return png_bytes(view->folder() / file);
    }
    void check_mode(StereoMode mode, std::string const& name, glm::ivec2 at = {0, 0}, float exposure_ev = 0)
    {
        SCOPED_TRACE(name);
        Eye const left = eye(0, exposure_ev), right = mode == StereoMode::off ? left : eye(1, exposure_ev);
        ASSERT_EQ(eye_px, eye_size(mode, kSize));
        if (mode != StereoMode::off) {
            EXPECT_GT(difference(left.low, right).differing, 10000u) << "both eyes see the same";
        }
        Eye const expected = composed(mode, left, right, at);
        Bytes const seen = shown(name);
        int const allowed = mode == StereoMode::anaglyph_dubois ? 1 : 0; // its matrices are products of floats
        Difference const d = difference(seen, expected);
        EXPECT_LE(d.most, allowed) << d.differing << " of " << seen.size() << " bytes differ";
        Difference const x = difference(window->picture(), seen);
        EXPECT_EQ(x.most, 0) << "the X server shows something else: " << x.differing << " bytes";
    }

    std::optional<LiveView> view;
    std::optional<XWindow> window;
    glm::ivec2 eye_px{};
    int frame = -1;

private:
    int shots_ = 0;
};

TEST_F(Stereo, WindowIsWhatTheTwoEyesSee)
{
    for (StereoMode const mode : kStereoModes) {
        if (mode == StereoMode::quad_buffer || mode == StereoMode::two_windows) continue;
        set_mode(mode);
        check_mode(mode, name_of(mode));
    }
    view->quit();
}

TEST_F(Stereo, ExposureIsThatOfTheScreenshots)
{
    set_mode(StereoMode::checkerboard);
    view->set("exposure", 1.5);
    view->settle();
    check_mode(StereoMode::checkerboard, "exposure", {0, 0}, 1.5f);
    view->quit();
}

TEST_F(Stereo, SwappedEyes)
{
    set_mode(StereoMode::rows);
    view->set("swap_eyes", true);
    view->settle();
    Eye const left = eye(0), right = eye(1);
    EXPECT_EQ(difference(shown("swapped"), composed(StereoMode::rows, right, left)).most, 0);
    view->quit();
}

/// The filter before the screen stays where it is when the window moves.
TEST_F(Stereo, InterlaceFollowsTheWindowOverTheScreen)
{
    for (StereoMode const mode : {StereoMode::rows, StereoMode::columns, StereoMode::checkerboard}) {
        set_mode(mode);
        for (glm::ivec2 const at : {glm::ivec2{11, 7}, {12, 7}, {11, 8}}) {
            if (mode == StereoMode::rows && at.x == 12) continue; // as the first
            if (mode == StereoMode::columns && at.y == 8) continue;
            window->move(at);
            view->settle();
            ASSERT_EQ(window->position_px(), at);
            check_mode(mode, fmt::format("{}_{}_{}", name_of(mode), at.x, at.y), at);
        }
    }
    view->quit();
}

/// Nobody asks for a picture: the window must have been redrawn by itself.
TEST_F(Stereo, InterlaceIsDrawnAnewWhenTheWindowMoves)
{
    set_mode(StereoMode::rows);
    Eye const left = eye(0), right = eye(1);
    for (glm::ivec2 const at : {glm::ivec2{20, 31}, {20, 32}}) {
        window->move(at);
        Eye const expected = composed(StereoMode::rows, left, right, at);
        Difference d;
        EXPECT_TRUE(is_soon([&] {
            d = difference(window->picture(), expected);
            return d.most == 0;
        })) << at.x
            << ", " << at.y << ": " << d.differing << " bytes differ";
    }
    view->quit();
}

/// llvmpipe has no quad-buffer stereo: side by side it is, and that is said.
TEST_F(Stereo, QuadBufferFallsBackToSideBySide)
{
    view->quit();
    window.reset();
    view.emplace("cornell --size 320x240 --set stereo=quad-buffer" + kStill);
    window.emplace("Lightwell: cornell");
    Json const stats = view->settle();
    bool said = false;
    for (auto const& [what, count] : stats.at("losses").items())
        said |= what.find("quad-buffer") != std::string::npos;
    if (!said) GTEST_SKIP() << "SKIPPED: this driver has quad-buffer stereo";
    EXPECT_NE(view->program().errors().find("quad-buffer"), std::string::npos) << "at once, not at the end";
    EXPECT_NE(stats.value("message", "").find("quad-buffer"), std::string::npos) << "in the window";
    eye(0);
    EXPECT_EQ(eye_px, glm::ivec2(160, 240)) << "the eyes are rendered at the shape in which they are shown";
    sleep_ms(5500); // until the message has gone
    check_mode(StereoMode::side_by_side, "quad_buffer");
    Outcome const o = view->quit();
    EXPECT_NE(o.err.find("quad-buffer"), std::string::npos) << o.err;
}

TEST_F(Stereo, TwoWindowsShowAnEyeEach)
{
    view->quit();
    window.reset();
    view.emplace("cornell --size 320x240 --set stereo=two-windows" + kStill);
    window.emplace("Lightwell: cornell (left eye)");
    XWindow const beside("Lightwell: cornell (right eye)");
    EXPECT_EQ(beside.position_px(), window->position_px() + glm::ivec2(kSize.x, 0));
    view->settle();
    Eye const left = eye(0), right = eye(1);
    ASSERT_EQ(eye_px, kSize);
    EXPECT_GT(difference(left.low, right).differing, 10000u) << "both eyes see the same";
    EXPECT_EQ(difference(window->picture(), left).differing, 0u);
    EXPECT_EQ(difference(beside.picture(), right).differing, 0u);
    Outcome const o = view->quit();
    EXPECT_EQ(o.err.find("OpenGL"), std::string::npos) << o.err;
}

TEST_F(Stereo, TwoWindowsAreRefusedWhereThereIsOne)
{
    Json const refused = view->answer({{"do", "set"}, {"key", "stereo"}, {"value", "two-windows"}});
    EXPECT_NE(refused.value("error", "").find("no second window"), std::string::npos) << refused;
    view->ask({{"do", "key"}, {"key", "0"}});
    EXPECT_EQ(view->ask({{"do", "get"}, {"key", "stereo"}}).at("value"), "off");
    EXPECT_NE(view->settle().value("message", "").find("no second window"), std::string::npos);
    view->quit();
}

/// The same place of the view, whatever share of the window an eye has.
TEST_F(Stereo, PicksWhatIsSeen)
{
    auto const picked = [&](double x_px, double y_px) {
        view->settle();
        Json const p = view->ask({{"do", "pick"}, {"x_px", x_px}, {"y_px", y_px}}).at("position");
        return glm::dvec3(p[0], p[1], p[2]);
    };
    set_mode(StereoMode::rows);
    glm::dvec3 const expected = picked(96, 72);
    set_mode(StereoMode::side_by_side);
    EXPECT_LT(glm::length(picked(48, 72) - expected), 1e-4);
    set_mode(StereoMode::top_bottom);
    EXPECT_LT(glm::length(picked(96, 36) - expected), 1e-4);
    view->quit();
}

TEST_F(Stereo, AnEyeHasAtLeastOnePixel)
{
    for (StereoMode const mode : {StereoMode::side_by_side, StereoMode::top_bottom}) {
        set_mode(mode);
        window->resize({1, 1});
        Json const eyes = view->settle().at("views");
        ASSERT_EQ(eyes.size(), 2u);
        for (Json const& e : eyes) {
            EXPECT_EQ(e.at("width"), 1) << name_of(mode);
            EXPECT_EQ(e.at("height"), 1) << name_of(mode);
        }
        window->resize(kSize);
        view->settle();
    }
    view->quit();
}

/// Depths of the eyes' pictures are those of the walls of the Cornell box, seen from where the eyes have to be. In
/// halves of the window the whole view is squeezed: what they show does not depend on their pixels' shape.
class EyesInMode : public Stereo, public ::testing::WithParamInterface<StereoMode> {};

TEST_P(EyesInMode, AreWhereTheGeometrySays)
{
    set_mode(GetParam());
    Json const camera = view->ask({{"do", "camera"}});
    glm::dvec3 const middle(camera["position"][0], camera["position"][1], camera["position"][2]);
    double const tan_half = std::tan(glm::radians(camera["fov_deg"].get<double>()) / 2);
    // The screen stands at the distance of the box's middle.
    glm::dvec3 const box(0.278, 0.2744, 0.2796);
    double const screen_m = glm::length(box - middle);
    for (int number : {0, 1}) {
        eye(number);
        gi::Picture const p = gi::read_exr(view->folder() / fmt::format("eye{}_{}.exr", number, number + 1));
        gi::Layer const* const depth = p.find("depth");
        ASSERT_NE(depth, nullptr);
        double const aside = (number == 0 ? -0.5 : 0.5) * kEyeDistance_m;
        int on_floor = 0, on_back = 0, on_wall = 0;
        for (int y = 0; y < p.height; ++y)
            for (int x = 0; x < p.width; ++x) {
                auto const right = [&](double at) {
                    return (2 * at / p.width - 1) * tan_half * kSize.x / kSize.y - aside / screen_m;
                };
                auto const up = [&](double at) { return (1 - 2 * at / p.height) * tan_half; };
                // It looks along +Z, so that right is -X. A path goes through any point of its pixel.
                auto const within = [&](double to, double low_x, double high_x) {
                    return middle.x - aside - right(x) * to < high_x &&
                           middle.x - aside - right(x + 1) * to > low_x;
                };
                float const seen = depth->data[std::size_t(y * p.width + x)];
                // Before the blocks, and above them: there is nothing else to be seen.
                if (up(y) < 0) {
                    double const far = -middle.y / up(y), near = -middle.y / up(y + 1);
                    if (near + middle.z > 0.005 && far + middle.z < 0.06 && within(far, 0.02, 0.53)) {
                        EXPECT_TRUE(seen >= near * 0.99999 && seen <= far * 1.00001)
                            << x << ", " << y << " of eye " << number << ": " << seen;
                        ++on_floor;
                    }
                }
                double const back = kCornellBack_m - middle.z;
                if (middle.y + up(y + 1) * back > 0.46 && middle.y + up(y) * back < 0.54 &&
                    within(back, 0.02, 0.53)) {
                    EXPECT_NEAR(seen, back, 1e-5) << x << ", " << y << " of eye " << number;
                    ++on_back;
                }
                // Only this one depends on the sideways position of the eye: the wall at x = 0.
                if (right(x) > 0 && up(y + 1) > 0) {
                    double const far = (middle.x - aside) / right(x), near = (middle.x - aside) / right(x + 1);
                    if (near + middle.z > 0.02 && far + middle.z < 0.54 && middle.y + up(y) * far < 0.53) {
                        EXPECT_TRUE(seen >= near * 0.99999 && seen <= far * 1.00001)
                            << x << ", " << y << " of eye " << number << ": " << seen;
                        ++on_wall;
                    }
                }
            }
        int const enough = 500 * p.width * p.height / (kSize.x * kSize.y);
        EXPECT_GT(on_wall, enough);
        EXPECT_GT(on_floor, enough);
        EXPECT_GT(on_back, enough);
    }
    view->quit();
}

INSTANTIATE_TEST_SUITE_P(Stereo, EyesInMode,
                         ::testing::Values(StereoMode::rows, StereoMode::side_by_side, StereoMode::top_bottom),
                         [](auto const& instance) {
                             std::string name = name_of(instance.param);
                             std::erase(name, '-');
                             return name;
                         });

using Walls = OnScreen;

/// Three windows of one process: one with two eyes, one with a wall pass.
TEST_F(Walls, EndWithoutErrorsOfOpenGL)
{
    TemporaryFolder const folder;
    std::ofstream(folder / "corner.yaml") << R"(name: corner
walls:
  - {name: left, lower_left_m: [-1, 0, 1], lower_right_m: [-1, 0, -1], upper_left_m: [-1, 2, 1], window: left}
  - {name: front, lower_left_m: [-1, 0, -1], lower_right_m: [1, 0, -1], upper_left_m: [-1, 2, -1], window: front, stereo: side-by-side}
  - {name: right, lower_left_m: [1, 0, -1], lower_right_m: [1, 0, 1], upper_left_m: [1, 2, -1], window: right, gain: [1, 0.9, 0.8]}
windows:
  - {name: left, size_px: [120, 120], position_px: [0, 0]}
  - {name: front, size_px: [120, 120], position_px: [140, 0]}
  - {name: right, size_px: [120, 120], position_px: [280, 0]}
users:
  - {name: guest, head_position_m: [0, 1, 0]}
)";
    LiveView view("cornell --display " + (folder / "corner.yaml").string() + kStill);
    XWindow const left("Lightwell: left"), front("Lightwell: front"), right("Lightwell: right");
    view.settle();
    view.screenshot("shot.png");
    gi::Picture const shot = gi::read_picture(view.folder() / "shot.png");
    EXPECT_EQ(glm::ivec2(shot.width, shot.height), glm::ivec2(360, 120)) << "the windows beside each other";
    Outcome const o = view.quit();
    EXPECT_EQ(o.err.find("OpenGL"), std::string::npos) << o.err;
}

} // namespace
} // namespace viewer::test
