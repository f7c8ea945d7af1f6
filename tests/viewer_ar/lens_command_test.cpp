// lightwell ar lens: STMaps and OpenCV's files out, with calibrations that name a map in.

#include "ar/calibration/calibration_file.h"
#include "tests/viewer/run_program.h"

#include <fmt/format.h>
#include <opencv2/core/persistence.hpp>

namespace viewer::test {
namespace {

TEST(LensCommand, WritesMapsAndOpenCvFilesThatComeBack)
{
    TemporaryFolder folder;
    ar::Calibration c;
    c.camera = {ar::LensModel::radial_tangential, {160, 120}, 139, 138, 80.2, 58.8,
                {-0.17, 0.06, 6e-4, -9e-4, -4e-3}};
    c.rms_px = 0.2;
    ar::write_calibration(folder / "camera.yaml", c);
    Outcome const o = run("ar lens camera.yaml --stmap st.exr --undistort un.exr --opencv cv.yaml", folder.path());
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find("radial_tangential, 160 x 120 px"), std::string::npos) << o.out;
    EXPECT_EQ(o.out.find("by up to 0.00 px"), std::string::npos) << o.out;

    cv::FileStorage const file(folder / "cv.yaml", cv::FileStorage::READ);
    cv::Mat k, d;
    file["camera_matrix"] >> k;
    file["distortion_coefficients"] >> d;
    EXPECT_EQ(k.at<double>(0, 0), 139);
    EXPECT_EQ(d.at<double>(0), -0.17);
    EXPECT_EQ(ar::read_calibration(folder / "cv.yaml").camera, c.camera);

    std::ofstream(folder / "table.yaml")
        << "image_width: 160\nimage_height: 120\nstmap: st.exr\ncamera_matrix: "
           "{rows: 3, cols: 3, dt: d, data: [139, 0, 80.2, 0, 138, 58.8, 0, 0, 1]}\n";
    Outcome const again = run("ar lens table.yaml --stmap again.exr", folder.path());
    ASSERT_EQ(again.code, 0) << again.err;
    EXPECT_NE(again.out.find("stmap, 160 x 120 px"), std::string::npos) << again.out;
    EXPECT_EQ(run("ar lens table.yaml --opencv no.yaml", folder.path()).code, 2);
    EXPECT_EQ(run("ar lens camera.yaml --stmap st.png", folder.path()).code, 2);
    EXPECT_EQ(run("ar lens table.yaml --undistort st.exr", folder.path()).code, 2) << "it is read";
    EXPECT_EQ(run("ar lens missing.yaml", folder.path()).code, 2);
}

TEST(LensCommand, RefusesAPoleAndMarksWhereFisheyesHold)
{
    TemporaryFolder folder;
    auto const write = [&](char const* name, std::string const& model, int width, int height, double f,
                           std::string const& coefficients, int n) {
        std::ofstream(folder / name) << fmt::format(
            "image_width: {}\nimage_height: {}\n{}camera_matrix: {{rows: 3, cols: 3, dt: d, data: [{}, 0, {}, 0, "
            "{}, "
            "{}, 0, 0, 1]}}\ndistortion_coefficients: {{rows: 1, cols: {}, dt: d, data: [{}]}}\n",
            width, height, model, f, 0.5 * (width - 1), f, 0.5 * (height - 1), n, coefficients);
    };
    write("pole.yaml", "", 384, 218, 242.2,
          "2.9972164630889893, -6.0928826332092285, 0.0005746, -0.00004857, -1.2618762254714966, "
          "3.5340938568115234, -4.270793914794922, -5.302351951599121",
          8);
    Outcome const pole = run("ar lens pole.yaml --stmap st.exr", folder.path());
    EXPECT_EQ(pole.code, 2) << pole.out;
    EXPECT_NE(pole.err.find("its denominator is 0 within the picture"), std::string::npos) << pole.err;
    EXPECT_FALSE(std::filesystem::exists(folder / "st.exr"));

    // 115 degrees off the axis in the corners.
    write("wide.yaml", "distortion_model: equidistant\n", 160, 120, 50, "0, 0, 0, 0", 4);
    Outcome const wide = run("ar lens wide.yaml --stmap st.exr", folder.path());
    ASSERT_EQ(wide.code, 0) << wide.err;
    EXPECT_NE(wide.out.find("fisheye, 160 x 120 px"), std::string::npos) << wide.out;
    EXPECT_NE(wide.out.find("within 80 degrees of its axis"), std::string::npos) << wide.out;
    EXPECT_LT(std::stod(wide.out.substr(wide.out.find("by up to ") + 9)), 300) << wide.out;
    EXPECT_NE(wide.out.find("st.exr: "), std::string::npos) << "pixels behind the camera have no place";

    // A circular fisheye, whose polynomial folds at 1 rad, before the corners.
    write("circle.yaml", "fisheye_model: 1\n", 120, 120, 82, "-0.33333333, 0, 0, 0", 4);
    Outcome const circle = run("ar lens circle.yaml", folder.path());
    ASSERT_EQ(circle.code, 0) << circle.err;
    EXPECT_NE(circle.out.find("holds over 6"), std::string::npos) << circle.out;
}

} // namespace
} // namespace viewer::test
