// Points by their distance are those that a search of all finds.

#include "ar/features/point_grid.h"

#include <gtest/gtest.h>
#include <random>

namespace ar::test {
namespace {

TEST(PointGrids, FindWhatASearchOfAllFinds)
{
    std::mt19937 random(3);
    std::uniform_real_distribution<double> place(-2, 2), exponent(-8, 2);
    auto const somewhere = [&] { return glm::dvec3(place(random), place(random), place(random)); };
    PointGrid grid;
    std::vector<glm::dvec3> points;
    std::size_t found = 0;
    for (int k = 0; k < 3000; ++k) {
        points.push_back(somewhere());
        grid.add(points.back());
        if (k % 3 == 0) {
            std::size_t const moved = random() % points.size();
            points[moved] = k % 2 == 0 ? somewhere() : points[moved] + 0.01 * somewhere();
            grid.move(moved, points[moved]);
        }
        glm::dvec3 const at = k % 5 == 0 ? points[random() % points.size()] : somewhere();
        double const radius = k % 7 == 0 ? 0.25 : std::exp2(exponent(random));
        std::vector<std::size_t> all;
        for (std::size_t i = 0; i < points.size(); ++i)
            if (glm::length(points[i] - at) <= radius) all.push_back(i);
        ASSERT_EQ(grid.near(at, radius), all) << k;
        found += all.size();
    }
    EXPECT_GT(found, 10000u);
}

TEST(PointGrids, KnowFarAndEqualPoints)
{
    PointGrid grid;
    for (glm::dvec3 const at : {glm::dvec3(1e9, -1e9, 0), glm::dvec3(0), glm::dvec3(0), glm::dvec3(-1e-12, 0, 0)})
        grid.add(at);
    EXPECT_EQ(grid.near(glm::dvec3(0), 1e-6), (std::vector<std::size_t>{1, 2, 3}));
    EXPECT_EQ(grid.near(glm::dvec3(1e9, -1e9, 0.5), 1), (std::vector<std::size_t>{0}));
}

} // namespace
} // namespace ar::test
