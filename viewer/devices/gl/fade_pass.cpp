#include "viewer/devices/gl/fade_pass.h"

#include <epoxy/gl.h>

namespace viewer {

void FadePass::draw(DrawTarget const& target, ShownPicture const& before, ShownPicture const& after,
                    float share) const
{
    bind(target);
    glBindTextureUnit(0, before.texture);
    glBindTextureUnit(1, after.texture);
    program_.set("corner", target.corner_px);
    program_.set("top_last", int(target.rows == RowOrder::top_last));
    program_.set("share", share);
    program_.use();
    glBindVertexArray(vertices_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
}

} // namespace viewer
