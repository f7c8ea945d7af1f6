#include "ar/light/picture_sampling.h"

#include "gi/core/error.h"

#include <algorithm>
#include <cmath>
#include <fmt/format.h>
#include <numbers>

namespace ar {
namespace {

cv::Vec3f bilinear(cv::Mat const& picture, glm::dvec2 p)
{
    int const x = std::clamp(int(p.x), 0, picture.cols - 2), y = std::clamp(int(p.y), 0, picture.rows - 2);
    auto const fx = float(p.x - x), fy = float(p.y - y);
    auto const *a = picture.ptr<cv::Vec3f>(y) + x, *b = picture.ptr<cv::Vec3f>(y + 1) + x;
    return (1 - fy) * ((1 - fx) * a[0] + fx * a[1]) + fy * ((1 - fx) * b[0] + fx * b[1]);
}

} // namespace

PartialMap gather(cv::Mat const& radiance, cv::Size size, double pixels_per_texel,
                  std::function<PictureSample(glm::dvec3)> const& look)
{
    int const n = std::clamp(int(std::ceil(pixels_per_texel)), 2, 16);
    PartialMap out{cv::Mat::zeros(size, CV_32FC3), cv::Mat::zeros(size, CV_32FC1)};
    cv::parallel_for_({0, size.height}, [&](cv::Range const& rows) {
        for (int j = rows.start; j < rows.end; ++j)
            for (int i = 0; i < size.width; ++i) {
                cv::Vec3d sum(0, 0, 0);
                double seen = 0, weights = 0, all = 0;
                for (int b = 0; b < n; ++b) {
                    double const v = (j + (b + 0.5) / n) / size.height, sr = std::sin(std::numbers::pi * v);
                    for (int a = 0; a < n; ++a) {
                        all += sr;
                        PictureSample const at = look(direction_of_uv({(i + (a + 0.5) / n) / size.width, v}));
                        glm::dvec2 const p = at.pixel;
                        bool const inside =
                            p.x >= 0 && p.y >= 0 && p.x <= radiance.cols - 1 && p.y <= radiance.rows - 1;
                        if (!(at.weight > 0) || !inside) continue;
                        sum += sr * cv::Vec3d(bilinear(radiance, p));
                        seen += sr;
                        weights += sr * at.weight;
                    }
                }
                if (2 * seen < all) continue; // less than half of it
                out.radiance.at<cv::Vec3f>(j, i) = cv::Vec3f(sum / seen);
                out.weight.at<float>(j, i) = float(weights / all);
            }
    });
    return out;
}

void check_picture(cv::Mat const& radiance, CameraModel const& camera, std::string const& where)
{
    auto const refuse = [&](std::string const& problem, std::string const& why) {
        throw gi::InputError(where + ": " + problem, why,
                             "give the radiance of the whole picture, in three floats");
    };
    if (radiance.type() != CV_32FC3 || radiance.cols < 2 || radiance.rows < 2)
        refuse("it is empty or not of three floats per pixel", "radiance is");
    if (radiance.cols != camera.size_px.x || radiance.rows != camera.size_px.y)
        refuse(fmt::format("{} x {} pixels, but the camera has {} x {}", radiance.cols, radiance.rows,
                           camera.size_px.x, camera.size_px.y),
               "pixels would have the wrong rays");
    for (int y = 0; y < radiance.rows; ++y)
        for (int x = 0; x < radiance.cols; ++x)
            for (float const v : radiance.at<cv::Vec3f>(y, x).val)
                if (!(v >= 0 && std::isfinite(v)))
                    refuse(fmt::format("the pixel ({}, {}) has the value {}", x, y, v),
                           "radiance is finite and not negative");
}

} // namespace ar
