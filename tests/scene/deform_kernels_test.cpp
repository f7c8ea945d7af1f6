// Morphing and skinning as kernels, on the host and on the device: against a plain form in doubles, and by what is
// known of the two kinds of skinning.

#include "gi/core/rng.h"
#include "gi/kernel/buffer.h"
#include "gi/kernel/launch.h"
#include "gi/scene/motion/skinning.h"
#include "gi/scene/motion/stretch.h"
#include "tests/support/on_device.h"

#include <algorithm>
#include <cstring>
#include <glm/gtc/matrix_inverse.hpp>
#include <glm/gtc/matrix_transform.hpp>

namespace gi::test {
namespace {

double number(Pcg32& rng) { return 2 * double(rng.uniform()) - 1; }
dvec3 point(Pcg32& rng) { return {number(rng), number(rng), number(rng)}; }
dquat turn(Pcg32& rng) { return glm::normalize(dquat(number(rng), number(rng), number(rng), number(rng) + 1e-3)); }

struct Rig {
    Scene scene; ///< node 0 holds mesh 0 and skin 0; the joints are nodes behind it
    Pose pose;
};

enum class Joints { rigid, scaled, any };

/// A cloud of vertices, three morph targets, and joints that moved since they were bound.
Rig random_rig(Pcg32& rng, bool skinned, Joints kind, SkinningMethod method, dvec3 away, float mesh_away)
{
    Rig rig;
    Mesh& m = rig.scene.meshes.emplace_back();
    constexpr std::size_t kVertices = 300, kJoints = 7;
    vec3 const offset = mesh_away * vec3{0.3f, -0.9f, 0.4f};
    for (std::size_t i = 0; i < kVertices; ++i) {
        m.positions.push_back(vec3(point(rng)) + offset);
        m.normals.push_back(glm::normalize(vec3(point(rng))));
        m.tangents.push_back(vec4(glm::normalize(vec3(point(rng))), i % 2 == 0 ? 1.0f : -1.0f));
    }
    for (int t = 0; t < 3; ++t) {
        MorphTarget& target = m.morph_targets.emplace_back();
        for (std::size_t i = 0; i < kVertices; ++i) {
            target.positions.push_back(0.3f * vec3(point(rng)));
            if (t < 2) target.normals.push_back(0.3f * vec3(point(rng)));
            if (t < 1) target.tangents.push_back(0.3f * vec3(point(rng)));
        }
    }
    Node& holder = rig.scene.nodes.emplace_back();
    holder.meshes = {0};
    rig.pose.morph_weights.push_back({0.5f, 0, -0.7f});
    auto const place = [&](dquat q, dvec3 scale, dvec3 at) {
        return glm::translate(dmat4(1), at) * glm::mat4_cast(q) * glm::scale(dmat4(1), scale);
    };
    dmat4 const to_zero = glm::translate(dmat4(1), -dvec3(offset)); // so that far meshes end near `away`
    auto const scale_of = [&]() -> dvec3 {
        if (kind == Joints::rigid) return dvec3{1};
        if (kind == Joints::scaled) return dvec3{0.01};
        return dvec3{1} + 0.6 * point(rng);
    };
    rig.pose.world_from_node.push_back(place(turn(rng), scale_of(), away + point(rng)) * to_zero);
    if (!skinned) return rig;
    holder.skin = 0;
    Skin& skin = rig.scene.skins.emplace_back();
    skin.method = method;
    for (std::size_t j = 0; j < kJoints; ++j) {
        Node& joint = rig.scene.nodes.emplace_back();
        joint.parent = -1;
        skin.joints.push_back(std::int32_t(j) + 1);
        dmat4 const bound = place(turn(rng), dvec3{1}, point(rng) + dvec3(offset));
        skin.inverse_bind.push_back(mat4(glm::inverse(bound)));
        // Turned by up to 60 degrees from one another, as limbs are.
        dquat const bend = glm::slerp(dquat(1, 0, 0, 0), turn(rng), 0.33);
        dmat4 const moved = place(bend, scale_of(), away + 0.5 * point(rng)) * to_zero * bound;
        rig.pose.world_from_node.push_back(moved);
        rig.pose.morph_weights.emplace_back();
    }
    for (std::size_t i = 0; i < kVertices; ++i) {
        std::array<std::uint16_t, 4> j{};
        vec4 w{0};
        for (int k = 0; k < 4; ++k) {
            j[std::size_t(k)] = std::uint16_t(rng.uniform() * float(kJoints));
            w[k] = k > int(i % 4) ? 0.0f : rng.uniform() + 0.01f; // no sum in particular
        }
        if (i % 50 == 7) w = vec4{0};
        m.joints.push_back(j);
        m.weights.push_back(w);
    }
    return rig;
}

struct Plain {
    std::vector<dvec3> positions, normals, tangents;
    std::vector<double> reach; ///< the sum of the sizes of what was added up for a position, m
};

/// The same in doubles, written down as plainly as it goes: linear blending,
/// or DLB of maps that are rigid but for one scale.
Plain plain_deform(Rig const& rig, double joint_scale)
{
    Mesh const& mesh = rig.scene.meshes[0];
    bool const skinned = !mesh.joints.empty();
    bool const dual = skinned && rig.scene.skins[0].method == SkinningMethod::dual_quaternion;
    Plain out;
    for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
        dvec3 p(mesh.positions[i]), n(mesh.normals[i]), t(mesh.tangents[i]);
        for (std::size_t k = 0; k < mesh.morph_targets.size(); ++k) {
            MorphTarget const& target = mesh.morph_targets[k];
            auto const w = double(rig.pose.morph_weights[0][k]);
            p += w * dvec3(target.positions[i]);
            if (!target.normals.empty()) n += w * dvec3(target.normals[i]);
            if (!target.tangents.empty()) t += w * dvec3(target.tangents[i]);
        }
        dmat4 m = rig.pose.world_from_node[0];
        vec4 const weights = skinned ? mesh.weights[i] : vec4{0};
        double const sum = double(weights.x) + double(weights.y) + double(weights.z) + double(weights.w);
        if (sum > 0) {
            Skin const& skin = rig.scene.skins[0];
            dmat4 linear(0.0);
            dquat real(0, 0, 0, 0), twice_dual(0, 0, 0, 0), first(0, 0, 0, 0);
            int heaviest = 0;
            for (int k = 1; k < 4; ++k)
                if (weights[k] > weights[heaviest]) heaviest = k;
            for (int pass = 0; pass < 2; ++pass)
                for (int k = 0; k < 4; ++k) {
                    std::size_t const j = mesh.joints[i][std::size_t(k)];
                    dmat4 const map = rig.pose.world_from_node[j + 1] * dmat4(skin.inverse_bind[j]);
                    dquat q = glm::normalize(glm::quat_cast(glm::dmat3(map) / joint_scale));
                    if (pass == 0) {
                        if (k == heaviest) first = q;
                        continue;
                    }
                    if (glm::dot(q, first) < 0) q = -q;
                    double const w = double(weights[k]) / sum;
                    linear += w * map;
                    real += w * q;
                    twice_dual += w * (dquat(0, map[3].x, map[3].y, map[3].z) * q);
                }
            m = linear;
            if (dual) {
                double const length = glm::length(real);
                dquat const q = real / length, moved = (twice_dual / length) * glm::conjugate(q);
                m = dmat4(glm::mat3_cast(q) * joint_scale);
                m[3] = glm::dvec4(moved.x, moved.y, moved.z, 1);
            }
        }
        glm::dmat3 const l(m);
        out.positions.push_back(dvec3(m * glm::dvec4(p, 1)));
        out.normals.push_back(glm::normalize(glm::inverseTranspose(l) * n));
        out.tangents.push_back(glm::normalize(l * t));
    }
    return out;
}

/// DeformVertices in a space.
template <Space S>
DeformedVertices run_kernel(Mesh const& mesh, InstancePlacement const& at, vec3 center)
{
    std::vector<Buffer<vec3, S>> deltas;
    std::vector<MorphView> views;
    for (auto const& [target, weight] : at.morphs) {
        MorphTarget const& t = mesh.morph_targets[target];
        MorphView v;
        v.weight = weight;
        auto const there = [&](std::vector<vec3> const& values) -> View<vec3 const> {
            if (values.empty()) return {};
            deltas.push_back(upload<S>(values));
            return std::as_const(deltas.back()).view();
        };
        v.positions = there(t.positions);
        v.normals = there(t.normals);
        v.tangents = there(t.tangents);
        views.push_back(v);
    }
    Buffer<MorphView, S> const morphs = upload<S>(views);
    Buffer<vec3, S> const positions = upload<S>(mesh.positions), normals = upload<S>(mesh.normals);
    Buffer<vec4, S> const tangents = upload<S>(mesh.tangents), weights = upload<S>(mesh.weights);
    Buffer<JointIndices, S> const joints = upload<S>(mesh.joints);
    Buffer<Affine, S> const maps = upload<S>(at.joints), stretches = upload<S>(at.stretches);
    Buffer<DualQuaternion, S> const motions = upload<S>(at.motions);
    Buffer<vec3, S> out_positions(mesh.positions.size()), out_normals(mesh.normals.size());
    Buffer<vec4, S> out_tangents(mesh.tangents.size());
    auto const run = [&](auto const& placement) {
        DeformVertices<std::remove_cvref_t<decltype(placement)>> kernel;
        kernel.mesh = {positions.view(), normals.view(), tangents.view(), joints.view(),
                       weights.view(),   morphs.view(),  center};
        kernel.placement = placement;
        kernel.handedness = at.mirrored ? -1.0f : 1.0f;
        kernel.shrink = at.shrink;
        kernel.positions = out_positions.view();
        kernel.normals = out_normals.view();
        kernel.tangents = out_tangents.view();
        launch(S, "deform vertices", mesh.positions.size(), kernel);
    };
    if (at.kind == InstancePlacement::Kind::rigid) run(RigidPlacement{at.node});
    if (at.kind == InstancePlacement::Kind::linear) run(LinearPlacement{at.node, maps.view()});
    if (at.kind == InstancePlacement::Kind::dual_quaternion)
        run(DualQuaternionPlacement{at.node, motions.view(), stretches.view()});
    return {download(out_positions), download(out_normals), download(out_tangents), at.mirrored};
}

/// Against doubles within the error that deform_kernels.h states, and the same positions in every space.
template <Space S>
void check_rigs(dvec3 away, float mesh_away)
{
    Pcg32 rng(4, 0);
    for (int round = 0; round < 60; ++round) {
        bool const skinned = round % 3 != 0, dual = round % 3 == 2;
        Joints const kind = dual ? (round % 2 == 0 ? Joints::rigid : Joints::scaled) : Joints::any;
        Rig const rig = random_rig(
            rng, skinned, kind, dual ? SkinningMethod::dual_quaternion : SkinningMethod::linear, away, mesh_away);
        Mesh const& mesh = rig.scene.meshes[0];
        vec3 const center = center_of(mesh);
        EXPECT_EQ(center == vec3{0}, mesh_away == 0);
        InstancePlacement at;
        place_instance(rig.scene, rig.pose, 0, mesh, center, away, at);
        DeformedVertices const found = run_kernel<S>(mesh, at, center);
        Plain const expected = plain_deform(rig, kind == Joints::scaled ? 0.01 : 1);
        // Inverse bind matrices are floats: where the mesh is far from its zero they place joints that coarsely.
        double const size = 4, tolerance = 8 * 0x1p-24 * (2 + size);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i) {
            ASSERT_LT(glm::distance(dvec3(found.positions[i]), expected.positions[i] - away), tolerance)
                << "round " << round << ", vertex " << i;
            double const sign =
                at.mirrored ? glm::sign(glm::dot(dvec3(found.normals[i]), expected.normals[i])) : 1;
            ASSERT_LT(glm::distance(dvec3(found.normals[i]), sign * expected.normals[i]), 1e-4)
                << round << " " << i;
            ASSERT_LT(glm::distance(dvec3(vec3(found.tangents[i])), expected.tangents[i]), 1e-4)
                << round << " " << i;
            ASSERT_EQ(found.tangents[i].w, mesh.tangents[i].w * (at.mirrored ? -1.0f : 1.0f));
        }
        DeformedVertices const host = deform(rig.scene, rig.pose, 0, mesh, away);
        ASSERT_EQ(0, std::memcmp(host.positions.data(), found.positions.data(),
                                 sizeof(vec3) * found.positions.size())); // bit for bit
    }
}

template <Space S>
void check_plain()
{
    check_rigs<S>(dvec3{0}, 0);
}
LIGHTWELL_TEST_BOTH(DeformKernels, AgreeWithDoubles, check_plain);

template <Space S>
void check_far()
{
    check_rigs<S>(dvec3{1e6, -1e6, 1e6}, 0);
}
LIGHTWELL_TEST_BOTH(DeformKernels, AgreeAThousandKilometresAway, check_far);

/// A mesh whose own coordinates are far from zero, as of a map.
template <Space S>
void check_far_mesh()
{
    Pcg32 rng(8, 0);
    for (int round = 0; round < 20; ++round) {
        Rig const rig = random_rig(rng, false, Joints::any, SkinningMethod::linear, dvec3{0}, 1e5f);
        Mesh const& mesh = rig.scene.meshes[0];
        vec3 const center = center_of(mesh);
        EXPECT_NE(center, vec3{0});
        InstancePlacement at;
        place_instance(rig.scene, rig.pose, 0, mesh, center, dvec3{0}, at);
        DeformedVertices const found = run_kernel<S>(mesh, at, center);
        Plain const expected = plain_deform(rig, 1);
        for (std::size_t i = 0; i < mesh.positions.size(); ++i)
            ASSERT_LT(glm::distance(dvec3(found.positions[i]), expected.positions[i]), 8 * 0x1p-24 * 6);
    }
}
LIGHTWELL_TEST_BOTH(DeformKernels, MeshesFarFromTheirZeroKeepTheirDetail, check_far_mesh);

/// A tube of radius 1 along x from 0 to 2, bound to joints at its ends of which the second turns about x.
Rig twisted_tube(SkinningMethod method, double angle)
{
    Rig rig;
    Mesh& m = rig.scene.meshes.emplace_back();
    for (int ring = 0; ring <= 8; ++ring)
        for (int s = 0; s < 12; ++s) {
            double const a = 2 * glm::pi<double>() * s / 12;
            m.positions.push_back(vec3(dvec3{ring / 4.0, std::cos(a), std::sin(a)}));
            m.normals.push_back(vec3(dvec3{0, std::cos(a), std::sin(a)}));
            m.joints.push_back({0, 1, 0, 0});
            m.weights.push_back({1 - float(ring) / 8, float(ring) / 8, 0, 0});
        }
    rig.scene.nodes.resize(3);
    rig.scene.nodes[0].skin = 0;
    rig.scene.nodes[0].meshes = {0};
    rig.scene.skins = {{{1, 2}, {mat4(1), glm::translate(mat4(1), vec3{-2, 0, 0})}, method}};
    rig.pose.morph_weights.resize(3);
    rig.pose.world_from_node = {dmat4(1), dmat4(1),
                                glm::rotate(glm::translate(dmat4(1), dvec3{2, 0, 0}), angle, dvec3{1, 0, 0})};
    return rig;
}

/// Kavan et al. 2008, fig. 2: linear blending takes the waist of a tube that is turned by 180 degrees to a point.
TEST(Skinning, DualQuaternionsKeepATwistedTubeRound)
{
    for (double const degrees : {30.0, 90.0, 150.0, 179.0, 180.0, 200.0}) {
        for (SkinningMethod const method : {SkinningMethod::linear, SkinningMethod::dual_quaternion}) {
            Rig const rig = twisted_tube(method, glm::radians(degrees));
            DeformedVertices const v = deform(rig.scene, rig.pose, 0, rig.scene.meshes[0]);
            double least = 10, most = 0;
            for (std::size_t i = 0; i < v.positions.size(); ++i) {
                double const r = glm::length(dvec3{0, v.positions[i].y, v.positions[i].z});
                least = std::min(least, r);
                most = std::max(most, r);
                EXPECT_NEAR(v.positions[i].x, rig.scene.meshes[0].positions[i].x, 1e-6f);
                if (method == SkinningMethod::dual_quaternion) {
                    EXPECT_LT(glm::distance(v.normals[i], vec3{0, v.positions[i].y, v.positions[i].z}), 1e-5f);
                }
            }
            EXPECT_NEAR(most, 1, 1e-6);
            double const waist =
                method == SkinningMethod::linear ? std::abs(std::cos(glm::radians(degrees) / 2)) : 1;
            EXPECT_NEAR(least, waist, 2e-6) << degrees;
        }
    }
}

/// Uneven and mirroring scales included.
TEST(Skinning, VerticesOfOneJointGoTheSameWayByBothMethods)
{
    Pcg32 rng(17, 0);
    for (int round = 0; round < 40; ++round) {
        Rig rig = random_rig(rng, true, Joints::any, SkinningMethod::linear, dvec3{0}, 0);
        if (round % 2 == 1)
            for (std::size_t j = 1; j < rig.pose.world_from_node.size(); ++j)
                rig.pose.world_from_node[j] *= glm::scale(dmat4(1), dvec3{1, 1, -1});
        for (vec4& w : rig.scene.meshes[0].weights) w = {0, 0.3f, 0, 0};
        DeformedVertices const a = deform(rig.scene, rig.pose, 0, rig.scene.meshes[0]);
        rig.scene.skins[0].method = SkinningMethod::dual_quaternion;
        DeformedVertices const b = deform(rig.scene, rig.pose, 0, rig.scene.meshes[0]);
        EXPECT_EQ(a.mirrored, b.mirrored);
        EXPECT_EQ(a.mirrored, round % 2 == 1);
        for (std::size_t i = 0; i < a.positions.size(); ++i) {
            ASSERT_LT(glm::distance(a.positions[i], b.positions[i]), 1e-5f) << round;
            ASSERT_LT(glm::distance(a.normals[i], b.normals[i]), 1e-4f) << round;
            ASSERT_LT(glm::distance(vec3(a.tangents[i]), vec3(b.tangents[i])), 1e-4f) << round;
        }
    }
}

TEST(Skinning, NearestRotationIsARotation)
{
    Pcg32 rng(5, 0);
    for (int round = 0; round < 200; ++round) {
        glm::dmat3 m(point(rng), point(rng), point(rng));
        if (round % 4 == 1) m[2] = dvec3{0}; // flat
        if (round % 4 == 2) m = 1e-9 * m;
        if (round % 4 == 3) m = glm::mat3_cast(turn(rng)) * 3.0;
        glm::dmat3 const q = nearest_rotation(m), error = glm::transpose(q) * q - glm::dmat3(1);
        for (int c = 0; c < 3; ++c) EXPECT_LT(glm::length(error[c]), 1e-9) << round;
        EXPECT_NEAR(glm::determinant(q), 1, 1e-9) << round;
        glm::dmat3 const stretch = glm::transpose(q) * m;
        double const size = glm::length(m[0]) + glm::length(m[1]) + glm::length(m[2]);
        for (int c = 0; c < 3; ++c)
            for (int r = 0; r < 3; ++r) EXPECT_NEAR(stretch[c][r], stretch[r][c], 1e-9 * size) << round;
    }
    EXPECT_EQ(nearest_rotation(glm::dmat3(0.0)), glm::dmat3(1));
    EXPECT_EQ(nearest_rotation(glm::dmat3(std::numeric_limits<double>::quiet_NaN())), glm::dmat3(1));
}

/// No weights, weights that are no numbers, joints that cancel each other, joints without volume: always numbers.
TEST(Skinning, DegenerateWeightsAndJointsGiveNumbers)
{
    float const nan = std::numeric_limits<float>::quiet_NaN();
    for (SkinningMethod const method : {SkinningMethod::linear, SkinningMethod::dual_quaternion}) {
        Rig rig = twisted_tube(method, glm::pi<double>());
        rig.pose.world_from_node[0] = glm::translate(dmat4(1), dvec3{0, 7, 0});
        Mesh& m = rig.scene.meshes[0];
        m.weights[0] = vec4{0};
        m.weights[1] = vec4{nan, 1, 0, 0};
        m.weights[2] = vec4{1e-38f, 0, 0, 0};
        m.weights[3] = vec4{1, -1, 0, 0};
        DeformedVertices v = deform(rig.scene, rig.pose, 0, m);
        for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(v.positions[i], m.positions[i] + vec3(0, 7, 0)) << i;
        for (dvec3 const scale : {dvec3{0}, dvec3{1, 0, 0}, dvec3{1, 1, 0}, dvec3{1e-15}, dvec3{1e15}}) {
            rig.pose.world_from_node[2] = glm::scale(dmat4(1), scale);
            v = deform(rig.scene, rig.pose, 0, m);
            for (vec3 const p : v.positions) EXPECT_TRUE(all_finite(p));
            for (vec3 const n : v.normals) EXPECT_TRUE(all_finite(n));
        }
    }
}

} // namespace
} // namespace gi::test
