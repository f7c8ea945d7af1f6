#include "gi/core/rng.h"
#include "gi/hit_buffers/directions/axis_set.h"
#include "gi/hit_buffers/directions/directions.h"
#include "tests/support/scenes.h"

#include <gtest/gtest.h>
#include <utility>

namespace gi::test {
namespace {

/// A room, and in it a ball and a grating (with holes, if asked) that move.
World world_at(float t, bool holes)
{
    Scene scene;
    int const m = add_material(scene, lambert(vec3{0.5f}));
    Material cut = lambert(vec3{0.7f});
    if (holes) {
        cut.alpha_mode = AlphaMode::blend;
        cut.alpha = 0.5f;
    }
    int const moving = add_material(scene, cut);
    add_box(scene, {-2, -2, -2}, {2, 2, 2}, m, true);
    add_sphere(scene, {-0.7f, -1, 0.2f}, 0.8f, 3, m, false);
    add_sphere(scene, {0.9f - t, 0.3f, 0.8f * std::sin(3 * t)}, 0.4f, 3, moving, false);
    add_quad(scene, {-1, -1.5f + t, -1}, {1, 0.2f * t, 0}, {0, 0, 1}, moving);
    return world_of(scene);
}

constexpr std::size_t kStays = 12 + 1280; // triangles: the box and the first sphere

/// Everything of a scene that moves, with what an AxisSet needs.
struct Moving {
    World world;
    TriangleSoup soup;
    CutOuts cut_outs;

    Moving(float t, bool holes) : world(world_at(t, holes)), soup(make_soup(world)), cut_outs(world) {}
    AxisSet::Source source(bool split, std::uint32_t most_layers) const
    {
        return {.bounds = {vec3{-2}, vec3{2}},
                .windows = {{vec3{-1}, vec3{0.5f}}},
                .soup = soup,
                .cut_outs = cut_outs,
                .resolution = 40,
                .most_layers = most_layers,
                .packed = false,
                .seed = 5,
                .first_moving = split ? kStays : soup.count};
    }
    void go_to(float t, bool holes)
    {
        world = world_at(t, holes);
        cut_outs = CutOuts(world);
        update_soup(world, kStays, soup);
    }
};

/// The layers of all texels of all axes, one column after the other.
std::vector<std::vector<std::pair<float, std::uint32_t>>> columns(AxisPool const& pool)
{
    std::vector<std::vector<std::pair<float, std::uint32_t>>> out;
    for (std::size_t a = 0; a < pool.size(); ++a)
        for (std::size_t t = 0; t < pool.grids[a].texels(); ++t) {
            LayerRange const r = pool.column(pool.first_offset[a] + t);
            auto& column = out.emplace_back();
            for (std::uint32_t k = r.begin; k < r.end; ++k) {
                HitLayer const& l = pool.layers[pool.first_layer[a] + k];
                column.emplace_back(l.depth, l.primitive);
            }
        }
    return out;
}

QueryBatch ask(World const& world, AxisPool const& pool)
{
    Pcg32 rng(9, 9);
    QueryBatch batch;
    batch.resize(20000);
    for (std::size_t k = 0; k < batch.size(); ++k) {
        std::uint32_t const t = rng.next() % std::uint32_t(world.triangles.size()), a = rng.next() % pool.size();
        Surface const& s = world.surfaces[t];
        vec2 u = rng.uniform2();
        if (u.x + u.y > 1) u = 1.0f - u;
        float const cosine = glm::dot(glm::normalize(glm::cross(s.edge1, s.edge2)), pool.grids[a].axis);
        batch.set(k,
                  {s.corner + u.x * s.edge1 + u.y * s.edge2, t, cosine > 0, rng.uniform() < 0.5f,
                   std::sqrt(1 - cosine * cosine) / std::abs(cosine)},
                  a);
    }
    nearest_layers(pool, world.surfaces, batch);
    return batch;
}

class Appended : public testing::TestWithParam<std::tuple<bool, std::uint32_t>> {};

/// Frame after frame, what is appended to what stays is what would be built from everything, bit for bit.
TEST_P(Appended, IsWhatIsBuiltFromEverything)
{
    auto const [holes, most_layers] = GetParam();
    Moving moving(0, holes);
    DirectionSet const directions = make_directions("icosahedron:80");
    AxisSet split(moving.source(true, most_layers));
    split.store(directions);
    for (float const t : {0.0f, 0.3f, 1.1f, 0.6f}) {
        moving.go_to(t, holes);
        split.moved();
        split.update_axes();
        AxisSet whole(moving.source(false, most_layers));
        whole.store(directions);
        ASSERT_EQ(columns(split.pool()), columns(whole.pool())) << t;
        QueryBatch const one = ask(moving.world, split.pool()), other = ask(moving.world, whole.pool());
        EXPECT_EQ(one.hit, other.hit);
        EXPECT_EQ(one.hit_x, other.hit_x);
        EXPECT_EQ(one.hit_y, other.hit_y);
        EXPECT_EQ(one.hit_z, other.hit_z);
        EXPECT_EQ(most_layers > 0, whole.lost() > 0);
    }
}

INSTANTIATE_TEST_SUITE_P(Scenes, Appended,
                         testing::Combine(testing::Bool(), testing::Values(std::uint32_t(0), std::uint32_t(3))));

/// Axes that come and go pass after pass, while things move.
TEST(Moving, FreshAxesHaveWhatMovesToo)
{
    Moving moving(0, false);
    AxisSet split(moving.source(true, 0));
    for (std::uint32_t pass = 0; pass < 6; ++pass) {
        moving.go_to(0.2f * float(pass), false);
        split.refresh(2, 6, 2, pass);
        split.moved();
        split.update_axes();
        AxisSet whole(moving.source(false, 0));
        whole.refresh(2, 6, 2, pass);
        ASSERT_EQ(columns(split.pool()), columns(whole.pool())) << pass;
    }
}

TEST(Moving, WhatLeavesTheBuffersLeavesNothingBehind)
{
    Moving moving(0, false);
    AxisSet split(moving.source(true, 0));
    split.store(make_directions("octahedron:8"));
    auto const still = columns(split.pool());
    split.moved();
    split.update_axes();
    EXPECT_NE(columns(split.pool()), still);
    moving.go_to(1e6f, false); // far outside every grid
    split.moved();
    split.update_axes();
    EXPECT_EQ(columns(split.pool()), still);
}

/// Of stored axes those that follow are as if built from everything, and paths take no others; in as many turns as
/// there are parts, each axis has its turn once for each bounce.
TEST(Moving, SomeAxesFollowInTurns)
{
    constexpr std::uint32_t kBounces = 3, kCount = 8, kParts = 5;
    Moving moving(0, true);
    DirectionSet const directions = make_directions("icosahedron:80");
    AxisSet some(moving.source(true, 0));
    some.store(directions);
    for (std::uint32_t cycle = 0; cycle < 3; ++cycle) {
        std::vector<std::array<int, kBounces>> times(directions.axes.size());
        for (std::uint32_t turn = 0; turn < kParts; ++turn) {
            moving.go_to(0.1f * float(kParts * cycle + turn), true);
            some.moved();
            some.update_some_axes(kBounces, kCount, kParts * cycle + turn);
            AxisSet whole(moving.source(false, 0));
            whole.store(directions);
            auto const one = columns(some.pool()), other = columns(whole.pool());
            std::size_t const texels = some.pool().grids[0].texels();
            for (std::uint32_t b = 0; b < kBounces; ++b)
                for (std::size_t k = 0; k < some.few()[b].count; ++k) {
                    std::size_t const a = some.few()[b].slot[k];
                    ++times[a][b];
                    for (std::size_t t = a * texels; t < (a + 1) * texels; ++t) ASSERT_EQ(one[t], other[t]);
                }
        }
        for (auto const& each : times)
            for (int const n : each) EXPECT_EQ(n, 1);
    }
    some.update_axes();
    AxisSet whole(moving.source(false, 0));
    whole.store(directions);
    EXPECT_EQ(columns(some.pool()), columns(whole.pool()));
}

/// The mean over all turns of what some axes bring is what all of them bring.
TEST(Moving, SomeAxesBringWhatAllDo)
{
    constexpr std::uint32_t kParts = 10, kTurns = 4 * kParts;
    constexpr int kTurnSamples = 2000;
    Moving moving(0, false);
    AxisSet set(moving.source(true, 0));
    set.store(make_directions("icosahedron:320"));
    for (vec3 const normal : {vec3{0, 0, 1}, glm::normalize(vec3{1, -2, 0.3f})})
        for (std::uint32_t bounce : {0u, 2u}) {
            auto const mean = [&] {
                vec3 sum{0};
                for (int k = 0; k < kTurnSamples; ++k) {
                    AxisSample const s = set.sample(bounce, normal, (float(k) + 0.5f) / kTurnSamples);
                    sum += s.weight * vec3{1, s.direction.x * s.direction.x, std::max(0.0f, s.direction.y)};
                }
                return sum / float(kTurnSamples);
            };
            set.update_axes();
            vec3 const all = mean();
            vec3 some{0};
            for (std::uint32_t turn = 0; turn < kTurns; ++turn) {
                set.update_some_axes(3, 16, turn);
                some += mean() / float(kTurns);
            }
            for (int c = 0; c < 3; ++c) EXPECT_NEAR(some[c], all[c], 4e-3f) << c;
        }
}

} // namespace
} // namespace gi::test
