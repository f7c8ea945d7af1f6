#include "viewer/devices/gl/gl_object.h"

#include <epoxy/gl.h>

namespace viewer {

GlObject::GlObject(Kind kind, unsigned texture_target) : kind_(kind)
{
    switch (kind) {
    case Kind::texture:
        glCreateTextures(texture_target, 1, &id_);
        break;
    case Kind::buffer:
        glCreateBuffers(1, &id_);
        break;
    case Kind::framebuffer:
        glCreateFramebuffers(1, &id_);
        break;
    case Kind::vertex_array:
        glCreateVertexArrays(1, &id_);
        break;
    case Kind::program:
        id_ = glCreateProgram();
        break;
    case Kind::time:
        glCreateQueries(GL_TIMESTAMP, 1, &id_);
        break;
    }
}

GlObject::~GlObject()
{
    if (id_ == 0) return;
    switch (kind_) {
    case Kind::texture:
        glDeleteTextures(1, &id_);
        break;
    case Kind::buffer:
        glDeleteBuffers(1, &id_);
        break;
    case Kind::framebuffer:
        glDeleteFramebuffers(1, &id_);
        break;
    case Kind::vertex_array:
        glDeleteVertexArrays(1, &id_);
        break;
    case Kind::program:
        glDeleteProgram(id_);
        break;
    case Kind::time:
        glDeleteQueries(1, &id_);
        break;
    }
}

GlObject texture_2d(unsigned format, glm::ivec2 size_px, unsigned filter)
{
    GlObject texture(GlObject::Kind::texture, GL_TEXTURE_2D);
    glTextureStorage2D(texture.id(), 1, format, size_px.x, size_px.y);
    for (GLenum const which : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTextureParameteri(texture.id(), which, GLint(filter));
    for (GLenum const axis : {GL_TEXTURE_WRAP_S, GL_TEXTURE_WRAP_T})
        glTextureParameteri(texture.id(), axis, GL_CLAMP_TO_EDGE);
    return texture;
}

} // namespace viewer
