// Pictures of one sample a pixel, averaged along the motion of what they show.

#include "gi/surfaces/antialiasing.h"

#include "gi/filter/filter_input.h"

#include <cmath>
#include <gtest/gtest.h>
#include <limits>

namespace gi::test {
namespace {

constexpr int kSize = 24;

/// @param color, motion  at a place of the picture, in pixels
template <class Color, class Motion>
Picture sampled(Color const& color, Motion const& motion, vec2 at, int size = kSize, float depth = 2)
{
    Picture p{size, size, {}, {}};
    for (char const* const name : {"color", "motion"}) p.add(name, 3);
    p.add("depth", 1);
    for (int y = 0; y < size; ++y)
        for (int x = 0; x < size; ++x) {
            std::size_t const i = std::size_t(y * size + x);
            vec2 const place = vec2{float(x), float(y)} + at;
            vec3 const c{color(place)}, m = motion(place);
            for (int k = 0; k < 3; ++k) {
                p.find("color")->data[3 * i + std::size_t(k)] = c[k];
                p.find("motion")->data[3 * i + std::size_t(k)] = m[k];
            }
            p.find("depth")->data[i] = depth;
        }
    return p;
}

/// An edge across the picture, whose pixels' coverage is known.
float edge(vec2 p, float shift = 0) { return p.x + 0.3f * p.y - shift > 15 ? 1.0f : 0.0f; }
float coverage(int x, int y, float shift = 0)
{
    constexpr int kSamples = 16;
    float sum = 0;
    for (int j = 0; j < kSamples; ++j)
        for (int i = 0; i < kSamples; ++i)
            sum += edge({float(x) + (float(i) + 0.5f) / kSamples, float(y) + (float(j) + 0.5f) / kSamples}, shift);
    return sum / (kSamples * kSamples);
}
/// Root mean square of differences from the coverage, away from the borders.
template <class Value>
double edge_error(Value const& value, float shift = 0)
{
    double sum = 0;
    for (int y = 4; y < kSize - 4; ++y)
        for (int x = 4; x < kSize - 4; ++x) sum += std::pow(double(value(x, y)) - coverage(x, y, shift), 2);
    return std::sqrt(sum) / (kSize - 8);
}
float shown(Picture const& p, int x, int y) { return rgb(*p.find("color"), std::size_t(y * p.width + x)).x; }
vec3 still(vec2) { return {0, 0, 2}; }

/// Adds a picture at its own size.
Picture add(Antialiasing& a, Picture const& p) { return a.add(p, p.width, p.height); }

float ramp(vec2 at) { return 1 + 0.1f * at.x + 0.3f * at.y; }
/// Interpolated at the middles of pixels, away from the borders.
void expect_ramp(Picture const& p)
{
    for (int y = 2; y + 2 < kSize; ++y)
        for (int x = 2; x + 2 < kSize; ++x)
            ASSERT_NEAR(shown(p, x, y), ramp({float(x) + 0.5f, float(y) + 0.5f}), 1e-5f);
}

TEST(Antialiasing, FirstPictureIsInterpolated)
{
    Antialiasing a;
    Picture const p = add(a, sampled(ramp, still, a.sample()));
    expect_ramp(p);
    EXPECT_EQ(p.find("motion"), nullptr);
    EXPECT_EQ(p.find("depth")->data, std::vector<float>(p.pixels(), 2));
}

/// A picture of half the size becomes one of the whole size: an edge as with all samples, nearly.
TEST(Antialiasing, SmallerPicturesBecomeSharpOnes)
{
    auto const error_of = [](int size, float step) {
        Antialiasing a;
        double sum = 0;
        float const larger = float(kSize) / float(size);
        for (int frame = 0; frame < 32; ++frame) {
            float const shift = step * float(frame) - 4 * (step != 0);
            Picture const p = a.add(sampled([&](vec2 at) { return edge(larger * at, shift); },
                                            [&](vec2) {
                                                return vec3{-step / larger, 0, 2};
                                            },
                                            a.sample(), size),
                                    kSize, kSize);
            EXPECT_EQ(p.width, kSize);
            if (frame >= 24) sum += edge_error([&](int x, int y) { return shown(p, x, y); }, shift) / 8;
        }
        return sum;
    };
    double const hard = edge_error([](int x, int y) {
        return edge({2 * float(x / 2) + 1, 2 * float(y / 2) + 1});
    });
    RecordProperty("error", std::to_string(error_of(12, 0)) + " still, " + std::to_string(error_of(12, 0.37f)) +
                                " moving, of " + std::to_string(hard));
    EXPECT_LT(error_of(12, 0), 0.5 * hard);
    EXPECT_LT(error_of(12, 0.37f), 0.8 * hard);
    EXPECT_LT(error_of(18, 0), error_of(12, 0));
}

TEST(Antialiasing, StillEdgeBecomesItsCoverage)
{
    Antialiasing a;
    Picture p;
    for (int frame = 0; frame < 32; ++frame) {
        p = add(a, sampled([](vec2 at) { return edge(at); }, still, a.sample()));
    }
    double const hard = edge_error([](int x, int y) {
        return edge({float(x) + 0.5f, float(y) + 0.5f});
    }),
                 smooth = edge_error([&](int x, int y) { return shown(p, x, y); });
    RecordProperty("error", std::to_string(smooth) + " of " + std::to_string(hard));
    EXPECT_LT(smooth, 0.3 * hard); // measured: 0.22
}

TEST(Antialiasing, MovingEdgeIsFollowed)
{
    Antialiasing a;
    constexpr float kStep = 0.37f; // pixels a frame
    double hard = 0, smooth = 0;
    for (int frame = 0; frame < 24; ++frame) {
        float const shift = kStep * float(frame) - 4;
        Picture p = sampled([&](vec2 at) { return edge(at, shift); },
                            [](vec2) {
                                return vec3{-kStep, 0, 2};
                            },
                            a.sample());
        p = add(a, p);
        if (frame < 8) continue;
        hard += edge_error([&](int x, int y) { return edge({float(x) + 0.5f, float(y) + 0.5f}, shift); }, shift);
        smooth += edge_error([&](int x, int y) { return shown(p, x, y); }, shift);
    }
    RecordProperty("error", std::to_string(smooth) + " of " + std::to_string(hard));
    EXPECT_LT(smooth, 0.75 * hard); // measured: 0.67
}

TEST(Antialiasing, ConstantColoursStayAlsoWhenTheSizeChanges)
{
    Antialiasing a;
    for (int const size : {24, 24, 13, 1, 40, 40}) {
        Picture p = sampled([](vec2) { return 0.7f; },
                            [](vec2) {
                                return vec3{0.4f, -1.3f, 2};
                            },
                            a.sample(), size);
        p = add(a, p);
        for (float const v : p.find("color")->data) ASSERT_NEAR(v, 0.7f, 1e-5f) << size;
    }
}

/// A soft edge gets steeper, and neither darker nor brighter than what lies on its two sides.
TEST(Antialiasing, EdgesAreSharpenedWithoutHalos)
{
    auto const soft = [](vec2 at) {
        int const x = int(at.x);
        return x < 10 ? 0.2f : x == 10 ? 0.4f : x == 11 ? 0.8f : 1.0f;
    };
    Antialiasing a;
    Picture p;
    for (int frame = 0; frame < 8; ++frame) p = add(a, sampled(soft, still, a.sample()));
    EXPECT_LT(shown(p, 10, 12), 0.37f);
    EXPECT_GT(shown(p, 11, 12), 0.83f);
    for (int x = 1; x < kSize - 1; ++x) {
        EXPECT_GE(shown(p, x, 12), 0.2f - 1e-5f) << x;
        EXPECT_LE(shown(p, x, 12), 1.0f + 1e-5f) << x;
    }
}

TEST(Antialiasing, LightThatEndsIsGoneInTheNextPicture)
{
    Antialiasing a;
    for (int frame = 0; frame < 9; ++frame) {
        Picture p = sampled([&](vec2) { return frame < 8 ? 5.0f : 0.25f; }, still, a.sample());
        p = add(a, p);
        for (float const v : p.find("color")->data) ASSERT_NEAR(v, frame < 8 ? 5 : 0.25f, 1e-4f);
    }
}

TEST(Antialiasing, AnotherSurfaceAndUnknownMotionBeginAnew)
{
    for (vec3 const motion : {vec3{0, 0, 9}, vec3{std::numeric_limits<float>::quiet_NaN()}, vec3{1e30f, 0, 2},
                              vec3{-100, 0, 2}, vec3{kInf, 0, 2}}) {
        Antialiasing a;
        add(a, sampled([](vec2) { return 7.0f; }, still, a.sample()));
        expect_ramp(add(a, sampled(
                               ramp, [&](vec2) { return motion; }, a.sample())));
    }
}

TEST(Antialiasing, ValuesThatAreNotFiniteDoNotStay)
{
    Antialiasing a;
    for (int frame = 0; frame < 3; ++frame) {
        Picture p = sampled([](vec2) { return 1.0f; }, still, a.sample());
        if (frame == 0) p.find("color")->data[3 * (10 * kSize + 10)] = std::numeric_limits<float>::quiet_NaN();
        if (frame == 0) p.find("color")->data[3 * (14 * kSize + 14)] = kInf;
        p = add(a, p);
        if (frame == 0) continue;
        for (float const v : p.find("color")->data) ASSERT_NEAR(v, 1, 1e-5f);
    }
}

} // namespace
} // namespace gi::test
