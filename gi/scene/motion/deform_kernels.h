#pragma once
// Kernels that compute the world-space vertices of one instance of a mesh, one item per vertex: morph targets,
// then the node's transform, linear blend skinning or dual quaternion skinning. skinning.h prepares their inputs.
//
// Results are float metres relative to a fixed origin. Matrices are multiplied in double and the origin is
// subtracted before rounding; meshes far from their local zero are first moved to their centre. The error of a
// position is therefore at most about 8 * 2^-24 * (its distance from the origin + the size of the mesh at that
// place), wherever the origin lies. Explicit fused multiply-adds make host and device give the same positions, bit
// for bit, because hit buffers depend on them.
//
// Normals are multiplied by the cofactor matrix, which exists even for singular transforms,
// and negated together with the winding if the instance is mirrored; tangents are multiplied by the matrix itself.
// Vectors without length become zero.

#include "gi/core/math.h"
#include "gi/core/view.h"

#include <array>

namespace gi {

/// Affine map: row r is (linear part, offset).
struct Affine {
    vec4 rows[3]{{1, 0, 0, 0}, {0, 1, 0, 0}, {0, 0, 1, 0}};

    bool operator==(Affine const&) const = default;
};

using JointIndices = std::array<std::uint16_t, 4>;

/// One morph target with non-zero weight; arrays are empty or as long as the mesh's positions.
struct MorphView {
    View<vec3 const> positions, normals, tangents;
    float weight = 0;
};

/// A mesh as authored. Normals and tangents are empty or as long as the positions.
struct MeshView {
    View<vec3 const> positions, normals;
    View<vec4 const> tangents;
    View<JointIndices const> joints;
    View<vec4 const> weights;
    View<MorphView const> morphs;
    vec3 center{0}; ///< subtracted from the positions; the maps apply to the result
};

namespace deform_detail {

GI_FN inline float dot(vec3 a, vec3 b) { return std::fma(a.z, b.z, std::fma(a.y, b.y, a.x * b.x)); }
GI_FN inline vec3 cross(vec3 a, vec3 b)
{
    return {std::fma(a.y, b.z, -(a.z * b.y)), std::fma(a.z, b.x, -(a.x * b.z)), std::fma(a.x, b.y, -(a.y * b.x))};
}
/// s * a + b
GI_FN inline vec3 add_scaled(float s, vec3 a, vec3 b)
{
    return {std::fma(s, a.x, b.x), std::fma(s, a.y, b.y), std::fma(s, a.z, b.z)};
}
GI_FN inline vec4 add_scaled(float s, vec4 a, vec4 b)
{
    return {std::fma(s, a.x, b.x), std::fma(s, a.y, b.y), std::fma(s, a.z, b.z), std::fma(s, a.w, b.w)};
}
GI_FN inline Affine scaled(float s, Affine const& a) { return {{s * a.rows[0], s * a.rows[1], s * a.rows[2]}}; }
GI_FN inline Affine add_scaled(float s, Affine const& a, Affine const& b)
{
    return {{add_scaled(s, a.rows[0], b.rows[0]), add_scaled(s, a.rows[1], b.rows[1]),
             add_scaled(s, a.rows[2], b.rows[2])}};
}
GI_FN inline vec3 linear(vec4 row) { return {row.x, row.y, row.z}; }

GI_FN inline vec3 apply(Affine const& a, vec3 p)
{
    auto const row = [p](vec4 r) { return std::fma(r.x, p.x, std::fma(r.y, p.y, std::fma(r.z, p.z, r.w))); };
    return {row(a.rows[0]), row(a.rows[1]), row(a.rows[2])};
}

GI_FN inline vec3 unit(vec3 v)
{
    float const length = std::sqrt(dot(v, v));
    return length > 0 && length <= kInf ? vec3{v.x / length, v.y / length, v.z / length} : vec3{0};
}

/// Weights of a vertex, normalised to sum one; `any` is false if they are all zero or NaN.
struct Weights {
    vec4 w;
    bool any;
};
GI_FN inline Weights normalised(vec4 w)
{
    float const sum = w.x + w.y + w.z + w.w;
    if (!(sum > 1e-30f)) return {w, false};
    float const inverse = 1 / sum;
    return {{w.x * inverse, w.y * inverse, w.z * inverse, w.w * inverse}, true};
}

} // namespace deform_detail

/// Rigid placement: every vertex follows the node.
struct RigidPlacement {
    Affine node;

    GI_FN Affine operator()(MeshView const&, std::size_t) const { return node; }
};

/// Linear blend skinning: weighted mean of the joints' maps. Vertices without weights follow the node.
struct LinearPlacement {
    Affine node;
    View<Affine const> joints;

    GI_FN Affine operator()(MeshView const& mesh, std::size_t i) const
    {
        using namespace deform_detail;
        Weights const v = normalised(mesh.weights[i]);
        if (!v.any) return node;
        JointIndices const& j = mesh.joints[i];
        Affine m = scaled(v.w.x, joints[j[0]]);
        m = add_scaled(v.w.y, joints[j[1]], m);
        m = add_scaled(v.w.z, joints[j[2]], m);
        return add_scaled(v.w.w, joints[j[3]], m);
    }
};

/// Rigid motion: rotation `real` (x, y, z, w; unit) followed by a translation t, dual = 0.5 t real.
struct DualQuaternion {
    vec4 real{0, 0, 0, 1}, dual{0};

    bool operator==(DualQuaternion const&) const = default;
};

/// Dual quaternion skinning (Kavan, Collins, Zara & O'Sullivan 2008, "Geometric Skinning with Approximate Dual
/// Quaternion Blending", DLB; two phases for scale, their section 4.4). Each joint's map is split into a
/// stretch followed by a rigid motion: first the stretches are blended linearly, then the motions as dual
/// quaternions, in the hemisphere of the joint with the largest weight. So a vertex of a single joint has the same
/// position as with linear skinning, under any scale, and a uniform scale shared by all joints commutes with the
/// blending. Between joints of different or non-uniform scale, the stretch is interpolated linearly about their
/// rest positions, and there the two kinds of skinning differ in the stretch, too.
struct DualQuaternionPlacement {
    Affine node;
    View<DualQuaternion const> motions;
    View<Affine const> stretches; ///< one per joint, or one for all

    GI_FN Affine operator()(MeshView const& mesh, std::size_t i) const
    {
        using namespace deform_detail;
        Weights const v = normalised(mesh.weights[i]);
        if (!v.any) return node;
        JointIndices const& j = mesh.joints[i];
        int pivot = 0;
        for (int k = 1; k < 4; ++k)
            if (v.w[k] > v.w[pivot]) pivot = k;
        vec4 const toward = motions[j[std::size_t(pivot)]].real;
        vec4 real{0}, dual{0};
        for (int k = 0; k < 4; ++k) {
            DualQuaternion const& q = motions[j[std::size_t(k)]];
            float const cosine = std::fma(q.real.w, toward.w, dot(linear(q.real), linear(toward)));
            float const w = cosine < 0 ? -v.w[k] : v.w[k];
            real = add_scaled(w, q.real, real);
            dual = add_scaled(w, q.dual, dual);
        }
        float const length = std::sqrt(std::fma(real.w, real.w, dot(linear(real), linear(real))));
        if (!(length > 1e-6f)) { // opposite rotations cancel: use the one of largest weight
            real = toward;
            dual = motions[j[std::size_t(pivot)]].dual;
        } else {
            real = {real.x / length, real.y / length, real.z / length, real.w / length};
            dual = {dual.x / length, dual.y / length, dual.z / length, dual.w / length};
        }
        Affine stretch = stretches[0];
        if (stretches.size() > 1) {
            stretch = scaled(v.w.x, stretches[j[0]]);
            for (int k = 1; k < 4; ++k) stretch = add_scaled(v.w[k], stretches[j[std::size_t(k)]], stretch);
        }
        return after(real, dual, stretch);
    }

private:
    /// Returns the composition: the affine map followed by the rigid motion.
    GI_FN static Affine after(vec4 real, vec4 dual, Affine const& a)
    {
        using namespace deform_detail;
        vec3 const r = linear(real), d = linear(dual);
        vec3 const across = cross(r, d);
        Affine out;
        for (int k = 0; k < 3; ++k) {
            // Row k of the rotation (w^2 - r.r) I + 2 r r^T + 2 w [r]; that of [r] is cross(axis k, r).
            vec3 axis{0};
            axis[k] = 1;
            vec3 const turned = cross(axis, r);
            vec3 row{2 * r[k] * r.x, 2 * r[k] * r.y, 2 * r[k] * r.z};
            row = add_scaled(2 * real.w, turned, row);
            row[k] += std::fma(real.w, real.w, -dot(r, r));
            float const moved = 2 * std::fma(real.w, d[k], std::fma(-dual.w, r[k], across[k]));
            vec4 m{row.x * a.rows[0].x, row.x * a.rows[0].y, row.x * a.rows[0].z,
                   std::fma(row.x, a.rows[0].w, moved)};
            m = add_scaled(row.y, a.rows[1], m);
            out.rows[k] = add_scaled(row.z, a.rows[2], m);
        }
        return out;
    }
};

/// Item = vertex. Outputs are as long as the mesh's positions; normals and tangents may be empty if they are not
/// needed or the mesh has none.
template <class Placement>
struct DeformVertices {
    MeshView mesh;
    Placement placement;
    float handedness = 1; ///< -1: the instance is mirrored
    float shrink = 1;     ///< power of two that scales the maps' linear parts to about one, against overflow
    View<vec3> positions, normals;
    View<vec4> tangents;

    GI_FN void operator()(std::size_t i) const
    {
        using namespace deform_detail;
        Affine const m = placement(mesh, i);
        positions[i] = apply(m, morphed(mesh.positions[i] - mesh.center, i, &MorphView::positions));
        if (normals.empty() && tangents.empty()) return;
        vec3 const x = shrink * linear(m.rows[0]), y = shrink * linear(m.rows[1]), z = shrink * linear(m.rows[2]);
        if (!normals.empty()) {
            // If m has the rows x, y, z, its cofactor matrix has the rows cross(y, z), cross(z, x), cross(x, y).
            vec3 const n = morphed(mesh.normals[i], i, &MorphView::normals);
            normals[i] = handedness * unit({dot(cross(y, z), n), dot(cross(z, x), n), dot(cross(x, y), n)});
        }
        if (!tangents.empty()) {
            vec4 const given = mesh.tangents[i];
            vec3 const t = morphed(linear(given), i, &MorphView::tangents);
            tangents[i] = vec4(unit({dot(x, t), dot(y, t), dot(z, t)}), given.w * handedness);
        }
    }

private:
    GI_FN vec3 morphed(vec3 v, std::size_t i, View<vec3 const> MorphView::*field) const
    {
        for (MorphView const& target : mesh.morphs)
            if (View<vec3 const> const& delta = target.*field; !delta.empty())
                v = deform_detail::add_scaled(target.weight, delta[i], v);
        return v;
    }
};

} // namespace gi
