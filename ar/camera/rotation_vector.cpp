#include "ar/camera/rotation_vector.h"

#include "ar/camera/pose.h"

namespace ar {

glm::dquat exp_rotation(glm::dvec3 v) { return pose_of({v.x, v.y, v.z}, {}).rotation; }

glm::dvec3 log_rotation(glm::dquat const& rotation)
{
    cv::Vec3d const v = rotation_vector({rotation, {}});
    return {v[0], v[1], v[2]};
}

} // namespace ar
