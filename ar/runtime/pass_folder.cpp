#include "ar/runtime/pass_folder.h"

#include "ar/pipeline/bridge.h"
#include "gi/core/error.h"

#include <fmt/format.h>
#include <utility>

namespace ar {
namespace {

namespace fs = std::filesystem;

constexpr std::size_t kMostWaiting = 4; // a frame of 1920 x 1080 has about 100 MB

void add_layer(gi::Picture& picture, char const* name, cv::Mat const& values)
{
    gi::Layer& layer = picture.add(name, values.channels());
    cv::Mat const all = values.isContinuous() ? values : values.clone();
    std::copy_n(all.ptr<float>(), layer.data.size(), layer.data.begin());
}

std::string numbers(std::initializer_list<double> values)
{
    std::string text;
    for (double const v : values) text += (text.empty() ? "" : " ") + fmt::format("{:.9g}", v);
    return text;
}

/// How the composite's codes follow from radiance: unit = vignetting(r) M radiance,
/// code = the nearest by response.
void add_response(std::map<std::string, std::string>& text, Compositor const& compositor, PassFrame const& f)
{
    Photometry const& p = compositor.photometry();
    text["bits"] = f.camera.depth() == CV_8U ? "8" : f.camera.depth() == CV_16U ? "16" : "float";
    if (f.camera.depth() == CV_32F) return; // radiance itself
    cv::Matx33f const m = compositor.unit_of_radiance(f.exposure);
    text["unit_of_radiance"] =
        numbers({m(0, 0), m(0, 1), m(0, 2), m(1, 0), m(1, 1), m(1, 2), m(2, 0), m(2, 1), m(2, 2)});
    text["vignetting"] = numbers({p.vignetting[0], p.vignetting[1], p.vignetting[2]});
    std::string& curve = text["response"];
    if (p.unit_of_byte == srgb_photometry().unit_of_byte) {
        curve = "sRGB";
        return;
    }
    for (auto const& channel : p.unit_of_byte)
        for (float const unit : channel) curve += fmt::format("{:.9g} ", unit);
}

/// Measured or predicted for the frame, not kept from an earlier one.
bool is_own(PoseState state) { return state == PoseState::tracked || state == PoseState::predicted; }

} // namespace

PassLayers::PassLayers(CameraModel const& camera, Compositor compositor, double frames_per_s, bool is_undistorted)
    : camera_(camera), shown_(camera), compositor_(std::move(compositor)), frames_per_s_(frames_per_s)
{
    if (is_undistorted) {
        shown_ = covering_pinhole(camera);
        undistort_.emplace(shown_, camera);
    }
    directions_.create(camera.size_px.y, camera.size_px.x, CV_32FC2);
    directions_.forEach<cv::Vec2f>([&](cv::Vec2f& p, int const* at) {
        auto const d = direction_of(camera_, {at[1], at[0]});
        p = d && d->z > 0 ? cv::Vec2f(float(d->x / d->z), float(d->y / d->z)) : cv::Vec2f(NAN, NAN);
    });
}

/// From a pixel to where its surface was in the frame before, if it did not move itself.
cv::Mat PassLayers::motion(cv::Mat const& depth_m, gi::RigidPose const& now, gi::RigidPose const& before) const
{
    gi::RigidPose const before_from_now = inverse(before) * now;
    cv::Mat out(depth_m.size(), CV_32FC2);
    out.forEach<cv::Vec2f>([&](cv::Vec2f& px, int const* at) {
        cv::Vec2f const p = directions_.at<cv::Vec2f>(at[0], at[1]);
        float const z = depth_m.at<float>(at[0], at[1]);
        glm::dvec3 const ray(p[0], p[1], 1); // without a surface: infinitely far
        glm::dvec3 const point = z > 0 ? before_from_now * (double(z) * ray) : before_from_now.rotation * ray;
        auto const was = std::isfinite(p[0]) ? project(camera_, point) : std::nullopt;
        px = was ? cv::Vec2f(float(was->x - at[1]), float(was->y - at[0])) : cv::Vec2f(0, 0);
    });
    return out;
}

gi::Picture PassLayers::picture(PassFrame const& f)
{
    CompositePasses const p = f.pair ? passes_of(compositor_, f.camera, f.composite, *f.pair, f.exposure)
                                     : passes_of_nothing(compositor_.photometry(), f.camera, f.exposure);
    gi::Picture out{shown_.size_px.x, shown_.size_px.y, {}, {}};
    auto const smooth = [&](char const* name, cv::Mat const& m) {
        add_layer(out, name, undistort_ ? undistort_->smooth(m) : m);
    };
    auto const nearest = [&](char const* name, cv::Mat const& m) {
        add_layer(out, name, undistort_ ? undistort_->nearest(m) : m);
    };
    smooth("color", p.composite);
    smooth("background", p.background);
    smooth("objects", p.objects);
    smooth("added", p.added);
    smooth("noise", p.noise);
    smooth("shadow", p.shadow);
    smooth("indirect", p.indirect);
    cv::Mat coverage;
    cv::extractChannel(p.objects, coverage, 3);
    smooth("coverage", coverage);
    if (f.depth) {
        nearest("depth", f.depth->composite);
        nearest("depth_place", f.depth->place);
    }
    bool const has_motion = f.depth && f.world_from_camera && is_own(f.state) && f.before && !undistort_;
    if (has_motion)
        nearest("motion_place", motion(f.depth->place, *f.world_from_camera, f.before->world_from_camera));
    auto& text = out.metadata;
    text["frame"] = std::to_string(f.sequence);
    text["colour_space"] = "linear BT.709 (sRGB primaries), D65";
    text["lens"] = name_of(shown_.lens);
    text["focal_length_px"] = numbers({shown_.fx, shown_.fy});
    // Pixel centres are whole numbers, from the top left.
    text["principal_point_px"] = numbers({shown_.cx, shown_.cy});
    std::string coefficients;
    for (int i = 0; i < coefficient_count(shown_.lens); ++i)
        coefficients += (i > 0 ? " " : "") + fmt::format("{:.9g}", shown_.distortion[std::size_t(i)]);
    if (!coefficients.empty()) text["distortion"] = coefficients;
    if (f.world_from_camera) {
        auto const& [at, q] = *f.world_from_camera;
        text["camera_position_m"] = numbers({at.x, at.y, at.z});
        text["camera_rotation_xyzw"] = numbers({q.x, q.y, q.z, q.w}); // camera: x right, y down, z ahead
    }
    text["pose"] = name_of(f.state);
    text["shown"] = numbers({f.shown}); // share of the change by virtual objects
    add_response(text, compositor_, f);
    text["sum"] = "color = objects.rgb + (1 - objects.a) background + added + noise";
    if (has_motion)
        text["motion_to_frame"] = std::to_string(f.before->sequence);
    else
        text["motion"] = undistort_ ? "none: only in the camera's lens" : "none: no own pose here or before";
    return out;
}

gi::ExrAttributes PassLayers::attributes(PassFrame const& f) const
{
    gi::ExrAttributes a;
    a.frames_per_s = frames_per_s_;
    a.time_code = gi::time_code_of(f.sequence, frames_per_s_);
    if (!f.world_from_camera) return a;
    a.world_to_camera = glm::inverse(gi_camera(shown_, *f.world_from_camera).world_from_camera);
    // Projection matrix of the pinhole; lens distortion is applied afterwards.
    double const w = shown_.size_px.x, h = shown_.size_px.y, near = 0.01, far = 1000;
    gi::dmat4 ndc(0);
    ndc[0][0] = 2 * shown_.fx / w;
    ndc[1][1] = 2 * shown_.fy / h;
    ndc[2][0] = 1 - 2 * (shown_.cx + 0.5) / w;
    ndc[2][1] = 2 * (shown_.cy + 0.5) / h - 1;
    ndc[2][2] = -(far + near) / (far - near);
    ndc[2][3] = -1;
    ndc[3][2] = -2 * far * near / (far - near);
    a.world_to_ndc = ndc * *a.world_to_camera;
    return a;
}

PassFolder::PassFolder(PassSettings const& settings, CameraModel const& camera, Compositor compositor,
                       double frames_per_s, WhenFull when_full, gi::Report& report)
    : settings_(settings), layers_(camera, std::move(compositor), frames_per_s, settings.is_undistorted)
{
    std::error_code problem;
    fs::create_directories(settings.folder, problem);
    if (problem)
        throw gi::InputError("'" + settings.folder.string() + "' cannot be made", problem.message(),
                             "choose another folder");
    thread_ = std::make_unique<KeepThread<PassFrame>>(
        [this, &report](PassFrame const& f) {
            gi::write_exr(settings_.folder / fmt::format("{:06}.exr", f.sequence), layers_.picture(f),
                          settings_.bits == 32 ? gi::PixelType::single : gi::PixelType::half, report,
                          layers_.attributes(f));
        },
        when_full, kMostWaiting);
}

void PassFolder::add(RunFrame const& record, FrameResult const& r)
{
    PassFrame f{.sequence = record.sequence,
                .exposure = record.exposure,
                .camera = r.camera,
                .composite = r.rgb,
                .pair = r.pair,
                .depth = r.depth,
                .state = record.state,
                .shown = record.shown,
                .world_from_camera = record.world_from_camera,
                .before = std::exchange(before_, std::nullopt)};
    if (record.world_from_camera && is_own(record.state)) before_ = {record.sequence, *record.world_from_camera};
    thread_->add(std::move(f));
}

} // namespace ar
