#include "ar/pipeline/plain_composite.h"

#include "ar/camera/photometry.h"

#include <opencv2/core.hpp>

namespace ar {

cv::Mat plain_composite(cv::Mat const& rgb, RenderedPair const& pair)
{
    Photometry const srgb = srgb_photometry();
    cv::Mat const table(1, 256, CV_32FC1, const_cast<float*>(srgb.unit_of_byte[0].data()));
    cv::Mat light, uncovered, dark, bright;
    cv::LUT(rgb, table, light);
    cv::subtract(light, pair.without, light);
    cv::subtract(1, pair.coverage, uncovered);
    cv::merge(std::vector<cv::Mat>(3, uncovered), uncovered);
    cv::multiply(light, uncovered, light);
    cv::add(light, pair.with, light);
    light = cv::max(light, 0);
    cv::pow(light, 1 / 2.4, bright);
    bright.convertTo(bright, -1, 255 * 1.055, -255 * 0.055);
    light.convertTo(dark, -1, 255 * 12.92);
    dark.copyTo(bright, light <= 0.0031308);
    cv::Mat out;
    bright.convertTo(out, CV_8U);
    return out;
}

} // namespace ar
