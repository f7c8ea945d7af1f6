#include "ar/light/light_fit.h"

#include "ar/light/lamps.h"

#include <algorithm>
#include <cmath>

namespace ar {

std::optional<FittedLamp> dominant_lamp(LightFit const& fit)
{
    if (fit.lamps.empty()) return std::nullopt;
    FittedLamp all = fit.lamps[0];
    glm::dvec3 sum(0);
    all.irradiance = all.sigma = cv::Vec3d(0, 0, 0);
    all.gain = 0;
    for (FittedLamp const& l : fit.lamps) {
        if (glm::dot(l.direction, fit.lamps[0].direction) < std::cos(glm::radians(8.0))) continue;
        sum += luminance(l.irradiance) * l.direction;
        all.irradiance += l.irradiance;
        all.gain += l.gain;
        // Discs side by side are alternatives for one lamp: the error of their sum is no larger than that of one.
        for (int c = 0; c < 3; ++c) all.sigma[c] = std::max(all.sigma[c], l.sigma[c]);
    }
    if (glm::length(sum) > 0) all.direction = glm::normalize(sum);
    return all;
}

cv::Mat map_of(LightBasis const& basis, LightFit const& fit, cv::Size size)
{
    cv::Mat map = basis.spread(fit.radiance, size);
    for (FittedLamp const& lamp : fit.lamps) {
        // Weight of a texel: the share of a grid of points in it that the disc covers.
        // A disc that covers no point lies in one texel.
        double const texel = std::numbers::pi / size.height;
        double const limit = std::cos(std::max(lamp.half_angle_rad, 0.75 * texel));
        constexpr int n = 4;
        cv::Mat share = cv::Mat::zeros(size, CV_64F);
        double all = 0;
        for (int j = 0; j < size.height; ++j)
            for (int i = 0; i < size.width; ++i) {
                if (glm::dot(texel_direction(size, i, j), lamp.direction) <
                    std::cos(std::min(std::numbers::pi, std::acos(limit) + 2 * texel)))
                    continue;
                int inside = 0;
                for (int b = 0; b < n * n; ++b)
                    inside += glm::dot(direction_of_uv({(i + (b % n + 0.5) / n) / size.width,
                                                        (j + (b / n + 0.5) / n) / size.height}),
                                       lamp.direction) >= limit;
                share.at<double>(j, i) = inside / double(n * n);
                all += share.at<double>(j, i) * texel_sr(size, j);
            }
        if (!(all > 0)) continue;
        for (int j = 0; j < size.height; ++j)
            for (int i = 0; i < size.width; ++i)
                if (double const s = share.at<double>(j, i); s > 0)
                    map.at<cv::Vec3f>(j, i) += cv::Vec3f(s / all * lamp.irradiance);
    }
    return map;
}

double irradiance_sigma(LightBasis const& basis, LightFit const& fit, glm::dvec3 normal)
{
    std::vector<double> e;
    for (int k = 0; k < basis.count(); ++k)
        e.push_back(basis.cell_sr() * std::max(0.0, glm::dot(normal, basis.direction(k))));
    for (FittedLamp const& l : fit.lamps) e.push_back(std::max(0.0, glm::dot(normal, l.direction)));
    double sum = 0;
    for (std::size_t a = 0; a < e.size(); ++a)
        for (std::size_t b = 0; b < e.size(); ++b) sum += e[a] * e[b] * fit.covariance.at<double>(int(a), int(b));
    return std::sqrt(std::max(0.0, sum));
}

} // namespace ar
