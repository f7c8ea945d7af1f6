#pragma once
// The last finished picture as another place would see it: what a head-mounted display shows while the next
// picture is still rendered.
//
// Seen from the new camera B, a pixel looks along r + c w in tangents of the old camera A, w = 1 / depth (along
// A's axis) of what it meets, r the direction alone and c what the shift of the camera adds. The depth is that
// which A's picture has there: a fixed point, searched by iteration from far and from near (Bowles et al. 2012,
// "Iterative Image Warping"); the nearer solution hides the other. Turning alone (c = 0) needs no search. 1/depth
// of a plane is linear in the picture, so that planes are found between pixels.
//
// What A did not see - behind something, or outside its picture - is filled with what A saw beside it: the first
// farther pixel along the shift, or the picture's edge, stretched. View-dependent light (mirrors) moves with its
// surface.

#include "gi/scene/model/camera.h"
#include "viewer/devices/gl/gl_program.h"
#include "viewer/devices/gl/picture_texture.h"

#include <optional>

namespace viewer {

/// How A's pixels are reached from B's; matrices for positions in pixels from the top left, homogeneous.
struct ReprojectionMaps {
    glm::mat3 a_from_b;  ///< of directions: A's pixel of what is infinitely far
    glm::vec3 b_in_a{0}; ///< B's place in A's frame: pixels times depth, and depth (m)
};

/// Throws InputError on an orthographic camera. Lenses are taken as pinholes; world_from_camera must be rigid.
ReprojectionMaps reprojection_maps(gi::Camera const& a, glm::ivec2 a_px, gi::Camera const& b, glm::ivec2 b_px);

/// Belongs to the context that was current when it was made.
class Reprojection {
public:
    Reprojection();
    /// What `picture`, taken by camera a, shows from camera b in a picture of size_px: linear radiance; alpha is 1
    /// where A saw it, 0 where it is stretched. From the same place in the same size the pixels are the same, bit
    /// for bit. A picture without depth is taken as infinitely far: only turning is seen. Valid until the next
    /// call.
    ShownPicture draw(PictureTexture const& picture, gi::Camera const& a, gi::Camera const& b, glm::ivec2 size_px);

private:
    GlProgram turn_, search_; ///< the same place, another one
    GlObject vertices_{GlObject::Kind::vertex_array};
    std::optional<TextureTarget> out_;
};

} // namespace viewer
