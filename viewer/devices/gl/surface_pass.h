#pragma once
// The picture of a wall that is not flat, from finished pictures of the faces of a cube around an eye: each pixel
// takes the colour in the direction from the eye to the point of the surface that it lights (cube_faces.h).
// Input and output are display-encoded.

#include "viewer/devices/gl/draw_target.h"
#include "viewer/devices/gl/gl_program.h"
#include "viewer/displays/cube_faces.h"

namespace viewer {

/// A face and its picture.
struct ShownFace {
    CubeFace face = CubeFace::front;
    gi::ViewTangents tangents;
    ShownPicture picture;
};

/// One wall. Belongs to the context that was current at its creation.
class SurfacePass {
public:
    explicit SurfacePass(Surface const& surface);
    /// Fills the target; black where the surface is not lit or its face is missing.
    /// If the size of the target has changed, the surface's points are computed again.
    /// @param eye_m  in the room
    void draw(DrawTarget const& target, std::span<ShownFace const> faces, gi::dvec3 eye_m);

private:
    void find_points(glm::ivec2 size_px);

    Surface surface_;
    GlProgram program_;
    GlObject vertices_{GlObject::Kind::vertex_array}, points_;
    glm::ivec2 points_px_{0};
};

} // namespace viewer
