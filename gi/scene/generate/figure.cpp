#include "gi/scene/generate/figure.h"

#include <algorithm>
#include <array>
#include <glm/gtc/matrix_transform.hpp>

namespace gi {
namespace {

enum Joint : std::uint16_t {
    pelvis,
    spine,
    chest,
    neck,
    head,
    arm_l,
    forearm_l,
    hand_l,
    arm_r,
    forearm_r,
    hand_r,
    thigh_l,
    shin_l,
    foot_l,
    thigh_r,
    shin_r,
    foot_r,
    joints
};

struct JointRest {
    char const* name;
    int parent;
    vec3 position; ///< m, of the standing figure, feet at y = 0; +X is its left
};

constexpr std::array<JointRest, joints> kRest{{
    {"pelvis", -1, {0, 0.93f, 0}},
    {"spine", pelvis, {0, 1.05f, 0}},
    {"chest", spine, {0, 1.22f, 0}},
    {"neck", chest, {0, 1.46f, -0.01f}},
    {"head", neck, {0, 1.55f, 0.01f}},
    {"arm_l", chest, {0.19f, 1.40f, 0}},
    {"forearm_l", arm_l, {0.215f, 1.12f, 0}},
    {"hand_l", forearm_l, {0.225f, 0.87f, 0.02f}},
    {"arm_r", chest, {-0.19f, 1.40f, 0}},
    {"forearm_r", arm_r, {-0.215f, 1.12f, 0}},
    {"hand_r", forearm_r, {-0.225f, 0.87f, 0.02f}},
    {"thigh_l", pelvis, {0.095f, 0.90f, 0}},
    {"shin_l", thigh_l, {0.1f, 0.48f, 0}},
    {"foot_l", shin_l, {0.1f, 0.08f, -0.02f}},
    {"thigh_r", pelvis, {-0.095f, 0.90f, 0}},
    {"shin_r", thigh_r, {-0.1f, 0.48f, 0}},
    {"foot_r", shin_r, {-0.1f, 0.08f, -0.02f}},
}};

/// A tapered limb along one bone.
struct Limb {
    Joint joint;
    int blend_with; ///< joint that shares the upper end; -1 = none
    vec3 from, to;
    vec2 radius_from, radius_to; ///< across (x) and along the viewing direction (z)
    bool dressed;
};

vec3 at(Joint j) { return kRest[j].position; }

std::array<Limb, 17> limbs()
{
    vec3 const toe{0, -0.045f, 0.17f};
    return {{{pelvis, -1, {0, 0.86f, 0}, {0, 1.06f, 0}, {0.15f, 0.115f}, {0.13f, 0.10f}, true},
             {spine, pelvis, {0, 1.03f, 0}, {0, 1.24f, 0}, {0.13f, 0.10f}, {0.155f, 0.115f}, true},
             {chest, spine, {0, 1.22f, 0}, {0, 1.40f, -0.005f}, {0.155f, 0.115f}, {0.165f, 0.105f}, true},
             {neck, chest, {0, 1.42f, -0.01f}, {0, 1.56f, 0}, {0.062f, 0.062f}, {0.052f, 0.055f}, false},
             {head, neck, {0, 1.60f, 0.02f}, {0, 1.67f, 0.02f}, {0.072f, 0.085f}, {0.078f, 0.095f}, false},
             {arm_l, chest, at(arm_l), at(forearm_l), {0.062f, 0.062f}, {0.043f, 0.045f}, true},
             {forearm_l, arm_l, at(forearm_l), at(hand_l), {0.042f, 0.044f}, {0.029f, 0.033f}, false},
             {hand_l,
              forearm_l,
              at(hand_l),
              at(hand_l) + vec3{0.004f, -0.12f, 0.02f},
              {0.028f, 0.04f},
              {0.018f, 0.034f},
              false},
             {arm_r, chest, at(arm_r), at(forearm_r), {0.062f, 0.062f}, {0.043f, 0.045f}, true},
             {forearm_r, arm_r, at(forearm_r), at(hand_r), {0.042f, 0.044f}, {0.029f, 0.033f}, false},
             {hand_r,
              forearm_r,
              at(hand_r),
              at(hand_r) + vec3{-0.004f, -0.12f, 0.02f},
              {0.028f, 0.04f},
              {0.018f, 0.034f},
              false},
             {thigh_l, pelvis, at(thigh_l), at(shin_l), {0.088f, 0.092f}, {0.056f, 0.06f}, true},
             {shin_l, thigh_l, at(shin_l), at(foot_l), {0.055f, 0.06f}, {0.037f, 0.042f}, true},
             {foot_l,
              -1,
              at(foot_l) + vec3{0, -0.03f, -0.03f},
              at(foot_l) + toe,
              {0.04f, 0.045f},
              {0.042f, 0.03f},
              false},
             {thigh_r, pelvis, at(thigh_r), at(shin_r), {0.088f, 0.092f}, {0.056f, 0.06f}, true},
             {shin_r, thigh_r, at(shin_r), at(foot_r), {0.055f, 0.06f}, {0.037f, 0.042f}, true},
             {foot_r,
              -1,
              at(foot_r) + vec3{0, -0.03f, -0.03f},
              at(foot_r) + toe,
              {0.04f, 0.045f},
              {0.042f, 0.03f},
              false}}};
}

/// Adds rings along the bone with round ends; the upper end is weighted equally with the neighbouring joint.
void add_limb(Mesh& m, Limb const& limb, int segments)
{
    constexpr int kCapRings = 5, kBodyRings = 7;
    vec3 const axis = glm::normalize(limb.to - limb.from);
    vec3 x = vec3{1, 0, 0} - axis.x * axis;
    x = glm::normalize(x);
    vec3 const z = glm::cross(axis, x);
    auto const first = std::uint32_t(m.positions.size());
    int const rings = 2 * kCapRings + kBodyRings;
    for (int r = 0; r <= rings; ++r) {
        // Position t along the bone: [0, 1] between the joints; beyond are the caps, whose rings `shrink` narrows.
        float t, shrink = 1, beyond = 0;
        if (r <= kCapRings) {
            float const a = 0.5f * kPi * (1 - float(r) / kCapRings);
            t = 0;
            shrink = std::cos(a);
            beyond = -std::sin(a) * std::min(limb.radius_from.x, limb.radius_from.y);
        } else if (r >= kCapRings + kBodyRings) {
            float const a = 0.5f * kPi * float(r - kCapRings - kBodyRings) / kCapRings;
            t = 1;
            shrink = std::cos(a);
            beyond = std::sin(a) * std::min(limb.radius_to.x, limb.radius_to.y);
        } else {
            t = float(r - kCapRings) / kBodyRings;
        }
        shrink = r == 0 || r == rings ? 0 : shrink;
        vec2 radius = glm::mix(limb.radius_from, limb.radius_to, t);
        radius *= 1 + 0.08f * std::sin(kPi * t); // thicker in the middle, like muscles
        vec3 const center = glm::mix(limb.from, limb.to, t) + beyond * axis;
        float const along = glm::clamp(t + (beyond < 0 ? -0.1f : 0.0f), -0.1f, 1.0f);
        float const shared =
            limb.blend_with >= 0 ? 0.5f * glm::clamp(1 - (along + 0.1f) / 0.3f, 0.0f, 1.0f) : 0.0f;
        float const slope = (r <= kCapRings || r >= kCapRings + kBodyRings) ? 0.0f : 1.0f;
        for (int s = 0; s <= segments; ++s) {
            float const angle = s < segments ? 2 * kPi * float(s) / float(segments) : 0.0f;
            float const c = std::cos(angle), si = std::sin(angle);
            m.positions.push_back(center + shrink * (radius.x * c * x + radius.y * si * z));
            vec3 n = c / radius.x * x + si / radius.y * z;
            n = shrink * glm::normalize(n) +
                (slope == 0 ? std::sqrt(std::max(0.0f, 1 - shrink * shrink)) * (beyond < 0 ? -axis : axis)
                            : vec3{0});
            m.normals.push_back(glm::normalize(n));
            m.uv0.push_back({float(s) / float(segments), float(r) / float(rings)});
            m.joints.push_back({limb.joint, std::uint16_t(std::max(limb.blend_with, 0)), 0, 0});
            m.weights.push_back({1 - shared, shared, 0, 0});
        }
    }
    auto const row = std::uint32_t(segments) + 1;
    for (std::uint32_t r = 0; r < std::uint32_t(rings); ++r)
        for (std::uint32_t s = 0; s < std::uint32_t(segments); ++s) {
            std::uint32_t const a = first + r * row + s, b = a + 1, c = a + row, d = c + 1;
            if (r > 0) m.triangles.push_back({a, b, d});
            if (r + 1 < std::uint32_t(rings)) m.triangles.push_back({a, d, c});
        }
}

struct Stride {
    double hip, knee; ///< rad; hip forwards, knee bent
};

/// Returns the angles of one leg at phase 0..2 pi; the other leg is half a period later.
Stride stride(double phase)
{
    return {0.45 * std::sin(phase) + 0.05, 0.12 + 0.85 * std::pow(std::max(0.0, std::cos(phase - 0.25)), 2.0)};
}

constexpr double kSole = 0.075, kBall = 0.17; ///< m; foot joint to sole, and to ball in front of it

/// Pitch of the foot against the ground, rad; positive = toes down.
double foot_pitch(Stride const& s) { return 0.25 * s.knee; }

dquat about_x(double angle) { return glm::angleAxis(angle, dvec3{1, 0, 0}); }
dquat about_y(double angle) { return glm::angleAxis(angle, dvec3{0, 1, 0}); }

void push(AnimationChannel& c, dquat const& q)
{
    c.values.insert(c.values.end(), {float(q.x), float(q.y), float(q.z), float(q.w)});
}

Animation walk(std::int32_t first_joint)
{
    constexpr int kKeys = 24;
    constexpr double kDuration = 1.2;
    Animation clip;
    clip.name = "walk";
    clip.duration_s = kDuration;
    std::array<AnimationChannel, joints> rotation;
    AnimationChannel lift;
    for (std::size_t j = 0; j < joints; ++j) {
        rotation[j].node = first_joint + std::int32_t(j);
        rotation[j].path = ChannelPath::rotation;
    }
    lift.node = first_joint + pelvis;
    lift.path = ChannelPath::translation;
    double const thigh = double(at(thigh_l).y - at(shin_l).y), shin = double(at(shin_l).y - at(foot_l).y);
    for (int k = 0; k <= kKeys; ++k) {
        double const phase = 2 * glm::pi<double>() * double(k % kKeys) / kKeys;
        Stride const left = stride(phase), right = stride(phase + glm::pi<double>());
        auto const reach = [&](Stride const& s) { // down to the ball of the foot
            return thigh * std::cos(s.hip) + shin * std::cos(s.hip - s.knee) + kSole * std::cos(foot_pitch(s)) +
                   kBall * std::sin(foot_pitch(s));
        };
        // The leg that reaches lower stands on the floor.
        double const drop = std::max(reach(left), reach(right)) - thigh - shin - kSole;
        auto const set = [&](Joint j, dquat const& q) {
            rotation[j].times_s.push_back(float(kDuration * k / kKeys));
            push(rotation[j], q);
        };
        lift.times_s.push_back(float(kDuration * k / kKeys));
        vec3 const p = at(pelvis);
        lift.values.insert(lift.values.end(), {p.x, p.y + float(drop), p.z});
        double const swing = std::sin(phase);
        set(pelvis, about_y(0.07 * swing));
        set(spine, about_y(-0.06 * swing));
        set(chest, about_y(-0.10 * swing) * about_x(0.04));
        set(neck, about_y(0.05 * swing));
        set(head, about_y(0.04 * swing));
        // A positive rotation about +X swings hanging limbs backwards, so forwards is negative.
        set(thigh_l, about_x(-left.hip));
        set(shin_l, about_x(left.knee));
        set(foot_l, about_x(left.hip - left.knee + foot_pitch(left)));
        set(thigh_r, about_x(-right.hip));
        set(shin_r, about_x(right.knee));
        set(foot_r, about_x(right.hip - right.knee + foot_pitch(right)));
        set(arm_l, about_x(0.38 * swing));
        set(forearm_l, about_x(-0.35 - 0.15 * std::max(0.0, -swing)));
        set(hand_l, dquat(1, 0, 0, 0));
        set(arm_r, about_x(-0.38 * swing));
        set(forearm_r, about_x(-0.35 - 0.15 * std::max(0.0, swing)));
        set(hand_r, dquat(1, 0, 0, 0));
    }
    for (AnimationChannel& c : rotation) clip.channels.push_back(std::move(c));
    clip.channels.push_back(std::move(lift));
    return clip;
}

} // namespace

void add_figure(Scene& scene, dmat4 const& world_from_root, double detail)
{
    Material cloth, skin;
    cloth.base_color = {0.16f, 0.22f, 0.42f};
    cloth.specular = 0;
    skin.base_color = {0.62f, 0.42f, 0.32f};
    skin.roughness = 0.5f;
    std::array<Mesh, 2> meshes; // dressed, bare
    int const segments = std::max(6, int(std::lround(20 * detail)));
    for (Limb const& limb : limbs()) add_limb(meshes[limb.dressed ? 0 : 1], limb, segments);

    auto const root = std::int32_t(scene.nodes.size());
    Node root_node;
    root_node.name = "figure";
    root_node.matrix = world_from_root;
    scene.nodes.push_back(root_node);
    std::int32_t const first_joint = root + 1;
    Skin rig;
    for (std::size_t j = 0; j < joints; ++j) {
        JointRest const& rest = kRest[j];
        Node node;
        node.name = rest.name;
        node.parent = rest.parent < 0 ? root : first_joint + rest.parent;
        node.translation =
            dvec3(rest.position - (rest.parent < 0 ? vec3{0} : kRest[std::size_t(rest.parent)].position));
        rig.joints.push_back(first_joint + std::int32_t(j));
        rig.inverse_bind.push_back(glm::translate(mat4(1), -rest.position));
        scene.nodes.push_back(std::move(node));
    }
    auto const skin_index = std::int32_t(scene.skins.size());
    scene.skins.push_back(std::move(rig));
    Material const materials[] = {cloth, skin};
    char const* const names[] = {"figure cloth", "figure skin"};
    for (std::size_t i = 0; i < 2; ++i) {
        meshes[i].name = names[i];
        meshes[i].material = std::int32_t(scene.materials.size());
        scene.materials.push_back(materials[i]);
        scene.material_names.emplace_back(names[i]);
        Node node;
        node.name = names[i];
        node.parent = root;
        node.meshes = {std::int32_t(scene.meshes.size())};
        node.skin = skin_index;
        scene.meshes.push_back(std::move(meshes[i]));
        scene.nodes.push_back(std::move(node));
    }
    scene.playbacks.push_back({std::int32_t(scene.animations.size()), 0, 1, true});
    scene.animations.push_back(walk(first_joint));
}

} // namespace gi
