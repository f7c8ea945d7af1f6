#pragma once
// A finished picture on the GPU: linear radiance, and depth if it is to be reprojected.

#include "viewer/devices/gl/draw_target.h"

#include <glm/vec4.hpp>
#include <span>
#include <vector>

namespace viewer {

class PictureTexture {
public:
    /// Replaces the picture. Rows from the top.
    /// @param rgb     3 floats per pixel, linear
    /// @param depth_m one float per pixel, along the camera's axis, 0 = no hit (infinitely far); or empty
    /// Throws InputError if the number of values is wrong.
    void upload(glm::ivec2 size_px, std::span<float const> rgb, std::span<float const> depth_m = {});

    ShownPicture shown() const { return {color_.id(), size_px_}; }
    /// Side of the tiles of around().
    static constexpr int kTile = 16;
    /// R, G: least and greatest 1 / depth of each tile and of those beside it, 1/m; 0 = no depth was given.
    unsigned around() const { return has_depth_ ? around_.id() : 0; }
    float nearest_m() const { return nearest_m_; } ///< smallest depth except 0; infinite if there is none

private:
    glm::ivec2 size_px_{};
    GlObject color_, around_; ///< color_: radiance and 1 / depth
    std::vector<glm::vec4> texels_;
    bool has_depth_ = false;
    float nearest_m_ = 0;
};

} // namespace viewer
