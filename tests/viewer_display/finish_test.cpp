// Edge blending makes overlapping pictures as bright as a single one; meshes that fold are refused.

#include "tests/viewer_display/display_samples.h"
#include "tests/viewer_display/mesh_samples.h"
#include "viewer/displays/blend.h"

#include <limits>

namespace viewer::test {
namespace {

/// (u, v) of a point in the plane of a wall.
glm::dvec2 on_wall(WallFrame const& w, gi::dvec3 p)
{
    return {glm::dot(p - w.lower_left, w.right) / w.width_m, glm::dot(p - w.lower_left, w.up) / w.height_m};
}

TEST(Blend, ProjectorsOfThePowerWallAddUpToOne)
{
    Display const d = shipped("powerwall.yaml");
    int overlapped = 0;
    for (int j = 0; j <= 230; ++j)
        for (int i = 0; i <= 560; ++i) {
            gi::dvec3 const p{-2.8 + 0.01 * i, 0.5 + 0.01 * j, 0};
            double light = 0;
            int lit = 0;
            for (Wall const& wall : d.walls) {
                WallFrame const frame = wall_frame(wall.corners);
                glm::dvec2 at = on_wall(frame, p);
                for (int k = 0; k < 2; ++k) // rounding at the outer edges
                    if (std::abs(at[k] - std::round(at[k])) < 1e-9) at[k] = std::round(at[k]);
                double const weight = blend_weight(wall.blend, frame.width_m, frame.height_m, at.x, at.y);
                double const value = encoded_weight(wall.blend, weight); // what a shader multiplies by
                light += std::pow(value, wall.blend.gamma);
                lit += weight > 0;
            }
            ASSERT_NEAR(light, 1, 1e-9) << p.x << " " << p.y;
            overlapped += lit == 4;
        }
    EXPECT_GT(overlapped, 500); // corners where four projectors meet
}

TEST(Blend, OutsideAndWithoutBands)
{
    WallBlend const none;
    EXPECT_EQ(blend_weight(none, 2, 1, 0, 0), 1);
    EXPECT_EQ(blend_weight(none, 2, 1, 1, 1), 1);
    EXPECT_EQ(blend_weight(none, 2, 1, 1.001, 0.5), 0);
    EXPECT_EQ(blend_weight(none, 2, 1, std::numeric_limits<double>::quiet_NaN(), 0.5), 0);
    WallBlend left;
    left.left_m = 0.5;
    EXPECT_EQ(blend_weight(left, 2, 1, 0, 0.5), 0);
    EXPECT_EQ(blend_weight(left, 2, 1, 0.125, 0.5), 0.5);
    EXPECT_EQ(blend_weight(left, 2, 1, 0.0625, 0.5), 0.125);
    EXPECT_EQ(blend_weight(left, 2, 1, 0.1875, 0.5), 0.875);
    EXPECT_EQ(blend_weight(left, 2, 1, 0.25, 0.5), 1);
    Wall wall;
    EXPECT_FALSE(needs_finish(wall));
    wall.gain = {1, 0.9, 1};
    EXPECT_TRUE(needs_finish(wall));
    wall = {};
    wall.blend = left;
    EXPECT_TRUE(needs_finish(wall));
}

TEST(WallMesh, APlainMeshChangesNothing)
{
    WallMesh const mesh = plain_mesh(5, 4);
    EXPECT_FALSE(find_fault(mesh));
    for (double const x : {0.0, 0.1, 0.5, 0.99, 1.0})
        for (double const y : {0.0, 0.3, 1.0}) {
            auto const p = picture_at(mesh, {x, y});
            ASSERT_TRUE(p);
            EXPECT_NEAR(p->x, x, 1e-12);
            EXPECT_NEAR(p->y, y, 1e-12);
        }
    EXPECT_FALSE(picture_at(mesh, {1.01, 0.5}));
}

TEST(WallMesh, BentMeshesAreLinearBetweenTheirNodes)
{
    WallMesh mesh = plain_mesh(3, 3);
    mesh.nodes[4].place = {0.6, 0.45};
    EXPECT_FALSE(find_fault(mesh));
    auto const middle = picture_at(mesh, {0.6, 0.45});
    ASSERT_TRUE(middle);
    EXPECT_NEAR(middle->x, 0.5, 1e-12);
    auto const half = picture_at(mesh, {0.3, 0.225}); // half way along the diagonal of the first cell
    ASSERT_TRUE(half);
    EXPECT_NEAR(half->x, 0.25, 1e-12);
    EXPECT_NEAR(half->y, 0.25, 1e-12);
    for (WarpNode& n : mesh.nodes) n.place.x = 1 - n.place.x; // for a screen seen from behind
    EXPECT_FALSE(find_fault(mesh));
    EXPECT_NEAR(picture_at(mesh, {0.4, 0.45})->x, 0.5, 1e-12);
}

TEST(WallMesh, WhatCannotBeDrawnIsRefused)
{
    auto const fault = [](auto const& spoil) {
        WallMesh mesh = plain_mesh(4, 3);
        spoil(mesh);
        return find_fault(mesh).value_or("");
    };
    auto const has = [](std::string const& text, char const* part) {
        return text.find(part) != std::string::npos;
    };
    EXPECT_PRED2(has, fault([](WallMesh& m) { m.nodes[5].place.x = 0.9; }), "folds at cell");
    WallMesh calibrated = plain_mesh(31, 31); // 1800 triangles
    calibrated.nodes[40].place.x = 0.9;       // 3 of them turned
    for (std::size_t i = 0; i < 31; ++i) calibrated.nodes[i].place.y = calibrated.nodes[31 + i].place.y;
    EXPECT_EQ(find_fault(calibrated), std::nullopt);
    EXPECT_GE(find_flaws(calibrated).flat, 50u);
    EXPECT_GE(find_flaws(calibrated).folded, 1u);
    for (std::size_t i = 341; i < 480; i += 2) calibrated.nodes[i].place.x += 0.1;
    EXPECT_NE(find_fault(calibrated), std::nullopt);
    EXPECT_PRED2(has, fault([](WallMesh& m) { m.nodes[5].place = m.nodes[4].place; }), "is flat");
    EXPECT_PRED2(has, fault([](WallMesh& m) { m.nodes.pop_back(); }), "need 12 nodes, there are 11");
    EXPECT_PRED2(has, fault([](WallMesh& m) { m.rows = 1; }), "2 to 257");
    EXPECT_PRED2(has, fault([](WallMesh& m) { m.nodes[0].place.y = -1.5; }), "farther outside the viewport");
    EXPECT_PRED2(has, fault([](WallMesh& m) { m.nodes[0].picture.y = 1.01; }), "outside the picture");
    EXPECT_PRED2(has, fault([](WallMesh& m) { m.nodes[0].place.x = std::numeric_limits<double>::quiet_NaN(); }),
                 "farther outside");
}

} // namespace
} // namespace viewer::test
