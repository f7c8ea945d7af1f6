#include "ar/calibration/calibration_file.h"

#include "gi/core/error.h"
#include "tests/ar_calibration/synthetic_camera.h"

#include <filesystem>
#include <gtest/gtest.h>
#include <opencv2/core/persistence.hpp>
#include <unistd.h>

namespace ar::test {
namespace {

/// Of this process: others run the same test with other lenses at the same time.
std::filesystem::path own_file(std::string const& name)
{
    return std::filesystem::path(testing::TempDir()) /
           ("lightwell_" + name + "_" + std::to_string(getpid()) + ".yaml");
}

Calibration full(LensModel lens)
{
    Calibration c;
    c.camera = {lens, {640, 480}, 525.123456789012345, 530, 318.5, 243.25, {}};
    for (int i = 0; i < coefficient_count(lens); ++i) c.camera.distortion[std::size_t(i)] = 0.01 / (i + 1);
    c.rms_px = 0.12;
    int const n = 4 + coefficient_count(lens);
    c.covariance = cv::Mat::eye(n, n, CV_64F) / 3;
    c.photometry = film_photometry();
    c.photometry->vignetting = {-0.3, 0.1, -1. / 3};
    c.photometry->colour = {1.7f, -0.5f, -0.15f, -0.25f, 1.5f, -0.3f, 0.02f, -0.6f, 1.6f};
    c.photometry->reference = {0.01, 2, 1.5, 1.25};
    c.photometry->radiance_per_unit = 12.5;
    c.noise = NoiseModel{1e-6, 1e-4};
    c.provenance = {{"camera", "a \"webcam\" \\ no. 3"}, {"views", "20"}};
    return c;
}

class FileOfLens : public testing::TestWithParam<LensModel> {};
INSTANTIATE_TEST_SUITE_P(All, FileOfLens,
                         testing::Values(LensModel::pinhole, LensModel::radial_tangential, LensModel::rational,
                                         LensModel::fisheye),
                         [](auto const& p) { return name_of(p.param); });

TEST_P(FileOfLens, ComesBackAsItWasAndIsReadByOpenCv)
{
    Calibration const c = full(GetParam());
    auto const file = own_file("calibration");
    write_calibration(file, c);
    Calibration const back = read_calibration(file);
    EXPECT_EQ(back.camera, c.camera);
    EXPECT_EQ(back.rms_px, c.rms_px);
    EXPECT_EQ(cv::norm(back.covariance, c.covariance), 0);
    EXPECT_EQ(back.photometry->unit_of_byte, c.photometry->unit_of_byte);
    EXPECT_EQ(back.photometry->vignetting, c.photometry->vignetting);
    EXPECT_EQ(back.photometry->colour, c.photometry->colour);
    EXPECT_EQ(back.photometry->reference, c.photometry->reference);
    EXPECT_EQ(back.photometry->radiance_per_unit, 12.5);
    EXPECT_EQ(back.noise, c.noise);
    EXPECT_EQ(back.provenance, c.provenance);

    cv::FileStorage const storage(file.string(), cv::FileStorage::READ);
    ASSERT_TRUE(storage.isOpened());
    cv::Mat k, d, covariance, response;
    storage["camera_matrix"] >> k;
    storage["distortion_coefficients"] >> d;
    storage["covariance"] >> covariance;
    storage["response"] >> response;
    EXPECT_EQ(int(storage["image_width"]), 640);
    EXPECT_EQ(int(storage["image_height"]), 480);
    EXPECT_EQ(cv::norm(k, cv::Mat(camera_matrix(c.camera))), 0);
    ASSERT_EQ(int(d.total()), coefficient_count(GetParam()));
    EXPECT_TRUE(d.empty() || cv::norm(d, distortion_of(c.camera)) == 0);
    EXPECT_EQ(cv::norm(covariance, c.covariance), 0);
    EXPECT_EQ(response.size(), cv::Size(256, 3));
    std::filesystem::remove(file);
}

TEST(CalibrationFile, OfOpenCvIsRead)
{
    for (int const n : {0, 4, 5, 8, 14}) {
        cv::FileStorage out("c.yaml", cv::FileStorage::WRITE | cv::FileStorage::MEMORY);
        out << "calibration_time"
            << "Sun 22 Nov 2026"
            << "nr_of_frames" << 12;
        out << "camera_matrix" << cv::Mat((cv::Mat_<double>(3, 3) << 500, 0, 320, 0, 501, 240, 0, 0, 1));
        cv::Mat d = cv::Mat::zeros(n, 1, CV_64F);
        if (n > 0) d.at<double>(0) = -0.1;
        if (n > 4) d.at<double>(4) = 0.003;
        if (n > 0) out << "distortion_coefficients" << d;
        Calibration const c = parse_calibration(out.releaseAndGetString(), "c.yaml", glm::ivec2(640, 480));
        EXPECT_EQ(c.camera.lens, n == 0   ? LensModel::pinhole
                                 : n <= 5 ? LensModel::radial_tangential
                                          : LensModel::rational);
        EXPECT_EQ(c.camera.fy, 501);
        EXPECT_EQ(c.camera.distortion[0], n > 0 ? -0.1 : 0);
        EXPECT_EQ(c.camera.distortion[4], n > 4 ? 0.003 : 0);
        EXPECT_FALSE(c.photometry);
    }
}

TEST(CalibrationFile, OfRosNamesItsModel)
{
    auto const text = [](std::string const& model, std::string const& coefficients, int n) {
        return "image_width: 640\nimage_height: 480\ncamera_name: narrow\ncamera_matrix:\n  rows: 3\n  cols: 3\n"
               "  data: [500, 0, 320, 0, 501, 240, 0, 0, 1]\n" +
               model + "distortion_coefficients:\n  rows: 1\n  cols: " + std::to_string(n) + "\n  data: [" +
               coefficients +
               "]\nrectification_matrix:\n  rows: 3\n  cols: 3\n  data: [1, 0, 0, 0, 1, 0, 0, 0, 1]\n";
    };
    struct Case {
        char const *model, *coefficients;
        int n;
        LensModel lens;
    };
    for (Case const& c :
         {Case{"distortion_model: plumb_bob\n", "-0.1, 0.01, 0, 0, 0", 5, LensModel::radial_tangential},
          Case{"distortion_model: plumb_bob\n", "-0.1, 0.01, 0, 0", 4, LensModel::radial_tangential},
          Case{"distortion_model: plumb_bob\n", "", 0, LensModel::pinhole},
          Case{"distortion_model: rational_polynomial\n", "0.1, 0.01, 0, 0, 0, 0.1, 0, 0", 8, LensModel::rational},
          Case{"distortion_model: equidistant\n", "-0.02, 0.01, 0, 0", 4, LensModel::fisheye},
          Case{"distortion_model: none\n", "", 0, LensModel::pinhole},
          Case{"distortion_model: none\n", "0, 0, 0, 0, 0", 5, LensModel::pinhole},
          Case{"distortion_model: pinhole\n", "0, 0, 0, 0", 4, LensModel::pinhole},
          Case{"distortion_model: radtan\n", "-0.1, 0.01, 0, 0", 4, LensModel::radial_tangential},
          Case{"distortion_model: fisheye\n", "-0.02, 0.01, 0, 0", 4, LensModel::fisheye},
          Case{"", "-0.1, 0.01, 0, 0", 4, LensModel::radial_tangential}})
        EXPECT_EQ(parse_calibration(text(c.model, c.coefficients, c.n), "ros.yaml").camera.lens, c.lens)
            << c.model;
    for (auto const& [model, coefficients, n] :
         {std::tuple{"distortion_model: thin_prism_fisheye\n", "0, 0, 0, 0", 4},
          {"distortion_model: fov\n", "0.9", 1},
          {"distortion_model: none\n", "-0.1, 0.01, 0, 0, 0", 5},
          {"distortion_model: pinhole\n", "-0.1, 0.01, 0, 0", 4},
          {"distortion_model: equidistant\n", "-0.1, 0.01, 0, 0, 0", 5},
          {"distortion_model: rational_polynomial\n", "-0.1, 0.01, 0, 0, 0", 5},
          {"distortion_model: plumb_bob\n", "0.1, 0.01, 0, 0, 0, 0.1, 0, 0", 8}})
        EXPECT_THROW(parse_calibration(text(model, coefficients, n), "ros.yaml"), gi::InputError) << model;
}

TEST(CalibrationFile, SaysWhatIsWrongAndWhere)
{
    std::string const good = format_calibration(full(LensModel::radial_tangential));
    struct Case {
        char const *from, *to, *message;
    };
    for (Case const& c : {
             Case{"lens_model: radial", "lens_model: axial", "c.yaml:5:13: 'axial_tangential' is no lens model"},
             Case{"lens_model: radial_tangential", "lens_model: rational",
                  "5 distortion coefficients for the lens model rational"},
             Case{"rows: 3\n   cols: 3", "rows: 3\n   cols: 2", "has 9 entries (6 are needed)"},
             Case{"525.1234", ".nan", "is not a number"},
             Case{"525.1234", "1e400", "is not a number"},
             Case{"525.1234", "-525.1234", "focal lengths"},
             Case{"image_width: 640", "image_width: 0", "c.yaml:3:14: image_width is 0"},
             Case{"image_width: 640\n", "", "has no 'image_width'"},
             Case{"image_width", "image_width: 640\nimage_width", "key 'image_width' twice"},
             Case{"camera_matrix", "kamera_matrix", "has no 'camera_matrix'"},
             Case{"---", "--- [", "this is not YAML"},
             Case{"   photon", "   foton", "unknown key 'foton'"},
         }) {
        std::string text = good;
        auto const at = text.find(c.from);
        ASSERT_NE(at, std::string::npos) << c.from;
        text.replace(at, std::string(c.from).size(), c.to);
        try {
            parse_calibration(text, "c.yaml");
            ADD_FAILURE() << c.to;
        } catch (gi::InputError const& e) {
            EXPECT_NE(std::string(e.what()).find(c.message), std::string::npos) << e.what();
        }
    }
    EXPECT_THROW(read_calibration("/no/such/file.yaml"), gi::InputError);
    Calibration wrong = full(LensModel::pinhole);
    wrong.photometry->unit_of_byte[1][7] = 2;
    auto const file = own_file("wrong");
    EXPECT_THROW(write_calibration(file, wrong), gi::InputError);
    EXPECT_FALSE(std::filesystem::exists(file));
}

} // namespace
} // namespace ar::test
