// Hidden areas of lenses, as pixels and as changes of a session.

#include "viewer/protocol/hidden_mask.h"

#include "gi/core/error.h"

#include <cmath>
#include <gtest/gtest.h>
#include <numeric>

namespace viewer::test {
namespace {

int count(std::vector<std::uint8_t> const& pixels) { return std::accumulate(pixels.begin(), pixels.end(), 0); }

TEST(HiddenPixels, NoneWithoutTriangles) { EXPECT_EQ(count(hidden_pixels({}, {-1, 1, -1, 1}, 8, 6)), 0); }

/// The upper left half of an asymmetric view, either way round.
TEST(HiddenPixels, CoversMiddlesInTheTriangle)
{
    gi::ViewTangents const view{-2, 1, -1, 0.5};
    for (std::vector<std::uint32_t> const& command : {std::vector<std::uint32_t>{0, 1, 2}, {0, 2, 1}}) {
        HiddenMask const mask{{{-2, 0.5f}, {-2, -1}, {1, 0.5f}}, command};
        auto const hidden = hidden_pixels(mask, view, 30, 15);
        for (int y = 0; y < 15; ++y)
            for (int x = 0; x < 30; ++x) {
                double const sum = (x + 0.5) / 30 + (y + 0.5) / 15;
                if (std::abs(sum - 1) < 1e-6) continue; // on the edge
                EXPECT_EQ(hidden[std::size_t(y * 30 + x)], sum < 1) << x << ' ' << y;
            }
    }
}

TEST(HiddenPixels, ReachesPastThePicture)
{
    HiddenMask const mask{{{-100, 100}, {-100, -300}, {300, 100}}, {0, 1, 2}};
    EXPECT_EQ(count(hidden_pixels(mask, {-1, 1, -1, 1}, 7, 5)), 35);
    EXPECT_EQ(count(pixels_to_leave_out(mask, {-1, 1, -1, 1}, 7, 5)), 35) << "nothing is seen beside it";
}

TEST(HiddenPixels, TrianglesThatAreNoneAreLeftOut)
{
    float const nan = std::nanf("");
    HiddenMask const mask{{{-1, -1}, {1, 1}, {nan, 0}}, {0, 1, 7, 0, 1, 2, 0, 1, 1, 0}};
    EXPECT_EQ(count(hidden_pixels(mask, {-1, 1, -1, 1}, 8, 8)), 0);
}

/// Against the definition, pixel by pixel, in a view whose guard is wider than high and one where it is the least.
TEST(HiddenPixels, ThoseNearWhatIsSeenAreRendered)
{
    HiddenMask const mask{{{-1, 1}, {-1, 0}, {0.2f, 1}, {1, -1}, {0.1f, -1}, {1, 0.3f}}, {0, 1, 2, 3, 4, 5}};
    gi::ViewTangents const view{-1, 1.2, -1, 0.9};
    for (auto const& [width, height] : {std::pair{330, 210}, {64, 48}}) {
        auto const hidden = hidden_pixels(mask, view, width, height),
                   left_out = pixels_to_leave_out(mask, view, width, height);
        double const across = std::max(4.0, kHiddenGuard * width / 2.2),
                     along = std::max(4.0, kHiddenGuard * height / 1.9);
        auto const is_near = [&](int x, int y) {
            for (int v = std::max(0, y - 20); v < std::min(height, y + 21); ++v)
                for (int u = std::max(0, x - 20); u < std::min(width, x + 21); ++u)
                    if (hidden[std::size_t(v * width + u)] == 0 &&
                        std::hypot((u - x) / across, (v - y) / along) <= 1)
                        return true;
            return false;
        };
        EXPECT_GT(count(left_out), width * height / 20);
        EXPECT_LT(count(left_out), count(hidden));
        for (int y = 0; y < height; ++y)
            for (int x = 0; x < width; ++x)
                ASSERT_EQ(left_out[std::size_t(y * width + x)] != 0, !is_near(x, y))
                    << x << ' ' << y << " of " << width;
    }
}

TEST(HiddenMask, ComesThroughAnOrderInAllItsBits)
{
    HiddenMask const mask{{{-1.1f, 0.1f}, {1 / 3.0f, -2e-7f}, {0, 1e4f}}, {0, 1, 2, 2, 1, 0}};
    FrameCommand command;
    command.changes = {hidden_change("left eye", mask), hidden_change("right eye", {})};
    FrameCommand const back = command_from_bytes(to_bytes(command));
    EXPECT_TRUE(is_hidden_mask(back.changes[0].key));
    EXPECT_EQ(hidden_mask_of(back.changes[0]), (std::pair{std::string("left eye"), mask}));
    EXPECT_EQ(hidden_mask_of(back.changes[1]), (std::pair{std::string("right eye"), HiddenMask{}}));
    EXPECT_FALSE(is_hidden_mask("exposure"));
}

TEST(HiddenMask, TheLargestFitsAnOrder)
{
    HiddenMask mask;
    for (std::size_t i = 0; i < HiddenMaskLimits::points; ++i)
        mask.points.push_back({-1.17549435e-38f * float(i + 1), 0.1f + float(i) * 1.1920929e-7f});
    for (std::size_t i = 0; i < 3 * HiddenMaskLimits::triangles; ++i)
        mask.triangles.push_back(std::uint32_t(mask.points.size() - 1 - i % 7));
    FrameCommand command;
    command.changes = {hidden_change("left eye", mask)};
    EXPECT_EQ(hidden_mask_of(command_from_bytes(to_bytes(command)).changes[0]).second, mask);
    mask.points.push_back({0, 0});
    EXPECT_THROW(hidden_mask_of(hidden_change("left eye", mask)), gi::InputError);
}

TEST(HiddenMask, RefusesWhatIsNone)
{
    using Json = nlohmann::json;
    Json const points{{0, 0}, {1, 0}, {0, 1}};
    for (Json const& value :
         {Json(1), Json("round"), Json::array(), Json::object(), Json{{"points", points}},
          Json{{"points", 3}, {"triangles", {0, 1, 2}}}, Json{{"points", points}, {"triangles", "all"}},
          Json{{"points", points}, {"triangles", {0, 1}}}, Json{{"points", points}, {"triangles", {0, 1, 3}}},
          Json{{"points", points}, {"triangles", {0, 1, -1}}},
          Json{{"points", points}, {"triangles", {0, 1, 1.5}}},
          Json{{"points", points}, {"triangles", {0, 1, 18446744073709551615u}}},
          Json{{"points", {{0, 0}, {1}, {0, 1}}}, {"triangles", {0, 1, 2}}},
          Json{{"points", {{0, 0}, {1, 0, 0}, {0, 1}}}, {"triangles", {0, 1, 2}}},
          Json{{"points", {{0, 0}, {1, "0"}, {0, 1}}}, {"triangles", {0, 1, 2}}},
          Json{{"points", {{0, 0}, {1, 1e5}, {0, 1}}}, {"triangles", {0, 1, 2}}},
          Json{{"points", {{0, 0}, {1, std::nan("")}, {0, 1}}}, {"triangles", {0, 1, 2}}}})
        EXPECT_THROW(hidden_mask_of({"hidden.left eye", value}), gi::InputError) << value;
    EXPECT_THROW(hidden_mask_of({"hidden.", {{"points", points}, {"triangles", {0, 1, 2}}}}), gi::InputError);
    EXPECT_EQ(hidden_mask_of({"hidden.a", {{"points", points}, {"triangles", {0, 1, 2}}}}).second.points.size(),
              3u);
}

} // namespace
} // namespace viewer::test
