#include "ar/light/map_file.h"

#include "gi/core/error.h"
#include "tests/ar_light/environments.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>

namespace ar::test {
namespace {

namespace fs = std::filesystem;

class MapFile : public testing::Test {
protected:
    fs::path folder = fs::temp_directory_path() / ("ar_map_file_" + std::to_string(std::uintptr_t(this)));
    void SetUp() override { fs::create_directories(folder); }
    void TearDown() override { fs::remove_all(folder); }
};

TEST_F(MapFile, ComesBackAsWellAsItsFormatCan)
{
    cv::Mat const map = drawn({32, 16}, with_discs(kRoom, {{{0, 1, 0}, 0.4, 500}}));
    write_map(folder / "a.exr", map);
    EXPECT_EQ(cv::norm(read_map(folder / "a.exr"), map, cv::NORM_INF), 0);
    write_map(folder / "a.hdr", map);
    cv::Mat const hdr = read_map(folder / "a.hdr");
    for (int k = 0; k < int(map.total()); ++k)
        for (int c = 0; c < 3; ++c) {
            cv::Vec3f const v = map.at<cv::Vec3f>(k / 32, k % 32);
            EXPECT_NEAR(hdr.at<cv::Vec3f>(k / 32, k % 32)[c], v[c], 0.01 * std::max({v[0], v[1], v[2]}));
        }
    write_map(folder / "a.png", map);
    cv::Mat const png = read_map(folder / "a.png");
    EXPECT_NEAR(png.at<cv::Vec3f>(10, 5)[2], std::min(1.0f, map.at<cv::Vec3f>(10, 5)[2]), 0.01);
    EXPECT_EQ(png.at<cv::Vec3f>(0, 5)[2], 1);
}

TEST_F(MapFile, ThatIsNoMapIsRefused)
{
    EXPECT_THROW(read_map(folder / "missing.exr"), gi::InputError);
    EXPECT_THROW(read_map(folder / "missing.hdr"), gi::InputError);
    for (char const* name : {"a.exr", "a.hdr", "a.png", "a.txt"}) {
        std::ofstream(folder / name) << "not a picture";
        EXPECT_THROW(read_map(folder / name), gi::InputError) << name;
    }
    cv::Mat const map = drawn({32, 16}, kRoom);
    for (char const* name : {"b.exr", "b.hdr", "b.png"}) {
        write_map(folder / name, map);
        fs::resize_file(folder / name, 60);
        EXPECT_THROW(read_map(folder / name), gi::InputError) << name;
        EXPECT_THROW(write_map(folder / "no" / "folder" / name, map), gi::InputError) << name;
    }
    cv::Mat bad = map.clone();
    bad.at<cv::Vec3f>(0, 0)[0] = -1;
    EXPECT_THROW(write_map(folder / "c.exr", bad), gi::InputError);
    EXPECT_THROW(write_map(folder / "c.exr", map.rowRange(0, 8)), gi::InputError);
    EXPECT_THROW(write_map(folder / "c.xyz", map), gi::InputError);
}

} // namespace
} // namespace ar::test
