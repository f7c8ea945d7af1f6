#pragma once
// Hides what is outside or inside of a circle with a soft edge: windows and masks that follow gaze.

#include "viewer/devices/gl/draw_target.h"
#include "viewer/devices/gl/gl_program.h"

namespace viewer {

/// Belongs to the context that was current at its creation.
class GazePass {
public:
    enum class Hidden { outside, inside };
    GazePass() : program_({"full_screen.vert"}, {"gaze.frag"}) {}
    /// Blends a grey over what was drawn. @param centre_px  from the target's top left corner   @param edge_px
    /// width over which it fades, around the radius   @param grey  display-encoded, 0..1
    void draw(DrawTarget const& target, Hidden hidden, glm::vec2 centre_px, float radius_px, float edge_px,
              float grey) const;

private:
    GlProgram program_;
    GlObject vertices_{GlObject::Kind::vertex_array};
};

} // namespace viewer
