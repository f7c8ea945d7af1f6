// Frames with all their bits, and the passes of composites, through the program.

#include "ar/calibration/calibration_file.h"
#include "ar/pose/pose_file.h"
#include "gi/image_io/picture_file.h"
#include "tests/viewer/run_program.h"

#include <ImathMatrix.h>
#include <ImfChromaticitiesAttribute.h>
#include <ImfFramesPerSecond.h>
#include <ImfMultiPartInputFile.h>
#include <ImfStandardAttributes.h>
#include <fmt/format.h>
#include <opencv2/imgcodecs.hpp>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

class ArPasses : public testing::Test {
protected:
    static void SetUpTestSuite()
    {
        made_ = std::make_unique<TemporaryFolder>();
        run_well("ar synthesize desk --frames 2 --size 128x96 --paths 2 --no-truth", made_->path());
    }
    static void TearDownTestSuite() { made_.reset(); }
    ArPasses() { fs::copy(*made_ / "desk", desk(), fs::copy_options::recursive); }

    fs::path desk() const { return folder_ / "desk"; }
    Outcome run(std::string const& command) const { return viewer::test::run(command, desk()); }
    void refused(std::string const& command, std::string const& with) const
    {
        Outcome const o = run(command);
        EXPECT_EQ(o.code, 2) << command;
        EXPECT_NE(o.err.find(with), std::string::npos) << o.err;
    }
    /// The session with these changes.
    void write_session(std::string const& name, std::string const& from, std::string const& to,
                       std::string const& more = {}) const
    {
        std::string text = file_text(desk() / "session.yaml");
        text.replace(text.find(from), from.size(), to);
        std::ofstream(desk() / name) << text << more;
    }
    /// Frames of linear radiance, beyond 1.
    void write_linear_frames() const
    {
        fs::create_directories(desk() / "linear");
        for (int f = 0; f < 2; ++f) {
            gi::Picture picture = gi::read_picture(desk() / fmt::format("frames/{:06}.png", f));
            for (float& v : picture.layers[0].data) v *= 1.7f;
            gi::Report report;
            gi::write_exr(desk() / fmt::format("linear/{:06}.exr", f), picture, gi::PixelType::half, report);
        }
    }

    static inline std::unique_ptr<TemporaryFolder> made_;
    TemporaryFolder folder_;
};

std::size_t layer_size(gi::Picture const& p, char const* name, int channels)
{
    gi::Layer const* const layer = p.find(name);
    EXPECT_TRUE(layer && layer->channels == channels) << name;
    return layer ? layer->data.size() : 0;
}

TEST_F(ArPasses, AreOneFileAFrameWithAllThatIsPromised)
{
    Outcome const o = run("ar run session.yaml --fast --poses poses.csv --passes passes");
    ASSERT_EQ(o.code, 0) << o.err;
    gi::Picture const p = gi::read_exr(desk() / "passes/000001.exr");
    std::size_t const n = 128 * 96;
    for (char const* name : {"color", "background", "added", "noise", "shadow", "indirect"})
        EXPECT_EQ(layer_size(p, name, 3), 3 * n);
    EXPECT_EQ(layer_size(p, "objects", 4), 4 * n);
    for (char const* name : {"coverage", "depth", "depth_place"}) EXPECT_EQ(layer_size(p, name, 1), n);
    EXPECT_EQ(layer_size(p, "motion_place", 2), 2 * n);
    EXPECT_EQ(p.metadata.at("frame"), "1");
    EXPECT_EQ(p.metadata.at("lens"), "radial_tangential");
    // Virtual objects are nearer than the place behind them.
    std::size_t covered = 0;
    for (std::size_t i = 0; i < n; ++i)
        if (p.find("coverage")->data[i] > 0.99f) {
            ++covered;
            float const place = p.find("depth_place")->data[i];
            EXPECT_TRUE(place == 0 || p.find("depth")->data[i] <= place * 1.001f) << i;
        }
    EXPECT_GT(covered, n / 100);

    Imf::MultiPartInputFile file((desk() / "passes/000001.exr").c_str());
    for (int part = 0; part < file.parts(); ++part) {
        Imf::Header const& header = file.header(part);
        ASSERT_TRUE(Imf::hasTimeCode(header) && Imf::hasChromaticities(header) && Imf::hasWorldToCamera(header));
        EXPECT_EQ(Imf::timeCode(header).frame(), 1);
        EXPECT_EQ(Imf::timeCode(header).seconds(), 0);
        EXPECT_EQ(double(Imf::framesPerSecond(header)), 30);
        EXPECT_EQ(Imf::chromaticities(header).red, Imath::V2f(0.64f, 0.33f));
    }
    ASSERT_EQ(run("ar run session.yaml --fast --poses poses.csv --passes flat --undistorted --pass-bits 32").code,
              0);
    gi::Picture const flat = gi::read_exr(desk() / "flat/000001.exr");
    EXPECT_EQ(flat.metadata.at("lens"), "pinhole");
    EXPECT_GT(flat.width, 128);
    EXPECT_EQ(flat.find("motion_place"), nullptr);
    // A corner of the board, by worldToNDC of an undistorted frame and by its pinhole. Imath's vectors are rows.
    Imf::MultiPartInputFile flat_file((desk() / "flat/000001.exr").c_str());
    Imath::V3f ndc;
    Imf::worldToNDC(flat_file.header(0)).multVecMatrix(Imath::V3f(0.1f, 0, -0.05f), ndc);
    gi::RigidPose const world_from_camera = ar::read_poses(desk() / "poses.csv", {30}).poses[1].world_from_camera;
    glm::dvec3 const seen = inverse(world_from_camera) * glm::dvec3(0.1, 0, -0.05);
    auto const two = [&](char const* key) {
        std::istringstream in(flat.metadata.at(key));
        glm::dvec2 v;
        in >> v.x >> v.y;
        return v;
    };
    glm::dvec2 const pixel = two("focal_length_px") * glm::dvec2(seen) / seen.z + two("principal_point_px");
    EXPECT_NEAR((ndc.x + 1) / 2 * flat.width - 0.5, pixel.x, 0.01);
    EXPECT_NEAR((1 - ndc.y) / 2 * flat.height - 0.5, pixel.y, 0.01);
    EXPECT_GT(pixel.x, 0) << "in the picture";
    EXPECT_LT(pixel.x, flat.width);
}

TEST_F(ArPasses, MotionLeadsToTheSamePlaceInTheFrameBefore)
{
    ASSERT_EQ(run("ar run session.yaml --fast --poses poses.csv --passes passes").code, 0);
    gi::Picture const before = gi::read_exr(desk() / "passes/000000.exr"),
                      now = gi::read_exr(desk() / "passes/000001.exr");
    EXPECT_EQ(before.find("motion_place"), nullptr);
    ar::CameraModel const camera = ar::read_calibration(desk() / "camera.yaml").camera;
    auto const poses = ar::read_poses(desk() / "poses.csv", {30}).poses;
    gi::RigidPose const before_from_now = inverse(poses[0].world_from_camera) * poses[1].world_from_camera;
    std::vector<float> const &depth = now.find("depth_place")->data,
                             &depth_before = before.find("depth_place")->data,
                             &motion = now.find("motion_place")->data;
    int seen = 0, agree = 0;
    for (int y = 0; y < 96; ++y)
        for (int x = 0; x < 128; ++x) {
            std::size_t const i = std::size_t(128 * y + x);
            auto const d = ar::direction_of(camera, {x, y});
            if (!(depth[i] > 0) || !d) continue;
            glm::dvec3 const point = before_from_now * (*d * (double(depth[i]) / d->z));
            auto const was = ar::project(camera, point);
            if (!was) continue;
            EXPECT_NEAR(motion[2 * i], was->x - x, 0.01);
            EXPECT_NEAR(motion[2 * i + 1], was->y - y, 0.01);
            auto const u = std::lround(was->x), v = std::lround(was->y);
            if (u < 0 || v < 0 || u >= 128 || v >= 96) continue;
            ++seen;
            agree += std::abs(depth_before[std::size_t(128 * v + u)] / point.z - 1) < 0.03;
        }
    EXPECT_GT(seen, 2000);
    EXPECT_GT(agree, 0.8 * seen) << "the rest was hidden behind things";
}

TEST_F(ArPasses, SayWhichPoseTheyHave)
{
    std::string const poses = file_text(desk() / "poses.csv");
    std::ofstream(desk() / "first.csv") << poses.substr(0, poses.find('\n', poses.find('\n') + 1) + 1);
    write_session("held.yaml", "schema", "schema", "pose: {hold_s: 1}\n");
    ASSERT_EQ(run("ar run held.yaml --fast --poses first.csv --passes held").code, 0);
    gi::Picture const held = gi::read_exr(desk() / "held/000001.exr");
    EXPECT_EQ(held.metadata.at("pose"), "held");
    EXPECT_EQ(held.metadata.at("shown"), "1");
    EXPECT_EQ(held.find("motion_place"), nullptr) << "nobody knows how the camera moved";
    EXPECT_EQ(held.metadata.count("motion_to_frame"), 0u);
    EXPECT_EQ(gi::read_exr(desk() / "held/000000.exr").metadata.at("pose"), "tracked");
    ASSERT_EQ(run("ar run session.yaml --fast --poses poses.csv --passes passes").code, 0);
    EXPECT_EQ(gi::read_exr(desk() / "passes/000001.exr").metadata.at("motion_to_frame"), "0");
}

TEST_F(ArPasses, OfWrongCallsAreRefused)
{
    refused("ar run session.yaml --fast --undistorted", "--passes");
    refused("ar run session.yaml --fast --pass-bits 32", "--passes");
    refused("ar run session.yaml --fast --passes frames", "frames");
    refused("ar run session.yaml --fast --passes both --out both", "both");
    write_session("bits.yaml", "schema", "schema", "passes: {folder: p, bits: 24}\n");
    refused("ar run bits.yaml --fast", "bits.yaml:10:27");
    write_session("none.yaml", "schema", "schema", "passes: {bits: 16}\n");
    refused("ar run none.yaml --fast", "folder");
    EXPECT_FALSE(fs::exists(desk() / "p"));
}

TEST_F(ArPasses, OfLinearFramesComeOutAsRadiance)
{
    write_linear_frames();
    write_session("linear.yaml", "source: frames", "source: linear");
    Outcome const o =
        run("ar run linear.yaml --fast --poses poses.csv --out out --passes passes --pass-bits 32 --video v.mkv");
    ASSERT_EQ(o.code, 0) << o.err;
    EXPECT_NE(o.out.find("2 composites reduced to 8 bits"), std::string::npos) << o.out;
    gi::Picture const in = gi::read_exr(desk() / "linear/000001.exr"),
                      out = gi::read_exr(desk() / "out/000001.exr"),
                      p = gi::read_exr(desk() / "passes/000001.exr");
    std::size_t kept = 0, changed = 0;
    for (std::size_t i = 0; i < in.pixels(); ++i) {
        bool const same = p.find("coverage")->data[i] == 0 && gi::rgb(*p.find("added"), i) == gi::vec3{0};
        if (!same) {
            changed += gi::rgb(out.layers[0], i) != gi::rgb(in.layers[0], i);
            continue;
        }
        ++kept;
        EXPECT_EQ(gi::rgb(out.layers[0], i), gi::rgb(in.layers[0], i)) << i;
    }
    EXPECT_GT(kept, in.pixels() / 10);
    EXPECT_GT(changed, in.pixels() / 20);
    // A frame that is cut is counted, with its reason; the rest is composited.
    fs::resize_file(desk() / "linear/000001.exr", fs::file_size(desk() / "linear/000001.exr") / 3);
    Outcome const cut = run("ar run linear.yaml --fast --poses poses.csv");
    EXPECT_EQ(cut.code, 0) << cut.err;
    EXPECT_NE(cut.out.find("1 refused"), std::string::npos) << cut.out;
    EXPECT_NE(cut.out.find("000001.exr"), std::string::npos) << cut.out;
}

TEST(TimeCodes, AreThoseOfTheRate)
{
    auto const text = [](std::uint64_t frame, double rate) {
        auto const t = gi::time_code_of(frame, rate);
        return t ? fmt::format("{:02}:{:02}:{:02}:{:02}{}", t->hours, t->minutes, t->seconds, t->frame,
                               t->is_second_field ? "." : "")
                 : std::string("none");
    };
    EXPECT_EQ(text(0, 25), "00:00:00:00");
    EXPECT_EQ(text(25 * 3661 + 24, 25), "01:01:01:24");
    EXPECT_EQ(text(30 * 60, 29.97), "00:01:00:00"); // not drop-frame
    EXPECT_EQ(text(59, 60), "00:00:00:29.");
    EXPECT_EQ(text(5, 0), "none");
    EXPECT_EQ(text(5, 120), "none");
    EXPECT_EQ(text(25 * 86400, 25), "none");
}

} // namespace
} // namespace viewer::test
