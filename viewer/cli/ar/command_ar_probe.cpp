#include "ar/calibration/calibration_file.h"
#include "ar/light/irradiance.h"
#include "ar/light/lamps.h"
#include "ar/light/map_file.h"
#include "ar/light/mirror_ball.h"
#include "ar/markers/marker_map_file.h"
#include "gi/core/error.h"
#include "viewer/base/arguments.h"
#include "viewer/base/outputs.h"
#include "viewer/base/validators.h"
#include "viewer/cli/ar/ar_arguments.h"
#include "viewer/cli/ar/ar_probe_sides.h"
#include "viewer/cli/commands.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <fmt/format.h>
#include <memory>
#include <opencv2/imgproc.hpp>

namespace viewer {
namespace {

struct ProbeOptions {
    std::vector<std::string> pictures;
    std::string calibration, markers, ball, reflectivity = "0.6", exposures, out;
    double radius_m = 0, camera_deg = 6;
    int size = 512;
};

/// Fills markers with the brightness around them, as their squares could be taken for the rim of the ball.
cv::Mat without_markers(ProbeSide const& side, ar::MarkerMap const& map, ar::CameraModel const& camera)
{
    cv::Mat picture = side.radiance.clone();
    std::vector<std::vector<cv::Point>> corners{std::size_t(ar::count_of(map))};
    for (ar::PlacedMarker const& m : ar::placed_markers(map))
        for (glm::dvec3 const& corner : m.corners_m)
            if (auto const p = project(camera, inverse(side.world_from_camera) *
                                                   (ar::world_from_thing(map, m.thing) * corner)))
                corners[std::size_t(m.thing)].emplace_back(cv::Point2d(p->x, p->y));
    for (auto const& points : corners) {
        if (points.size() < 3) continue;
        std::vector<cv::Point> hull;
        cv::convexHull(points, hull);
        int const wider = std::max(3, int(0.05 * std::sqrt(cv::contourArea(hull))));
        cv::Mat inside = cv::Mat::zeros(picture.size(), CV_8U), around;
        cv::fillConvexPoly(inside, hull, 255);
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

/// @param[in,out] ball_m position found by the first side; the ball must not move between sides
ar::PartialMap unwrapped(ProbeSide const& side, ProbeOptions const& o, ar::MarkerMap const& markers,
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
    fmt::print(
        "{}: ball at {:.4f}, {:.4f}, {:.4f} m, rim {:.2f} px RMS in {} of 360 places; shows {:.2f} % of all "
        "directions\n",
        side.name, at.x, at.y, at.z, ball.rms_px, ball.rim_points, 100 * ar::covered_share(map));
    return map;
}

void print_light(cv::Mat const& map)
{
    fmt::print("irradiance of surfaces facing (red, green, blue)\n");
    static constexpr struct {
        char const* name;
        glm::dvec3 normal;
    } faces[] = {{"+x", {1, 0, 0}}, {"-x", {-1, 0, 0}}, {"+y, upward", {0, 1, 0}}, {"-y, downward", {0, -1, 0}},
                 {"+z", {0, 0, 1}}, {"-z", {0, 0, -1}}};
    for (auto const& f : faces) {
        cv::Vec3d const e = ar::irradiance_exact(map, f.normal);
        fmt::print("  {:<12} {:>10.4f} {:>10.4f} {:>10.4f}\n", f.name, e[0], e[1], e[2]);
    }
    ar::SplitMap const split = ar::split_lamps(map);
    fmt::print("{} lights with {:.1f} % of all light\n", split.lamps.size(), 100 * split.lamp_share);
    for (ar::Lamp const& l : split.lamps)
        fmt::print(
            "  towards {:.4f}, {:.4f}, {:.4f}: half angle {:.2f} degrees, irradiance {:.4f} {:.4f} {:.4f}\n",
            l.direction.x, l.direction.y, l.direction.z, glm::degrees(l.half_angle_rad), l.irradiance[0],
            l.irradiance[1], l.irradiance[2]);
}

int run_probe(ProbeOptions const& o)
{
    std::vector<std::string> inputs = o.pictures;
    inputs.insert(inputs.end(), {o.calibration, o.markers});
    check_outputs({o.out}, inputs);
    if (o.size % 2 != 0)
        throw gi::InputError(fmt::format("--size {}", o.size), "maps are twice as wide as high",
                             "give an even one");
    ar::Calibration const calibration = ar::read_calibration(o.calibration);
    ar::MarkerMap const markers = ar::read_marker_map(o.markers);
    if (!calibration.photometry)
        fmt::print(stderr, "{}: it has no response, bytes are assumed to be sRGB\n", o.calibration);
    auto const seconds = o.exposures.empty() ? std::vector<double>() : parse_exposures(o.exposures);
    std::vector<ar::PartialMap> maps;
    std::optional<glm::dvec3> ball_m;
    for (ProbeSide const& side : read_probe_sides(o.pictures, seconds, calibration, markers))
        maps.push_back(unwrapped(side, o, markers, calibration.camera, ball_m));
    ar::PartialMap const seen = ar::merged(maps);
    ar::FilledMap const map = ar::filled(seen);
    ar::write_map(o.out, map.radiance);
    fmt::print("{}: {} x {}, {:.2f} % measured, {:.2f} % filled in from neighbours\n", o.out, o.size, o.size / 2,
               100 * ar::covered_share(seen), 100 * std::max(0.0, map.filled_share));
    print_light(map.radiance);
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
    c->add_option("--out", o->out, "map to write: .exr, .hdr or .png (clipped at 1)")->required();
    c->footer(R"(Example:
  lightwell ar probe a1.png a2.png b1.png b2.png --exposures 1/30,1/500 --calibration camera.yaml --markers markers.yaml
      --ball-radius 0.05 --out probe.exr

Give all pictures of one side, then those of the next. Two sides at 90 degrees leave no gap.)");
    c->callback([o, &exit_code] { exit_code = run_probe(*o); });
}

} // namespace viewer
