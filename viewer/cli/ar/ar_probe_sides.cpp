#include "viewer/cli/ar/ar_probe_sides.h"

#include "ar/calibration/response.h"
#include "ar/markers/detect.h"
#include "ar/pipeline/pose_finder.h"
#include "gi/core/error.h"
#include "viewer/cli/ar/ar_arguments.h"

#include <algorithm>
#include <fmt/format.h>
#include <opencv2/imgproc.hpp>

namespace viewer {
namespace {

/// Camera pose from the picture with the most markers; dark pictures of an exposure bracket show none.
gi::RigidPose camera_of(std::vector<cv::Mat> const& rgb, ar::MarkerMap const& map, ar::CameraModel const& camera,
                        std::string const& name)
{
    ar::Sighting best;
    for (cv::Mat const& picture : rgb) {
        cv::Mat gray;
        cv::cvtColor(picture, gray, cv::COLOR_RGB2GRAY);
        ar::Sighting s = ar::detect(gray, map);
        if (s.points.size() > best.points.size() || best.markers_seen == 0) best = std::move(s);
    }
    ar::PoseEstimate const pose = ar::estimate_pose(best, camera);
    if (!pose.found())
        throw gi::InputError(
            "the camera is not found in " + name,
            fmt::format("{} marker points are used: {}", best.points.size(), ar::cause_of_loss(best, pose)),
            !best.contradictions.empty() ? best.contradictions.front()
            : best.markers_ambiguous > 0 ? "cover all but one " + best.ambiguous.front()
                                         : "take pictures with the markers lit and sharp");
    for (std::string const& why : best.contradictions) fmt::print(stderr, "lost: {}: {}\n", name, why);
    if (best.markers_ambiguous > 0)
        fmt::print(stderr, "lost: {}: {} is there more than once, and left out\n", name, best.ambiguous.front());
    fmt::print("{}: camera found from {} points, {:.2f} px RMS{}\n", name, pose.points_used, pose.rms_px,
               pose.ambiguous ? "; another pose would fit as well" : "");
    return pose.world_from_camera;
}

cv::Mat white_in_shortest(ar::Bracket const& bracket)
{
    std::size_t shortest = 0;
    for (std::size_t i = 1; i < bracket.exposures.size(); ++i)
        if (bracket.exposures[i].time_s < bracket.exposures[shortest].time_s) shortest = i;
    cv::Mat white(bracket.rgb[0].size(), CV_8UC1);
    for (int y = 0; y < white.rows; ++y)
        for (int x = 0; x < white.cols; ++x) {
            cv::Vec3b const v = bracket.rgb[shortest].at<cv::Vec3b>(y, x);
            white.at<std::uint8_t>(y, x) = std::max({v[0], v[1], v[2]}) >= 253 ? 255 : 0; // as ar::merge
        }
    return white;
}

} // namespace

std::vector<ProbeSide> read_probe_sides(std::vector<std::string> const& pictures,
                                        std::vector<double> const& seconds, ar::Calibration const& calibration,
                                        ar::MarkerMap const& map)
{
    std::size_t const each = std::max<std::size_t>(1, seconds.size());
    if (pictures.size() % each != 0)
        throw gi::InputError(fmt::format("{} pictures and {} exposures", pictures.size(), seconds.size()),
                             "each side needs a picture of each exposure",
                             "give all pictures of one side, then all of the next");
    ar::Photometry photometry = calibration.photometry ? *calibration.photometry : ar::srgb_photometry();
    if (photometry.reference.time_s == 0 && !seconds.empty()) {
        auto sorted = seconds;
        std::sort(sorted.begin(), sorted.end());
        photometry.reference.time_s = sorted[sorted.size() / 2];
        fmt::print(stderr, "the calibration has no reference exposure: radiance is relative to {:.6g} s\n",
                   photometry.reference.time_s);
    }
    ar::MergeOptions merging;
    if (calibration.noise) merging.noise = *calibration.noise;
    std::vector<ProbeSide> sides;
    for (std::size_t first = 0; first < pictures.size(); first += each) {
        ar::Bracket bracket;
        for (std::size_t i = 0; i < each; ++i) {
            bracket.rgb.push_back(read_rgb(pictures[first + i]));
            glm::ivec2 const is(bracket.rgb.back().cols, bracket.rgb.back().rows);
            if (is != calibration.camera.size_px)
                throw gi::InputError(fmt::format("{} has {} x {} px", pictures[first + i], is.x, is.y),
                                     fmt::format("the calibration is of {} x {}", calibration.camera.size_px.x,
                                                 calibration.camera.size_px.y),
                                     "give pictures as they come from that camera");
            ar::Exposure e;
            if (!seconds.empty()) e.time_s = seconds[i];
            bracket.exposures.push_back(e);
        }
        ProbeSide side{pictures[first], {}, camera_of(bracket.rgb, map, calibration.camera, pictures[first])};
        if (each > 1) {
            ar::MergedRadiance const m = ar::merge(bracket, photometry, merging);
            side.radiance = m.radiance;
            fmt::print("  {} px white in the shortest exposure, {} black in the longest, {} where they disagree\n",
                       m.saturated, m.dark, m.inconsistent);
        } else {
            side.radiance = ar::radiance_of(bracket.rgb[0], photometry, bracket.exposures[0]);
            fmt::print("  {} px at an end of their range: lights are brighter than measured\n",
                       cv::countNonZero(ar::is_clipped(bracket.rgb[0])));
        }
        side.clipped = white_in_shortest(bracket);
        sides.push_back(std::move(side));
    }
    return sides;
}

} // namespace viewer
