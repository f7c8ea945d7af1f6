// STMaps: written as Nuke has them, read back as a lens.

#include "ar/calibration/stmap.h"

#include "ar/calibration/calibration_file.h"
#include "ar/composite/warp.h"
#include "gi/core/error.h"
#include "gi/image_io/picture_file.h"

#include <ImfChannelList.h>
#include <ImfFrameBuffer.h>
#include <ImfHeader.h>
#include <ImfOutputFile.h>
#include <array>
#include <fmt/format.h>
#include <gtest/gtest.h>
#include <opencv2/core/persistence.hpp>
#include <unistd.h>

namespace ar::test {
namespace {

std::filesystem::path own(std::string const& name)
{
    return std::filesystem::path(testing::TempDir()) / fmt::format("lightwell_{}_{}", getpid(), name);
}

CameraModel camera_with(LensModel lens)
{
    CameraModel c{lens, {320, 240}, 262, 265, 158.5, 122.25, {}};
    if (lens == LensModel::radial_tangential) c.distortion = {-0.28, 0.09, 0.001, -0.0007, -0.01};
    if (lens == LensModel::rational) c.distortion = {0.4, 0.1, 0.0005, -0.0003, 0.02, 0.7, 0.2, 0.03};
    if (lens == LensModel::fisheye) c.distortion = {0.03, -0.01, 0.004, -0.001};
    return c;
}

std::string text_of(CameraModel const& camera)
{
    Calibration c;
    c.camera = camera;
    return format_calibration(c);
}

std::string refusal(CameraModel const& camera, std::filesystem::path const& file)
{
    try {
        with_stmap(camera, file);
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return "none";
}

TEST(StMaps, HaveNukesConvention)
{
    CameraModel pinhole = camera_with(LensModel::pinhole);
    cv::Mat const st = stmap_of(pinhole, StMap::distort);
    EXPECT_NEAR(st.at<cv::Vec2f>(0, 0)[0], 0.5 / 320, 1e-7); // the upper left pixel: s small, t near 1
    EXPECT_NEAR(st.at<cv::Vec2f>(0, 0)[1], 1 - 0.5 / 240, 1e-7);
    EXPECT_NEAR(st.at<cv::Vec2f>(239, 319)[0], 1 - 0.5 / 320, 1e-7);
    EXPECT_NEAR(st.at<cv::Vec2f>(239, 319)[1], 0.5 / 240, 1e-7);
}

class StMapOf : public testing::TestWithParam<LensModel> {};
INSTANTIATE_TEST_SUITE_P(Lenses, StMapOf,
                         testing::Values(LensModel::pinhole, LensModel::radial_tangential, LensModel::rational,
                                         LensModel::fisheye),
                         [](auto const& p) { return name_of(p.param); });

TEST_P(StMapOf, IsReadBackAsTheLens)
{
    CameraModel const lens = camera_with(GetParam());
    auto const file = own("lens.exr");
    write_stmap(file, stmap_of(lens, StMap::distort));
    CameraModel const table = with_stmap(lens, file);
    EXPECT_EQ(table.lens, LensModel::stmap);
    double ray = 0, pixel = 0, back = 0;
    for (double y = -0.5; y <= 239.5; y += 3.7)
        for (double x = -0.5; x <= 319.5; x += 3.7) {
            auto const a = direction_of(lens, {x, y}), b = direction_of(table, {x, y});
            ASSERT_TRUE(a && b) << x << ' ' << y;
            ray = std::max(ray, 262 * glm::length(*a / a->z - *b / b->z));
            auto const p = project(table, *a), q = project(table, *b);
            ASSERT_TRUE(p && q);
            pixel = std::max(pixel, glm::length(*p - glm::dvec2(x, y)));
            back = std::max(back, glm::length(*q - glm::dvec2(x, y)));
        }
    fmt::print("{}: rays off by {:.2g} px, points by {:.2g} px, inverse by {:.2g} px\n", name_of(GetParam()), ray,
               pixel, back);
    // Bilinear between pixels of a small picture, and continued linearly beyond the outermost centres.
    EXPECT_LT(ray, 1e-2);
    EXPECT_LT(pixel, 1e-2);
    EXPECT_LT(back, 1e-7);
    // The undistorting map is its inverse: of the lens and of the table alike.
    cv::Mat const of_lens = stmap_of(lens, StMap::undistort), of_table = stmap_of(table, StMap::undistort);
    for (int y = 20; y < 220; y += 7)
        for (int x = 20; x < 300; x += 7) {
            cv::Vec2f const v = of_lens.at<cv::Vec2f>(y, x), w = of_table.at<cv::Vec2f>(y, x);
            if (w[0] < 0) continue; // outside of the camera's picture, where the table ends
            EXPECT_NEAR(v[0], w[0], 2e-5);
            EXPECT_NEAR(v[1], w[1], 2e-5);
        }
    std::filesystem::remove(file);
}

TEST(StMaps, WorkInCalibrationsAndPictures)
{
    CameraModel const lens = camera_with(LensModel::radial_tangential);
    auto const map = own("distort.exr"), file = own("camera.yaml");
    write_stmap(map, stmap_of(lens, StMap::distort));
    Calibration c;
    c.camera = lens;
    c.camera.lens = LensModel::pinhole;
    c.camera.distortion = {};
    c.stmap = map;
    write_calibration(file, c);
    Calibration const back = read_calibration(file);
    EXPECT_EQ(back.camera.lens, LensModel::stmap);
    EXPECT_EQ(std::filesystem::weakly_canonical(back.stmap), std::filesystem::weakly_canonical(map));
    write_calibration(file, back); // as `ar response` does
    EXPECT_EQ(read_calibration(file).camera.lens, LensModel::stmap);
    // The pictures that are rendered for it, and their warp, are those of the lens.
    CameraModel const a = covering_pinhole(lens), b = covering_pinhole(back.camera);
    EXPECT_LE(std::abs(a.size_px.x - b.size_px.x), 2);
    EXPECT_LE(std::abs(a.size_px.y - b.size_px.y), 2);
    EXPECT_LT(cv::norm(remap_table(lens, a), remap_table(back.camera, a), cv::NORM_INF), 5e-3);
    CameraModel const half = scaled(back.camera, {160, 120});
    auto const d = direction_of(back.camera, {100.5, 80.5}), h = direction_of(half, {50, 40});
    EXPECT_NEAR(glm::length(*d - *h), 0, 1e-9);
    std::filesystem::remove(map);
    std::filesystem::remove(file);
}

/// Single precision, with an alpha beside s and t. @param data  window
void write_with_alpha(std::filesystem::path const& file, cv::Mat st, Imath::Box2i const& data,
                      std::array<char const*, 2> const& names)
{
    Imf::Header h({{0, 0}, {st.cols - 1, st.rows - 1}}, data);
    Imf::FrameBuffer buffer;
    std::vector<float> alpha(st.total(), 1.0f);
    auto* const at = reinterpret_cast<char*>(st.ptr<float>());
    for (std::size_t c = 0; c < 2; ++c) {
        h.channels().insert(names[c], Imf::Channel(Imf::FLOAT));
        buffer.insert(names[c], Imf::Slice(Imf::FLOAT, at + c * sizeof(float), sizeof(cv::Vec2f), st.step[0]));
    }
    h.channels().insert("A", Imf::Channel(Imf::FLOAT));
    buffer.insert("A", Imf::Slice(Imf::FLOAT, reinterpret_cast<char*>(alpha.data()), sizeof(float),
                                  sizeof(float) * std::size_t(st.cols)));
    Imf::OutputFile out(file.c_str(), h);
    out.setFrameBuffer(buffer);
    out.writePixels(data.max.y - data.min.y + 1);
}

TEST(StMaps, MayHaveAnAlphaAndOtherNames)
{
    CameraModel const lens = camera_with(LensModel::radial_tangential);
    auto const file = own("alpha.exr");
    cv::Mat const st = stmap_of(lens, StMap::distort);
    for (auto const& names : {std::array{"R", "G"}, {"r", "g"}, {"red", "green"}}) {
        write_with_alpha(file, st, {{0, 0}, {319, 239}}, names);
        gi::Report report;
        CameraModel const table = with_stmap(lens, file, &report);
        auto const a = direction_of(lens, {20, 30}), b = direction_of(table, {20, 30});
        ASSERT_TRUE(a && b);
        EXPECT_LT(glm::length(*a / a->z - *b / b->z), 1e-4) << names[0];
        EXPECT_TRUE(report.losses().empty());
    }
    // Zeros outside of the data window fold the map: the cause is named.
    write_with_alpha(file, st, {{0, 0}, {299, 239}}, {"R", "G"});
    gi::Report report;
    EXPECT_THROW(with_stmap(lens, file, &report), gi::InputError);
    EXPECT_NE(refusal(lens, file).find("its data window covers 300 x 240 of 320 x 240"), std::string::npos)
        << refusal(lens, file);
    EXPECT_EQ(report.losses().at("STMaps not used as they are").count, 1u);
    std::filesystem::remove(file);
}

TEST(StMaps, ThatAreWrongSayWhy)
{
    CameraModel const lens = camera_with(LensModel::radial_tangential);
    auto const file = own("bad.exr");
    cv::Mat const good = stmap_of(lens, StMap::distort);
    write_stmap(file, good(cv::Rect(0, 0, 300, 240)).clone());
    EXPECT_NE(refusal(lens, file).find("300 x 240 pixels (the calibration is of 320 x 240)"), std::string::npos)
        << refusal(lens, file);
    cv::Mat folded = good.clone();
    folded.at<cv::Vec2f>(100, 50) = {0.9f, 0.1f};
    write_stmap(file, folded);
    EXPECT_NE(refusal(lens, file).find("it folds"), std::string::npos) << refusal(lens, file);
    folded.at<cv::Vec2f>(100, 50) = {NAN, 0};
    write_stmap(file, folded);
    EXPECT_NE(refusal(lens, file).find("pixel (50, 100)"), std::string::npos) << refusal(lens, file);
    gi::Picture other{320, 240, {}, {}};
    other.add("uv", 2);
    gi::Report report;
    gi::write_exr(file, other, gi::PixelType::half, report);
    EXPECT_NE(refusal(lens, file).find("no channels R and G"), std::string::npos) << refusal(lens, file);
    std::filesystem::resize_file(file, 600);
    EXPECT_NE(refusal(lens, file).find("bad.exr"), std::string::npos);
    std::filesystem::remove(file);
    EXPECT_NE(refusal(lens, file), "none");

    std::string const text = text_of(lens);
    auto const parsed = [&](std::string const& more) {
        try {
            parse_calibration(text + more, "c.yaml");
        } catch (gi::InputError const& e) {
            return std::string(e.what());
        }
        return std::string("none");
    };
    EXPECT_NE(parsed("stmap: a.exr\n").find("distorted twice"), std::string::npos) << parsed("stmap: a.exr\n");
    std::string table = text_of(camera_with(LensModel::pinhole));
    table.replace(table.find("lens_model: pinhole"), 19, "lens_model: stmap");
    EXPECT_THROW(parse_calibration(table, "c.yaml"), gi::InputError);
}

} // namespace
} // namespace ar::test
