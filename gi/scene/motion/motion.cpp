#include "gi/scene/motion/motion.h"

#include <algorithm>

namespace gi {
namespace {

/// True if the value of a channel depends on time: some key differs from the first, or a tangent is not 0.
bool varies(AnimationChannel const& channel)
{
    std::size_t const keys = channel.times_s.size();
    if (keys < 2) return false;
    bool const cubic = channel.interpolation == Interpolation::cubic_spline;
    std::size_t const stride = channel.values.size() / keys, count = cubic ? stride / 3 : stride;
    for (std::size_t k = 0; k < keys; ++k)
        for (std::size_t i = 0; i < stride; ++i) {
            bool const tangent = cubic && (i < count || i >= 2 * count);
            float const v = channel.values[k * stride + i];
            if (tangent ? v != 0 : v != channel.values[i]) return true;
        }
    return false;
}

bool places(ChannelPath path)
{
    return path == ChannelPath::translation || path == ChannelPath::rotation || path == ChannelPath::scale;
}

} // namespace

Motion find_motion(Scene const& scene)
{
    std::size_t const n = scene.nodes.size();
    Motion motion{std::vector<std::string>(n), std::vector<std::string>(n)};
    for (Playback const& playback : scene.playbacks) {
        Animation const& clip = scene.animations[std::size_t(playback.animation)];
        if (playback.speed == 0 || !(clip.duration_s > 0)) continue;
        for (AnimationChannel const& channel : clip.channels)
            if (varies(channel))
                (places(channel.path) ? motion.node : motion.morph)[std::size_t(channel.node)] =
                    "clip '" + clip.name + "'";
    }
    for (std::size_t i = 0; i < n; ++i) {
        Node const& node = scene.nodes[i];
        if (!motion.node[i].empty()) continue;
        if (node.driven)
            motion.node[i] = "driven";
        else if (node.parent >= 0)
            motion.node[i] = motion.node[std::size_t(node.parent)];
    }
    return motion;
}

std::string why_moving(Scene const& scene, Motion const& motion, std::size_t node, Mesh const& mesh)
{
    std::int32_t const skin = scene.nodes[node].skin;
    if (skin >= 0 && !mesh.joints.empty())
        for (std::int32_t const joint : scene.skins[std::size_t(skin)].joints)
            if (std::string const& why = motion.node[std::size_t(joint)]; !why.empty()) return "skin, " + why;
    if (!mesh.morph_targets.empty() && !motion.morph[node].empty()) return "morph targets, " + motion.morph[node];
    return motion.node[node];
}

std::vector<std::string> reasons_for_motion(Scene const& scene)
{
    Motion const motion = find_motion(scene);
    std::vector<std::string> reasons;
    for (std::size_t n = 0; n < scene.nodes.size(); ++n)
        for (std::int32_t const m : scene.nodes[n].meshes) {
            std::string const why = why_moving(scene, motion, n, scene.meshes[std::size_t(m)]);
            if (!why.empty() && std::find(reasons.begin(), reasons.end(), why) == reasons.end())
                reasons.push_back(why);
        }
    return reasons;
}

} // namespace gi
