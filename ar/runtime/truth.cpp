#include "ar/runtime/truth.h"

#include "ar/camera/photometry.h"
#include "gi/metrics/flip.h"

#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

std::vector<float> linear(cv::Mat const& rgb)
{
    cv::Mat const radiance = radiance_of(rgb, srgb_photometry());
    return {radiance.ptr<float>(), radiance.ptr<float>() + radiance.total() * 3};
}

cv::Mat flip_of(cv::Mat const& a, cv::Mat const& b)
{
    std::vector<float> const values = gi::flip(linear(a), linear(b), a.cols, a.rows);
    return cv::Mat(a.rows, a.cols, CV_32FC1, const_cast<float*>(values.data())).clone();
}

} // namespace

cv::Mat affected_by_truth(cv::Mat const& camera, cv::Mat const& truth)
{
    cv::Mat difference, most, region;
    cv::absdiff(camera, truth, difference);
    std::array<cv::Mat, 3> channels;
    cv::split(difference, channels.data());
    most = cv::max(channels[0], cv::max(channels[1], channels[2]));
    cv::dilate(most > 1, region, cv::getStructuringElement(cv::MORPH_ELLIPSE, {5, 5}));
    return region;
}

TruthErrors errors_against_truth(cv::Mat const& composite, cv::Mat const& camera, cv::Mat const& truth)
{
    cv::Mat const region = affected_by_truth(camera, truth);
    auto const mean = [](cv::Mat const& flip, cv::Mat const& where) {
        return cv::countNonZero(where) > 0 ? std::optional(cv::mean(flip, where)[0]) : std::nullopt;
    };
    cv::Mat const flip = flip_of(composite, truth), nothing = flip_of(camera, truth);
    TruthErrors e;
    e.affected = double(cv::countNonZero(region)) / double(region.total());
    e.flip_affected = mean(flip, region);
    e.flip_elsewhere = mean(flip, ~region);
    e.camera_affected = mean(nothing, region);
    e.camera_elsewhere = mean(nothing, ~region);
    e.equals_camera = cv::norm(camera, truth, cv::NORM_INF) == 0;
    return e;
}

} // namespace ar
