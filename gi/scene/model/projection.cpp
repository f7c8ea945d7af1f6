#include "gi/scene/model/projection.h"

namespace gi {
namespace {

dvec3 over_square(dvec3 v) { return v / glm::dot(v, v); }

} // namespace

Projection::Projection(CameraRays const& camera)
    : origin_(camera.origin),
      forward_(camera.forward),
      across_(over_square(dvec3(camera.step_x))),
      down_(over_square(dvec3(camera.step_y))),
      corner_x_(glm::dot(dvec3(camera.corner), across_)),
      corner_y_(glm::dot(dvec3(camera.corner), down_)),
      orthographic_(camera.orthographic)
{
}

} // namespace gi
