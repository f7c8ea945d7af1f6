// Pass-through in the headset of a real runtime; what both eyes were given is looked at.

#include "ar/pose/pose_file.h"
#include "ar/runtime/runner.h"
#include "tests/viewer_xr/monado.h"
#include "tests/viewer_xr/remote_driver.h"
#include "viewer/devices/gl/pass_through_pass.h"

#include "ar/composite/warp.h"
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

constexpr std::array<std::array<float, 4>, 2> kFov{{{-0.6f, 0.5f, 0.5f, -0.45f}, {-0.5f, 0.6f, 0.45f, -0.5f}}};
constexpr double kEyes_m = 0.032; ///< of each from the middle

TEST(HmdCommand, RefusesWithoutARuntimeInOneLine)
{
    TemporaryFolder const folder;
    run_well("ar synthesize desk --frames 1 --size 64x48 --paths 1 --no-truth", folder.path());
    Child program({LIGHTWELL_PROGRAM, "ar", "run", (folder / "desk/session.yaml").string(), "--hmd"},
                  folder.path(), "run", {"XR_RUNTIME_JSON=/nonexistent.json", "DISPLAY="});
    EXPECT_EQ(program.wait(Seconds(60)), 2);
    EXPECT_EQ(program.out(), "");
    std::string const err = program.err();
    EXPECT_TRUE(err.starts_with("lightwell: there is no OpenXR runtime (")) << err;
    EXPECT_EQ(std::count(err.begin(), err.end(), '\n'), 1) << err;
}

class PassThroughInMonado : public Monado {
protected:
    void SetUp() override
    {
        Monado::SetUp();
        if (IsSkipped()) return;
        run_well("ar synthesize desk --frames 6 --size 160x120 --paths 4 --no-truth", folder.path());
        run_well("ar run desk/session.yaml --fast --poses desk/poses.csv --out out", folder.path());
    }

    Child& start(std::string const& session)
    {
        int const port = free_port();
        start_service({"--remote", std::to_string(port)});
        remote_.emplace(port);
        remote_->set_head({{0, 0, 0, 1}, {0, 1.6f, 0}});
        remote_->set_eyes({RemoteEye{kFov[0], {{0, 0, 0, 1}, {float(-kEyes_m), 0, 0}}},
                           RemoteEye{kFov[1], {{0, 0, 0, 1}, {float(kEyes_m), 0, 0}}}});
        remote_->send_all();
        std::vector<std::string> call{kScript, "client", "--dir", runtime_folder(), "--", LIGHTWELL_PROGRAM};
        for (std::string const& a :
             {std::string("ar"), std::string("run"), (folder / "desk" / session).string(), std::string("--hmd"),
              std::string("--fast"), std::string("--poses"), (folder / "desk/poses.csv").string(),
              std::string("--eyes"), (folder / "eyes").string()})
            call.push_back(a);
        return program_.emplace(call, folder.path(), "run", std::vector<std::string>{"DISPLAY="});
    }

    /// What the eye should see of a composite that stands 1 m before a camera in the middle of the head.
    cv::Mat expected(std::size_t eye, cv::Mat const& composite, glm::ivec2 size_px) const
    {
        ar::CameraModel const camera = ar::load_camera(folder / "desk/camera.yaml").model;
        ar::CameraModel const pinhole = ar::covering_pinhole(camera);
        cv::Mat const lens = ar::remap_table(pinhole, camera);
        gi::Camera seen;
        auto const& f = kFov[eye];
        seen.off_axis = gi::ViewTangents{std::tan(f[0]), std::tan(f[1]), std::tan(f[3]), std::tan(f[2])};
        seen.world_from_camera[3] = glm::dvec4(eye == 0 ? -kEyes_m : kEyes_m, 1.6, 0, 1);
        gi::RigidPose const room_from_camera{{0, 1.6, 0}, glm::dquat(0, 1, 0, 0)};
        glm::dmat3 const m = pinhole_from_eye(seen, size_px, pinhole, room_from_camera, 1);
        cv::Mat at(size_px.y, size_px.x, CV_32FC2), map, picture;
        for (int y = 0; y < size_px.y; ++y)
            for (int x = 0; x < size_px.x; ++x) {
                glm::dvec3 const p = m * glm::dvec3(x + 0.5, y + 0.5, 1);
                at.at<cv::Vec2f>(y, x) = {float(p.x / p.z), float(p.y / p.z)};
            }
        cv::remap(lens, map, at, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT, cv::Scalar::all(-1e4));
        cv::remap(composite, picture, map, cv::noArray(), cv::INTER_LINEAR, cv::BORDER_CONSTANT);
        return picture;
    }

    void expect_eyes(Child& program)
    {
        ASSERT_EQ(program.wait(Seconds(120)), 0) << program.out() << program.err();
        std::string const out = program.out();
        std::puts(out.c_str());
        EXPECT_NE(out.find("focused"), std::string::npos) << out;
        EXPECT_NE(out.find("6 composites, camera found in 6"), std::string::npos) << out;
        cv::Mat const composite = cv::imread((folder / "out/000005.png").string());
        ASSERT_FALSE(composite.empty());
        for (std::size_t eye = 0; eye < 2; ++eye) {
            char const* const name = eye == 0 ? "left.png" : "right.png";
            if (char const* keep = std::getenv("LIGHTWELL_TEST_PICTURES"))
                fs::copy_file(folder / "eyes" / name, fs::path(keep) / name, fs::copy_options::overwrite_existing);
            cv::Mat const seen = cv::imread((folder / "eyes" / name).string());
            ASSERT_FALSE(seen.empty());
            cv::Mat const wanted = expected(eye, composite, {seen.cols, seen.rows});
            cv::Mat difference, most;
            cv::absdiff(seen, wanted, difference);
            cv::reduce(difference.reshape(1, int(difference.total())), most, 1, cv::REDUCE_MAX);
            double const off = double(cv::countNonZero(most > 8)) / double(most.total());
            double const black = double(cv::countNonZero(seen.reshape(1) == 0)) / double(3 * seen.total());
            std::printf("%s: %.2f %% of pixels off by more than 8 of 255, mean %.2f, %.0f %% black\n", name,
                        100 * off, cv::mean(difference)[0], 100 * black);
            EXPECT_LT(off, 0.02) << name; // the rim of the picture
            EXPECT_LT(black, 0.6) << "there is a picture";
        }
    }

    std::optional<RemoteDriver> remote_;
    std::optional<Child> program_;
};

TEST_F(PassThroughInMonado, BothEyesSeeTheCompositeWhereTheCameraWas) { expect_eyes(start("session.yaml")); }

/// The right eye has a camera of its own, which is where the left one is: both see the same.
TEST_F(PassThroughInMonado, EachEyeMayHaveItsOwnCamera)
{
    std::ofstream(folder / "desk/stereo.yaml")
        << file_text(folder / "desk/session.yaml")
        << "hmd: {right: {source: frames, camera: camera.yaml, left_from_right: {position_m: [0, 0, 0]}}}\n";
    expect_eyes(start("stereo.yaml"));
    EXPECT_NE(program_->out().find("right source: 6 frames"), std::string::npos) << program_->out();
}

} // namespace
} // namespace viewer::test
