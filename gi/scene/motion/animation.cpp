#include "gi/scene/motion/animation.h"

#include <algorithm>
#include <cmath>
#include <glm/gtc/matrix_transform.hpp>

namespace gi {
namespace {

dquat to_quaternion(float const* v)
{
    dquat const q{double(v[3]), double(v[0]), double(v[1]), double(v[2])};
    double const length = glm::length(q);
    return length > 0 ? q / length : dquat(1, 0, 0, 0);
}

void store(dquat const& q, float* out)
{
    out[0] = float(q.x);
    out[1] = float(q.y);
    out[2] = float(q.z);
    out[3] = float(q.w);
}

/// The two keys around a time and the fraction between them, 0..1; `span` is their distance in s.
struct KeyPair {
    std::size_t first, second;
    double fraction, span;
};

KeyPair find_keys(std::vector<float> const& times, double time)
{
    auto const after =
        std::upper_bound(times.begin(), times.end(), time, [](double t, float key) { return t < double(key); });
    if (after == times.begin()) return {0, 0, 0, 0};
    auto const second = std::size_t(after - times.begin());
    if (after == times.end()) return {second - 1, second - 1, 0, 0};
    double const start = double(times[second - 1]), span = double(times[second]) - start;
    return {second - 1, second, (time - start) / span, span};
}

dmat4 local_matrix(dvec3 translation, dquat rotation, dvec3 scale)
{
    dmat4 m = glm::mat4_cast(rotation);
    for (int c = 0; c < 3; ++c) m[c] *= scale[c];
    m[3] = glm::dvec4(translation, 1);
    return m;
}

struct LocalTransform {
    dvec3 translation, scale;
    dquat rotation;
    std::optional<dmat4> matrix;
};

/// Weighted sum of the clips' values for one node.
struct Blend {
    dvec3 translation{0}, scale{0};
    dquat rotation{0, 0, 0, 0}, first_rotation{1, 0, 0, 0};
    std::vector<double> morph;
    double translation_weight = 0, scale_weight = 0, rotation_weight = 0, morph_weight = 0;
};

void add_channel(AnimationChannel const& channel, double time_s, double weight, std::size_t targets, Blend& to)
{
    float v[4];
    switch (channel.path) {
    case ChannelPath::translation:
        sample_channel(channel, time_s, 3, v);
        to.translation += weight * dvec3{v[0], v[1], v[2]};
        to.translation_weight += weight;
        break;
    case ChannelPath::scale:
        sample_channel(channel, time_s, 3, v);
        to.scale += weight * dvec3{v[0], v[1], v[2]};
        to.scale_weight += weight;
        break;
    case ChannelPath::rotation: {
        sample_channel(channel, time_s, 4, v);
        dquat const q = to_quaternion(v);
        if (to.rotation_weight == 0) to.first_rotation = q;
        to.rotation += (glm::dot(q, to.first_rotation) < 0 ? -weight : weight) * q;
        to.rotation_weight += weight;
        break;
    }
    case ChannelPath::morph_weights: {
        std::vector<float> values(targets);
        sample_channel(channel, time_s, targets, values.data());
        to.morph.resize(targets);
        for (std::size_t i = 0; i < targets; ++i) to.morph[i] += weight * double(values[i]);
        to.morph_weight += weight;
        break;
    }
    case ChannelPath::morph_frame:
        sample_channel(channel, time_s, 1, v);
        to.morph.resize(targets);
        add_frame(double(v[0]), weight, to.morph);
        to.morph_weight += weight;
        break;
    }
}

/// Parts that no clip moves are not changed.
void apply(Blend const& blend, LocalTransform& local, std::vector<float>& morph_weights)
{
    if (blend.translation_weight > 0) local.translation = blend.translation / blend.translation_weight;
    if (blend.scale_weight > 0) local.scale = blend.scale / blend.scale_weight;
    if (blend.rotation_weight > 0) local.rotation = glm::normalize(blend.rotation / blend.rotation_weight);
    if (blend.translation_weight + blend.scale_weight + blend.rotation_weight > 0) local.matrix.reset();
    if (blend.morph_weight > 0)
        for (std::size_t i = 0; i < morph_weights.size(); ++i)
            morph_weights[i] = float(blend.morph[i] / blend.morph_weight);
}

std::vector<Blend> blend_clips(Scene const& scene, double time_s)
{
    std::vector<Blend> blends(scene.nodes.size());
    for (Playback const& playback : scene.playbacks) {
        if (!(playback.weight > 0)) continue;
        Animation const& clip = scene.animations[std::size_t(playback.animation)];
        double const end_s = playback.loop ? clip.duration_s : clip.duration_s - clip.closing_s;
        double const t = local_time(playback, end_s, time_s);
        for (AnimationChannel const& channel : clip.channels) {
            auto const node = std::size_t(channel.node);
            add_channel(channel, t, playback.weight, scene.nodes[node].morph_weights.size(), blends[node]);
        }
    }
    return blends;
}

} // namespace

void sample_channel(AnimationChannel const& channel, double time_s, std::size_t count, float* out)
{
    KeyPair const k = find_keys(channel.times_s, time_s);
    bool const cubic = channel.interpolation == Interpolation::cubic_spline;
    std::size_t const stride = cubic ? 3 * count : count;
    float const* const a = channel.values.data() + k.first * stride + (cubic ? count : 0);
    float const* const b = channel.values.data() + k.second * stride + (cubic ? count : 0);
    bool const rotation = channel.path == ChannelPath::rotation;
    if (channel.interpolation == Interpolation::step || k.first == k.second) {
        std::copy(a, a + count, out);
    } else if (cubic) {
        double const t = k.fraction, t2 = t * t, t3 = t2 * t;
        for (std::size_t i = 0; i < count; ++i) {
            double const leave = k.span * double(a[count + i]); // out-tangent of the first key
            // In-tangent of the second.
            double const arrive = k.span * double(b[std::ptrdiff_t(i) - std::ptrdiff_t(count)]);
            out[i] = float((2 * t3 - 3 * t2 + 1) * double(a[i]) + (t3 - 2 * t2 + t) * leave +
                           (3 * t2 - 2 * t3) * double(b[i]) + (t3 - t2) * arrive);
        }
    } else if (rotation) {
        store(glm::slerp(to_quaternion(a), to_quaternion(b), k.fraction), out);
    } else {
        for (std::size_t i = 0; i < count; ++i) out[i] = float(glm::mix(double(a[i]), double(b[i]), k.fraction));
    }
    if (rotation) store(to_quaternion(out), out);
}

void add_frame(double frame, double weight, std::vector<double>& morph)
{
    auto const frames = double(morph.size() + 1);
    double const wrapped = frame - std::floor(frame / frames) * frames, fraction = wrapped - std::floor(wrapped);
    auto const first = std::size_t(wrapped) % (morph.size() + 1), second = (first + 1) % (morph.size() + 1);
    if (first > 0) morph[first - 1] += weight * (1 - fraction);
    if (second > 0) morph[second - 1] += weight * fraction;
}

double local_time(Playback const& playback, double duration_s, double time_s)
{
    double const t = playback.offset_s + playback.speed * time_s;
    if (!(duration_s > 0)) return 0;
    if (!playback.loop) return std::clamp(t, 0.0, duration_s);
    return t - std::floor(t / duration_s) * duration_s;
}

Pose evaluate_pose(Scene const& scene, std::optional<double> time_s)
{
    std::size_t const n = scene.nodes.size();
    Pose pose;
    pose.morph_weights.resize(n);
    std::vector<LocalTransform> local(n);
    for (std::size_t i = 0; i < n; ++i) {
        Node const& node = scene.nodes[i];
        local[i] = {node.translation, node.scale, node.rotation, node.matrix};
        pose.morph_weights[i] = node.morph_weights;
    }
    if (time_s) {
        std::vector<Blend> const blends = blend_clips(scene, *time_s);
        for (std::size_t i = 0; i < n; ++i) apply(blends[i], local[i], pose.morph_weights[i]);
    }
    pose.world_from_node.resize(n);
    for (std::size_t i = 0; i < n; ++i) {
        LocalTransform const& t = local[i];
        dmat4 const m = t.matrix ? *t.matrix : local_matrix(t.translation, t.rotation, t.scale);
        std::int32_t const parent = scene.nodes[i].parent;
        pose.world_from_node[i] = parent >= 0 ? pose.world_from_node[std::size_t(parent)] * m : m;
    }
    return pose;
}

} // namespace gi
