#include "ar/calibration/report.h"

#include "tests/ar_calibration/synthetic_camera.h"

#include <gtest/gtest.h>

namespace ar::test {
namespace {

TEST(Report, IsOnePageWithAllThereIs)
{
    CameraModel const camera{LensModel::pinhole, {640, 480}, 525, 525, 320, 240, {}};
    CalibrationReport r;
    for (int k = 0; k < 6; ++k) {
        BoardView v;
        v.name = k == 2 ? "<b>third</b>" : "view";
        gi::RigidPose const p =
            pose_of({0.3 * std::sin(2. * k), 0.3 * std::cos(3. * k), 0.1 * k}, {-0.1, -0.05, 0.5 + 0.02 * k});
        for (int i = 0; i < 40; ++i) {
            v.board_m.emplace_back(0.03 * (i % 8), 0.03 * (i / 8), 0);
            v.pixels.push_back(*project(camera, p * v.board_m.back()) +
                               0.1 * glm::dvec2(std::sin(9. * i), std::cos(7. * i)));
        }
        r.views.push_back(v);
    }
    for (auto& p : r.views[4].pixels) p += 3. * glm::dvec2(std::sin(p.y), std::cos(p.x));
    r.lens = calibrate_lens(r.views, camera.size_px, LensModel::pinhole);
    r.photometry = film_photometry();
    r.noise = NoiseModel{1e-6, 1e-4};
    r.background = cv::Mat(480, 640, CV_8UC3, cv::Scalar(90, 120, 60));
    std::string const html = to_html(r);
    for (char const* text : {"data:image/jpeg;base64,", "&lt;b&gt;third", "left out: its error",
                             "standard deviation", ">fx<", "Vignetting leaves 100.0 %", "only 5 views", "</html>"})
        EXPECT_NE(html.find(text), std::string::npos) << text;
    EXPECT_EQ(html.find("<b>third"), std::string::npos);
    EXPECT_EQ(html.find("http"), std::string::npos) << "it needs nothing from elsewhere";
}

} // namespace
} // namespace ar::test
