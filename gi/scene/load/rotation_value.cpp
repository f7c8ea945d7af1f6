#include "gi/scene/load/rotation_value.h"

#include "gi/scene/load/scene_file_keys.h"

#include <glm/gtc/matrix_transform.hpp>

namespace gi {

dmat4 read_rotation(Yaml const& r)
{
    if (r.is_list()) {
        dvec3 const a = glm::radians(r.vector(-1e6, 1e6));
        return glm::rotate(dmat4(1), a.z, dvec3{0, 0, 1}) * glm::rotate(dmat4(1), a.y, dvec3{0, 1, 0}) *
               glm::rotate(dmat4(1), a.x, dvec3{1, 0, 0});
    }
    check_keys(r, "rotation");
    dvec3 const axis = r.has("axis") ? r.at("axis").vector(-1e6, 1e6) : dvec3{0, 1, 0};
    if (!(glm::length(axis) > 0)) throw r.error("the axis is zero", "it has no direction", "axis: [0, 1, 0]");
    if (!r.has("degrees")) throw r.error("a rotation needs degrees", "the angle is missing", "degrees: 90");
    return glm::rotate(dmat4(1), glm::radians(r.at("degrees").number(-1e6, 1e6)), glm::normalize(axis));
}

} // namespace gi
