#include "ar/scene/read_values.h"

#include <fmt/format.h>

namespace ar {

bool is_device(std::string const& name)
{
    return name == "camera" || name == "counter" || name.starts_with("camera:") || name.starts_with("device:") ||
           name.starts_with("gstreamer:");
}

PlacedScene read_placed(gi::Yaml const& p, std::string const& file_key, std::filesystem::path const& folder)
{
    PlacedScene placed;
    std::string const name = p.at(file_key).text();
    // As load_scene: a name without an extension is a scene that is generated, unless there is a folder of meshes.
    std::error_code none;
    bool const is_file = std::filesystem::path(name).has_extension() ||
                         (!name.empty() && std::filesystem::is_directory(folder / name, none));
    placed.scene = is_file ? folder / name : std::filesystem::path(name);
    if (p.has("at")) placed.at_m = p.at("at").vector(-1e6, 1e6);
    if (p.has("turn_deg")) placed.turn_deg = p.at("turn_deg").number(-360, 360);
    if (p.has("scale")) placed.scale = p.at("scale").number(1e-6, 1e6);
    return placed;
}

gi::RigidPose read_pose(gi::Yaml const& p)
{
    gi::RigidPose pose;
    if (p.has("position_m")) pose.position = p.at("position_m").vector(-1e4, 1e4);
    if (p.has("rotation_deg") && p.has("rotation_xyzw"))
        throw p.at("rotation_xyzw")
            .error("rotation_deg is there too", "only one of them can count", "remove one of the two");
    if (p.has("rotation_deg")) {
        gi::dvec3 const r = glm::radians(p.at("rotation_deg").vector(-360, 360));
        pose.rotation =
            glm::normalize(glm::angleAxis(r.z, gi::dvec3(0, 0, 1)) * glm::angleAxis(r.y, gi::dvec3(0, 1, 0)) *
                           glm::angleAxis(r.x, gi::dvec3(1, 0, 0)));
    }
    if (p.has("rotation_xyzw")) {
        gi::Yaml const at = p.at("rotation_xyzw");
        auto const q = at.items();
        if (q.size() != 4) throw at.error("not four numbers", "it is a quaternion", "write [x, y, z, w], w last");
        glm::dquat const rotation(q[3].number(-1.1, 1.1), q[0].number(-1.1, 1.1), q[1].number(-1.1, 1.1),
                                  q[2].number(-1.1, 1.1));
        if (!(std::abs(glm::length(rotation) - 1) < 1e-3))
            throw at.error(fmt::format("the quaternion's length is {:g}", glm::length(rotation)),
                           "that of rotations is 1", "write [x, y, z, w]; [0, 0, 0, 1] is no rotation");
        pose.rotation = glm::normalize(rotation);
    }
    return pose;
}

void read_turned(gi::Yaml const& at, gi::RigidPose& pose)
{
    at.only_keys({"position_m", "rotation_deg", "rotation_xyzw"});
    gi::RigidPose const read = read_pose(at);
    bool const is_turned = at.has("rotation_deg") || at.has("rotation_xyzw");
    pose = {read.position, is_turned ? read.rotation : pose.rotation};
}

} // namespace ar
