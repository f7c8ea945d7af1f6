#pragma once
// A picture of any size whose surfaces, textures and outlines are its own,
// and whose light is that of a smaller one.

#include "gi/surfaces/kept_light.h"
#include "gi/surfaces/mirror_boxes.h"
#include "gi/surfaces/seen_surfaces.h"

namespace gi {

struct LitCounts {
    std::size_t surfaces = 0;
    std::size_t unlike = 0; ///< of these, those that found no similar surface, and took some light around them
};

/// Layers color and depth (of what mirrors show, as an image behind them) of the last view of `seen`.
/// @param hidden  1 for each pixel that stays black and without a surface; empty = none
/// @param before  of the previous frame: adds the layer "motion" for Antialiasing::add; null = none
/// @param margin  pixels on each side that lie beyond the picture of light, whose edge they take it from
Picture lit_picture(SeenSurfaces const& seen, int width, int height, KeptLight const& light,
                    std::span<std::uint8_t const> hidden, LitCounts& counts, CameraRays const* before = nullptr,
                    vec2 margin = vec2{0});

/// A picture of light, enlarged, with what mirrors and panes show in a part of it. Layers color and depth, as lit_picture.
/// @param seen  its last view is that part  @param width, height  of the result, px
Picture mirror_picture(SeenSurfaces const& seen, PixelBox const& part, int width, int height,
                       KeptLight const& light, Picture const& of_light);

/// A pixel whose surface is elsewhere: SeenSurface::is_image.
struct SeenImage {
    std::uint32_t pixel = 0;
    bool is_reflected = false;
    vec3 mirror{0}; ///< place of the mirror or pane, m
};

/// Layers of a method's picture for pixels that show a mirror or a pane.
struct MirrorLayers {
    std::vector<std::uint32_t> pixels;
    std::vector<std::array<vec3, 3>> layers; ///< albedo, normal, position
    std::vector<float> depths;
    std::vector<SeenImage> images;
};

/// Replaces albedo, normal, position, depth and motion of pixels that show a mirror or a pane by those of what is
/// seen in it, so that filters and temporal reuse follow that. Returns what they were. The last view of `seen`
/// must be that of the picture. @param before  the camera of the previous frame
MirrorLayers describe_mirrored(SeenSurfaces const& seen, CameraRays const& now, CameraRays const& before,
                               dvec3 origin, Picture& picture);
/// The layer of depths of what a picture shows, also in mirrors: "seen_depth", or "depth" without mirrors.
inline char const* seen_depth_of(Picture const& picture)
{
    return picture.find("seen_depth") != nullptr ? "seen_depth" : "depth";
}
/// Undoes it for albedo, normal and position; keeps the depth in "seen_depth".
void describe_mirrors(MirrorLayers const& was, Picture& picture);

} // namespace gi
