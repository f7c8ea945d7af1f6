#include "ar/composite/sensor_noise.h"

#include <algorithm>
#include <cmath>
#include <opencv2/imgproc.hpp>

namespace ar {
namespace {

/// The finaliser of splitmix64 (Steele et al. 2014).
std::uint64_t mixed(std::uint64_t x)
{
    x += 0x9e3779b97f4a7c15ull;
    x = (x ^ (x >> 30)) * 0xbf58476d1ce4e5b9ull;
    x = (x ^ (x >> 27)) * 0x94d049bb133111ebull;
    return x ^ (x >> 31);
}

} // namespace

bool SensorNoise::any() const
{
    auto const positive = [](float v) { return v > 0; };
    return std::any_of(constant.begin(), constant.end(), positive) ||
           std::any_of(per_unit.begin(), per_unit.end(), positive);
}

NoiseField::NoiseField(SensorNoise const& noise) : tile_(kSize, kSize, CV_32FC3), seed_(noise.seed)
{
    cv::RNG random(mixed(noise.seed));
    random.fill(tile_, cv::RNG::NORMAL, 0, 1);
    if (noise.grain_sigma_px > 0) {
        int const around = std::min(kSize / 2, int(std::ceil(4 * noise.grain_sigma_px)) + 1);
        cv::Mat wrapped;
        cv::copyMakeBorder(tile_, wrapped, around, around, around, around, cv::BORDER_WRAP);
        cv::GaussianBlur(wrapped, wrapped, {2 * around + 1, 2 * around + 1}, noise.grain_sigma_px);
        tile_ = wrapped({around, around, kSize, kSize}).clone();
    }
    cv::Scalar mean, deviation;
    cv::meanStdDev(tile_, mean, deviation);
    tile_.forEach<cv::Vec3f>([&](cv::Vec3f& v, int const*) {
        for (int c = 0; c < 3; ++c) v[c] = float((v[c] - mean[c]) / deviation[c]);
    });
}

cv::Point NoiseField::offset(std::uint64_t frame) const
{
    std::uint64_t const h = mixed(mixed(seed_) ^ frame);
    return {int(h % kSize), int((h >> 32) % kSize)};
}

} // namespace ar
