#include "viewer/devices/gl/gaze_pass.h"

#include <epoxy/gl.h>

namespace viewer {

void GazePass::draw(DrawTarget const& target, Hidden hidden, glm::vec2 centre_px, float radius_px, float edge_px,
                    float grey) const
{
    bind(target);
    glEnable(GL_BLEND);
    glBlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    program_.set("corner", target.corner_px);
    program_.set("target_size", target.size_px);
    program_.set("top_last", int(target.rows == RowOrder::top_last));
    program_.set("hides_inside", int(hidden == Hidden::inside));
    program_.set("centre", centre_px);
    program_.set("radius", radius_px);
    program_.set("edge", edge_px);
    program_.set("grey", grey);
    program_.use();
    glBindVertexArray(vertices_.id());
    glDrawArrays(GL_TRIANGLES, 0, 3);
    glDisable(GL_BLEND);
}

} // namespace viewer
