#include "viewer/devices/gl/messages.h"

#include <epoxy/gl.h>

namespace viewer {
namespace {

void GLAPIENTRY on_message(GLenum, GLenum type, GLuint, GLenum, GLsizei, GLchar const* message, void const* user)
{
    static_cast<GlMessages*>(const_cast<void*>(user))->hear(type, message);
}

} // namespace

GlMessages::GlMessages(gi::Report& report) : report_(report)
{
    glEnable(GL_DEBUG_OUTPUT);
    glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
    glDebugMessageCallback(on_message, this);
}

void GlMessages::hear(unsigned type, char const* message)
{
    if (type == GL_DEBUG_TYPE_ERROR) {
        ++errors_;
        report_.lose("OpenGL errors", 1, message);
    } else if (type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR) {
        report_.lose("OpenGL calls with undefined behaviour", 1, message);
    }
}

} // namespace viewer
