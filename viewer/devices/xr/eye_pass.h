#pragma once
// Draws a finished picture into an image of the runtime: any size, either first row, light or its sRGB code.

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
        bool is_srgb = false; ///< GL_SRGB8_ALPHA8: what is drawn is stored as sRGB code
    };
    /// Bytes of sRGB code arrive as they are in a target of sRGB code of the same size. GL's state is as before.
    void draw(unsigned texture, TextureValues values, FirstRow first_row, Target const& target) const;

private:
    unsigned program_ = 0, vertices_ = 0, framebuffer_ = 0, sampler_ = 0;
};

} // namespace viewer
