#pragma once
// Propagation of light from cell to cell (Kaplanyan and Dachsbacher 2010, sec. 4.3), as kernels for CPU and CUDA.
//
// A cell holds the intensity of a point light at its centre. Each of its six neighbours gets the flux through the
// neighbour's five other faces, which becomes light of the neighbour (Reprojection). The flux through a face is
// the exact integral of the four coefficients over the face's solid angle (the paper multiplies its solid angle
// with the intensity towards its middle). Four coefficients of a lobe are below 0 behind it: such fluxes count as
// 0, and the others of the cell are scaled so that their sum is the cell's flux. So propagation in free space
// keeps each channel's flux.

#include "gi/light_paths/settings.h"
#include "gi/methods/photons/sh_lattice.h"
#include "gi/render/render_settings.h"

namespace gi {

/// The far face and the four side faces of a cell, seen from the centre of its neighbour: solid angles, sr, and
/// the integrals of the unit direction over them: along the axis between the cells, and outwards.
inline constexpr float kFarSolidAngle = 0.400669685f, kSideSolidAngle = 0.423431354f, kFarAlong = 0.387413633f,
                       kSideAlong = 0.338356467f, kSideOutwards = 0.219373131f;
/// The same of the face between the cells.
inline constexpr float kNearSolidAngle = 2.09439510f, kNearAlong = 1.7408395f;

/// Flux through a face, which may be below 0. @param side  0 to 3 = the side faces, low and high, of the axes
/// (axis + 1) % 3 and (axis + 2) % 3; 4 = the far one
GI_FN inline vec3 face_flux(ShColor const& light, int axis, float sign, int side)
{
    vec3 const along = sign * light.c[axis + 1];
    if (side == 4) return (ShColor::kY0 * kFarSolidAngle) * light.c[0] + (ShColor::kY1 * kFarAlong) * along;
    float const out = (side & 1) != 0 ? kSideOutwards : -kSideOutwards;
    return (ShColor::kY0 * kSideSolidAngle) * light.c[0] +
           ShColor::kY1 * (kSideAlong * along + out * light.c[(axis + 1 + side / 2) % 3 + 1]);
}

/// The factor of a cell's fluxes above 0 that keeps its flux.
GI_FN inline vec3 face_scale(ShColor const& light)
{
    vec3 sum{0};
    for (int neighbour = 0; neighbour < 6; ++neighbour)
        for (int side = 0; side < 5; ++side)
            sum += glm::max(face_flux(light, neighbour / 2, neighbour % 2 != 0 ? 1.0f : -1.0f, side), vec3{0});
    vec3 const flux = glm::max(light.integral(), vec3{0});
    vec3 scale{0};
    for (int k = 0; k < 3; ++k) scale[k] = sum[k] > 0 ? flux[k] / sum[k] : 0;
    return scale;
}

struct ScaleFaces {
    View<ShColor const> lights;
    View<vec3> scales;

    GI_FN void operator()(std::size_t i) const
    {
        scales[i] = lights[i].c[0] == vec3{0} ? vec3{0} : face_scale(lights[i]);
    }
};

/// Surfaces about a corner of the lattice's cells, along the three axes.
struct Blocker {
    vec3 area{0};   ///< projected, over that of a face
    vec3 moment{0}; ///< sum of such areas times their coordinate, m

    GI_FN Blocker& operator+=(Blocker const& o)
    {
        area += o.area;
        moment += o.moment;
        return *this;
    }
};
GI_FN inline Blocker operator*(float by, Blocker const& b) { return {by * b.area, by * b.moment}; }

/// Shares of the light that passes the low faces of cells, x, y and z. The surfaces' areas, projected on the axes
/// and divided by a face's, lie in cells about the corners of the lattice's cells: the mean of the four at the
/// corners of a face is what blocks it.
struct OpenFaces {
    GridFrame frame;             ///< grid of the corners: one more per side than cells
    View<Blocker const> blocked; ///< per corner
    View<vec3> open; ///< per cell, and those behind the last ones, whose low faces are the last ones' high faces

    GI_FN void operator()(std::size_t i) const
    {
        glm::ivec3 const at = frame.cell_of(std::uint32_t(i));
        vec3 out{1};
        for (int axis = 0; axis < 3; ++axis)
            for (int k = 0; k < 4; ++k) {
                glm::ivec3 corner = at;
                corner[(axis + 1) % 3] += k & 1;
                corner[(axis + 2) % 3] += k >> 1;
                if (frame.holds(corner)) out[axis] -= 0.25f * blocked[frame.index(corner)].area[axis];
            }
        open[i] = glm::max(out, vec3{0});
    }
};

/// Adds flux through a face to the cell behind it:
///   beams         one along the mean way from the neighbour's centre to the face, so that light keeps its
///                 direction as far as four coefficients can
///   cosine_lobes  a clamped cosine about the face's normal (Kaplanyan and Dachsbacher): light forgets its
///                 direction within a few steps, and much of it turns back
/// @param side  see face_flux()
GI_FN inline void add_through_face(Reprojection by, vec3 flux, int axis, float sign, int side, ShColor& to)
{
    int const across = (axis + 1 + side / 2) % 3;
    float const outwards = (side & 1) != 0 ? 1.0f : -1.0f;
    vec3 way{0};
    if (side == 4)
        way[axis] = by == Reprojection::beams ? sign * (kFarAlong / kFarSolidAngle) : sign;
    else if (by == Reprojection::beams) {
        way[axis] = sign * (kSideAlong / kSideSolidAngle);
        way[across] = outwards * (kSideOutwards / kSideSolidAngle);
    } else
        way[across] = outwards;
    if (by == Reprojection::beams)
        to.add_beam(flux, way);
    else
        to.add_cosine_lobe(flux, way);
}

/// One step of all light: gathers what a cell's six neighbours send.
struct Propagate {
    DenseView<ShColor> lights;
    View<vec3 const> scales;
    GridFrame corners;     ///< see OpenFaces
    View<vec3 const> open; ///< none = nothing blocks
    /// Of the coarser grid: all light that ever was in a cell; comes in over the border.
    DenseView<ShColor> around;
    Reprojection by;
    View<ShColor> moved, total; ///< per cell: the step's light; its sum over the steps

    GI_FN void operator()(std::size_t i) const
    {
        glm::ivec3 const at = lights.frame.cell_of(std::uint32_t(i));
        ShColor sum;
        for (int neighbour = 0; neighbour < 6; ++neighbour) {
            int const axis = neighbour / 2;
            float const sign = neighbour % 2 != 0 ? 1.0f : -1.0f; // in which the light travels
            glm::ivec3 from = at, face = at;
            from[axis] += sign > 0 ? -1 : 1;
            face[axis] += sign > 0 ? 0 : 1;
            vec3 scale;
            ShColor light;
            if (lights.frame.holds(from)) {
                std::uint32_t const source = lights.frame.index(from);
                if (scales[source] == vec3{0}) continue;
                light = lights.values[source];
                scale = scales[source];
            } else {
                if (around.values.empty()) continue;
                float const ratio = square(lights.frame.cell / around.frame.cell); // of the same radiance
                light = ratio * trilinear<ShColor>(around, lights.frame.center(from));
                scale = face_scale(light);
            }
            if (!open.empty()) scale *= open[corners.index(face)][axis];
            for (int side = 0; side < 5; ++side) {
                vec3 const flux = scale * glm::max(face_flux(light, axis, sign, side), vec3{0});
                add_through_face(by, flux, axis, sign, side, sum);
            }
        }
        moved[i] = sum;
        total[i] += sum;
    }
};

} // namespace gi
