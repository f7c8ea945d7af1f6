#include "gi/filter/temporal.h"

#include "gi/core/error.h"
#include "gi/core/rng.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace gi::test {
namespace {

constexpr int kWidth = 48, kHeight = 40;

struct Values {
    vec3 l0{0}, l1{0}, l2{0}, albedo{0.5f}, normal{0, 0, 1}, motion{0, 0, 2};
    float depth = 2;
};

/// A picture from what `at` says of each pixel.
template <class At>
Picture picture(At const& at)
{
    Picture p;
    p.width = kWidth;
    p.height = kHeight;
    for (char const* const name : {"color", "L0", "L1", "L2", "albedo", "normal", "motion"}) p.add(name, 3);
    p.add("depth", 1);
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            Values const v = at(x, y);
            std::size_t const i = std::size_t(y * kWidth + x);
            auto const set = [&](char const* name, vec3 value) {
                for (int c = 0; c < 3; ++c) p.find(name)->data[3 * i + std::size_t(c)] = value[c];
            };
            set("color", v.l0 + v.l1 + v.l2);
            set("L0", v.l0);
            set("L1", v.l1);
            set("L2", v.l2);
            set("albedo", v.albedo);
            set("normal", v.normal);
            set("motion", v.motion);
            p.find("depth")->data[i] = v.depth;
        }
    return p;
}

float value(Picture const& p, char const* layer, int x, int y)
{
    return p.find(layer)->data[3 * std::size_t(y * kWidth + x)];
}

/// Variance of a layer around a value, over all pixels.
double noise(Picture const& p, char const* layer, float truth)
{
    double sum = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) sum += std::pow(double(value(p, layer, x, y) - truth), 2);
    return sum / (kWidth * kHeight);
}

TEST(Temporal, AStillPictureIsTheMeanOfItsFrames)
{
    TemporalReuse reuse({.most_frames = 4});
    Pcg32 rng(1, 1);
    std::vector<double> sum(std::size_t(kWidth * kHeight), 0.0);
    for (int frame = 1; frame <= 12; ++frame) {
        Picture p = picture([&](int x, int y) {
            Values v;
            v.l0 = vec3{rng.uniform()};
            v.l1 = vec3{rng.uniform()};
            v.l2 = vec3{rng.uniform()};
            v.albedo = vec3{rng.uniform()}; // jitter over an edge of a texture
            sum[std::size_t(y * kWidth + x)] += double(v.l0.x) + double(v.l1.x) + double(v.l2.x);
            return v;
        });
        TemporalCounts const counts = reuse.add(p, frame == 1 ? SceneChange::light : SceneChange::nothing);
        EXPECT_EQ(counts.still_frames, frame);
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth; ++x)
                ASSERT_NEAR(value(p, "color", x, y), sum[std::size_t(y * kWidth + x)] / frame, 1e-4);
    }
}

/// A wall that the camera passes, by whole or broken pixels a frame: the mean has the noise of many frames, but
/// where it came into view.
TEST(Temporal, VariancesAreThoseOfTheMeans)
{
    TemporalReuse reuse({});
    Pcg32 rng(5, 5);
    for (int frame = 1; frame <= 12; ++frame) {
        Picture p = picture([&](int, int) { return Values{.l1 = vec3{0.5f}, .l2 = vec3{rng.uniform()}}; });
        reuse.add(p, SceneChange::nothing);
        Layer const &direct = *p.find("variance_direct"), &indirect = *p.find("variance_indirect");
        double mean = 0;
        for (std::size_t i = 0; i < p.pixels(); ++i) {
            mean += double(indirect.data[i]) / double(p.pixels());
            EXPECT_NEAR(direct.data[i], frame == 1 ? -1 : 0, 1e-6f) << frame;
        }
        if (frame == 1)
            EXPECT_NEAR(mean, -1, 1e-9) << "one frame tells nothing";
        else // over an albedo of a half
            EXPECT_NEAR(mean / (4 * noise(p, "L2", 0.5f)), 1, 0.15) << frame;
    }
}

/// Light that is linear in the normal stays so, in the means of both, however they are resampled.
TEST(Temporal, NormalsAreAveragedAsTheirLightIs)
{
    TemporalReuse reuse({.most_frames = 8, .most_unchanged = 64, .keep_normals = true});
    auto const lit = [](vec3 n) { return 0.6f * n.z + 0.3f * n.x; };
    Picture p;
    for (int frame = 0; frame < 20; ++frame) {
        p = picture([&](int x, int) {
            float const angle = 0.3f * std::sin((float(x) + 0.5f * float(frame)) * 0.9f);
            Values v;
            v.normal = {std::sin(angle), 0, std::cos(angle)};
            v.motion = {0.5f, 0, 2};
            v.l2 = v.albedo * lit(v.normal);
            return v;
        });
        reuse.add(p, SceneChange::motion);
    }
    Layer const& normal = *p.find("light_normal");
    double blurred = 0;
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x) {
            std::size_t const i = std::size_t(y * kWidth + x);
            ASSERT_NEAR(value(p, "L2", x, y) / 0.5f, lit(rgb(normal, i)), 1e-4f) << x << ", " << y;
            blurred = std::max(blurred, double(glm::length(rgb(normal, i) - rgb(*p.find("normal"), i))));
        }
    EXPECT_GT(blurred, 0.01) << "nothing was resampled";
}

/// A camera that moves, light that stays: the mean covers more frames than where light changes.
TEST(Temporal, UnchangedLightIsAveragedOverMoreFrames)
{
    TemporalReuse reuse({.most_frames = 8, .most_unchanged = 64}), shorter({.most_frames = 8});
    Pcg32 rng(6, 6);
    double noise_of_64 = 0, noise_of_8 = 0, renewed = 0;
    for (int frame = 1; frame <= 80; ++frame) {
        Picture p =
            picture([&](int, int) { return Values{.l1 = vec3{rng.uniform()}, .l2 = vec3{rng.uniform()}}; });
        Picture again = p;
        renewed += reuse.add(p, SceneChange::motion).renewed;
        shorter.add(again, SceneChange::motion);
        if (frame > 70) noise_of_64 += noise(p, "L2", 0.5f), noise_of_8 += noise(again, "L2", 0.5f);
    }
    EXPECT_LT(noise_of_64, 0.25 * noise_of_8);
    EXPECT_LT(renewed, 0.01 * 80 * kWidth * kHeight) << "noise is taken for a change";
}

/// Where light changes, in a part of the picture, without anything that announces it.
TEST(Temporal, ChangedLightIsAsNewAsWithoutLongMeans)
{
    TemporalReuse reuse({.most_frames = 8, .most_unchanged = 64}), shorter({.most_frames = 8});
    Pcg32 rng(7, 7);
    auto const left = [](Picture const& p) {
        double sum = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth / 2; ++x) sum += value(p, "L2", x, y);
        return sum / (kHeight * kWidth / 2);
    };
    double renewed = 0;
    for (int frame = 1; frame <= 76; ++frame) {
        Picture p = picture([&](int x, int) {
            float const light = frame > 60 && x < kWidth / 2 ? 1.2f : 1.0f;
            return Values{.l2 = light * vec3{0.5f + rng.uniform()}};
        });
        Picture again = p;
        renewed += reuse.add(p, SceneChange::motion).renewed;
        shorter.add(again, SceneChange::motion);
        EXPECT_NEAR(left(p), left(again), frame > 60 && frame < 72 ? 0.1 : 0.03) << frame;
    }
    EXPECT_GT(renewed, 0.5 * kWidth * kHeight / 2) << "of the changed pixels, most";
    EXPECT_LT(renewed, 3.0 * kWidth * kHeight / 2) << "hardly others, and not again and again";
}

/// A door that opens and closes: its light is there in the first frame.
TEST(Temporal, SuddenLightIsFollowedAtOnce)
{
    TemporalReuse reuse({.most_frames = 16, .most_unchanged = 64, .follow_sudden = true});
    Pcg32 rng(8, 8);
    for (int frame = 1; frame <= 63; ++frame) {
        float const light = frame == 61 || frame == 62 ? 5.0f : 1.0f;
        Picture p = picture([&](int x, int) { // every second path finds it
            float const here = x < kWidth / 2 ? light : 1.0f;
            return Values{.l2 = here * vec3{rng.uniform() < 0.5f ? 2.0f : 0.0f}};
        });
        double const sudden = reuse.add(p, SceneChange::motion).sudden / (kWidth * kHeight);
        double sum = 0;
        for (int y = 0; y < kHeight; ++y)
            for (int x = 0; x < kWidth / 4; ++x) sum += value(p, "L2", x, y);
        EXPECT_NEAR(sum / (kHeight * kWidth / 4), light, 0.1 * light) << frame;
        bool const switches = frame == 61 || frame == 63;
        EXPECT_LT(sudden, frame < 61 ? 0.02 : 1.0) << frame;
        EXPECT_GE(sudden, switches ? 0.3 : 0.0) << frame << ": of a half";
    }
}

/// Light that one of 20 paths finds.
TEST(Temporal, NoiseIsNoSuddenLight)
{
    TemporalReuse reuse({.most_frames = 16, .most_unchanged = 64, .follow_sudden = true});
    Pcg32 rng(9, 9);
    double sudden = 0;
    for (int frame = 1; frame <= 60; ++frame) {
        Picture p = picture([&](int, int) { return Values{.l2 = vec3{rng.uniform() < 0.05f ? 20.0f : 0.0f}}; });
        sudden += reuse.add(p, SceneChange::motion).sudden / (60.0 * kWidth * kHeight);
    }
    EXPECT_LT(sudden, 0.01);
}

/// Light known beforehand is worth some frames of it, where it is known, and only for a first frame.
TEST(Temporal, BeginsWithWhatIsKnown)
{
    auto const first = [](SceneChange change, std::size_t known) {
        TemporalReuse reuse({.most_frames = 16});
        EXPECT_TRUE(reuse.is_new());
        std::vector<KnownLight> light(known);
        for (std::size_t i = 0; i < known; ++i)
            if (i % 2 == 0) light[i] = {vec3{4}, vec3{8}, 3};
        reuse.begin_with(std::move(light));
        Picture p = picture([](int, int) { return Values{.l1 = vec3{1}, .l2 = vec3{0.5f}}; });
        TemporalCounts const counts = reuse.add(p, change);
        EXPECT_EQ(counts.started, counts.surfaces);
        EXPECT_FALSE(reuse.is_new());
        return std::pair{p, reuse};
    };
    std::size_t const all = std::size_t(kWidth * kHeight);
    auto const [p, reuse] = first(SceneChange::motion, all);
    for (int x = 0; x < kWidth; ++x) { // an albedo of a half; kWidth is even
        bool const known = x % 2 == 0;
        EXPECT_NEAR(value(p, "L1", x, 7), 0.5f * (known ? (3 * 4 + 2) / 4.0f : 2.0f), 1e-5f) << x;
        EXPECT_NEAR(value(p, "L2", x, 7), 0.5f * (known ? (3 * 8 + 1) / 4.0f : 1.0f), 1e-5f) << x;
    }
    TemporalReuse again = reuse; // what is known later is of no use
    again.begin_with(std::vector<KnownLight>(all, {vec3{100}, vec3{100}, 8}));
    Picture next = picture([](int, int) { return Values{.l1 = vec3{1}, .l2 = vec3{0.5f}}; });
    again.add(next, SceneChange::motion);
    for (int x = 0; x < kWidth; ++x) EXPECT_LT(value(next, "L1", x, 7), 2) << x;

    Picture const changed = first(SceneChange::light, all).first, none = first(SceneChange::motion, 0).first;
    for (int x = 0; x < kWidth; ++x) {
        EXPECT_NEAR(value(changed, "L1", x, 7), 1, 1e-5f) << "the light has changed";
        EXPECT_NEAR(value(none, "L1", x, 7), 1, 1e-5f);
    }
}

TEST(Temporal, LightFollowsItsSurface)
{
    for (vec3 const motion : {vec3{3, -2, 2}, vec3{0.5f, 0.25f, 2}}) {
        TemporalReuse reuse({.most_frames = 8});
        Pcg32 rng(2, 2);
        double before = 0, after = 0;
        auto const old_noise = [](Picture const& p) {
            double sum = 0;
            for (int y = 24; y < kHeight; ++y)
                for (int x = 0; x < 16; ++x) sum += std::pow(double(value(p, "L2", x, y)) - 0.5, 2);
            return sum;
        };
        for (int frame = 0; frame < 30; ++frame) {
            Picture p = picture([&](int, int) {
                Values v;
                v.l2 = vec3{0.5f * (1 + rng.uniform() - rng.uniform())};
                v.motion = motion;
                return v;
            });
            before = old_noise(p);
            reuse.add(p, SceneChange::motion);
            after = old_noise(p);
        }
        EXPECT_LT(after, before / 8); // 1/15 in the limit
        EXPECT_GT(after, before / 60);
    }
}

/// A shadow two pixels wide on a floor that begins behind a wall, while both move in the picture.
TEST(Temporal, SmallShadowsBesideAnEdgeStay)
{
    constexpr int kFrames = 50, kEdge = 24, kShadow = 2;
    constexpr float kMotion = -0.3f;
    TemporalReuse reuse({.most_frames = 8, .most_unchanged = 64, .spread = 1e3f});
    Picture p;
    for (int frame = 0; frame < kFrames; ++frame) {
        float const moved = kMotion * float(kFrames - 1 - frame);
        p = picture([&](int x, int) {
            float const behind_edge = float(x) - moved - kEdge, depth = behind_edge < 0 ? 1.0f : 2.0f;
            bool const dark = behind_edge >= 0 && behind_edge < kShadow;
            return Values{.l1 = vec3{dark ? 0.0f : 1.0f}, .motion = {kMotion, 0, depth}, .depth = depth};
        });
        reuse.add(p, SceneChange::motion);
    }
    EXPECT_LT(value(p, "L1", kEdge, kHeight / 2), 0.1f);
    EXPECT_LT(value(p, "L1", kEdge + 1, kHeight / 2), 0.1f);
    EXPECT_GT(value(p, "L1", kEdge + kShadow + 1, kHeight / 2), 0.85f);
}

TEST(Temporal, NothingOfBeforeALightChangedIsUsed)
{
    TemporalReuse reuse({});
    auto const lit = [&](float l) {
        return picture([&](int, int) { return Values{.l1 = vec3{l}, .l2 = vec3{l}}; });
    };
    for (int frame = 0; frame < 5; ++frame) {
        Picture p = lit(1);
        reuse.add(p, SceneChange::motion);
    }
    Picture dark = lit(0);
    reuse.add(dark, SceneChange::light);
    EXPECT_EQ(noise(dark, "color", 0), 0);
    for (int frame = 0; frame < 3; ++frame) {
        Picture p = lit(0);
        reuse.add(p, SceneChange::nothing);
        EXPECT_EQ(noise(p, "color", 0), 0);
    }
}

/// The shadow's edge moves 4 pixels a frame over a still wall.
TEST(Temporal, AMovingShadowLeavesNoGhost)
{
    TemporalReuse reuse({});
    for (int frame = 0; frame < 8; ++frame) {
        int const edge = 4 + 4 * frame;
        Picture p = picture([&](int x, int) { return Values{.l1 = vec3{x < edge ? 0.0f : 1.0f}}; });
        reuse.add(p, SceneChange::motion);
        for (int x = 0; x < kWidth; ++x) {
            if (std::abs(float(x) + 0.5f - float(edge)) < 3) continue;
            EXPECT_EQ(value(p, "L1", x, 20), x < edge ? 0.0f : 1.0f) << frame << " " << x;
        }
    }
}

TEST(Temporal, WhatWasHiddenStartsAfresh)
{
    TemporalReuse reuse({});
    Picture close = picture([&](int, int) { return Values{.l2 = vec3{7}, .depth = 1}; });
    reuse.add(close, SceneChange::motion);
    // The near wall disappears, and the far one appears behind it. Then a surface that faces another way,
    // then one without a previous position.
    Values const cases[] = {{.l2 = vec3{1}, .motion = {0, 0, 2}},
                            {.l2 = vec3{1}, .normal = {1, 0, 0}},
                            {.l2 = vec3{1}, .motion = vec3{std::numeric_limits<float>::quiet_NaN()}, .depth = 2},
                            {.l2 = vec3{1}, .motion = {1e30f, 0, 2}, .depth = 2}};
    for (Values const& v : cases) {
        Picture p = picture([&](int, int) { return v; });
        TemporalCounts const counts = reuse.add(p, SceneChange::motion);
        EXPECT_EQ(counts.started, counts.surfaces);
        EXPECT_EQ(noise(p, "L2", 1), 0);
    }
}

TEST(Temporal, WithoutSurfacesOrAlbedoNothingBreaks)
{
    TemporalReuse reuse({});
    for (int frame = 0; frame < 4; ++frame) {
        Picture p = picture([&](int x, int) {
            Values v{.l0 = vec3{x < 10 ? float(frame) : 2.0f}, .albedo = vec3{0}};
            v.depth = x < 10 ? 0.0f : 2.0f;
            v.l1 = vec3{x < 10 ? 0.0f : 1.0f};
            return v;
        });
        reuse.add(p, SceneChange::motion);
        EXPECT_EQ(value(p, "L0", 3, 3), float(frame)); // what is no surface is that of now
        EXPECT_EQ(value(p, "color", 20, 3), 3);
    }
}

/// A pixel that stands still beside something that moves is smoothed over the edge of a texture that it covers.
TEST(Temporal, EdgesOfTexturesAreSmoothWhereThePictureStandsStill)
{
    TemporalReuse reuse({.most_frames = 32});
    Picture p;
    for (int frame = 0; frame < 32; ++frame) {
        p = picture([&](int x, int) {
            float const a = frame % 2 == 0 ? 0.2f : 0.6f;
            return Values{.l1 = vec3{3 * a}, .albedo = vec3{a}, .motion = {x < 10 ? 0.0f : 0.7f, 0, 2}};
        });
        reuse.add(p, SceneChange::motion);
    }
    EXPECT_NEAR(value(p, "albedo", 3, 20), 0.4f, 1e-5f);
    EXPECT_NEAR(value(p, "L1", 3, 20), 1.2f, 1e-4f);
    EXPECT_NEAR(value(p, "albedo", 30, 20), 0.6f, 1e-5f);
}

TEST(Temporal, MissingLayersAreNamed)
{
    TemporalReuse reuse({});
    Picture p;
    p.width = p.height = 4;
    p.add("color", 3);
    EXPECT_THROW(reuse.add(p, SceneChange::motion), InputError);
}

/// Two eyes pass a wall; the second takes all but some columns, and there it has a mean of its own.
TEST(Temporal, ASecondEyeHasThePastOfTheFirst)
{
    TemporalReuse left({.most_frames = 8}), right({.most_frames = 8}), alone({.most_frames = 8});
    Pcg32 rng(2, 6);
    std::vector<std::uint32_t> from(std::size_t(kWidth * kHeight));
    for (std::size_t i = 0; i < from.size(); ++i) {
        std::size_t const x = i % kWidth;
        from[i] = x < 10 || x == kWidth - 1 ? kOwnLight : std::uint32_t(i + 1);
    }
    Picture a, b, c;
    for (int frame = 0; frame < 10; ++frame) {
        auto const at = [&](int, int) {
            Values v;
            v.l1 = v.l2 = vec3{rng.uniform()};
            v.motion = {-1, 0, 2};
            return v;
        };
        a = picture(at);
        b = picture([&](int x, int y) {
            Values v = at(x, y);
            v.albedo = vec3{0.25f};
            std::uint32_t const q = from[std::size_t(y * kWidth + x)];
            if (q != kOwnLight) v.l1 = v.l2 = vec3{0.5f * value(a, "L1", int(q) % kWidth, y)};
            return v;
        });
        c = b;
        SceneChange const change = frame == 0 ? SceneChange::light : SceneChange::motion;
        left.add(a, change);
        right.add(b, change, &left, from);
        alone.add(c, change);
    }
    for (int y = 0; y < kHeight; ++y)
        for (int x = 0; x < kWidth; ++x)
            for (char const* const layer : {"L1", "L2"}) {
                std::uint32_t const q = from[std::size_t(y * kWidth + x)];
                if (q != kOwnLight) {
                    ASSERT_NEAR(value(b, layer, x, y), 0.5f * value(a, layer, x + 1, y), 1e-6f) << x << " " << y;
                } else if (x < 8) { // what it asks of before is its own too
                    ASSERT_NEAR(value(b, layer, x, y), value(c, layer, x, y), 1e-5f) << x << " " << y;
                }
            }
}

/// Light over an albedo that is too dark to tell is no light over another one.
TEST(Temporal, ASecondEyeTakesNothingBetweenBlackAndWhite)
{
    TemporalReuse left({}), right({});
    std::vector<std::uint32_t> const from(std::size_t(kWidth * kHeight), 0);
    auto const of = [](float albedo) {
        return picture([&](int, int) {
            Values v;
            v.albedo = vec3{albedo};
            v.l1 = v.l2 = vec3{albedo};
            return v;
        });
    };
    Picture white = of(0.9f), black = of(0.001f);
    left.add(white, SceneChange::light);
    right.add(black, SceneChange::light, &left, from);
    EXPECT_FLOAT_EQ(value(black, "L1", 20, 20), 0.001f);
    EXPECT_FLOAT_EQ(value(black, "color", 20, 20), 0.002f);
}

} // namespace
} // namespace gi::test
