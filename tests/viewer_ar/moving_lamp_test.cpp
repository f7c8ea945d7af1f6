// A lamp that is switched on, carried to the other side and switched off while a session runs.

#include "ar/light/map_file.h"
#include "ar/pipeline/bridge.h"
#include "ar/pipeline/pipeline.h"
#include "ar/pipeline/synthetic.h"
#include "gi/scene/generate/builder.h"
#include "gi/scene/generate/write_glb.h"
#include "tests/viewer/run_program.h"

#include <opencv2/imgproc.hpp>

namespace viewer::test {
namespace {

enum class Lamp { off, left, right };

/// A dark wall, and on it the lamp, at the borders of what the camera sees.
ar::Frame frame(Lamp lamp, std::uint64_t sequence)
{
    cv::Mat rgb(90, 120, CV_8UC3, cv::Scalar::all(40));
    int const x = lamp == Lamp::left ? 0 : 100;
    if (lamp != Lamp::off) cv::rectangle(rgb, {x, 20, 20, 50}, cv::Scalar::all(254), cv::FILLED);
    ar::Frame f;
    f.sequence = sequence;
    f.size_px = {120, 90};
    f.planes[0] = rgb;
    return f;
}

/// Mean radiance of the left and the right rim of the virtual ball, where a lamp from aside is seen.
std::pair<double, double> rims(ar::FrameResult const& r)
{
    cv::Mat const whole = r.pair->coverage > 0.99;
    cv::Rect const box = cv::boundingRect(whole);
    auto const mean = [&](cv::Rect const& part) {
        cv::Scalar const m = cv::mean(r.pair->with(part), whole(part));
        return (m[0] + m[1] + m[2]) / 3;
    };
    int const rim = box.width / 8;
    return {mean({box.x, box.y, rim, box.height}), mean({box.x + box.width - rim, box.y, rim, box.height})};
}

TEST(MovingLamp, IsFollowedInTheFrameThatShowsIt)
{
    TemporaryFolder const folder;
    gi::Report report;
    gi::SceneBuilder b;
    gi::Material white;
    white.base_color = gi::vec3{0.8f};
    white.specular = 0;
    b.sphere(b.add_material("ball", white), {0, 0, 0}, 0.1f, 32);
    gi::write_glb(folder / "ball.glb", b.finish("ball"), report);
    ar::Session session;
    session.virtual_things.scene = folder / "ball.glb";
    ar::write_map(folder / "dark.exr", cv::Mat(32, 64, CV_32FC3, cv::Scalar::all(0.0212)));
    session.light = folder / "dark.exr"; // what the camera never sees: as bright as the wall
    session.live_light = 1000;           // after the first frame only when a lamp changes
    session.render.paths = 32;
    session.render.denoise.denoiser = gi::Denoiser::none;
    session.render.resolution = 1;
    session.render.method = "slhb";
    session.render.settings.of<gi::SlhbSettings>().directions = "icosahedron:80";
    session.render.settings.of<gi::SlhbSettings>().resolution = 32;
    session.render.settings.of<gi::SlhbSettings>().light_samples = 8;
    session.render.settings.of<gi::SlhbSettings>().shadow_resolution = 64;
    // Wide, so that a lamp at its borders stands beside the ball and not behind it.
    ar::CalibratedCamera camera;
    camera.model = {ar::LensModel::pinhole, {120, 90}, 35, 35, 59.5, 44.5, {}};
    camera.photometry = ar::srgb_photometry();
    ar::MarkerMap markers;
    markers.markers = {{"DICT_4X4_50", 0, 0.05, {}}};
    ar::Pipeline pipeline(session, camera, markers, report);
    // A quarter of a metre before the ball, looking along -z: x is to the right.
    gi::RigidPose const pose{{0, 0, 0.25}, glm::angleAxis(glm::radians(180.0), glm::dvec3(1, 0, 0))};
    std::uint64_t sequence = 0;
    auto const seen = [&](Lamp lamp) {
        double const time_s = double(sequence) / 10;
        ar::Frame const f = frame(lamp, sequence++);
        ar::FrameResult r = pipeline.find(f, time_s, pose);
        pipeline.add(r, f, time_s, {});
        return rims(r);
    };
    // Two per cent of it are noise, the lamp adds fifteen at the rim.
    auto const before = seen(Lamp::off);
    EXPECT_NEAR(before.first / before.second, 1, 0.1);
    auto const same = seen(Lamp::off);
    EXPECT_NEAR(same.first / before.first, 1, 0.1) << "nothing has changed";
    auto const left = seen(Lamp::left);
    EXPECT_GT(left.first, 1.08 * before.first) << "in the frame in which it was switched on";
    EXPECT_GT(left.first, 1.08 * left.second);
    auto const right = seen(Lamp::right);
    EXPECT_GT(right.second, 1.08 * right.first) << "in the frame in which it was moved";
    auto const after = seen(Lamp::off);
    EXPECT_NEAR(after.first / before.first, 1, 0.15) << "in the frame in which it was switched off";
    EXPECT_NEAR(after.second / before.second, 1, 0.15);
}

} // namespace
} // namespace viewer::test
