#include "ar/runtime/counter_check.h"

#include "ar/calibration/calibration_file.h"
#include "ar/capture/counter_source.h"
#include "ar/markers/marker_map_file.h"
#include "gi/scene/generate/builder.h"
#include "gi/scene/generate/write_glb.h"

#include <cmath>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

constexpr double kDistance_m = 1, kWayPerFrame = 0.02, kWay = 0.25; // of the picture's width; to either side
constexpr double kFocal = 0.9;                                      // of the picture's width

/// Looks along -z; to the left and right by a triangle wave.
gi::RigidPose pose_of_frame(std::uint64_t number)
{
    auto const steps = std::uint64_t(std::lround(2 * kWay / kWayPerFrame)); // from one side to the other
    std::uint64_t const k = number % (2 * steps);
    double const side = kWay - kWayPerFrame * double(k < steps ? k : 2 * steps - k);
    return {{side * kDistance_m / kFocal, 0, 0}, glm::dquat(0, 1, 0, 0)};
}

} // namespace

gi::RigidPose CounterSession::camera_at(double since_frame_0_s) const
{
    constexpr double kRounding = 1e-4; // of a frame
    double const frames = std::max(since_frame_0_s * rate_hz + kRounding, 0.0);
    auto const before = std::uint64_t(frames);
    gi::RigidPose pose = pose_of_frame(before);
    double const part = frames - double(before);
    if (part > 2 * kRounding) pose.position = glm::mix(pose.position, pose_of_frame(before + 1).position, part);
    return pose;
}

CounterSession make_counter_session(std::filesystem::path const& folder, glm::ivec2 size_px, double rate_hz,
                                    gi::Report& report)
{
    CounterSession c;
    c.rate_hz = rate_hz;
    c.camera.size_px = size_px;
    c.camera.fx = c.camera.fy = kFocal * size_px.x;
    c.camera.cx = 0.5 * (size_px.x - 1);
    c.camera.cy = 0.5 * (size_px.y - 1);
    Calibration calibration;
    calibration.camera = c.camera;
    calibration.photometry = srgb_photometry();
    Session& s = c.session;
    s.file = folder / "session.yaml";
    s.camera = folder / "camera.yaml";
    s.markers = folder / "markers.yaml";
    s.virtual_things.scene = folder / "ball.glb";
    write_calibration(s.camera, calibration);
    Marker marker; // never detected: poses are supplied
    marker.dictionary = "DICT_4X4_50";
    marker.side_m = 0.1;
    write_marker_map(s.markers, {{marker}, {}, {}});
    gi::SceneBuilder b;
    gi::Material white;
    white.base_color = gi::vec3(0);
    white.emission = gi::vec3(1.5f); // white in every byte
    b.sphere(b.add_material("white", white), {0, 0, -float(kDistance_m)}, 0.05f, 32);
    gi::write_glb(s.virtual_things.scene, b.finish("ball"), report);
    s.frames.source = "counter";
    s.frames.options.size_px = size_px;
    s.frames.options.frames_per_s = rate_hz;
    s.render.paths = 1;
    s.render.resolution = 1;
    s.render.settings.bounces = 1;
    s.render.denoise.denoiser = gi::Denoiser::none;
    return c;
}

std::optional<glm::dvec2> ball_in(cv::Mat const& rgb)
{
    // The generated pattern has less blue than this; numbers are in the upper tenth.
    cv::Mat blue;
    cv::extractChannel(rgb.rowRange(rgb.rows / 8, rgb.rows), blue, 2);
    cv::Moments const m = cv::moments(blue > 200, true);
    if (m.m00 < 4) return std::nullopt;
    return glm::dvec2(m.m10 / m.m00, m.m01 / m.m00 + rgb.rows / 8);
}

glm::dvec2 ball_from(CameraModel const& camera, gi::RigidPose const& world_from_camera)
{
    return project(camera, inverse(world_from_camera) * glm::dvec3(0, 0, -kDistance_m)).value_or(glm::dvec2(-1e3));
}

void CounterCheck::add(RunFrame const& f, cv::Mat const& shown, bool in_window, double before_s, double after_s)
{
    ++verdict_.frames;
    std::optional<std::uint32_t> const number = read_counter(shown);
    if (!number) {
        ++verdict_.unread;
        return;
    }
    if (*number != std::uint32_t(f.sequence)) ++verdict_.other;

    cv::Size const size(session_.camera.size_px.x, session_.camera.size_px.y);
    glm::dvec2 const scale(double(size.width) / shown.cols, double(size.height) / shown.rows);
    std::optional<glm::dvec2> const ball = ball_in(shown);
    glm::dvec2 const right = ball_from(session_.camera, pose_of_frame(*number));
    double const off_px = ball ? glm::distance((*ball + 0.5) * scale - 0.5, right) : size.width;
    verdict_.most_off_px = std::max(verdict_.most_off_px, off_px);
    if (off_px > 0.25 * kWayPerFrame * size.width) ++verdict_.misplaced;

    constexpr double kRounding_s = 1e-6;
    bool good = f.captured_steady_s.has_value();
    if (good) {
        double const captured_s = *f.captured_steady_s, start_s = captured_s - double(*number) / session_.rate_hz;
        if (!start_s_) start_s_ = start_s;
        StageTimes const& t = f.times;
        double const ready_ms = f.age_ms + t.decode_ms + t.detect_ms + t.pose_ms + t.wait_ms + t.light_ms +
                                t.render_ms + t.composite_ms;
        double const ready_s = captured_s + 1e-3 * f.latency_ms;
        good = std::abs(start_s - *start_s_) < kRounding_s &&
               std::abs(ready_ms - f.latency_ms) < 1e3 * kRounding_s && ready_s < before_s + kRounding_s;
        if (in_window) {
            double const swapped_s = captured_s + 1e-3 * f.swapped_ms;
            good = good && swapped_s > before_s - kRounding_s && swapped_s < after_s + kRounding_s &&
                   std::abs(f.latency_ms + f.show_wait_ms + f.present_ms - f.swapped_ms) < 1e3 * kRounding_s;
        }
    }
    if (!good) ++verdict_.mistimed;
}

} // namespace ar
