#include "ar/light/lamps.h"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

using Texels = std::vector<cv::Point>;

/// Regions connected by edges and corners, also across the seam at u = 0, with a rim of one texel for the lamp's
/// blurred edge. Rims do not overlap.
std::vector<Texels> bright_regions(cv::Mat const& map, double limit)
{
    cv::Mat bright(map.size(), CV_8UC1);
    for (int j = 0; j < map.rows; ++j)
        for (int i = 0; i < map.cols; ++i)
            bright.at<uchar>(j, i) = luminance(cv::Vec3d(map.at<cv::Vec3f>(j, i))) > limit ? 255 : 0;
    cv::Mat wide; // one column of the other side at each end
    cv::copyMakeBorder(bright, wide, 0, 0, 1, 1, cv::BORDER_WRAP);
    cv::dilate(wide, wide, cv::Mat::ones(3, 3, CV_8UC1));
    bright = wide.colRange(1, map.cols + 1).clone();
    cv::Mat labels;
    int const n = cv::connectedComponents(bright, labels, 8);
    std::vector<int> same(std::size_t(n), 0);
    std::iota(same.begin(), same.end(), 0);
    auto const root = [&](int l) {
        while (same[std::size_t(l)] != l) l = same[std::size_t(l)];
        return l;
    };
    for (int j = 0; j < map.rows; ++j)
        for (int b = std::max(0, j - 1); b <= std::min(map.rows - 1, j + 1); ++b) {
            int const left = labels.at<int>(j, 0), right = labels.at<int>(b, map.cols - 1);
            if (left && right) same[std::size_t(root(left))] = root(right);
        }
    std::vector<Texels> regions(static_cast<std::size_t>(n));
    for (int j = 0; j < map.rows; ++j)
        for (int i = 0; i < map.cols; ++i)
            if (int const l = labels.at<int>(j, i)) regions[std::size_t(root(l))].emplace_back(i, j);
    std::erase_if(regions, [](Texels const& r) { return r.empty(); });
    return regions;
}

double region_sr(cv::Size map, Texels const& region)
{
    double sum = 0;
    for (cv::Point const& t : region) sum += texel_sr(map, t.y);
    return sum;
}

Lamp lamp_of(cv::Mat const& map, cv::Mat const& rest, Texels const& region)
{
    Lamp lamp;
    glm::dvec3 towards(0);
    double sum = 0, sum2 = 0;
    for (cv::Point const& t : region) {
        double const sr = texel_sr(map.size(), t.y);
        cv::Vec3d const light = sr * (cv::Vec3d(map.at<cv::Vec3f>(t)) - cv::Vec3d(rest.at<cv::Vec3f>(t)));
        lamp.irradiance += light;
        towards += luminance(light) * texel_direction(map.size(), t.x, t.y);
        sum += luminance(light);
        sum2 += luminance(light) * luminance(light) / sr;
    }
    double const region_size = region_sr(map.size(), region);
    lamp.solid_angle_sr = sum2 > 0 ? std::min(region_size, sum * sum / sum2) : region_size;
    lamp.half_angle_rad = std::acos(std::clamp(1 - lamp.solid_angle_sr / (2 * std::numbers::pi), -1.0, 1.0));
    if (glm::length(towards) > 0) lamp.direction = glm::normalize(towards);
    lamp.radiance = lamp.irradiance / lamp.solid_angle_sr;
    return lamp;
}

double light_of(cv::Mat const& map, Texels const& region)
{
    double sum = 0;
    for (cv::Point const& t : region)
        sum += texel_sr(map.size(), t.y) * luminance(cv::Vec3d(map.at<cv::Vec3f>(t)));
    return sum;
}

} // namespace

double luminance(cv::Vec3d const& rgb) { return 0.2126 * rgb[0] + 0.7152 * rgb[1] + 0.0722 * rgb[2]; }

SplitMap split_lamps(cv::Mat const& map, LampSettings const& settings)
{
    SplitMap out;
    out.rest = map.clone();
    double const whole = luminance(integral(map));
    if (!(whole > 0)) return out;
    std::vector<Texels> regions = bright_regions(map, settings.times_mean * whole / (4 * std::numbers::pi));
    auto const drop = [&](auto const& condition) { return int(std::erase_if(regions, condition)); };
    out.too_large = drop([&](Texels const& r) { return region_sr(map.size(), r) > settings.largest_sr; });
    out.too_faint = drop([&](Texels const& r) { return light_of(map, r) < settings.least_share * whole; });
    std::stable_sort(regions.begin(), regions.end(),
                     [&](Texels const& a, Texels const& b) { return light_of(map, a) > light_of(map, b); });
    if (regions.size() > settings.most) {
        out.too_many = int(regions.size() - settings.most);
        regions.resize(settings.most);
    }
    if (regions.empty()) return out;
    PartialMap around{map.clone(), cv::Mat::ones(map.size(), CV_32FC1)};
    for (Texels const& r : regions)
        for (cv::Point const& t : r) around.weight.at<float>(t) = 0;
    if (cv::countNonZero(around.weight) == 0) return out;
    cv::Mat const fill = filled(around).radiance;
    for (Texels const& r : regions)
        for (cv::Point const& t : r)
            for (int c = 0; c < 3; ++c) // a lamp takes no light away
                out.rest.at<cv::Vec3f>(t)[c] = std::min(fill.at<cv::Vec3f>(t)[c], map.at<cv::Vec3f>(t)[c]);
    double light = 0;
    for (Texels const& r : regions) {
        out.lamps.push_back(lamp_of(map, out.rest, r));
        light += luminance(out.lamps.back().irradiance);
    }
    out.lamp_share = light / whole;
    return out;
}

} // namespace ar
