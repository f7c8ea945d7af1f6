#pragma once
// Draws a finished picture into images of the runtime: any size, top or bottom row first, linear or sRGB-encoded,
// with its depths if they are known.

#include "viewer/devices/xr/frame.h"

namespace viewer {

class EyePass {
public:
    EyePass();
    ~EyePass();
    EyePass(EyePass const&) = delete;
    EyePass& operator=(EyePass const&) = delete;

    /// Distance of what has a depth of 1 in the runtime's images, m: they are reversed, kNear_m / depth, and 0 is
    /// infinitely far. What is nearer is drawn as being there.
    static constexpr float kNear_m = 0.05f;

    struct Target {
        unsigned texture = 0;       ///< GL name
        unsigned depth_texture = 0; ///< of the same size; 0 = none
        int width = 0, height = 0;
        bool is_srgb = false; ///< GL_SRGB8_ALPHA8: drawn values are stored sRGB-encoded
    };
    /// sRGB-encoded bytes stay unchanged in an sRGB target of the same size. Asks OpenGL for nothing, as drivers with a
    /// thread of their own would make it wait; what it has switched on, it switches off.
    /// @param depth  drawn if the target has depths, too
    void draw(unsigned texture, TextureValues values, FirstRow first_row, Target const& target,
              ShownDepth const& depth = {}) const;

private:
    unsigned program_ = 0, with_depth_ = 0, vertices_ = 0, framebuffer_ = 0, smooth_ = 0, exact_ = 0;
};

} // namespace viewer
