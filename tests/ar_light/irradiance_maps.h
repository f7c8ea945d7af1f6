#pragma once
// What environments do to matt faces of all directions, and how far two of them are apart: the measure by which
// tests judge light that was captured.

#include "ar/light/lamps.h"
#include "gi/light_paths/settings.h"

#include <array>
#include <cmath>
#include <numbers>

namespace ar::test {

inline std::array<double, 9> basis(glm::dvec3 d)
{
    return {0.282094791773878,
            0.488602511902920 * d.y,
            0.488602511902920 * d.z,
            0.488602511902920 * d.x,
            1.092548430592079 * d.x * d.y,
            1.092548430592079 * d.y * d.z,
            0.315391565252520 * (3 * d.z * d.z - 1),
            1.092548430592079 * d.x * d.z,
            0.546274215296040 * (d.x * d.x - d.y * d.y)};
}

/// Real spherical harmonics up to order 2, l = 0: 1, l = 1: y z x, l = 2: xy yz 3z^2-1 xz x^2-y^2 (Ramamoorthi and
/// Hanrahan 2001, "An Efficient Representation for Irradiance Environment Maps"), of each channel.
using Harmonics9 = std::array<cv::Vec3d, 9>;
inline Harmonics9 harmonics_of(cv::Mat const& map)
{
    Harmonics9 sum{};
    for (int j = 0; j < map.rows; ++j) {
        double const sr = texel_sr(map.size(), j);
        for (int i = 0; i < map.cols; ++i) {
            auto const y = basis(texel_direction(map.size(), i, j));
            cv::Vec3d const light = sr * cv::Vec3d(map.at<cv::Vec3f>(j, i));
            for (std::size_t k = 0; k < 9; ++k) sum[k] += y[k] * light;
        }
    }
    return sum;
}

/// Their E(n) = sum A_l L_lm Y_lm(n), A = pi, 2 pi / 3, pi / 4. Within 3 % of the truth on the mean for most
/// environments, 9 % at worst (same paper); may be slightly negative opposite a single lamp.
inline cv::Vec3d irradiance(Harmonics9 const& harmonics, glm::dvec3 normal)
{
    constexpr double pi = std::numbers::pi;
    auto const y = basis(normal);
    cv::Vec3d sum(0, 0, 0);
    for (std::size_t k = 0; k < 9; ++k) sum += (k == 0 ? pi : k < 4 ? 2 * pi / 3 : pi / 4) * y[k] * harmonics[k];
    return sum;
}

enum class IrradianceBy { harmonics, exact_sum };
/// CV_32FC3, lat-long by normal.
inline cv::Mat irradiance_map(cv::Mat const& map, cv::Size size = {64, 32},
                              IrradianceBy by = IrradianceBy::harmonics)
{
    Harmonics9 const harmonics = by == IrradianceBy::harmonics ? harmonics_of(map) : Harmonics9{};
    std::vector<glm::dvec4> texels; // direction and solid angle
    if (by == IrradianceBy::exact_sum)
        for (int j = 0; j < map.rows; ++j)
            for (int i = 0; i < map.cols; ++i)
                texels.emplace_back(texel_direction(map.size(), i, j), texel_sr(map.size(), j));
    cv::Mat out(size, CV_32FC3);
    cv::parallel_for_({0, size.height}, [&](cv::Range const& rows) {
        for (int j = rows.start; j < rows.end; ++j)
            for (int i = 0; i < size.width; ++i) {
                glm::dvec3 const n = texel_direction(size, i, j);
                cv::Vec3d sum = by == IrradianceBy::harmonics ? irradiance(harmonics, n) : cv::Vec3d();
                for (std::size_t k = 0; k < texels.size(); ++k)
                    if (double const cosine = glm::dot(n, glm::dvec3(texels[k])); cosine > 0)
                        sum += cosine * texels[k].w *
                               cv::Vec3d(map.at<cv::Vec3f>(int(k) / map.cols, int(k) % map.cols));
                out.at<cv::Vec3f>(j, i) = cv::Vec3f(sum);
            }
    });
    return out;
}

/// Mean over the sphere and channels of (x - r)^2 / (r^2 + 0.01 m^2), m = the mean of r:
/// of two irradiance maps of one size.
inline double relative_error2(cv::Mat const& x, cv::Mat const& r)
{
    CV_Assert(x.size() == r.size() && x.type() == CV_32FC3 && r.type() == CV_32FC3);
    cv::Vec3d const mean = integral(r) / (4 * std::numbers::pi);
    double sum = 0;
    for (int j = 0; j < r.rows; ++j)
        for (int i = 0; i < r.cols; ++i)
            for (int c = 0; c < 3; ++c) {
                double const truth = r.at<cv::Vec3f>(j, i)[c], miss = x.at<cv::Vec3f>(j, i)[c] - truth;
                if (miss != 0)
                    sum += texel_sr(r.size(), j) * miss * miss / (truth * truth + 0.01 * mean[c] * mean[c]);
            }
    return sum / (3 * 4 * std::numbers::pi);
}

/// The map with the lamps drawn as discs, each with its light whatever texels the disc falls on.
inline cv::Mat with_lamps(cv::Mat const& rest, std::vector<Lamp> const& lamps)
{
    cv::Mat out = rest.clone();
    for (Lamp const& lamp : lamps) {
        double const cosine = std::cos(lamp.half_angle_rad);
        std::vector<cv::Point> disc;
        glm::dvec2 const uv = uv_of(lamp.direction);
        for (int j = 0; j < out.rows; ++j)
            for (int i = 0; i < out.cols; ++i)
                if (glm::dot(lamp.direction, texel_direction(out.size(), i, j)) >= cosine) disc.emplace_back(i, j);
        if (disc.empty())
            disc.emplace_back(std::min(out.cols - 1, int(uv.x * out.cols)),
                              std::min(out.rows - 1, int(uv.y * out.rows)));
        double sr = 0;
        for (cv::Point const& t : disc) sr += texel_sr(out.size(), t.y);
        cv::Vec3d const radiance = lamp.irradiance / sr;
        for (cv::Point const& t : disc) out.at<cv::Vec3f>(t) += cv::Vec3f(radiance);
    }
    return out;
}

} // namespace ar::test
