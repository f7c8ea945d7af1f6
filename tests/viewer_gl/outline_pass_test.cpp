// Stairs of a slanted edge come nearer to what each pixel covers; evenness and soft textures stay.

#include "viewer/devices/gl/outline_pass.h"

#include "tests/viewer_gl/surfaceless.h"

#include <epoxy/gl.h>

namespace viewer::test {
namespace {

constexpr int kSide = 48;

class OutlinePassTest : public Surfaceless {
protected:
    /// @param grey  of each pixel, 0..1   @return the red bytes of the smoothed picture
    static std::vector<int> smoothed(auto const& grey)
    {
        std::vector<unsigned char> rgba;
        for (int y = 0; y < kSide; ++y)
            for (int x = 0; x < kSide; ++x) {
                auto const v = static_cast<unsigned char>(255 * grey(x, y) + 0.5);
                rgba.insert(rgba.end(), {v, v, v, 255});
            }
        TextureTarget const from(TextureTarget::Format::bytes, {kSide, kSide}),
            to(TextureTarget::Format::bytes, {kSide, kSide});
        glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
        glTextureSubImage2D(from.shown().texture, 0, 0, 0, kSide, kSide, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
        OutlinePass().draw(to.target(), from.shown());
        std::vector<unsigned char> const rgb = read_bytes(to.target());
        std::vector<int> red;
        for (std::size_t i = 0; i < rgb.size(); i += 3) red.push_back(rgb[i]);
        return red;
    }
};

TEST_F(OutlinePassTest, BringsSlantedEdgesNearer)
{
    double all_before = 0, all_after = 0;
    for (double const slope : {0.1, 0.3, 0.7, 1.0, 2.5}) {
        auto const above = [&](double x, double y) { return y < 10.3 + slope * (x - 20); };
        auto const covered = [&](int x, int y) {
            int n = 0;
            for (int k = 0; k < 256; ++k) n += above(x + (k % 16 + 0.5) / 16, y + (k / 16 + 0.5) / 16);
            return n / 256.0;
        };
        std::vector<int> const red = smoothed([&](int x, int y) { return above(x + 0.5, y + 0.5) ? 0.9 : 0.1; });
        double before = 0, after = 0;
        for (int y = 2; y < kSide - 2; ++y)
            for (int x = 2; x < kSide - 2; ++x) {
                double const right = 0.1 + 0.8 * covered(x, y), was = above(x + 0.5, y + 0.5) ? 0.9 : 0.1;
                before += (was - right) * (was - right);
                after += std::pow(red[std::size_t(y * kSide + x)] / 255.0 - right, 2);
            }
        EXPECT_LT(after, 1.01 * before) << slope;
        all_before += before;
        all_after += after;
    }
    EXPECT_LT(all_after, 0.6 * all_before);
}

TEST_F(OutlinePassTest, LeavesWhatIsEvenOrSoft)
{
    auto const soft = [](int x, int y) { return 0.5 + 0.02 * ((x * 7 + y * 13) % 3 - 1); };
    std::vector<int> const red = smoothed(soft);
    for (int y = 0; y < kSide; ++y)
        for (int x = 0; x < kSide; ++x) EXPECT_EQ(red[std::size_t(y * kSide + x)], int(255 * soft(x, y) + 0.5));
}

} // namespace
} // namespace viewer::test
