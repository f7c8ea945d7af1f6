#pragma once
// The walls of a CAVE are one picture: what neighbours show along their common edge.

#include "gi/image/tone_map.h"
#include "tests/support/scenes.h"
#include "viewer/display/display_file.h"
#include "viewer/display/views.h"
#include "viewer/session/session.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>
#include <gtest/gtest.h>

namespace viewer::test {

constexpr int kCaveWall_px = 64;

/// Differences of tone-mapped values along an edge of two walls, of 255; with their signs, three per pixel.
struct Seam {
    std::string walls;
    std::vector<double> differences;

    /// Of means of `together` pixels along the edge, without signs.
    std::vector<double> means_of(int together) const
    {
        std::vector<double> means;
        for (std::size_t i = 0; i + 3 * std::size_t(together) <= differences.size();
             i += 3 * std::size_t(together))
            for (std::size_t c = 0; c < 3; ++c) {
                double sum = 0;
                for (std::size_t k = 0; k < std::size_t(together); ++k) sum += differences[i + 3 * k + c];
                means.push_back(std::abs(sum / together));
            }
        return means;
    }
    double bias() const
    {
        double sum = 0;
        for (double const d : differences) sum += d;
        return std::abs(sum) / double(differences.size());
    }
};

inline double mean(std::vector<double> const& v)
{
    double sum = 0;
    for (double const x : v) sum += x;
    return sum / double(v.size());
}
inline double most(std::vector<double> const& v) { return *std::max_element(v.begin(), v.end()); }

/// A matt room, wider than the CAVE, with a lamp.
inline std::shared_ptr<gi::Scene const> room_around_cave(std::string const&, gi::Report&)
{
    using namespace gi::test;
    gi::Scene scene;
    add_box(scene, {-4, 0, -4}, {4, 5, 4}, add_material(scene, lambert(gi::vec3{0.7f, 0.6f, 0.5f})), true);
    add_quad(scene, {-1.5f, 4.99f, -1.5f}, {3, 0, 0}, {0, 0, 3}, add_material(scene, emitter(gi::vec3{4})));
    return std::make_shared<gi::Scene const>(std::move(scene));
}

/// Renders `frames` frames of 16 paths that stand still, and looks along the five edges of
/// data/displays/cave4.yaml.
inline std::vector<Seam> cave_seams(int frames)
{
    gi::Report report;
    Display display = load_display(LIGHTWELL_SOURCE_DIR "/data/displays/cave4.yaml", report);
    constexpr int kSize = kCaveWall_px, kLast = kSize - 1;
    for (Wall& wall : display.walls) {
        wall.stereo = StereoMode::off;
        wall.render_width_px = wall.render_height_px = kSize;
    }
    std::vector<std::optional<RoomPose>> const heads{RoomPose{{0.3, 1.6, 0.2}, {1, 0, 0, 0}}};
    FrameOrder order;
    order.views = view_orders(views_of(display, heads), gi::dmat4(1));
    Session session(room_around_cave, 0, report);
    session.apply({"directions", "icosahedron:1280"});
    session.apply({"denoise", "none"});
    session.apply({"scene", "room"});
    order.paths = 16;
    SessionFrame frame;
    for (int f = 0; f < frames; ++f) {
        order.frame = std::uint64_t(f);
        frame = session.render(order, {});
    }
    auto const shown = [&](std::string const& name) {
        for (std::size_t k = 0; k < order.views.size(); ++k)
            if (order.views[k].name.starts_with(name))
                return gi::tone_map(*frame.views[k].picture.find("color"), {1, gi::ToneCurve::srgb});
        return std::vector<float>();
    };
    // The left wall's right edge is the front wall's left one, and so on; rows count from the top. Pixel (i, k): i
    // along the edge, k pixels inside of it.
    struct Edge {
        std::string wall, other;
        std::function<std::pair<int, int>(int i, int k)> here, there; ///< pixels of both
    };
    auto const left = [](int i, int k) { return std::pair{k, i}; };
    auto const right = [](int i, int k) { return std::pair{kLast - k, i}; };
    auto const top = [](int i, int k) { return std::pair{i, k}; };
    auto const bottom = [](int i, int k) { return std::pair{i, kLast - k}; };
    auto const left_from_below = [](int i, int k) { return std::pair{k, kLast - i}; };
    std::vector<Edge> const edges{{"left", "front", right, left},
                                  {"front", "right", right, left},
                                  {"front", "floor", bottom, top},
                                  {"left", "floor", bottom, left_from_below},
                                  {"right", "floor", bottom, right}};
    std::vector<Seam> seams;
    for (Edge const& e : edges) {
        auto const a = shown(e.wall), b = shown(e.other);
        Seam seam{e.wall + " | " + e.other, {}};
        if (a.size() != std::size_t(kSize * kSize * 3) || b.size() != a.size()) {
            ADD_FAILURE() << "no picture of " << seam.walls;
            return {};
        }
        auto const at = [&](std::vector<float> const& p, std::pair<int, int> xy, int c) {
            return 255 * double(p[std::size_t(3 * (xy.second * kSize + xy.first) + c)]);
        };
        // On the edge itself, half a pixel outside of the last one's middle: the line that fits four pixels best.
        constexpr double kWeights[] = {0.85, 0.45, 0.05, -0.35};
        for (int i = 0; i < kSize; ++i)
            for (int c = 0; c < 3; ++c) {
                double d = 0;
                for (int k = 0; k < 4; ++k) d += kWeights[k] * (at(a, e.here(i, k), c) - at(b, e.there(i, k), c));
                seam.differences.push_back(d);
            }
        seams.push_back(std::move(seam));
    }
    return seams;
}

} // namespace viewer::test
