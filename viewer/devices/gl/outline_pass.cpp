#include "viewer/devices/gl/outline_pass.h"

#include <epoxy/gl.h>

namespace viewer {

void OutlinePass::draw(DrawTarget const& target, ShownPicture const& picture) const
{
    bind(target);
    for (GLenum const filter : {GL_TEXTURE_MIN_FILTER, GL_TEXTURE_MAG_FILTER})
        glTextureParameteri(picture.texture, filter, GL_LINEAR);
    glBindTextureUnit(0, picture.texture);
    program_.use();
    glBindVertexArray(vertices_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

} // namespace viewer
