#include "gi/scene/motion/joint_motion.h"

#include "gi/scene/motion/inverse_kinematics.h"

namespace gi {

dvec3 joint_position(Pose const& pose, std::int32_t node)
{
    return dvec3(pose.world_from_node[std::size_t(node)][3]);
}

dquat orientation_of(dvec3 x, dvec3 y, double determinant)
{
    double const sign = determinant < 0 ? -1 : 1;
    dvec3 const z = glm::cross(x, y);
    if (!(glm::length(x) > 0) || !(glm::length(z) > 0)) return {1, 0, 0, 0};
    dvec3 const ux = sign * glm::normalize(x), uz = glm::normalize(z);
    return glm::normalize(glm::quat_cast(glm::dmat3(ux, glm::cross(uz, ux), uz)));
}

dquat orientation_of(dmat4 const& m)
{
    return orientation_of(dvec3(m[0]), dvec3(m[1]), glm::determinant(glm::dmat3(m)));
}

dquat tracker_orientation(dvec3 forward, dvec3 up) { return orientation_of(glm::cross(forward, up), up, 1); }

dmat4 turn_about(dvec3 pivot, dquat const& rotation)
{
    dmat4 m = glm::mat4_cast(rotation);
    m[3] = glm::dvec4(pivot - rotation * pivot, 1);
    return m;
}

void move_below(Scene const& scene, std::vector<std::int32_t> const& roots, dmat4 const& motion, Pose& pose)
{
    std::vector<bool> moves(scene.nodes.size(), false);
    for (std::int32_t const r : roots) moves[std::size_t(r)] = true;
    for (std::size_t n = 0; n < scene.nodes.size(); ++n) {
        std::int32_t const parent = scene.nodes[n].parent;
        if (parent >= 0 && moves[std::size_t(parent)]) moves[n] = true;
        if (moves[n]) pose.world_from_node[n] = motion * pose.world_from_node[n];
    }
}

dvec3 bend_limb(Scene const& scene, std::int32_t upper, std::int32_t lower, std::int32_t end, dvec3 target,
                dvec3 pole, Pose& pose)
{
    dvec3 const root = joint_position(pose, upper), middle = joint_position(pose, lower),
                tip = joint_position(pose, end);
    TwoBones const to = reach(root, glm::distance(root, middle), glm::distance(middle, tip), target, pole);
    dmat4 const first = turn_about(root, turn_between(middle - root, to.middle - root, pole));
    move_below(scene, {upper}, first, pose);
    dvec3 const bent = joint_position(pose, lower), carried(first * glm::dvec4(tip, 1));
    move_below(scene, {lower}, turn_about(bent, turn_between(carried - bent, to.end - bent, pole)), pose);
    return to.end;
}

} // namespace gi
