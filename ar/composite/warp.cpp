#include "ar/composite/warp.h"

#include "ar/camera/lens_domain.h"
#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <limits>
#include <opencv2/imgproc.hpp>

namespace ar {

CameraModel covering_pinhole(CameraModel const& camera, double resolution)
{
    if (!(resolution > 0) || !std::isfinite(resolution))
        throw gi::InputError(fmt::format("a resolution of {}", resolution), "it must be positive", "give 1");
    constexpr double kLeastCosine = 0.17364817766693041; // of 80 degrees
    glm::dvec2 least(std::numeric_limits<double>::infinity()), most(-least);
    auto const include = [&](double x, double y) {
        auto const d = direction_of(camera, {x, y});
        if (!d)
            throw gi::InputError(fmt::format("the lens model has no ray at ({:g}, {:g})", x, y),
                                 "what is rendered there is not known: " + describe(reach_of(camera)),
                                 "calibrate up to the picture's corners, or crop the frames");
        if (d->z <= kLeastCosine)
            throw gi::InputError(
                fmt::format("the camera sees 80 degrees or more off its axis at ({:g}, {:g})", x, y),
                "a pinhole picture that covers it would be very large",
                "crop the frames; `lightwell ar track` needs no rendering and uses the whole lens");
        least = glm::min(least, glm::dvec2(*d) / d->z);
        most = glm::max(most, glm::dvec2(*d) / d->z);
    };
    // Rays go outward as pixels do (`check`), so the border has the extremes; it is at the edges of the pixels.
    double const right = camera.size_px.x - 0.5, bottom = camera.size_px.y - 0.5;
    for (int x = 0; x <= camera.size_px.x; ++x)
        for (double const y : {-0.5, bottom}) include(x - 0.5, y);
    for (int y = 0; y <= camera.size_px.y; ++y)
        for (double const x : {-0.5, right}) include(x, y - 0.5);

    CameraModel pinhole;
    pinhole.fx = camera.fx * resolution;
    pinhole.fy = camera.fy * resolution;
    // One pixel more each side: the bilinear filter's reach.
    glm::dvec2 const first = glm::floor(least * glm::dvec2(pinhole.fx, pinhole.fy)) - 1.0;
    glm::dvec2 const last = glm::ceil(most * glm::dvec2(pinhole.fx, pinhole.fy)) + 1.0;
    glm::dvec2 const size = last - first + 1.0;
    if (std::max(size.x, size.y) > 16384)
        throw gi::InputError(
            fmt::format("a pinhole picture of {} x {} pixels would cover the lens", size.x, size.y),
            "at most 16384 each way are rendered", "ask for a lower resolution");
    pinhole.size_px = glm::ivec2(size);
    pinhole.cx = -first.x;
    pinhole.cy = -first.y;
    return pinhole;
}

Warp::Warp(CameraModel const& to, CameraModel const& from) : to_(to), from_(from), same_(to == from)
{
    if (same_) return;
    cv::Mat const table = remap_table(to, from);
    for (int y = 0; y < table.rows; ++y)
        for (int x = 0; x < table.cols; ++x) {
            cv::Vec2f const p = table.at<cv::Vec2f>(y, x);
            unseen_px_ += !(p[0] >= -0.5f && p[1] >= -0.5f && p[0] <= float(from.size_px.x) - 0.5f &&
                            p[1] <= float(from.size_px.y) - 0.5f);
        }
    cv::convertMaps(table, {}, table_, fractions_, CV_16SC2, false);
    cv::convertMaps(table, {}, table_nearest_, cv::noArray(), CV_16SC2, true);
}

cv::Mat Warp::remapped(cv::Mat const& picture, int interpolation) const
{
    if (picture.size() != cv::Size(from_.size_px.x, from_.size_px.y))
        throw gi::InputError(fmt::format("a rendered picture of {} x {} pixels", picture.cols, picture.rows),
                             fmt::format("the warp was made for {} x {}", from_.size_px.x, from_.size_px.y),
                             "make another Warp");
    if (same_) return picture;
    cv::Mat out;
    bool const nearest = interpolation == cv::INTER_NEAREST;
    cv::remap(picture, out, nearest ? table_nearest_ : table_, nearest ? cv::Mat() : fractions_, interpolation,
              cv::BORDER_CONSTANT, cv::Scalar::all(0));
    return out;
}

cv::Mat Warp::smooth(cv::Mat const& picture) const { return remapped(picture, cv::INTER_LINEAR); }
cv::Mat Warp::nearest(cv::Mat const& picture) const { return remapped(picture, cv::INTER_NEAREST); }

RenderedPair Warp::operator()(RenderedPair const& pair) const
{
    check(pair);
    return {smooth(pair.with), smooth(pair.without), smooth(pair.coverage),
            pair.direct.empty() ? cv::Mat() : smooth(pair.direct)};
}

} // namespace ar
