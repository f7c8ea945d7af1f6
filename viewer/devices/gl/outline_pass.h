#pragma once
// Smooths stairs at outlines of an encoded picture, by what it shows alone: where brightness jumps around a pixel, the
// pixel becomes a mean along that edge (FXAA, Lottes 2009). For drawn surfaces, which have one sample a pixel. The
// outermost pixels stay as they are.

#include "viewer/devices/gl/draw_target.h"
#include "viewer/devices/gl/gl_program.h"

namespace viewer {

/// Belongs to the context that was current at its creation.
class OutlinePass {
public:
    OutlinePass() : program_({"full_screen.vert"}, {"outline.frag"}) {}
    /// @param target  a texture of the picture's size
    void draw(DrawTarget const& target, ShownPicture const& picture) const;

private:
    GlProgram program_;
    GlObject vertices_{GlObject::Kind::vertex_array};
};

} // namespace viewer
