// The walls of a CAVE are one picture: rendered to convergence, neighbours agree along their common edge.

#include "gi/image/tone_map.h"
#include "tests/support/scenes.h"
#include "viewer/display/display_file.h"
#include "viewer/display/views.h"
#include "viewer/session/session.h"

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

/// Where two walls meet.
struct Edge {
    std::string wall, other;
    std::function<std::pair<int, int>(int i, int k)> here, there; ///< pixels of both
};

TEST(Cave, WallsAreContinuousAcrossTheirEdges)
{
    gi::Report report;
    Display display = load_display(LIGHTWELL_SOURCE_DIR "/data/displays/cave4.yaml", report);
    constexpr int kSize = 64;
    for (Wall& wall : display.walls) {
        wall.stereo = StereoMode::off;
        wall.render_width_px = wall.render_height_px = kSize;
    }
    std::vector<std::optional<RoomPose>> const heads{RoomPose{{0.3, 1.6, 0.2}, {1, 0, 0, 0}}};
    FrameOrder order;
    order.views = view_orders(views_of(display, heads), gi::dmat4(1));
    ASSERT_EQ(order.views.size(), 4u);
    for (ViewOrder const& v : order.views) ASSERT_EQ(v.width, kSize) << v.name;
    Session session(room, 0, report);
    session.apply({"directions", "icosahedron:1280"});
    session.apply({"denoise", "none"});
    session.apply({"scene", "room"});
    order.paths = 16;
    SessionFrame frame;
    for (int f = 0; f < 48; ++f) {
        order.frame = std::uint64_t(f);
        frame = session.render(order, {});
    }
    auto const shown = [&](std::string const& name) {
        for (std::size_t k = 0; k < order.views.size(); ++k)
            if (order.views[k].name.starts_with(name))
                return gi::tone_map(*frame.views[k].picture.find("color"), {1, gi::ToneCurve::srgb});
        return std::vector<float>();
    };
    int const last = kSize - 1;
    // The left wall's right edge is the front wall's left one, and so on; rows count from the top. Pixel (i, k): i
    // along the edge, k pixels inside of it.
    std::vector<Edge> const edges{{"left", "front",
                                   [=](int i, int k) {
                                       return std::pair{last - k, i};
                                   },
                                   [](int i, int k) {
                                       return std::pair{k, i};
                                   }},
                                  {"front", "right",
                                   [=](int i, int k) {
                                       return std::pair{last - k, i};
                                   },
                                   [](int i, int k) {
                                       return std::pair{k, i};
                                   }},
                                  {"front", "floor",
                                   [=](int i, int k) {
                                       return std::pair{i, last - k};
                                   },
                                   [](int i, int k) {
                                       return std::pair{i, k};
                                   }},
                                  {"left", "floor",
                                   [=](int i, int k) {
                                       return std::pair{i, last - k};
                                   },
                                   [=](int i, int k) {
                                       return std::pair{k, last - i};
                                   }},
                                  {"right", "floor",
                                   [=](int i, int k) {
                                       return std::pair{i, last - k};
                                   },
                                   [=](int i, int k) {
                                       return std::pair{last - k, i};
                                   }}};
    for (Edge const& e : edges) {
        auto const a = shown(e.wall), b = shown(e.other);
        ASSERT_EQ(a.size(), std::size_t(kSize * kSize * 3));
        constexpr int kTogether = 4; // pixels along the edge: less noise, and still far less than an edge
        double sum = 0, bias = 0, most = 0;
        int count = 0;
        for (int i = 0; i < kSize; i += kTogether)
            for (int c = 0; c < 3; ++c, ++count) {
                auto const at = [&](std::vector<float> const& p, std::pair<int, int> xy) {
                    return 255 * double(p[std::size_t(3 * (xy.second * kSize + xy.first) + c)]);
                };
                double d = 0;
                for (int k = i; k < i + kTogether;
                     ++k) // on the edge itself, half a pixel outside of the last one's middle
                    d += 1.5 * at(a, e.here(k, 0)) - 0.5 * at(a, e.here(k, 1)) -
                         (1.5 * at(b, e.there(k, 0)) - 0.5 * at(b, e.there(k, 1)));
                d /= kTogether;
                sum += std::abs(d);
                most = std::max(most, std::abs(d));
                bias += d;
            }
        std::printf("%s | %s: mean difference %.3f / 255, most %.3f, of the means %.3f\n", e.wall.c_str(),
                    e.other.c_str(), sum / count, most, std::abs(bias) / count);
        EXPECT_LE(sum / count, 1.0) << e.wall << " | " << e.other;
        EXPECT_LE(std::abs(bias) / count, 0.3) << e.wall << " | " << e.other;
    }
}

} // namespace
} // namespace viewer::test
