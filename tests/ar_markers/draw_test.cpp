#include "ar/markers/draw.h"

#include "gi/core/error.h"

#include <filesystem>
#include <fstream>
#include <gtest/gtest.h>
#include <opencv2/imgcodecs.hpp>

namespace ar::test {
namespace {

TEST(Draw, HasTheRightScale)
{
    MarkerMap map;
    map.markers = {{"DICT_4X4_50", 3, 0.06, {}}};
    Sheet const sheet = sheet_of(map, 0);
    EXPECT_NEAR(sheet.width_m, 0.08, 1e-12); // one of six cells on each side
    cv::Mat const picture = draw(sheet, 1000);
    ASSERT_EQ(picture.size(), cv::Size(80, 80));
    EXPECT_EQ(picture.at<std::uint8_t>(9, 40), 255);
    EXPECT_EQ(picture.at<std::uint8_t>(10, 40), 0);
    EXPECT_EQ(picture.at<std::uint8_t>(69, 69), 0);
    EXPECT_EQ(picture.at<std::uint8_t>(70, 69), 255);
    // At other scales the black covers the same area.
    cv::Mat const odd = draw(sheet, 1234.5);
    double const black = double(cv::sum(255 - odd)[0]) / 255 / (1234.5 * 1234.5);
    double const black_of_mm = double(cv::sum(255 - picture)[0]) / 255 / 1e6;
    EXPECT_NEAR(black, black_of_mm, 1e-5 * black_of_mm + 2e-6);
    EXPECT_THROW(draw(sheet, 1e7), gi::InputError);
    EXPECT_THROW(draw(sheet, std::nan("")), gi::InputError);
    EXPECT_THROW(sheet_of(map, 1), gi::InputError);
}

TEST(Draw, SvgIsInMillimetres)
{
    MarkerMap map;
    map.boards = {{2, 2, 0.05, 0.03, "DICT_4X4_50", 0, false, {}}};
    std::string const svg = to_svg(sheet_of(map, 0, 0.01));
    EXPECT_NE(svg.find("width=\"120.0000mm\" height=\"120.0000mm\""), std::string::npos) << svg;
    EXPECT_NE(svg.find("M10.0000 10.0000h50.0000v50.0000h-50.0000z"), std::string::npos) << svg;
}

TEST(Draw, PngKnowsItsDensity)
{
    MarkerMap map;
    map.grids = {{2, 3, 0.05, 0.01, "DICT_APRILTAG_36h11", 0, {}}};
    cv::Mat const picture = draw(sheet_of(map, 0), 5906);
    auto const file = std::filesystem::path(testing::TempDir()) / "lightwell_grid.png";
    write_png(file, picture, 5906);
    cv::Mat const read = cv::imread(file.string(), cv::IMREAD_GRAYSCALE);
    ASSERT_EQ(read.size(), picture.size());
    EXPECT_EQ(cv::norm(read, picture, cv::NORM_INF), 0);
    std::ifstream in(file, std::ios::binary);
    std::string const bytes((std::istreambuf_iterator<char>(in)), {});
    EXPECT_EQ(bytes.substr(37, 4), "pHYs");
    EXPECT_EQ(bytes.substr(41, 4), std::string("\0\0\x17\x12", 4)); // 5906
    std::filesystem::remove(file);
    EXPECT_THROW(write_png("/no/such/folder/a.png", picture, 5906), gi::InputError);
}

} // namespace
} // namespace ar::test
