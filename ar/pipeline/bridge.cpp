#include "ar/pipeline/bridge.h"

#include <algorithm>
#include <cstring>
#include <glm/gtc/matrix_transform.hpp>
#include <stdexcept>

namespace ar {

gi::Camera gi_camera(CameraModel const& c, gi::RigidPose const& world_from_camera)
{
    gi::Camera camera;
    camera.off_axis = {(-0.5 - c.cx) / c.fx, (c.size_px.x - 0.5 - c.cx) / c.fx, -(c.size_px.y - 0.5 - c.cy) / c.fy,
                       (c.cy + 0.5) / c.fy};
    camera.world_from_camera = glm::translate(gi::dmat4(1), world_from_camera.position) *
                               glm::mat4_cast(world_from_camera.rotation) *
                               glm::scale(gi::dmat4(1), gi::dvec3(1, -1, -1));
    return camera;
}

cv::Mat matrix_of(gi::Picture const& picture, std::string const& name)
{
    gi::Layer const* const layer = picture.find(name);
    if (layer == nullptr) throw std::invalid_argument("a picture without the layer " + name);
    cv::Mat out(picture.height, picture.width, CV_32FC(layer->channels));
    std::memcpy(out.data, layer->data.data(), layer->data.size() * sizeof(float));
    return out;
}

gi::EnvironmentMap environment_of(cv::Mat const& lat_long)
{
    CV_Assert(lat_long.type() == CV_32FC3);
    gi::EnvironmentMap map;
    map.width = std::uint32_t(lat_long.cols);
    map.height = std::uint32_t(lat_long.rows);
    for (int y = 0; y < lat_long.rows; ++y)
        for (int x = 0; x < lat_long.cols; ++x) {
            auto const& v = lat_long.at<cv::Vec3f>(y, x);
            auto const light = [](float f) { return std::isfinite(f) ? std::max(f, 0.0f) : 0.0f; };
            map.radiance.push_back({light(v[0]), light(v[1]), light(v[2])});
        }
    return map;
}

} // namespace ar
