#include "ar/light/irradiance.h"

#include <cmath>
#include <numbers>

namespace ar {
namespace {

std::array<double, 9> basis(glm::dvec3 d)
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

} // namespace

Harmonics9 harmonics_of(cv::Mat const& map)
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

cv::Vec3d irradiance(Harmonics9 const& harmonics, glm::dvec3 normal)
{
    constexpr double pi = std::numbers::pi;
    auto const y = basis(normal);
    cv::Vec3d sum(0, 0, 0);
    for (std::size_t k = 0; k < 9; ++k) sum += (k == 0 ? pi : k < 4 ? 2 * pi / 3 : pi / 4) * y[k] * harmonics[k];
    return sum;
}

cv::Vec3d irradiance_exact(cv::Mat const& map, glm::dvec3 normal)
{
    cv::Vec3d sum(0, 0, 0);
    for (int j = 0; j < map.rows; ++j) {
        double const sr = texel_sr(map.size(), j);
        for (int i = 0; i < map.cols; ++i)
            if (double const cosine = glm::dot(normal, texel_direction(map.size(), i, j)); cosine > 0)
                sum += cosine * sr * cv::Vec3d(map.at<cv::Vec3f>(j, i));
    }
    return sum;
}

cv::Mat irradiance_map(cv::Mat const& map, cv::Size size, IrradianceBy by)
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

double relative_error2(cv::Mat const& x, cv::Mat const& r)
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

} // namespace ar
