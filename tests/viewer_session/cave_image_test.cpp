// The walls of a CAVE are one picture: rendered to convergence, neighbours agree along their common edge.

#include "gi/filter/tone_map.h"
#include "tests/support/scenes.h"
#include "viewer/displays/display_file.h"
#include "viewer/displays/views.h"
#include "viewer/engine/render_session.h"

#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace viewer::test {
namespace {

using gi::test::add_box, gi::test::add_material, gi::test::add_quad, gi::test::lambert, gi::test::emitter;

/// A matt room, wider than the CAVE, with a lamp.
std::shared_ptr<gi::Scene const> room(std::string const&, gi::Report&)
{
    gi::Scene scene;
    add_box(scene, {-4, 0, -4}, {4, 5, 4}, add_material(scene, lambert(gi::vec3{0.7f, 0.6f, 0.5f})), true);
    add_quad(scene, {-1.5f, 4.99f, -1.5f}, {3, 0, 0}, {0, 0, 3}, add_material(scene, emitter(gi::vec3{4})));
    return std::make_shared<gi::Scene const>(std::move(scene));
}

/// An edge of a picture, and the end of it from which pixels are counted.
enum class Side { left, right, top, bottom };
struct Edge {
    std::string wall;
    Side side = Side::left;
    std::string other;
    Side other_side = Side::left;
    bool reversed = false; ///< the other wall counts from the other end
};

constexpr int kSize = 16;
constexpr double kBeside = 1e-3; ///< of a wall's extent that a strip reaches to both sides of the edge

/// The same wall seen through a strip along one of its edges, one pixel wide. What it shows lies on the edge, half
/// of it beyond the wall: there both walls of an edge must show the same.
ViewCommand strip_along(ViewCommand view, Side side)
{
    gi::ViewTangents& t = *view.camera.off_axis;
    double const wide = kBeside * (t.right - t.left), high = kBeside * (t.top - t.bottom);
    if (side == Side::left) t.right = t.left;
    if (side == Side::right) t.left = t.right;
    if (side == Side::top) t.bottom = t.top;
    if (side == Side::bottom) t.top = t.bottom;
    bool const upright = side == Side::left || side == Side::right;
    if (upright) {
        t.left -= wide;
        t.right += wide;
    } else {
        t.bottom -= high;
        t.top += high;
    }
    view.width = upright ? 1 : kSize;
    view.height = upright ? kSize : 1;
    view.partner = -1;
    return view;
}

TEST(Cave, WallsAreContinuousAcrossTheirEdges)
{
    gi::Report report;
    Display display = load_display(LIGHTWELL_SOURCE_DIR "/data/displays/cave4.yaml", report);
    for (Wall& wall : display.walls) wall.stereo = StereoMode::off;
    std::vector<std::optional<RoomPose>> const heads{RoomPose{{0.3, 1.6, 0.2}, {1, 0, 0, 0}}};
    std::vector<ViewCommand> const walls = view_orders(views_of(display, heads), gi::dmat4(1));
    ASSERT_EQ(walls.size(), 4u);
    auto const view_of = [&](std::string const& name) {
        return *std::find_if(walls.begin(), walls.end(),
                             [&](ViewCommand const& v) { return v.name.starts_with(name); });
    };
    // The left wall's right edge is the front wall's left one, and so on; rows count from the top.
    Edge const edges[] = {{"left", Side::right, "front", Side::left},
                          {"front", Side::right, "right", Side::left},
                          {"front", Side::bottom, "floor", Side::top},
                          {"left", Side::bottom, "floor", Side::left, true},
                          {"right", Side::bottom, "floor", Side::right}};
    FrameCommand command;
    for (Edge const& e : edges) {
        command.views.push_back(strip_along(view_of(e.wall), e.side));
        command.views.push_back(strip_along(view_of(e.other), e.other_side));
    }
    RenderSession session(room, 0, report);
    session.apply({"method", "slhb"});
    session.apply({"directions", "icosahedron:320"});
    session.apply({"denoise", "none"});
    session.apply({"bounces", 3}); // the noise of more would need more frames
    session.apply({"scene", "room"});
    constexpr int kFrames = 16;
    command.paths = 256;
    SessionFrame frame;
    for (int f = 0; f < kFrames; ++f) {
        command.frame = std::uint64_t(f);
        frame = session.render(command, {});
    }
    for (std::size_t e = 0; e < std::size(edges); ++e) {
        auto const shown = [&](std::size_t view) {
            return gi::tone_map(*frame.views[view].picture.find("color"), {1, gi::ToneCurve::srgb});
        };
        std::vector<float> const a = shown(2 * e), b = shown(2 * e + 1);
        ASSERT_EQ(a.size(), std::size_t(3 * kSize));
        double sum = 0, most = 0, darkest = 255;
        for (int i = 0; i < kSize; ++i)
            for (int c = 0; c < 3; ++c) {
                int const j = edges[e].reversed ? kSize - 1 - i : i;
                double const one = 255 * double(a[std::size_t(3 * i + c)]),
                             other = 255 * double(b[std::size_t(3 * j + c)]);
                sum += std::abs(one - other);
                most = std::max(most, std::abs(one - other));
                darkest = std::min(darkest, one);
            }
        std::printf("%s | %s: mean difference %.3f / 255, most %.3f of single pixels (darkest %.0f)\n",
                    edges[e].wall.c_str(), edges[e].other.c_str(), sum / (3 * kSize), most, darkest);
        EXPECT_LE(most, 1.0) << edges[e].wall << " | " << edges[e].other;
        EXPECT_GT(darkest, 5) << "nothing to see";
    }
}

} // namespace
} // namespace viewer::test
