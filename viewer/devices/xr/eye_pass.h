#pragma once
// Draws a finished picture into an image of the runtime: any size, top or bottom
// row first, linear or sRGB-encoded.

#include "viewer/devices/xr/frame.h"

namespace viewer {

class EyePass {
public:
    EyePass();
    ~EyePass();
    EyePass(EyePass const&) = delete;
    EyePass& operator=(EyePass const&) = delete;

    struct Target {
        unsigned texture = 0; ///< GL name
        int width = 0, height = 0;
        bool is_srgb = false; ///< GL_SRGB8_ALPHA8: drawn values are stored sRGB-encoded
    };
    /// sRGB-encoded bytes stay unchanged in an sRGB target of the same size. Restores the GL state.
    void draw(unsigned texture, TextureValues values, FirstRow first_row, Target const& target) const;

private:
    unsigned program_ = 0, vertices_ = 0, framebuffer_ = 0, sampler_ = 0;
};

} // namespace viewer
