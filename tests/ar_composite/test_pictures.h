#pragma once
// Pictures that tests of this room share.

#include "ar/composite/rendered_pair.h"

namespace ar::test {

/// Bytes of all kinds, with structure and noise.
inline cv::Mat camera_frame(cv::Size size, int seed = 7)
{
    cv::Mat rgb(size, CV_8UC3);
    cv::RNG random{std::uint64_t(seed)};
    random.fill(rgb, cv::RNG::UNIFORM, 0, 256);
    for (int y = 0; y < size.height / 2; ++y)
        for (int x = 0; x < size.width; ++x)
            rgb.at<cv::Vec3b>(y, x) = cv::Vec3b(uchar(40 + x % 180), uchar(255 - y % 200), uchar(x * y % 256));
    return rgb;
}

inline cv::Mat random_radiance(cv::Size size, int seed, double least = 0, double most = 1)
{
    cv::Mat picture(size, CV_32FC3);
    cv::RNG random{std::uint64_t(seed)};
    random.fill(picture, cv::RNG::UNIFORM, least, most);
    return picture;
}

/// Nothing virtual.
inline RenderedPair unchanged_pair(cv::Size size)
{
    cv::Mat const place = random_radiance(size, 3);
    return {place, place.clone(), cv::Mat::zeros(size, CV_32FC1)};
}

inline bool equal(cv::Mat const& a, cv::Mat const& b)
{
    return a.size() == b.size() && a.type() == b.type() && cv::norm(a, b, cv::NORM_INF) == 0;
}

} // namespace ar::test
