#pragma once
// Mixes two encoded pictures of equal size.

#include "viewer/devices/gl/draw_target.h"
#include "viewer/devices/gl/gl_program.h"

namespace viewer {

/// Belongs to the context that was current at its creation.
class FadePass {
public:
    FadePass() : program_({"full_screen.vert"}, {"fade.frag"}) {}
    /// @param target  of the pictures' size  @param share  of the second, 0..1
    void draw(DrawTarget const& target, ShownPicture const& before, ShownPicture const& after, float share) const;

private:
    GlProgram program_;
    GlObject vertices_{GlObject::Kind::vertex_array};
};

} // namespace viewer
