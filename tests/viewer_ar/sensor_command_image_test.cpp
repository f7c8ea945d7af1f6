// lightwell ar vignetting, noise and colour: from pictures of a camera with known truth to its calibration file.

#include "ar/calibration/calibration_file.h"
#include "tests/ar_calibration/synthetic_camera.h"
#include "tests/viewer/run_program.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace viewer::test {
namespace {

constexpr double kRead = 4e-5, kPhoton = 6e-4;

ar::Photometry sensor_truth()
{
    ar::Photometry p = ar::test::film_photometry();
    p.vignetting = {-0.35, 0.12, -0.08};
    p.colour = {1.7f, -0.5f, -0.15f, -0.25f, 1.5f, -0.3f, 0.02f, -0.6f, 1.6f};
    return p;
}

ar::CameraModel sensor_camera()
{
    return {ar::LensModel::radial_tangential, {360, 240}, 300, 300, 179.5, 119.5, {-0.1}};
}

/// A lens and a response as the commands before these leave them.
void write_known(std::filesystem::path const& file)
{
    ar::Calibration c;
    c.camera = sensor_camera();
    c.photometry = ar::test::film_photometry();
    c.provenance = {{"made_by", "test"}};
    ar::write_calibration(file, c);
}

void save(cv::Mat const& light, std::filesystem::path const& file, std::uint64_t seed)
{
    cv::Mat bgr;
    cv::cvtColor(ar::test::photograph(light, sensor_truth(), 1, {kRead, kPhoton}, seed), bgr, cv::COLOR_RGB2BGR);
    cv::imwrite(file.string(), bgr);
}

/// Light of the sensor's own colours: what a grey wall has to be for equal units.
cv::Mat evenly_bright(double level)
{
    cv::Vec3f const l = sensor_truth().colour * cv::Vec3f(float(level), float(0.9 * level), float(0.7 * level));
    return {cv::Size(360, 240), CV_32FC3, cv::Scalar(l[0], l[1], l[2])};
}

/// The 24 patches, each a quadrilateral about its centre on a chart that is seen at an angle.
cv::Mat chart_picture(std::string& corners)
{
    auto const at = [](double column, double row) {
        auto const p =
            ar::project(sensor_camera(), {-0.3 + 0.11 * column, -0.2 + 0.12 * row, 1.0 + 0.02 * column});
        return cv::Point(int(std::lround(16 * p->x)), int(std::lround(16 * p->y))); // for 4 bits of fraction
    };
    cv::Mat light(240, 360, CV_32FC3, cv::Scalar::all(0.02));
    auto const& chart = ar::chart_linear_rgb();
    for (int i = 0; i < 24; ++i) {
        double const x = i % 6, y = i / 6;
        std::vector<cv::Point> const patch{at(x - 0.4, y - 0.4), at(x + 0.4, y - 0.4), at(x + 0.4, y + 0.4),
                                           at(x - 0.4, y + 0.4)};
        cv::Vec3f const& c = chart[std::size_t(i)];
        cv::fillConvexPoly(light, patch, 0.8 * cv::Scalar(c[0], c[1], c[2]), cv::LINE_8, 4);
    }
    for (auto const& [x, y] : {std::pair{0, 0}, {5, 0}, {5, 3}, {0, 3}}) {
        cv::Point const p = at(x, y);
        corners += fmt::format(" {:.2f},{:.2f}", p.x / 16.0, p.y / 16.0);
    }
    return light;
}

TEST(ArSensor, IsThatOfThePicturesForIt)
{
    TemporaryFolder const folder;
    write_known(folder / "camera.yaml");
    save(evenly_bright(0.3), folder / "flat1.png", 1);
    save(evenly_bright(0.5), folder / "flat2.png", 2);
    cv::Mat const still = 0.3 * ar::test::scene({360, 240});
    for (int i = 1; i <= 4; ++i) save(still, folder / fmt::format("still{}.png", i), 10 + std::uint64_t(i));
    std::string corners;
    save(chart_picture(corners), folder / "chart.png", 20);

    Outcome const flat = run_well(
        "ar vignetting flat1.png flat2.png --calibration camera.yaml --report vignetting.html", folder.path());
    Outcome const noise =
        run_well("ar noise still1.png still2.png still3.png still4.png --calibration camera.yaml "
                 "--report noise.html",
                 folder.path());
    Outcome const colour = run_well("ar colour chart.png --patches" + corners +
                                        " --calibration camera.yaml --out whole.yaml --report colour.html",
                                    folder.path());
    fmt::print("{}{}{}", flat.out, noise.out, colour.out);
    ar::Calibration const before = ar::read_calibration(folder / "camera.yaml"),
                          c = ar::read_calibration(folder / "whole.yaml");
    ar::Photometry const truth = sensor_truth();
    ASSERT_TRUE(before.photometry && before.noise && c.photometry);
    EXPECT_EQ(before.photometry->colour, cv::Matx33f::eye()) << "--out leaves the calibration as it was";
    EXPECT_EQ(c.camera, sensor_camera());
    EXPECT_EQ(c.photometry->unit_of_byte, ar::test::film_photometry().unit_of_byte);

    double vignetting_off = 0, sigma_off = 0, colour_off = 0;
    for (double r = 0; r <= 1; r += 0.05) {
        auto const left = [r](ar::Photometry const& p) {
            return 1 + r * r * (p.vignetting[0] + r * r * (p.vignetting[1] + r * r * p.vignetting[2]));
        };
        vignetting_off = std::max(vignetting_off, std::abs(left(*c.photometry) / left(truth) - 1));
    }
    for (double const unit : {0.05, 0.1, 0.3, 0.6, 0.9})
        sigma_off = std::max(sigma_off, std::abs(c.noise->sigma(unit) / std::sqrt(kRead + kPhoton * unit) - 1));
    cv::Matx33f const same = c.photometry->colour * truth.colour.inv(); // up to how bright the chart is lit
    float const scale = (same(0, 0) + same(1, 1) + same(2, 2)) / 3;
    for (int i = 0; i < 9; ++i)
        colour_off = std::max(colour_off, std::abs(double(same.val[i] / scale) - (i % 4 == 0 ? 1 : 0)));
    fmt::print("off at most: vignetting {:.2f} %, sigma {:.1f} %, colour {:.3f}\n", 100 * vignetting_off,
               100 * sigma_off, colour_off);
    EXPECT_LT(vignetting_off, 0.01);
    EXPECT_LT(sigma_off, 0.06);
    EXPECT_LT(colour_off, 0.03);

    EXPECT_NE(flat.out.find("error: "), std::string::npos);
    EXPECT_NE(flat.out.find("RMS of 3456 regions of 2 pictures"), std::string::npos);
    EXPECT_NE(noise.out.find("of 2 pairs"), std::string::npos);
    EXPECT_NE(colour.out.find("without the matrix"), std::string::npos);
    for (auto const& [page, text] : {std::pair{"vignetting.html", "Vignetting"},
                                     {"noise.html", "sigma at 0.18"},
                                     {"colour.html", "without the matrix"}}) {
        std::string const html = file_text(folder / page);
        EXPECT_NE(html.find(text), std::string::npos) << page;
        EXPECT_NE(html.find("</html>"), std::string::npos) << page;
    }
    std::map<std::string, std::string> const how(c.provenance.begin(), c.provenance.end());
    EXPECT_EQ(how.count("made_by") + how.count("vignetting") + how.count("noise") + how.count("colour"), 4u);

    // Again: what was measured before is replaced, not added to.
    run_well("ar vignetting flat1.png flat2.png --calibration whole.yaml", folder.path());
    ar::Calibration const again = ar::read_calibration(folder / "whole.yaml");
    EXPECT_EQ(again.photometry->vignetting, c.photometry->vignetting);
    EXPECT_EQ(again.photometry->colour, c.photometry->colour);
    EXPECT_EQ(again.provenance.size(), c.provenance.size());

    // The response assumed for a camera without a measured one is reported.
    ar::Calibration bare;
    bare.camera = sensor_camera();
    ar::write_calibration(folder / "bare.yaml", bare);
    EXPECT_NE(run_well("ar noise still1.png still2.png --calibration bare.yaml", folder.path()).out.find("sRGB"),
              std::string::npos);
}

TEST(ArSensor, RefusesWhatTellsNothing)
{
    TemporaryFolder const folder;
    write_known(folder / "camera.yaml");
    save(evenly_bright(0.3), folder / "flat.png", 1);
    cv::imwrite((folder / "white.png").string(), cv::Mat(240, 360, CV_8UC3, cv::Scalar::all(255)));
    cv::imwrite((folder / "small.png").string(), cv::Mat(120, 180, CV_8UC3, cv::Scalar::all(99)));
    std::string corners;
    save(chart_picture(corners), folder / "chart.png", 20);
    std::string const turned = corners.substr(corners.find(' ', 1)) + corners.substr(0, corners.find(' ', 1));
    auto const before = folder.files();
    std::string const text = file_text(folder / "camera.yaml"),
                      to = " --calibration camera.yaml --report page.html";
    for (auto const& [arguments, mentions] : std::vector<std::pair<std::string, std::string>>{
             {"ar vignetting white.png", "clipped"},
             {"ar vignetting small.png", "180 x 120"},
             {"ar vignetting none.png", "none.png"},
             {"ar noise flat.png", "pairs"},
             {"ar noise flat.png flat.png", "do not differ"},
             {"ar colour flat.png --patches 10,10 20,10 20,20", "3 centres"},
             {"ar colour flat.png --patches 10,10 20,1o 20,20 10,20", "20,1o"},
             {"ar colour flat.png --patches 10,10 200,100 200,10 10,100", "corner patches"},
             {"ar colour flat.png --patches 30,30 300,30 300,200 30,200", "span colours"},
             {"ar colour chart.png --patches" + turned, "delta E"},
             {"ar colour white.png --patches 30,30 300,30 300,200 30,200", "clipped"},
             {"ar colour flat.png --patches 2,2 300,30 300,200 30,200 --half 20", "beyond the picture"}}) {
        Outcome const o = run(arguments + to, folder.path());
        EXPECT_EQ(o.code, 2) << arguments << o.out;
        EXPECT_NE(o.err.find(mentions), std::string::npos) << arguments << "\n" << o.err;
        EXPECT_EQ(std::count(o.err.begin(), o.err.end(), '\n'), 1) << arguments << "\n" << o.err;
    }
    EXPECT_EQ(run("ar noise flat.png flat.png --calibration none.yaml", folder.path()).code, 2);
    EXPECT_EQ(folder.files(), before);
    EXPECT_TRUE(file_text(folder / "camera.yaml") == text);
}

} // namespace
} // namespace viewer::test
