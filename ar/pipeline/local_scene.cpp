#include "ar/pipeline/local_scene.h"

#include "gi/core/error.h"
#include "gi/scene/motion/motion.h"

#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>
#include <span>

namespace ar {
namespace {

/// Scale of hidden objects. Not 0, so that lights keep a direction; triangles have zero area in floats.
constexpr double kGone = 1e-12;

/// Moves all nodes to one point, so that skins with distant joints vanish, too.
void vanish(std::span<gi::dmat4> world_from_node)
{
    gi::dvec3 const at = world_from_node[0][3];
    gi::dmat4 const gone = glm::translate(gi::dmat4(1), at) * glm::scale(gi::dmat4(1), gi::dvec3(kGone)) *
                           glm::translate(gi::dmat4(1), -at);
    for (gi::dmat4& m : world_from_node) m = gone * m;
}

} // namespace

void leave_out_views(gi::Scene& scene)
{
    for (gi::Node& n : scene.nodes) n.camera = -1;
    scene.cameras.clear();
    scene.environment.reset();
    scene.background = {};
}

LocalScene join_scenes(gi::Scene real, gi::Scene virtual_things, gi::dmat4 const& world_from_virtual)
{
    gi::Motion const motion = gi::find_motion(real);
    for (std::size_t n = 0; n < real.nodes.size(); ++n)
        if (!motion.node[n].empty() || !motion.morph[n].empty())
            throw gi::InputError(fmt::format("'{}' of the real scene moves ({}{})", real.nodes[n].name,
                                             motion.node[n], motion.morph[n]),
                                 "moving objects count as virtual", "leave it out, or move it to virtual");
    leave_out_views(real);
    leave_out_views(virtual_things);
    LocalScene local;
    local.first_virtual_node = real.nodes.size();
    for (gi::Node const& n : real.nodes) local.first_virtual_light += n.light >= 0 ? 1 : 0;
    gi::append(real, std::move(virtual_things), "virtual", world_from_virtual);
    real.nodes[local.first_virtual_node].driven = true;
    local.scene = std::make_shared<gi::Scene const>(std::move(real));
    return local;
}

gi::Pose local_pose(LocalScene const& local, gi::SceneTime time_s, gi::PairSide side)
{
    gi::Pose pose = gi::evaluate_pose(*local.scene, time_s);
    if (side == gi::PairSide::without) vanish(std::span(pose.world_from_node).subspan(local.first_virtual_node));
    return pose;
}

} // namespace ar
