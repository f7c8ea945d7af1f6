#include "ar/light/lat_long.h"
#include "gi/core/error.h"

#include <cmath>
#include <numbers>

namespace ar {
namespace {

struct Level {
    cv::Mat value; ///< CV_32FC3
    cv::Mat known; ///< CV_8UC1: 255
};

/// Halves width and height: the mean of the known texels in each 2 x 2 block, by solid angle.
Level coarser(Level const& fine)
{
    cv::Size const size(fine.value.cols / 2, fine.value.rows / 2);
    Level out{cv::Mat::zeros(size, CV_32FC3), cv::Mat::zeros(size, CV_8UC1)};
    for (int j = 0; j < size.height; ++j)
        for (int i = 0; i < size.width; ++i) {
            cv::Vec3d sum(0, 0, 0);
            double weights = 0;
            for (int b = 2 * j; b < 2 * j + 2; ++b)
                for (int a = 2 * i; a < 2 * i + 2; ++a)
                    if (fine.known.at<uchar>(b, a)) {
                        double const w = texel_sr(fine.value.size(), b);
                        sum += w * cv::Vec3d(fine.value.at<cv::Vec3f>(b, a));
                        weights += w;
                    }
            if (weights > 0) {
                out.value.at<cv::Vec3f>(j, i) = cv::Vec3f(sum / weights);
                out.known.at<uchar>(j, i) = 255;
            }
        }
    return out;
}

/// Gauss-Seidel on Laplace's equation on the sphere: (1/sin v) d/dv (sin v dL/dv) + (1/sin^2 v) d^2 L/du^2 = 0;
/// steps of u and v are alike in maps of 2 : 1.
void relax(Level& level, int rounds)
{
    cv::Mat& m = level.value;
    int const w = m.cols, h = m.rows;
    for (int round = 0; round < rounds; ++round)
        for (int j = 0; j < h; ++j) {
            double const sine = std::sin(std::numbers::pi * (j + 0.5) / h);
            auto const up = float(std::sin(std::numbers::pi * j / h) / sine);
            auto const down = float(std::sin(std::numbers::pi * (j + 1) / h) / sine);
            auto const across = float(1 / (sine * sine));
            auto const* above = m.ptr<cv::Vec3f>(std::max(0, j - 1));
            auto const* below = m.ptr<cv::Vec3f>(std::min(h - 1, j + 1));
            auto* row = m.ptr<cv::Vec3f>(j);
            for (int i = 0; i < w; ++i) {
                if (level.known.at<uchar>(j, i)) continue;
                cv::Vec3f const beside = row[(i + 1) % w] + row[(i + w - 1) % w];
                row[i] = (across * beside + up * above[i] + down * below[i]) / (2 * across + up + down);
            }
        }
}

/// Unknown texels from the coarser level, then smoothed.
void solve(Level& level)
{
    if (cv::countNonZero(level.known) == int(level.known.total())) return;
    if (level.value.cols % 2 == 0 && level.value.rows % 2 == 0 && level.value.rows > 2) {
        Level coarse = coarser(level);
        solve(coarse);
        for (int j = 0; j < level.value.rows; ++j)
            for (int i = 0; i < level.value.cols; ++i)
                if (!level.known.at<uchar>(j, i))
                    level.value.at<cv::Vec3f>(j, i) =
                        sample(coarse.value, texel_direction(level.value.size(), i, j));
    } else {
        cv::Scalar const mean = cv::mean(level.value, level.known);
        level.value.setTo(mean, level.known == 0);
    }
    relax(level, 40);
}

} // namespace

FilledMap filled(PartialMap const& map)
{
    if (map.weight.empty() || cv::countNonZero(map.weight > 0) == 0)
        throw gi::InputError("the environment map has no measured direction", "there is nothing to fill it from",
                             "check where the ball or the camera is and which way it looks");
    Level level{map.radiance.clone(), map.weight > 0};
    FilledMap out;
    out.filled_texels = int(level.known.total()) - cv::countNonZero(level.known);
    out.filled_share = 1 - covered_share(map);
    solve(level);
    out.radiance = level.value;
    return out;
}

} // namespace ar
