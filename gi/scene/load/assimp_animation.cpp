#include "gi/scene/load/assimp_parts.h"

#include <cmath>
#include <fmt/format.h>

namespace gi {
namespace {

template <class Key, class Store>
void add_channel(Animation& clip, std::int32_t node, ChannelPath path, Key const* keys, unsigned count,
                 double ticks_per_s, Store const& store)
{
    AnimationChannel channel;
    channel.node = node;
    channel.path = path;
    for (unsigned k = 0; k < count; ++k) {
        float const t = float(keys[k].mTime / ticks_per_s);
        if (!std::isfinite(t) || (!channel.times_s.empty() && !(t > channel.times_s.back()))) continue;
        channel.times_s.push_back(t);
        store(channel.values, keys[k].mValue);
    }
    if (channel.times_s.empty()) return;
    clip.duration_s = std::max(clip.duration_s, double(channel.times_s.back()));
    clip.channels.push_back(std::move(channel));
}
/// Splits a moving node's matrix into its parts, because channels replace some of them.
void split_matrix(Node& node)
{
    if (!node.matrix) return;
    aiMatrix4x4 m;
    for (unsigned r = 0; r < 4; ++r)
        for (unsigned c = 0; c < 4; ++c) m[r][c] = float((*node.matrix)[int(c)][int(r)]);
    aiVector3D scale, position;
    aiQuaternion rotation;
    m.Decompose(scale, rotation, position);
    node.translation = dvec3(to_vec3(position));
    node.scale = dvec3(to_vec3(scale));
    node.rotation =
        glm::normalize(dquat{double(rotation.w), double(rotation.x), double(rotation.y), double(rotation.z)});
    node.matrix.reset();
}

} // namespace

void convert_animations(aiScene const& source, NodeOfName const& node_of, Scene& scene, Report& report)
{
    for (unsigned a = 0; a < source.mNumAnimations; ++a) {
        aiAnimation const& animation = *source.mAnimations[a];
        Animation clip;
        clip.name = animation.mName.length > 0 ? animation.mName.C_Str() : fmt::format("clip {}", a);
        double const ticks = animation.mTicksPerSecond > 0 ? animation.mTicksPerSecond : 25;
        for (unsigned c = 0; c < animation.mNumChannels; ++c) {
            aiNodeAnim const& channel = *animation.mChannels[c];
            auto const node = node_of.find(channel.mNodeName.C_Str());
            if (node == node_of.end()) {
                report.lose("animation channels ignored", 1, clip.name);
                continue;
            }
            split_matrix(scene.nodes[std::size_t(node->second)]);
            auto const put_vector = [](std::vector<float>& to, aiVector3D v) {
                to.insert(to.end(), {v.x, v.y, v.z});
            };
            auto const put_rotation = [](std::vector<float>& to, aiQuaternion q) {
                to.insert(to.end(), {q.x, q.y, q.z, q.w});
            };
            add_channel(clip, node->second, ChannelPath::translation, channel.mPositionKeys,
                        channel.mNumPositionKeys, ticks, put_vector);
            add_channel(clip, node->second, ChannelPath::rotation, channel.mRotationKeys, channel.mNumRotationKeys,
                        ticks, put_rotation);
            add_channel(clip, node->second, ChannelPath::scale, channel.mScalingKeys, channel.mNumScalingKeys,
                        ticks, put_vector);
        }
        scene.animations.push_back(std::move(clip));
    }
    if (!scene.animations.empty()) scene.playbacks = {{0, 0, 1, true}};
}

} // namespace gi
