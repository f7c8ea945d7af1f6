// What detection takes, printed. Nothing depends on it.

#include "ar/markers/detect.h"
#include "gi/core/quantile.h"
#include "tests/ar_markers/drawn_view.h"
#include "tests/ar_markers/refinement_name.h"

#include <algorithm>
#include <chrono>
#include <fmt/format.h>
#include <gtest/gtest.h>

namespace ar::test {
namespace {

TEST(Speed, OfDetection)
{
    for (glm::ivec2 const size : {glm::ivec2(640, 480), {1280, 720}, {1920, 1080}}) {
        double const f = 0.82 * size.x;
        CameraModel const camera{
            LensModel::radial_tangential, size, f, f, 0.5 * size.x, 0.5 * size.y, {-0.2, 0.05}};
        MarkerMap map;
        map.boards = {{7, 5, 0.04, 0.03, "DICT_4X4_100", 0, false, {{-0.14, -0.1, 0}, {1, 0, 0, 0}}}};
        map.markers = {{"DICT_4X4_100", 90, 0.08, {{0.25, 0, 0}, {1, 0, 0, 0}}}};
        ViewSettings settings;
        settings.rays = 2;
        DrawnWorld const world(map, camera, settings);
        std::vector<cv::Mat> pictures;
        for (int i = 0; i < 8; ++i)
            pictures.push_back(world.picture(looking({0.01 * i, 0.1, 0.9}, {0.02, 0, 0}), std::uint64_t(i)));
        for (auto const refinement : {Refinement::none, Refinement::edges, Refinement::subpixel}) {
            DetectorSettings s;
            s.refinement = refinement;
            MarkerTracker tracker(map, s);
            std::vector<double> whole, near;
            std::size_t points = 0;
            for (int i = 0; i < 24; ++i) {
                cv::Mat const& p = pictures[std::size_t(i % 14 < 8 ? i % 14 : 14 - i % 14)];
                auto const a = std::chrono::steady_clock::now();
                detect(p, map, s);
                auto const b = std::chrono::steady_clock::now();
                points = tracker.next(p).points.size();
                auto const c = std::chrono::steady_clock::now();
                whole.push_back(std::chrono::duration<double, std::milli>(b - a).count());
                near.push_back(std::chrono::duration<double, std::milli>(c - b).count());
            }
            fmt::print("{} x {}, {}: whole picture {:.1f} ms, near {:.1f} ms (medians of 24; {} points; {} of {} "
                       "searched as a whole)\n",
                       size.x, size.y, name_of(refinement), gi::median(whole), gi::median(near), points,
                       tracker.counts().whole, tracker.counts().pictures);
            EXPECT_EQ(points, 28u);
        }
    }
}

} // namespace
} // namespace ar::test
