#include "viewer/devices/gl/view_matrices.h"

namespace viewer {

glm::dmat3 frame_from_pixel(gi::Camera const& camera, glm::ivec2 size_px)
{
    gi::ViewTangents const v = gi::view_edges(camera, size_px.x, size_px.y);
    glm::dmat3 m(0.0);
    m[0][0] = (v.right - v.left) / size_px.x;
    m[1][1] = (v.bottom - v.top) / size_px.y;
    m[2] = gi::dvec3(v.left, v.top, 1);
    return m;
}

glm::dmat3 axes_of(gi::Camera const& camera)
{
    auto const& m = camera.world_from_camera;
    return {gi::dvec3(m[0]), gi::dvec3(m[1]), -gi::dvec3(m[2])};
}

glm::dmat3 pixel_from_world(gi::Camera const& camera, glm::ivec2 size_px)
{
    return glm::inverse(frame_from_pixel(camera, size_px)) * glm::transpose(axes_of(camera));
}

std::array<glm::vec3, 8> corners_of(gi::Bounds const& box)
{
    std::array<glm::vec3, 8> corners;
    for (std::size_t k = 0; k < corners.size(); ++k)
        corners[k] = {(k & 1) != 0 ? box.high.x : box.low.x, (k & 2) != 0 ? box.high.y : box.low.y,
                      (k & 4) != 0 ? box.high.z : box.low.z};
    return corners;
}

} // namespace viewer
