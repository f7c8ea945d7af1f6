#include "ar/light/clipped_light.h"

#include "ar/light/lamps.h"
#include "ar/light/lat_long.h"

namespace ar {
namespace {

constexpr float kLeastClipped = 0.1f; ///< share of a texel
constexpr double kLeastCosine = 0.15;

} // namespace

ClippedLight repair_clipped(cv::Mat& map, cv::Mat const& clipped, std::optional<MeasuredFace> const& face)
{
    CV_Assert(clipped.size() == map.size() && clipped.type() == CV_32FC1);
    ClippedLight out;
    glm::dvec3 sum(0);
    double light = 0;
    for (int j = 0; j < map.rows; ++j)
        for (int i = 0; i < map.cols; ++i) {
            float const share = clipped.at<float>(j, i);
            if (share < kLeastClipped) continue;
            double const sr = texel_sr(map.size(), j);
            cv::Vec3d const power = sr * cv::Vec3d(map.at<cv::Vec3f>(j, i));
            out.clipped_sr += sr * double(share);
            out.as_measured += power;
            sum += luminance(power) * texel_direction(map.size(), i, j);
            light += luminance(power);
        }
    if (!(light > 0) || !(glm::length(sum) > 0)) return out;
    out.towards = glm::normalize(sum);
    if (!face || glm::dot(face->normal, out.towards) < kLeastCosine) return out;
    // In proportion to the clipped light that each texel has already, so that its shape stays the same.
    double reach = 0; // mean cosine
    for (int j = 0; j < map.rows; ++j)
        for (int i = 0; i < map.cols; ++i)
            if (clipped.at<float>(j, i) >= kLeastClipped)
                reach += texel_sr(map.size(), j) * luminance(cv::Vec3d(map.at<cv::Vec3f>(j, i))) / light *
                         std::max(0.0, glm::dot(face->normal, texel_direction(map.size(), i, j)));
    if (reach < kLeastCosine) return out;
    cv::Vec3d const measured = irradiance_exact(map, face->normal);
    for (int c = 0; c < 3; ++c) out.added[c] = std::max(0.0, (face->irradiance[c] - measured[c]) / reach);
    for (int j = 0; j < map.rows; ++j)
        for (int i = 0; i < map.cols; ++i) {
            if (clipped.at<float>(j, i) < kLeastClipped) continue;
            auto& texel = map.at<cv::Vec3f>(j, i);
            texel += cv::Vec3f(luminance(cv::Vec3d(texel)) / light * out.added);
        }
    out.repaired = true;
    return out;
}

} // namespace ar
