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

} // namespace
} // namespace viewer::test
