#pragma once
// A camera with a known response (an S-shaped film curve on a gamma), vignetting, colours and noise.

#include "ar/camera/photometry.h"

#include <algorithm>
#include <cmath>

namespace ar::test {

/// Byte 0..255 of a unit (1 = white), before rounding.
inline double film(double unit)
{
    double const g = std::pow(std::clamp(unit, 0., 1.), 1 / 2.2);
    return 255 * std::min(1.0, g * (1 + 0.18 * std::sin(3.14159265358979 * (g - 0.5)) * (1 - g)));
}

/// Its inverse at whole bytes.
inline Photometry film_photometry()
{
    Photometry p;
    for (std::size_t i = 0; i < 256; ++i) {
        double low = 0, high = 1;
        for (int k = 0; k < 60; ++k) {
            double const m = 0.5 * (low + high);
            (film(m) < double(i) ? low : high) = m;
        }
        for (auto& unit : p.unit_of_byte) unit[i] = float(0.5 * (low + high));
    }
    p.reference.time_s = 0.01;
    return p;
}

struct Noise {
    double read = 0, photon = 0; ///< variance = read + photon * unit
};

/// @param light CV_32FC3 radiance
inline cv::Mat photograph(cv::Mat const& light, Photometry const& p, double exposure, Noise noise,
                          std::uint64_t seed)
{
    cv::RNG rng(seed + 77);
    cv::Mat out(light.size(), CV_8UC3);
    cv::Matx33f const camera = p.colour.inv();
    for (int y = 0; y < light.rows; ++y)
        for (int x = 0; x < light.cols; ++x) {
            double const dx = x + 0.5 - 0.5 * light.cols, dy = y + 0.5 - 0.5 * light.rows;
            double const r2 =
                4 * (dx * dx + dy * dy) / (double(light.cols) * light.cols + double(light.rows) * light.rows);
            double const falloff = 1 + r2 * (p.vignetting[0] + r2 * (p.vignetting[1] + r2 * p.vignetting[2]));
            cv::Vec3f const v = camera * light.at<cv::Vec3f>(y, x);
            for (int c = 0; c < 3; ++c) {
                double u = v[c] * falloff * exposure;
                u += rng.gaussian(std::sqrt(noise.read + noise.photon * std::max(0., u)));
                out.at<cv::Vec3b>(y, x)[c] = cv::saturate_cast<std::uint8_t>(film(u));
            }
        }
    return out;
}

/// A scene with light from 0.002 to 3, smooth and with steps.
inline cv::Mat scene(cv::Size size)
{
    cv::Mat light(size, CV_32FC3);
    for (int y = 0; y < size.height; ++y)
        for (int x = 0; x < size.width; ++x) {
            double const u = double(x) / size.width, v = double(y) / size.height;
            double const base = std::exp(-6 + 7 * u) * (int(v * 8) % 2 == 0 ? 1 : 0.6);
            light.at<cv::Vec3f>(y, x) =
                cv::Vec3f(float(base), float(base * (0.8 + 0.4 * v)), float(base * (1.1 - 0.3 * v)));
        }
    return light;
}

} // namespace ar::test
