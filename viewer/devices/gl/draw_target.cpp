#include "viewer/devices/gl/draw_target.h"

#include "viewer/devices/gl/window.h"

#include <algorithm>
#include <epoxy/gl.h>

namespace viewer {

DrawTarget target_of(Window const& window)
{
    DrawTarget target;
    target.size_px = window.framebuffer_px();
    if (window.has_quad_buffer()) {
        target.left_buffer = GL_BACK_LEFT;
        target.right_buffer = GL_BACK_RIGHT;
    }
    return target;
}

DrawTarget part_of(DrawTarget const& whole, glm::ivec2 top_left_px, glm::ivec2 size_px)
{
    DrawTarget part = whole;
    part.corner_px.x += top_left_px.x;
    part.corner_px.y +=
        whole.rows == RowOrder::top_first ? top_left_px.y : whole.size_px.y - top_left_px.y - size_px.y;
    part.size_px = size_px;
    return part;
}

void bind(DrawTarget const& target)
{
    glBindFramebuffer(GL_FRAMEBUFFER, target.framebuffer);
    glViewport(target.corner_px.x, target.corner_px.y, target.size_px.x, target.size_px.y);
    for (GLenum const what :
         {GL_BLEND, GL_DEPTH_TEST, GL_SCISSOR_TEST, GL_CULL_FACE, GL_FRAMEBUFFER_SRGB, GL_DITHER})
        glDisable(what);
}

void clear(DrawTarget const& target, float grey)
{
    bind(target);
    glEnable(GL_SCISSOR_TEST);
    glScissor(target.corner_px.x, target.corner_px.y, target.size_px.x, target.size_px.y);
    glClearColor(grey, grey, grey, 1);
    glClear(GL_COLOR_BUFFER_BIT);
    glDisable(GL_SCISSOR_TEST);
}

void stretch(DrawTarget const& from, DrawTarget const& to)
{
    bind(to);
    glm::ivec2 const a = from.corner_px, b = from.corner_px + from.size_px;
    glm::ivec2 c = to.corner_px, d = to.corner_px + to.size_px;
    if (from.rows != to.rows) std::swap(c.y, d.y);
    glBlitNamedFramebuffer(from.framebuffer, to.framebuffer, a.x, a.y, b.x, b.y, c.x, c.y, d.x, d.y,
                           GL_COLOR_BUFFER_BIT, from.size_px == to.size_px ? GL_NEAREST : GL_LINEAR);
}

std::vector<unsigned char> read_bytes(DrawTarget const& target, unsigned buffer)
{
    std::size_t const row = 3 * std::size_t(target.size_px.x), rows = std::size_t(target.size_px.y);
    std::vector<unsigned char> bytes(row * rows);
    glBindFramebuffer(GL_READ_FRAMEBUFFER, target.framebuffer);
    if (buffer != 0) glReadBuffer(buffer);
    glPixelStorei(GL_PACK_ALIGNMENT, 1);
    glReadPixels(target.corner_px.x, target.corner_px.y, target.size_px.x, target.size_px.y, GL_RGB,
                 GL_UNSIGNED_BYTE, bytes.data());
    if (target.rows == RowOrder::top_last)
        for (std::size_t y = 0; y < rows / 2; ++y)
            std::swap_ranges(bytes.begin() + std::ptrdiff_t(y * row),
                             bytes.begin() + std::ptrdiff_t((y + 1) * row),
                             bytes.begin() + std::ptrdiff_t((rows - 1 - y) * row));
    return bytes;
}

TextureTarget::TextureTarget(Format format, glm::ivec2 size_px)
    : size_px_(size_px),
      texture_(texture_2d(format == Format::bytes   ? GL_RGBA8
                          : format == Format::words ? GL_RGBA32UI
                                                    : GL_RGBA32F,
                          size_px, GL_NEAREST)),
      framebuffer_(GlObject::Kind::framebuffer)
{
    glNamedFramebufferTexture(framebuffer_.id(), GL_COLOR_ATTACHMENT0, texture_.id(), 0);
}

DrawTarget TextureTarget::target() const
{
    return {framebuffer_.id(), {0, 0}, size_px_, RowOrder::top_first, 0, 0};
}

} // namespace viewer
