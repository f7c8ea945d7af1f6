// Hands in front of virtual objects, through the program: depth pictures and mattes.

#include "ar/calibration/calibration_file.h"
#include "tests/viewer/run_program.h"

#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

class ArOcclusions : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        made_ = std::make_unique<TemporaryFolder>();
        run_well("ar synthesize desk --frames 3 --size 128x96 --paths 2 --no-truth", made_->path());
        run_well("ar run session.yaml --fast --poses poses.csv --out plain", *made_ / "desk");
    }
    static void TearDownTestSuite() { made_.reset(); }
    ArOcclusions() { fs::copy(*made_ / "desk", desk(), fs::copy_options::recursive); }

    fs::path desk() const { return folder_ / "desk"; }
    Outcome run(std::string const& occlusion, std::string const& more = "--out out --stats s.json") const
    {
        std::ofstream(desk() / "s.yaml")
            << file_text(desk() / "session.yaml") << "occlusion: " << occlusion << "\n";
        return viewer::test::run("ar run s.yaml --fast --poses poses.csv " + more, desk());
    }
    void write(std::string const& folder, int number, cv::Mat const& picture) const
    {
        fs::create_directories(desk() / folder);
        cv::imwrite((desk() / folder / fmt::format("{:06}.png", number)).string(), picture);
    }
    /// A hand in the left half, the table elsewhere, as 16-bit millimetres.
    static cv::Mat hand(cv::Size size, int hand_mm = 300)
    {
        cv::Mat depth(size, CV_16UC1, cv::Scalar(5000));
        depth.colRange(0, size.width / 2) = hand_mm;
        return depth;
    }
    cv::Mat picture(std::string const& folder, int number) const
    {
        return cv::imread((desk() / folder / fmt::format("{:06}.png", number)).string());
    }
    /// Left half as the camera's frame, right half as without occlusion; some columns between are soft.
    void expect_left_hidden(int number) const
    {
        cv::Mat const out = picture("out", number), camera = picture("frames", number),
                      plain = picture("plain", number);
        EXPECT_EQ(cv::norm(out.colRange(0, 58), camera.colRange(0, 58), cv::NORM_INF), 0);
        EXPECT_EQ(cv::norm(out.colRange(70, 128), plain.colRange(70, 128), cv::NORM_INF), 0);
        EXPECT_GT(cv::norm(plain.colRange(0, 58), camera.colRange(0, 58), cv::NORM_INF), 20);
    }

    static inline std::unique_ptr<TemporaryFolder> made_;
    TemporaryFolder folder_;
};

TEST_F(ArOcclusions, ByDepthsKeepTheHand)
{
    for (int f : {0, 1, 2}) write("depth", f, hand({128, 96}));
    Outcome const o = run("{depth: depth}");
    ASSERT_EQ(o.code, 0) << o.err;
    for (int f : {0, 1, 2}) expect_left_hidden(f);
    EXPECT_NE(file_text(desk() / "s.json").find("pixels of virtual objects hidden by them"), std::string::npos);
    // Half the size, and far away: nothing is hidden.
    for (int f : {0, 1, 2}) write("far", f, hand({64, 48}, 4000));
    ASSERT_EQ(run("{depth: far}").code, 0);
    for (int f : {0, 1, 2}) EXPECT_EQ(cv::norm(picture("out", f), picture("plain", f), cv::NORM_INF), 0);
    // Holes do not hide.
    for (int f : {0, 1, 2}) write("holes", f, cv::Mat::zeros(96, 128, CV_16UC1));
    ASSERT_EQ(run("{depth: holes}").code, 0);
    EXPECT_NE(file_text(desk() / "s.json").find("without a measured depth"), std::string::npos);
    EXPECT_EQ(cv::norm(picture("out", 1), picture("plain", 1), cv::NORM_INF), 0);
}

TEST_F(ArOcclusions, OfADepthCameraBesideAreSeenByTheFrames)
{
    // The same camera a little smaller, 1 cm to the right.
    ar::Calibration c = ar::read_calibration(desk() / "camera.yaml");
    c.camera = ar::scaled(c.camera, {96, 72});
    ar::Calibration small;
    small.camera = c.camera;
    ar::write_calibration(desk() / "depth.yaml", small);
    cv::Mat near(72, 96, CV_16UC1, cv::Scalar(0));
    near.colRange(0, 48) = 500;
    for (int f : {0, 1, 2}) write("depth", f, near);
    Outcome const o = run("{depth: depth, camera: depth.yaml, camera_from_depth: {position_m: [0.01, 0, 0]}}");
    ASSERT_EQ(o.code, 0) << o.err;
    // 1 cm at half a metre: 2.2 pixels of 111 focal length to the right of the middle.
    cv::Mat const out = picture("out", 1), camera = picture("frames", 1), plain = picture("plain", 1);
    EXPECT_EQ(cv::norm(out.colRange(5, 60), camera.colRange(5, 60), cv::NORM_INF), 0);
    EXPECT_EQ(cv::norm(out.colRange(76, 128), plain.colRange(76, 128), cv::NORM_INF), 0);
}

TEST_F(ArOcclusions, ByMattesCountMissingNumbers)
{
    cv::Mat matte(96, 128, CV_8UC1, cv::Scalar(0));
    matte.colRange(0, 64) = 255;
    for (int f : {0, 2}) write("matte", f, matte);
    Outcome const o = run("{matte: matte}");
    ASSERT_EQ(o.code, 0) << o.err;
    expect_left_hidden(0);
    expect_left_hidden(2);
    EXPECT_EQ(cv::norm(picture("out", 1), picture("plain", 1), cv::NORM_INF), 0);
    EXPECT_NE(o.err.find("frames without their matte"), std::string::npos) << o.err;
    // Numbered from elsewhere.
    ASSERT_EQ(run("{matte: {source: matte, first: 1}}").code, 0);
    expect_left_hidden(1);
    // One that is cut.
    fs::resize_file(desk() / "matte/000002.png", 60);
    Outcome const cut = run("{matte: matte}");
    EXPECT_EQ(cut.code, 0);
    EXPECT_NE(cut.err.find("000002.png"), std::string::npos) << cut.err;
}

TEST_F(ArOcclusions, ThatAreWrongSayWhy)
{
    auto const refused = [this](std::string const& occlusion, std::string const& with) {
        Outcome const o = run(occlusion, "");
        EXPECT_EQ(o.code, 2) << occlusion;
        EXPECT_NE(o.err.find(with), std::string::npos) << o.err;
    };
    write("matte", 0, cv::Mat::zeros(60, 128, CV_8UC1));
    write("eight", 0, cv::Mat::zeros(96, 128, CV_8UC1));
    write("tall", 0, cv::Mat::zeros(128, 96, CV_16UC1));
    fs::create_directories(desk() / "empty");
    refused("{}", "neither 'depth' nor 'matte'");
    refused("{matte: matte}", "has 128 x 60 pixels (128 x 96 are needed)");
    refused("{depth: eight}", "16 bits");
    refused("{depth: tall}", "has 96 x 128 pixels");
    refused("{depth: missing}", "missing");
    refused("{depth: empty}", "no pictures");
    refused("{matte: eight, margin_m: 1}", "s.yaml:10:");
    refused("{depth: eight, soft_px: -1}", "s.yaml:10:");
    refused("{matte: eight, soft_px: 1}", "'soft_px' without 'depth'");
    refused("{depth: eight, camera_from_depth: {position_m: [1, 0, 0]}}", "no 'camera'");
    write("twice", 1, cv::Mat::zeros(96, 128, CV_8UC1));
    fs::copy(desk() / "twice/000001.png", desk() / "twice/b1.png");
    refused("{matte: twice}", "the number 1");
}

} // namespace
} // namespace viewer::test
