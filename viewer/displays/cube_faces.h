#pragma once
// Pictures for a surface that is not flat: parts of the faces of a cube around the eye, each an ordinary off-axis
// view, from which the surface's pixels are taken by direction. The cube is parallel to the surface's frame.

#include "gi/scene/model/camera.h"
#include "viewer/displays/surface.h"

#include <span>
#include <string_view>
#include <vector>

namespace viewer {

enum class CubeFace { front, left, right, up, down, back }; ///< -Z, -X, +X, +Y, -Y, +Z of the cube
inline constexpr std::array kCubeFaces{CubeFace::front, CubeFace::left, CubeFace::right,
                                       CubeFace::up,    CubeFace::down, CubeFace::back};
char const* name_of(CubeFace face);
/// From the frame of the face's camera (looks along -Z) to that of the cube.
glm::dmat3 cube_from_face(CubeFace face);

/// The rendered part of a face: view tangents of its edges, at most 1 plus a margin for filtering.
struct FaceView {
    CubeFace face = CubeFace::front;
    gi::ViewTangents tangents;
    int width_px = 0, height_px = 0;
};
/// The parts that a viewport needs, seen from any of `eyes` (room, m). Empty if nothing of it is lit.
/// @param viewport_px  width, height  @param face_px  edge of a whole face; 0 = as fine as the viewport
std::vector<FaceView> faces_for(Surface const& surface, glm::ivec2 viewport_px, std::span<gi::dvec3 const> eyes,
                                int face_px);
/// The camera of one face at an eye, in the room.
gi::Camera face_camera(Surface const& surface, FaceView const& face, gi::dvec3 eye_m);

} // namespace viewer
