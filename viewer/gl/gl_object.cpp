#include "viewer/gl/gl_object.h"

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
    }
}

} // namespace viewer
