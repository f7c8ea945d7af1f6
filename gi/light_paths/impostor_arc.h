#pragma once
// The arc that a ray covers as seen from a centre, and the cells of the cube about the centre
// that lie on it, one after the other.

#include "gi/light_paths/impostor_maps.h"

namespace gi {
namespace impostor_detail {

/// Positions along a ray by the share s of its arc: the direction from the centre is (1 - s) from + s reach, with
/// |reach| = |from|. So the end of the ray has s = 1, and the edges of texels are solutions of linear equations.
struct Arc {
    vec3 from, turn; ///< direction at s: from + s turn
    float away;      ///< |from|, m

    GI_FN Arc(vec3 from_m, vec3 direction) : from(from_m), away(glm::length(from_m))
    {
        turn = away * direction - from;
    }
    GI_FN vec3 at(float s) const { return from + s * turn; }
    /// Distance along the ray, m.
    GI_FN float distance(float s) const { return s < 1 ? away * s / (1 - s) : kInf; }
    GI_FN float share(float t) const { return t < kFarthest ? t / (away + t) : 1.0f; }
};

/// The part of an arc on one face of the cube: texel coordinates u / w and v / w, each linear in s.
struct FaceArc {
    int face;
    float u0, u1, v0, v1, w0, w1; ///< at s = 0, and per s
    bool u_up, v_up;              ///< whether columns and rows rise along the arc

    GI_FN FaceArc(Arc const& arc, int on) : face(on)
    {
        int const w = face / 2, u = (w + 1) % 3, v = (w + 2) % 3;
        float const sign = face % 2 == 0 ? 1.0f : -1.0f;
        w0 = sign * arc.from[w];
        w1 = sign * arc.turn[w];
        u0 = arc.from[u];
        u1 = arc.turn[u];
        v0 = arc.from[v];
        v1 = arc.turn[v];
        u_up = u1 * w0 - u0 * w1 > 0; // u / w is monotonous over a face
        v_up = v1 * w0 - v0 * w1 > 0;
    }
};

/// Steps along an arc from cell to cell of a face of n^2 cells: its texels or its blocks.
struct CellSteps {
    static constexpr float kRounding = 1e-5f;

    FaceArc const& arc;
    int n, i, j;
    float since, scale, next_u, next_v; ///< s at the start and at the edges ahead

    /// Starts in the cell at s, which rounding cannot put outside of `many` columns
    /// from first_i on and as many rows.
    GI_FN CellSteps(FaceArc const& on, float s, int cells, int first_i, int first_j, int many)
        : arc(on), n(cells), since(s), scale(2 / float(cells))
    {
        float const along = 0.5f * float(n) / (arc.w0 + s * arc.w1), middle = 0.5f * float(n);
        i = glm::clamp(int(middle + along * (arc.u0 + s * arc.u1)), first_i, first_i + many - 1);
        j = glm::clamp(int(middle + along * (arc.v0 + s * arc.v1)), first_j, first_j + many - 1);
        next_u = edge(arc.u0, arc.u1, i + (arc.u_up ? 1 : 0));
        next_v = edge(arc.v0, arc.v1, j + (arc.v_up ? 1 : 0));
    }
    GI_FN float end() const { return glm::min(glm::min(next_u, next_v), 1.0f); }
    /// Columns and rows only rise or only fall, so that this ends even if rounding puts edges out of order.
    GI_FN void step()
    {
        if (next_u < next_v) {
            i += arc.u_up ? 1 : -1;
            next_u = edge(arc.u0, arc.u1, i + (arc.u_up ? 1 : 0));
        } else {
            j += arc.v_up ? 1 : -1;
            next_v = edge(arc.v0, arc.v1, j + (arc.v_up ? 1 : 0));
        }
    }
    GI_FN bool inside() const { return i >= 0 && j >= 0 && i < n && j < n; }

private:
    GI_FN float edge(float x0, float x1, int k) const
    {
        float const at = scale * float(k) - 1;
        float const s = (at * arc.w0 - x0) / (x1 - at * arc.w1);
        // An edge behind the start is one of a coordinate that does not change: never.
        return s >= since - kRounding ? s : 2.0f;
    }
};

} // namespace impostor_detail
} // namespace gi
