#pragma once
// A finished picture on the GPU: linear radiance, and depth if it is to be reprojected.

#include "viewer/devices/gl/draw_target.h"

#include <span>

namespace viewer {

class PictureTexture {
public:
    /// Replaces the picture. Rows from the top.
    /// @param rgb     3 floats per pixel, linear
    /// @param depth_m one float per pixel, along the camera's axis, 0 = no hit (infinitely far); or empty
    /// Throws InputError if the number of values is wrong.
    void upload(glm::ivec2 size_px, std::span<float const> rgb, std::span<float const> depth_m = {});

    ShownPicture shown() const { return {color_.id(), size_px_}; }
    unsigned depth_texture() const { return has_depth_ ? depth_.id() : 0; } ///< 0 = no depth
    float nearest_m() const { return nearest_m_; } ///< smallest depth except 0; infinite if there is none

private:
    glm::ivec2 size_px_{};
    GlObject color_, depth_;
    bool has_depth_ = false;
    float nearest_m_ = 0;
};

} // namespace viewer
