#include "ar/light/lat_long.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace ar {
namespace {

constexpr double kPi = std::numbers::pi;

} // namespace

glm::dvec2 uv_of(glm::dvec3 d)
{
    return {0.5 + std::atan2(d.x, -d.z) / (2 * kPi), std::acos(std::clamp(d.y, -1.0, 1.0)) / kPi};
}

glm::dvec3 direction_of_uv(glm::dvec2 uv)
{
    double const turn = 2 * kPi * (uv.x - 0.5), down = kPi * uv.y;
    return {std::sin(down) * std::sin(turn), std::cos(down), -std::sin(down) * std::cos(turn)};
}

glm::dvec3 texel_direction(cv::Size map, int column, int row)
{
    return direction_of_uv({(column + 0.5) / map.width, (row + 0.5) / map.height});
}

double texel_sr(cv::Size map, int row)
{
    double const upper = std::cos(kPi * row / map.height), lower = std::cos(kPi * (row + 1) / map.height);
    return 2 * kPi / map.width * (upper - lower);
}

cv::Vec3f sample(cv::Mat const& map, glm::dvec3 direction)
{
    glm::dvec2 const uv = uv_of(direction);
    double const x = uv.x * map.cols - 0.5, y = uv.y * map.rows - 0.5;
    double const left = std::floor(x), top = std::floor(y);
    auto const fx = float(x - left), fy = float(y - top);
    auto const column = [&](int i) { return (i % map.cols + map.cols) % map.cols; };
    auto const row = [&](int j) { return map.ptr<cv::Vec3f>(std::clamp(j, 0, map.rows - 1)); };
    int const i0 = column(int(left)), i1 = column(int(left) + 1);
    auto const *r0 = row(int(top)), *r1 = row(int(top) + 1);
    return (1 - fy) * ((1 - fx) * r0[i0] + fx * r0[i1]) + fy * ((1 - fx) * r1[i0] + fx * r1[i1]);
}

cv::Vec3d integral(cv::Mat const& map)
{
    cv::Vec3d sum(0, 0, 0);
    for (int j = 0; j < map.rows; ++j) {
        cv::Vec3d row(0, 0, 0);
        for (int i = 0; i < map.cols; ++i) row += cv::Vec3d(map.at<cv::Vec3f>(j, i));
        sum += texel_sr(map.size(), j) * row;
    }
    return sum;
}

cv::Mat resampled(cv::Mat const& map, cv::Size size, glm::dquat const& to_from)
{
    glm::dquat const from_to = glm::conjugate(to_from);
    int const n = std::max(1, (map.cols + size.width - 1) / size.width) * (map.cols > size.width ? 1 : 2);
    cv::Mat out(size, CV_32FC3);
    cv::parallel_for_({0, size.height}, [&](cv::Range const& rows) {
        for (int j = rows.start; j < rows.end; ++j)
            for (int i = 0; i < size.width; ++i) {
                cv::Vec3d sum(0, 0, 0);
                double weights = 0;
                for (int b = 0; b < n; ++b) {
                    double const v = (j + (b + 0.5) / n) / size.height, weight = std::sin(kPi * v);
                    for (int a = 0; a < n; ++a) {
                        glm::dvec3 const d = direction_of_uv({(i + (a + 0.5) / n) / size.width, v});
                        sum += weight * cv::Vec3d(sample(map, from_to * d));
                        weights += weight;
                    }
                }
                out.at<cv::Vec3f>(j, i) = cv::Vec3f(sum / weights);
            }
    });
    return out;
}

void check_map(cv::Mat const& map, std::string const& where)
{
    auto const refuse = [&](std::string const& problem, std::string const& why) {
        throw gi::InputError(where + ": " + problem, why, "give a lat-long map of linear RGB radiance");
    };
    if (map.empty()) refuse("the map is empty", "it has no texels");
    if (map.type() != CV_32FC3) refuse("the map is not of three floats per texel", "radiance is");
    if (map.cols != 2 * map.rows)
        refuse(fmt::format("the map has {} x {} texels", map.cols, map.rows),
               "lat-long maps are twice as wide as high");
    for (int j = 0; j < map.rows; ++j)
        for (int i = 0; i < map.cols; ++i)
            for (float const v : map.at<cv::Vec3f>(j, i).val)
                if (!(v >= 0 && std::isfinite(v)))
                    refuse(fmt::format("the texel ({}, {}) has the value {}", i, j, v),
                           "radiance is finite and not negative");
}

double covered_share(PartialMap const& map)
{
    double sum = 0;
    for (int j = 0; j < map.weight.rows; ++j)
        sum += texel_sr(map.weight.size(), j) * cv::countNonZero(map.weight.row(j) > 0);
    return sum / (4 * kPi);
}

PartialMap merged(std::span<PartialMap const> maps)
{
    PartialMap out;
    if (maps.empty()) return out;
    out = {cv::Mat::zeros(maps[0].radiance.size(), CV_32FC3), cv::Mat::zeros(maps[0].radiance.size(), CV_32FC1)};
    for (PartialMap const& m : maps) {
        CV_Assert(m.radiance.size() == out.radiance.size());
        out.weight += m.weight;
    }
    for (int j = 0; j < out.weight.rows; ++j)
        for (int i = 0; i < out.weight.cols; ++i) {
            float const all = out.weight.at<float>(j, i);
            for (PartialMap const& m : maps)
                if (all > 0)
                    out.radiance.at<cv::Vec3f>(j, i) +=
                        m.weight.at<float>(j, i) / all * m.radiance.at<cv::Vec3f>(j, i);
        }
    return out;
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

} // namespace ar
