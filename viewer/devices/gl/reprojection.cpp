#include "viewer/devices/gl/reprojection.h"

#include "gi/core/error.h"
#include "viewer/devices/gl/view_matrices.h"

#include <cmath>
#include <epoxy/gl.h>

namespace viewer {
namespace {

using glm::dmat3;
using glm::dvec3;

void check(gi::Camera const& camera)
{
    if (camera.orthographic)
        throw gi::InputError("the orthographic camera '" + camera.name + "' cannot be reprojected",
                             "its rays do not share one origin", "show its pictures as they are");
}

} // namespace

ReprojectionMaps reprojection_maps(gi::Camera const& a, glm::ivec2 a_px, gi::Camera const& b, glm::ivec2 b_px)
{
    check(a);
    check(b);
    dmat3 const a_from_world = pixel_from_world(a, a_px);
    ReprojectionMaps maps;
    maps.a_from_b = glm::mat3(a_from_world * axes_of(b) * frame_from_pixel(b, b_px));
    maps.b_in_a = glm::vec3(a_from_world * (dvec3(b.world_from_camera[3]) - dvec3(a.world_from_camera[3])));
    return maps;
}

ReprojectionPrograms::ReprojectionPrograms()
    : turn({"full_screen.vert"}, {"reprojection.glsl", "reprojection.frag"},
           "#define SEARCHES 0\n#define TILE 1\n"),
      search({"full_screen.vert"}, {"reprojection.glsl", "reprojection.frag"},
             "#define SEARCHES 1\n#define TILE " + std::to_string(PictureTexture::kTile) + "\n")
{
}

ShownPicture Reprojection::draw(PictureTexture const& picture, gi::Camera const& a, gi::Camera const& b,
                                glm::ivec2 size_px)
{
    ShownPicture const shown = picture.shown();
    if (shown.texture == 0)
        throw gi::InputError("there is no picture to reproject", "none was uploaded", "upload one first");
    ReprojectionMaps const maps = reprojection_maps(a, shown.size_px, b, size_px);
    keep_only(size_px);
    if (!out_) out_.emplace(TextureTarget::Format::linear, size_px);
    bool const searches =
        picture.around() != 0 && std::isfinite(picture.nearest_m()) && maps.b_in_a != glm::vec3(0.0f);
    bind(out_->target());
    glBindTextureUnit(0, shown.texture);
    glBindTextureUnit(1, searches ? picture.around() : shown.texture);
    GlProgram const& program = searches ? programs_->search : programs_->turn;
    program.set("a_from_b", maps.a_from_b);
    program.set("b_in_a", maps.b_in_a);
    program.set("nearest", searches ? 1 / picture.nearest_m() : 0.0f);
    program.use();
    glBindVertexArray(vertices_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    return out_->shown();
}

} // namespace viewer
