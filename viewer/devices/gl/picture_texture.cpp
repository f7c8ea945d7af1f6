#include "viewer/devices/gl/picture_texture.h"

#include "gi/core/error.h"

#include <epoxy/gl.h>
#include <fmt/format.h>
#include <limits>

namespace viewer {

void PictureTexture::upload(glm::ivec2 size_px, std::span<float const> rgb, std::span<float const> depth_m)
{
    std::size_t const pixels = std::size_t(std::max(size_px.x, 0)) * std::size_t(std::max(size_px.y, 0));
    if (pixels == 0 || rgb.size() != 3 * pixels || (!depth_m.empty() && depth_m.size() != pixels))
        throw gi::InputError(fmt::format("a picture of {} x {} pixels with {} values of colour and {} of depth",
                                         size_px.x, size_px.y, rgb.size(), depth_m.size()),
                             "three of colour and one of depth belong to each pixel",
                             "give the layers of one picture");
    bool const resized = size_px != size_px_;
    size_px_ = size_px;
    if (resized || color_.id() == 0) color_ = texture_2d(GL_RGB32F, size_px, GL_NEAREST);
    glPixelStorei(GL_UNPACK_ALIGNMENT, 4);
    glTextureSubImage2D(color_.id(), 0, 0, 0, size_px.x, size_px.y, GL_RGB, GL_FLOAT, rgb.data());

    has_depth_ = !depth_m.empty();
    nearest_m_ = std::numeric_limits<float>::infinity();
    if (!has_depth_) {
        if (resized) depth_ = {};
        return;
    }
    if (resized || depth_.id() == 0) depth_ = texture_2d(GL_R32F, size_px, GL_NEAREST);
    glTextureSubImage2D(depth_.id(), 0, 0, 0, size_px.x, size_px.y, GL_RED, GL_FLOAT, depth_m.data());
    for (float const d : depth_m)
        if (d > 0 && d < nearest_m_) nearest_m_ = d;
}

} // namespace viewer
