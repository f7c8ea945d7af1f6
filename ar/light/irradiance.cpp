#include "ar/light/irradiance.h"

namespace ar {

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
