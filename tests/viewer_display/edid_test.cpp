#include "viewer/displays/edid.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace viewer::test {
namespace {

std::vector<unsigned char> edid(std::string const& name)
{
    std::vector<unsigned char> b(128, 0);
    unsigned char const head[]{0,    0xff, 0xff, 0xff, 0xff, 0xff, 0xff, 0,  0x10,
                               0xac, 0x34, 0x12, 1,    0,    0,    0,    20, 30};
    std::copy(std::begin(head), std::end(head), b.begin());
    b[21] = 60;
    b[22] = 34;
    b[54] = 1; // a mode of 597 x 336 mm
    b[54 + 12] = 597 & 0xff;
    b[54 + 13] = 336 & 0xff;
    b[54 + 14] = (597 >> 8) << 4 | 336 >> 8;
    auto const text = [&](std::size_t at, unsigned char kind, std::string const& t) {
        b[at + 3] = kind;
        for (std::size_t i = 0; i < 13; ++i)
            b[at + 5 + i] = i < t.size() ? static_cast<unsigned char>(t[i]) : i == t.size() ? '\n' : ' ';
    };
    text(72, 0xfc, name);
    text(90, 0xff, "8KV9X13");
    unsigned sum = 0;
    for (std::size_t i = 0; i < 127; ++i) sum += b[i];
    b[127] = static_cast<unsigned char>(256 - sum % 256);
    return b;
}

TEST(Edid, HasNameSerialSizeAndYear)
{
    auto const m = parse_edid(edid("DELL U2720Q"));
    ASSERT_TRUE(m);
    EXPECT_EQ(m->maker, "DEL");
    EXPECT_EQ(to_text(*m), "DELL U2720Q 8KV9X13 (2020)");
    EXPECT_NEAR(m->width_cm, 59.7, 1e-9);
    EXPECT_NEAR(m->height_cm, 33.6, 1e-9);
}

TEST(Edid, DamageIsNoMonitor)
{
    auto bytes = edid("X");
    bytes[30] ^= 1;
    EXPECT_FALSE(parse_edid(bytes)) << "checksum";
    EXPECT_FALSE(parse_edid({}));
    for (std::size_t n = 0; n < 128; ++n)
        EXPECT_FALSE(parse_edid({bytes.begin(), bytes.begin() + std::ptrdiff_t(n)}));
}

TEST(Edid, ConnectorsAreFoundByTheirNamesInX)
{
    auto const drm = std::filesystem::path(testing::TempDir()) / "lightwell_drm";
    std::filesystem::create_directories(drm / "card0-HDMI-A-1");
    auto const bytes = edid("EIZO CG2420");
    std::ofstream(drm / "card0-HDMI-A-1" / "edid", std::ios::binary)
        .write(reinterpret_cast<char const*>(bytes.data()), std::streamsize(bytes.size()));
    EXPECT_TRUE(monitor_at("HDMI-1", drm));
    EXPECT_TRUE(monitor_at("HDMI-A-1", drm));
    EXPECT_FALSE(monitor_at("DP-1", drm));
    EXPECT_FALSE(monitor_at("DP-1", drm / "nowhere"));
}

} // namespace
} // namespace viewer::test
