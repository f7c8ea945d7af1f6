// Pictures with margins are shown without them, and where the head has turned, their margins are seen.

#include "tests/viewer_gl/surfaceless.h"
#include "viewer/app/presenter.h"
#include "viewer/engine/picture_margin.h"

#include <glm/gtc/matrix_transform.hpp>

namespace viewer::test {
namespace {

using MarginShown = Surfaceless;

constexpr int kWidth = 64, kHeight = 48, kMargin = 4;

/// One colour in the view, another one in its margin.
std::shared_ptr<LiveFrame> frame_with_margin()
{
    auto frame = std::make_shared<LiveFrame>();
    ViewCommand view{"window", {}, kWidth, kHeight, -1};
    view.camera.yfov_rad = glm::radians(60.0);
    frame->command.views = {view};
    gi::Picture p{kWidth + 2 * kMargin, kHeight + 2 * kMargin, {}, {}};
    gi::Layer& color = p.add("color", 3);
    for (int y = 0; y < p.height; ++y)
        for (int x = 0; x < p.width; ++x) {
            bool const inside = x >= kMargin && x < kMargin + kWidth && y >= kMargin && y < kMargin + kHeight;
            color.data[std::size_t(3 * (y * p.width + x) + (inside ? 0 : 1))] = 1;
        }
    for (float& d : p.add("depth", 1).data) d = 2;
    frame->result.views.push_back({std::move(p), {}, {}, {kMargin, kMargin}});
    return frame;
}

std::vector<unsigned char> shown(std::vector<gi::Camera> const& now)
{
    auto const frame = frame_with_margin();
    Presenter presenter({});
    std::vector<Pane> const panes{{{0, 0}, {kWidth, kHeight}, StereoMode::off, 0, -1}};
    presenter.take(frame, panes);
    TextureTarget const window(TextureTarget::Format::bytes, {kWidth, kHeight});
    presenter.draw(window.target(), {0, 0}, panes, {}, now);
    return read_bytes(window.target());
}

TEST_F(MarginShown, TheViewAloneWhereTheHeadStands)
{
    for (std::vector<gi::Camera> const& now :
         {std::vector<gi::Camera>{}, std::vector<gi::Camera>{frame_with_margin()->command.views[0].camera}}) {
        auto const bytes = shown(now);
        ASSERT_EQ(bytes.size(), std::size_t(3 * kWidth * kHeight));
        for (std::size_t i = 0; i < bytes.size(); i += 3) {
            ASSERT_EQ(bytes[i], 255) << i / 3;
            ASSERT_EQ(bytes[i + 1], 0) << i / 3;
        }
    }
}

TEST_F(MarginShown, TheMarginWhereTheHeadTurns)
{
    gi::Camera turned = frame_with_margin()->command.views[0].camera;
    turned.world_from_camera = glm::rotate(gi::dmat4(1), glm::radians(-3.0), gi::dvec3{0, 1, 0}); // to the right
    auto const bytes = shown({turned});
    auto const green = [&](int x) { return int(bytes[std::size_t(3 * (kHeight / 2 * kWidth + x) + 1)]); };
    EXPECT_EQ(green(kWidth - 1), 255);
    EXPECT_EQ(green(kWidth - 3), 255);
    EXPECT_EQ(green(0), 0);
    EXPECT_EQ(green(kWidth - 8), 0);
}

} // namespace
} // namespace viewer::test
