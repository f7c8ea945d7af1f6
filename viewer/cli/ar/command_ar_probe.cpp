#include "ar/calibration/calibration_file.h"
#include "ar/light/clipped_light.h"
#include "ar/light/lamps.h"
#include "ar/light/lat_long.h"
#include "ar/light/map_file.h"
#include "ar/light/mirror_ball.h"
#include "ar/markers/marker_map_file.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/image_io/picture_file.h"
#include "viewer/base/arguments.h"
#include "viewer/base/outputs.h"
#include "viewer/base/report_json.h"
#include "viewer/base/validators.h"
#include "viewer/cli/ar/ar_arguments.h"
#include "viewer/cli/ar/ar_probe_sides.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <numbers>
#include <opencv2/imgproc.hpp>

namespace viewer {
namespace {

struct ProbeOptions {
    std::vector<std::string> pictures;
    std::string calibration, markers, ball, reflectivity = "0.6", exposures, out, stats;
    double radius_m = 0, camera_deg = 6, paper_albedo = 0; ///< 0 = not given
    int size = 512;
};

/// CV_8UC1: 255 inside the hull of a thing's markers, as the side sees it.
cv::Mat area_of(ProbeSide const& side, ar::MarkerMap const& map, ar::CameraModel const& camera, int thing)
{
    cv::Mat inside = cv::Mat::zeros(side.radiance.size(), CV_8U);
    std::vector<cv::Point> corners, hull;
    for (ar::PlacedMarker const& m : ar::placed_markers(map))
        for (glm::dvec3 const& corner : m.corners_m)
            if (m.thing == thing)
                if (auto const p = project(camera, inverse(side.world_from_camera) *
                                                       (ar::world_from_thing(map, m.thing) * corner)))
                    corners.emplace_back(cv::Point2d(p->x, p->y));
    if (corners.size() < 3) return inside;
    cv::convexHull(corners, hull);
    cv::fillConvexPoly(inside, hull, 255);
    return inside;
}

/// Fills markers with the brightness around them, as their squares could be taken for the rim of the ball.
cv::Mat without_markers(ProbeSide const& side, ar::MarkerMap const& map, ar::CameraModel const& camera)
{
    cv::Mat picture = side.radiance.clone();
    for (int thing = 0; thing < ar::count_of(map); ++thing) {
        cv::Mat inside = area_of(side, map, camera, thing), around;
        int const px = cv::countNonZero(inside);
        if (px == 0) continue;
        int const wider = std::max(3, int(0.05 * std::sqrt(px)));
        cv::dilate(inside, inside, {}, {-1, -1}, wider);
        cv::dilate(inside, around, {}, {-1, -1}, wider);
        picture.setTo(cv::mean(picture, around - inside), inside);
    }
    return picture;
}

ar::BallSight find_ball(ProbeSide const& side, ProbeOptions const& o, ar::MarkerMap const& map,
                        ar::CameraModel const& camera)
{
    if (o.ball.empty())
        return ar::find_ball(side.radiance, camera, ar::find_ball(without_markers(side, map, camera), camera));
    auto const near = ar::predicted_ball(side.world_from_camera, parse_point("--ball", o.ball), o.radius_m);
    if (!near)
        throw gi::InputError("--ball " + o.ball, "it is not in front of the camera",
                             "give its centre in the markers' world, in m");
    return ar::find_ball(side.radiance, camera, *near);
}

struct Unwrapped {
    ar::PartialMap light;
    cv::Mat clipped; ///< CV_32FC1, share of each texel that was clipped
};

/// @param[in,out] ball_m position found by the first side; the ball must not move between sides
Unwrapped unwrapped(ProbeSide const& side, ProbeOptions const& o, ar::MarkerMap const& markers,
                    ar::CameraModel const& camera, std::optional<glm::dvec3>& ball_m)
{
    ar::BallSight ball;
    try {
        ball = find_ball(side, o, markers, camera);
    } catch (gi::InputError const& e) {
        throw gi::InputError("no ball was found in " + side.name, e.what(),
                             o.ball.empty() ? "give --ball X,Y,Z" : "measure --ball and --ball-radius again");
    }
    glm::dvec3 const at = side.world_from_camera * (ar::ball_distance_m(ball, o.radius_m) * ball.axis);
    if (!ball_m) ball_m = at;
    if (double const off_m = glm::distance(at, *ball_m); off_m > 0.5 * o.radius_m)
        throw gi::InputError(
            fmt::format("{} shows the ball {:.0f} mm from where the first side does", side.name, 1e3 * off_m),
            "something else was found, or the ball was moved", "give --ball X,Y,Z");
    ar::BallSettings settings;
    settings.size = {o.size, o.size / 2};
    glm::dvec3 const colour = parse_color("--reflectivity", o.reflectivity);
    settings.reflectivity = {colour.x, colour.y, colour.z};
    settings.camera_half_angle_rad = glm::radians(o.camera_deg);
    ar::PartialMap map = ar::unwrap_ball(side.radiance, camera, side.world_from_camera.rotation, ball, settings);
    cv::Mat white;
    cv::cvtColor(side.clipped, white, cv::COLOR_GRAY2RGB);
    white.convertTo(white, CV_32F, 1 / 255.0);
    ar::BallSettings perfect = settings;
    perfect.reflectivity = cv::Vec3d::all(1);
    cv::Mat clipped;
    cv::extractChannel(ar::unwrap_ball(white, camera, side.world_from_camera.rotation, ball, perfect).radiance,
                       clipped, 0);
    fmt::print(
        "{}: ball at {:.4f}, {:.4f}, {:.4f} m, rim {:.2f} px RMS in {} of 360 places; shows {:.2f} % of all "
        "directions\n",
        side.name, at.x, at.y, at.z, ball.rms_px, ball.rim_points, 100 * ar::covered_share(map));
    return {std::move(map), std::move(clipped)};
}

/// The irradiance that the white paper of the largest sheet of markers shows: the 80 % quantile of its pixels, as
/// about half of them are white. Nothing if fewer than 200 of its pixels are seen unclipped.
std::optional<ar::MeasuredFace> paper_face(std::vector<ProbeSide> const& sides, ar::MarkerMap const& markers,
                                           ar::CameraModel const& camera, double albedo)
{
    int best = -1, most_px = 0;
    std::size_t of_side = 0;
    std::vector<cv::Mat> areas;
    for (std::size_t s = 0; s < sides.size(); ++s)
        for (int thing = 0; thing < ar::count_of(markers); ++thing) {
            cv::Mat const area = area_of(sides[s], markers, camera, thing);
            int const n = cv::countNonZero(area);
            areas.push_back(area);
            if (n <= most_px) continue;
            most_px = n;
            best = thing;
            of_side = s;
        }
    if (most_px < 200) return std::nullopt;
    ProbeSide const& side = sides[of_side];
    cv::Mat const& area = areas[of_side * std::size_t(ar::count_of(markers)) + std::size_t(best)];
    ar::MeasuredFace face;
    face.normal = ar::world_from_thing(markers, best).rotation * glm::dvec3(0, 0, 1);
    for (int c = 0; c < 3; ++c) {
        std::vector<float> values;
        for (int y = 0; y < area.rows; ++y)
            for (int x = 0; x < area.cols; ++x)
                if (area.at<std::uint8_t>(y, x) && !side.clipped.at<std::uint8_t>(y, x))
                    values.push_back(side.radiance.at<cv::Vec3f>(y, x)[c]);
        if (values.size() < 200) return std::nullopt;
        auto const at = values.begin() + std::ptrdiff_t(values.size() * 8 / 10);
        std::nth_element(values.begin(), at, values.end());
        face.irradiance[c] = std::numbers::pi * double(*at) / albedo;
    }
    return face;
}

struct NamedFace {
    char const* name;
    glm::dvec3 normal;
};
constexpr NamedFace kFaces[] = {{"+x", {1, 0, 0}},         {"-x", {-1, 0, 0}},
                                {"+y, upward", {0, 1, 0}}, {"-y, downward", {0, -1, 0}},
                                {"+z", {0, 0, 1}},         {"-z", {0, 0, -1}}};

void print_light(cv::Mat const& map, ar::ClippedLight const& clipped)
{
    fmt::print("irradiance of surfaces facing (red, green, blue)\n");
    for (auto const& f : kFaces) {
        cv::Vec3d const e = ar::irradiance_exact(map, f.normal);
        char const* const note = !clipped.lights(f.normal) ? ""
                                 : clipped.repaired        ? "  estimated: lit by clipped light"
                                                           : "  lower bound: lit by clipped light";
        fmt::print("  {:<12} {:>10.4f} {:>10.4f} {:>10.4f}{}\n", f.name, e[0], e[1], e[2], note);
    }
    ar::SplitMap const split = ar::split_lamps(map);
    fmt::print("{} lights with {:.1f} % of all light\n", split.lamps.size(), 100 * split.lamp_share);
    for (ar::Lamp const& l : split.lamps)
        fmt::print(
            "  towards {:.4f}, {:.4f}, {:.4f}: half angle {:.2f} degrees, irradiance {:.4f} {:.4f} {:.4f}\n",
            l.direction.x, l.direction.y, l.direction.z, glm::degrees(l.half_angle_rad), l.irradiance[0],
            l.irradiance[1], l.irradiance[2]);
}

void print_clipped(ar::ClippedLight const& c, bool has_paper_albedo)
{
    if (!(c.clipped_sr > 0)) return;
    fmt::print(
        "clipped in the shortest exposure: {:.5f} sr towards {:.4f}, {:.4f}, {:.4f}; measured irradiance of a "
        "face turned there {:.4f} {:.4f} {:.4f}, a lower bound\n",
        c.clipped_sr, c.towards.x, c.towards.y, c.towards.z, c.as_measured[0], c.as_measured[1], c.as_measured[2]);
    if (c.repaired)
        fmt::print("added from the markers' paper: {:.4f} {:.4f} {:.4f}\n", c.added[0], c.added[1], c.added[2]);
    else
        fmt::print(
            "not to be trusted: the power of that light and the faces marked as lower bounds (the sun may be "
            "tens of times brighter than measured): {}\n",
            has_paper_albedo ? "the markers' paper is not lit by it, or not seen"
                             : "take shorter exposures, or give --paper-albedo 0.8");
}

nlohmann::ordered_json json_of(cv::Mat const& map, ar::ClippedLight const& c, double measured_share)
{
    auto const numbers = [](auto const& v) { return nlohmann::ordered_json{v[0], v[1], v[2]}; };
    nlohmann::ordered_json j;
    j["measured_share"] = measured_share;
    for (auto const& f : kFaces)
        j["faces"].push_back({{"normal", numbers(f.normal)},
                              {"irradiance", numbers(ar::irradiance_exact(map, f.normal))},
                              {"lower_bound", c.lights(f.normal) && !c.repaired},
                              {"estimated", c.lights(f.normal) && c.repaired}});
    j["clipped"] = {{"solid_angle_sr", c.clipped_sr},
                    {"towards", numbers(c.towards)},
                    {"irradiance_lower_bound", numbers(c.as_measured)},
                    {"added", numbers(c.added)},
                    {"repaired", c.repaired}};
    return j;
}

/// Notes the origin of the light in the header of OpenEXR files.
void write_probe_map(std::string const& file, cv::Mat const& map, ar::ClippedLight const& c)
{
    ar::write_map(file, map);
    if (std::filesystem::path(file).extension() != ".exr" || !(c.clipped_sr > 0)) return;
    gi::Picture picture = gi::read_exr(file);
    picture.metadata["light"] = c.repaired ? "mirror ball; clipped light estimated from white paper"
                                           : "mirror ball; lights are clipped: a lower bound";
    gi::Report report;
    gi::write_exr(file, picture, gi::PixelType::single, report);
}

int run_probe(ProbeOptions const& o)
{
    std::vector<std::string> inputs = o.pictures;
    inputs.insert(inputs.end(), {o.calibration, o.markers});
    check_outputs({o.out, o.stats}, inputs);
    if (o.size % 2 != 0)
        throw gi::InputError(fmt::format("--size {}", o.size), "maps are twice as wide as high",
                             "give an even one");
    ar::Calibration const calibration = ar::read_calibration(o.calibration);
    ar::MarkerMap const markers = ar::read_marker_map(o.markers);
    say_doubts(markers, o.markers);
    if (!calibration.photometry)
        fmt::print(stderr, "{}: it has no response, bytes are assumed to be sRGB\n", o.calibration);
    auto const seconds = o.exposures.empty() ? std::vector<double>() : parse_exposures(o.exposures);
    std::vector<ar::PartialMap> maps;
    cv::Mat clipped;
    std::optional<glm::dvec3> ball_m;
    std::vector<ProbeSide> const sides = read_probe_sides(o.pictures, seconds, calibration, markers);
    for (ProbeSide const& side : sides) {
        Unwrapped u = unwrapped(side, o, markers, calibration.camera, ball_m);
        maps.push_back(std::move(u.light));
        clipped = clipped.empty() ? u.clipped : cv::Mat(cv::max(clipped, u.clipped));
    }
    ar::PartialMap const seen = ar::merged(maps);
    ar::FilledMap map = ar::filled(seen);
    std::optional<ar::MeasuredFace> face;
    if (o.paper_albedo > 0) face = paper_face(sides, markers, calibration.camera, o.paper_albedo);
    ar::ClippedLight const missing = ar::repair_clipped(map.radiance, clipped, face);
    write_probe_map(o.out, map.radiance, missing);
    if (!o.stats.empty())
        gi::write_text(o.stats, to_text(json_of(map.radiance, missing, ar::covered_share(seen))));
    fmt::print("{}: {} x {}, {:.2f} % measured, {:.2f} % filled in from neighbours\n", o.out, o.size, o.size / 2,
               100 * ar::covered_share(seen), 100 * std::max(0.0, map.filled_share));
    print_light(map.radiance, missing);
    print_clipped(missing, o.paper_albedo > 0);
    return 0;
}

} // namespace

void add_ar_probe(CLI::App& ar, int& exit_code)
{
    auto const o = std::make_shared<ProbeOptions>();
    CLI::App* const c =
        ar.add_subcommand("probe", "Measure an environment map from pictures of a mirror ball beside markers.");
    c->add_option("PICTURES", o->pictures, "one or more from each side: whole ball and markers")->required();
    c->add_option("--calibration", o->calibration, "calibration of the camera, with its response")->required();
    c->add_option("--markers", o->markers, "marker map, which defines the map's axes")->required();
    c->add_option("--ball-radius", o->radius_m, "m")->required()->check(in_range(1e-4, 100));
    c->add_option("--ball", o->ball,
                  "approximate centre of the ball, X,Y,Z, m (default: strongest circle in the picture)");
    c->add_option("--reflectivity", o->reflectivity, "reflectivity, one value or R,G,B; steel: about 0.6")
        ->capture_default_str();
    c->add_option("--exposures", o->exposures, "exposure times of the pictures of each side, s: 1/30,1/60,1/120");
    c->add_option("--camera-angle", o->camera_deg, "half angle of camera and tripod seen from the ball, degrees")
        ->check(in_range(0, 60))
        ->capture_default_str();
    c->add_option("--size", o->size, "width of the map")->check(CLI::Range(16, 16384))->capture_default_str();
    c->add_option("--paper-albedo", o->paper_albedo,
                  "albedo of the markers' paper, about 0.8: estimates lights that clip in every exposure by its "
                  "brightness")
        ->check(in_range(0.05, 1));
    c->add_option("--stats", o->stats, "file for the result as JSON, with what is clipped and not to be trusted");
    c->add_option("-o,--out", o->out, "map to write: .exr, .hdr or .png (clipped at 1)")->required();
    c->footer(R"(Example:
  lightwell ar probe a1.png a2.png b1.png b2.png --exposures 1/30,1/500 --calibration camera.yaml --markers markers.yaml
      --ball-radius 0.05 --out probe.exr

Give all pictures of one side, then those of the next. Two sides at 90 degrees leave no gap.)");
    c->callback([o, &exit_code] { exit_code = run_probe(*o); });
}

} // namespace viewer
