#pragma once
// Reprojection of the last finished picture to a new camera, e.g. for a head-mounted display while the next
// picture is being rendered.
//
// A pixel of the new camera B looks along r + c w in tangents of the old camera A, where w = 1 / depth (along A's
// axis) of the surface that it meets, r is the direction alone and c the contribution of the camera's translation.
// The depth must equal that of A's picture at this point: a fixed point, found by iteration from far and from near
// (Bowles et al. 2012, "Iterative Image Warping"); the nearer solution hides the other. Pure rotation (c = 0)
// needs no search. 1/depth of a plane is linear in the picture, so planes are found between pixels.
//
// Regions that A did not see (occluded or outside its picture) are filled from neighbouring pixels
// of A: the first farther pixel along the translation, or the stretched edge of the picture.
// View-dependent light (mirrors) moves with its surface.

#include "gi/light_paths/settings.h"
#include "gi/scene/model/camera.h"
#include "viewer/devices/gl/gl_program.h"
#include "viewer/devices/gl/picture_texture.h"

#include <memory>
#include <optional>

namespace viewer {

/// Mapping from B's pixels to A's, for homogeneous positions in pixels from the top left.
struct ReprojectionMaps {
    glm::mat3 a_from_b;  ///< for directions: A's pixel of a point at infinity
    glm::vec3 b_in_a{0}; ///< B's position in A's frame: pixels times depth, and depth (m)
};

/// Throws InputError on an orthographic camera. Lenses are treated as pinholes; world_from_camera must be rigid.
ReprojectionMaps reprojection_maps(gi::Camera const& a, glm::ivec2 a_px, gi::Camera const& b, glm::ivec2 b_px);

/// Belong to the context that was current at their creation.
struct ReprojectionPrograms {
    ReprojectionPrograms();
    GlProgram turn, search; ///< for pure rotation, and for translation
};

/// Belongs to the context that was current at its creation.
class Reprojection {
public:
    explicit Reprojection(
        std::shared_ptr<ReprojectionPrograms const> programs = std::make_shared<ReprojectionPrograms>())
        : programs_(std::move(programs))
    {
    }
    /// Reprojects `picture`, taken by camera a, to camera b at size_px: linear radiance, and in alpha 1 / depth, 1/m. With
    /// the same camera and size the pixels are bit-identical.
    /// Without depth, the picture is treated as infinitely far, so only rotation has an effect. The result is
    /// valid until the next call.
    ShownPicture draw(PictureTexture const& picture, gi::Camera const& a, gi::Camera const& b, glm::ivec2 size_px);

    /// Frees the memory of a result of another size.
    void keep_only(glm::ivec2 size_px)
    {
        if (out_ && out_->shown().size_px != size_px) out_.reset();
    }

private:
    std::shared_ptr<ReprojectionPrograms const> programs_;
    GlObject vertices_{GlObject::Kind::vertex_array};
    std::optional<TextureTarget> out_;
};

} // namespace viewer
