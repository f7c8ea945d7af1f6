#include "ar/pipeline/synthesize.h"

#include "ar/calibration/calibration_file.h"
#include "ar/camera/camera_model.h"
#include "ar/camera/pose.h"
#include "ar/capture/clock.h"
#include "ar/composite/warp.h"
#include "ar/markers/draw.h"
#include "ar/markers/marker_map_file.h"
#include "ar/pipeline/bridge.h"
#include "ar/pipeline/first_surfaces.h"
#include "ar/pose/pose_file.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/progress.h"
#include "gi/image_io/picture_file.h"
#include "gi/scene/generate/write_glb.h"
#include "gi/scene/model/scene.h"

#include <cmath>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <numbers>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

constexpr double kResolution = 1.25; ///< pixels rasterised per pixel of the camera, as synthetic_radiance

float sky(float y) { return 0.7f + 0.3f * y; }
/// Radiance of a matt surface with this normal, per albedo: irradiance / pi = 0.7 + 0.3 * 2/3 y.
float reflected(float y) { return 0.7f + 0.2f * y; }

/// The sky: radiance 0.7 + 0.3 y towards a direction of height y, white.
/// Its lat-long map: CV_32FC3, 2 height x height.
cv::Mat quick_sky(int height)
{
    cv::Mat map(height, 2 * height, CV_32FC3);
    for (int y = 0; y < map.rows; ++y)
        map.row(y).setTo(cv::Scalar::all(sky(float(std::cos(std::numbers::pi * (y + 0.5) / map.rows)))));
    return map;
}

/// Pictures of a scene for tests of tracking: rasterised, lit by a sky without shadows or interreflection. A frame
/// costs a small part of a second, where the reference renderer takes minutes; edges, textures and the lens are as
/// sharp.
class QuickView {
public:
    QuickView(gi::Scene const& scene, gi::Report& report);

    /// Radiance reflected by the first surfaces, CV_32FC3 of the camera's size, through its lens; 0 = no surface.
    /// @param samples  points per pixel of the camera, in the mean
    cv::Mat radiance(CameraModel const& camera, gi::RigidPose const& world_from_camera, int samples = 4);

private:
    gi::World world_;
    SurfaceView surfaces_;
};

QuickView::QuickView(gi::Scene const& scene, gi::Report& report)
    : world_(gi::build_world(std::make_shared<gi::Scene const>(scene), std::nullopt, report)),
      surfaces_(world_, Surfaces::all)
{
}

cv::Mat QuickView::radiance(CameraModel const& camera, gi::RigidPose const& world_from_camera, int samples)
{
    CameraModel const pinhole = covering_pinhole(camera, kResolution);
    gi::Camera const view = gi_camera(pinhole, world_from_camera);
    cv::Mat sum(pinhole.size_px.y, pinhole.size_px.x, CV_32FC3, cv::Scalar::all(0));
    int const passes = std::max(1, int(std::lround(samples / (kResolution * kResolution))));
    for (int k = 0; k < passes; ++k) {
        FirstSurfaces const s = surfaces_.seen(view, sum.cols, sum.rows, std::uint32_t(k));
        sum.forEach<cv::Vec3f>([&](cv::Vec3f& to, int const* at) {
            to += reflected(s.normal.at<cv::Vec3f>(at[0], at[1])[1]) * s.albedo.at<cv::Vec3f>(at[0], at[1]);
        });
    }
    return Warp(camera, pinhole).smooth(sum / passes);
}

namespace fs = std::filesystem;

PaperOnTable paper_of(MarkerMap const& map)
{
    constexpr double dots_per_m = 4000;
    Sheet const sheet = sheet_of(map, 0);
    PaperOnTable paper;
    paper.print = draw(sheet, dots_per_m);
    paper.width_m = paper.print.cols / dots_per_m;
    paper.depth_m = paper.print.rows / dots_per_m;
    glm::dvec3 const corner = world_from_thing(map, 0) * glm::dvec3(-sheet.origin_m, 0);
    paper.near_left_m = {corner.x, corner.z};
    return paper;
}

void write_png(fs::path const& file, cv::Mat const& rgb)
{
    gi::write_png(file, rgb.cols, rgb.rows, {rgb.ptr(), rgb.total() * 3});
}

void write_probe(fs::path const& file, cv::Mat const& probe, gi::Report& report)
{
    gi::Picture picture;
    picture.width = probe.cols;
    picture.height = probe.rows;
    gi::Layer& layer = picture.add("color", 3);
    std::copy_n(probe.ptr<float>(), layer.data.size(), layer.data.begin());
    gi::write_exr(file, picture, gi::PixelType::single, report);
}

std::string quick_text(SynthesizeOptions const& o)
{
    if (!o.quick) return o.apart ? ", apart" : "";
    constexpr char const* names[]{"board", "one", "none"};
    return fmt::format(", quick, markers: {}{}", names[std::size_t(o.markers)], o.apart ? ", apart" : "");
}

std::string options_text(SynthesizeOptions const& o)
{
    return fmt::format(
        "# Made by lightwell ar synthesize: {} x {} px, {} frames at {} Hz, {} paths, {} of the camera's "
        "pixels{}\n",
        o.size_px.x, o.size_px.y, o.frames, o.rate_hz, o.quality.paths, o.quality.resolution,
        (o.quality.denoise ? ", denoised" : "") + quick_text(o));
}

std::string session_text(SynthesizeOptions const& o)
{
    return options_text(o) + fmt::format(R"(schema: ar/2
frames: {{source: frames, rate_hz: {}, first: 0}}
camera: camera.yaml
markers: markers.yaml
light: {{map: probe.exr}}
real: {{scene: near.glb}}
virtual: {{scene: statue.glb, at: [-0.02, 0, -0.1]}}
render: {{paths: 4, resolution: 1}}
)",
                                         o.rate_hz);
}

TableCloth cloth_of(SynthesizeOptions const& o) { return o.quick ? TableCloth::printed : TableCloth::none; }

/// Refuses a folder whose frames were made with other options.
void check_folder(SynthesizeOptions const& o)
{
    fs::path const session = o.folder / "session.yaml";
    if (!fs::exists(session)) return;
    std::vector<unsigned char> const bytes = gi::read_bytes(session, std::size_t(1) << 20);
    if (std::string(bytes.begin(), bytes.end()) != session_text(o))
        throw gi::InputError("'" + o.folder.string() + "' holds another session",
                             "old and new frames would be mixed", "choose another folder");
}

void write_setup(SynthesizeOptions const& o, SyntheticCamera const& camera, MarkerMap const& markers,
                 PaperOnTable const& paper, std::vector<TimedPose> const& poses, gi::StopRequest const& stop,
                 gi::Report& report)
{
    Calibration calibration;
    calibration.camera = camera.model;
    calibration.photometry = camera.photometry;
    NoiseModel noise;
    noise.read = camera.read_noise * camera.read_noise;
    noise.photon = camera.photon_noise;
    calibration.noise = noise;
    calibration.provenance = {{"made_by", "lightwell_ar_synthesize"}};
    write_calibration(o.folder / "camera.yaml", calibration);
    write_marker_map(o.folder / "markers.yaml", markers); // defines the world, also where none is printed
    gi::write_text(o.folder / "poses.csv", format_poses(poses));
    gi::write_glb(o.folder / "near.glb", generate_desk(DeskPart::near, paper, cloth_of(o)), report);
    gi::write_glb(o.folder / "statue.glb", generate_statue(), report);
    SyntheticQuality fine = o.quality;
    fine.paths = std::max(4 * fine.paths, 8u);
    int const height = o.size_px.x < 320 ? 64 : 128; // small frames are for trying things out, and cost less than it
    cv::Mat const probe =
        o.quick ? quick_sky(128)
                : synthetic_probe(generate_desk(DeskPart::whole, paper), {0, 0.15, 0}, height, fine, stop, report);
    if (stop.requested()) return; // do not keep an unfinished probe
    write_probe(o.folder / "probe.exr", probe, report);
    gi::write_text(o.folder / "session.yaml", session_text(o));
}

} // namespace

MarkerMap synthetic_markers(DeskMarkers which)
{
    glm::dquat const flat = glm::angleAxis(glm::radians(-90.0), glm::dvec3(1, 0, 0));
    if (which == DeskMarkers::one) return {{{"DICT_4X4_50", 7, 0.07, {{0.05, 0.0005, 0.15}, flat}}}, {}, {}};
    CharucoBoard board;
    board.squares_x = 7;
    board.squares_y = 5;
    board.square_m = 0.045;
    board.marker_m = 0.034;
    board.dictionary = "DICT_4X4_50";
    // Flat on the table, its top away from the camera.
    board.world_from_board = {{-0.1575, 0.0005, 0.32}, flat};
    return {{}, {board}, {}};
}

PaperOnTable synthetic_paper(DeskMarkers which)
{
    return which == DeskMarkers::none ? PaperOnTable{} : paper_of(synthetic_markers(which));
}

int synthesize(SynthesizeOptions const& o, gi::StopRequest const& stop, gi::Report& report)
{
    if (!o.quick && o.markers != DeskMarkers::board)
        throw gi::InputError("another print than the board", "the reference renderer's desk has a board",
                             "add --quick");
    if (o.quick && o.truth)
        throw gi::InputError("reference pictures of a quick session", "they would have no shadows",
                             "add --no-truth");
    check_folder(o);
    std::error_code problem;
    fs::create_directories(o.folder / "frames", problem);
    if (o.truth && !problem) fs::create_directories(o.folder / "truth", problem);
    if (problem)
        throw gi::InputError("'" + o.folder.string() + "' cannot be made", problem.message(),
                             "choose another folder");
    SyntheticCamera const camera = synthetic_camera(o.size_px);
    MarkerMap const markers = synthetic_markers(o.markers);
    PaperOnTable const paper = synthetic_paper(o.markers);
    std::vector<TimedPose> poses;
    for (int f = 0; f < o.frames; ++f)
        poses.push_back({f / o.rate_hz, (o.apart ? synthetic_pose_apart : synthetic_pose)(
                                            o.frames > 1 ? double(f) / (o.frames - 1) : 0)});
    if (!fs::exists(o.folder / "session.yaml")) write_setup(o, camera, markers, paper, poses, stop, report);

    gi::Scene const empty = generate_desk(DeskPart::whole, paper, cloth_of(o));
    std::optional<QuickView> quick;
    if (o.quick) quick.emplace(empty, report);
    gi::Scene full = empty;
    gi::append(full, generate_statue(), "virtual", glm::translate(gi::dmat4(1), gi::dvec3(-0.02, 0, -0.1)));
    auto const file_of = [&](char const* folder, std::size_t f) {
        return o.folder / folder / fmt::format("{:06}.png", f);
    };
    std::size_t wanted = 0, written = 0;
    for (std::size_t f = 0; f < poses.size(); ++f)
        wanted += std::size_t(!fs::exists(file_of("frames", f))) +
                  std::size_t(o.truth && !fs::exists(file_of("truth", f)));
    gi::ProgressBar bar("synthesize");
    double const begun_s = steady_now_s();
    bool is_told = false;
    int done = 0;
    for (std::size_t f = 0; f < poses.size() && !stop.requested(); ++f) {
        auto const picture = [&](char const* folder, gi::Scene const& scene) {
            fs::path const file = file_of(folder, f);
            if (fs::exists(file)) return;
            bar.update(double(written) / double(wanted), fmt::format("frame {} of {}", f + 1, poses.size()));
            cv::Mat const radiance =
                quick ? quick->radiance(camera.model, poses[f].world_from_camera)
                      : synthetic_radiance(scene, poses[f].time_s, camera.model, poses[f].world_from_camera,
                                           o.quality, f, stop, report);
            if (stop.requested()) return;
            write_png(file, synthetic_frame(radiance, camera, f));
            ++written;
        };
        picture("frames", empty);
        if (o.truth) picture("truth", full);
        done += stop.requested() ? 0 : 1;
        if (is_told || written == 0 || stop.requested()) continue;
        is_told = true;
        double const each_s = (steady_now_s() - begun_s) / double(written);
        gi::say_estimate("synthesize", each_s * double(wanted - written),
                         fmt::format("{} pictures of {} x {}, {:.1f} s each with {} paths per pixel",
                                     wanted - written, o.size_px.x, o.size_px.y, each_s, o.quality.paths));
    }
    return done;
}

} // namespace ar
