#pragma once
// Temporal reuse: the light on a surface in earlier frames, found again through the motion of each pixel, averaged
// with that of this frame. Pictures of any method that gives the layer "motion".
//
// Two means are kept. While anything moves (camera, triangles), L1 and L2 over the albedo follow their surfaces:
// four texels of the frame before are asked, each believed if its depth and normal fit; the mean has at most
// `most_frames` frames, and L1 is held to what the neighbourhood shows now, as shadows move faster than that
// (Yang, Liu and Salvi 2020, sec. 4.2). Where the picture stands still, albedo and L0 are averaged too, so that
// edges and textures are smooth. While nothing moves anywhere, the mean of the pictures themselves is taken, over
// all frames since: so a still picture converges to what the method converges to. After a change of lights,
// materials or environment nothing of before is used: the lag is zero frames.
//
// A second eye need not ask the frame before where it takes the first one's light: that has its past with it.

#include "gi/filter/reused_light.h"

namespace gi {

struct TemporalSettings {
    int most_frames = 16; ///< >= 1; 1 = no reuse
};

/// What has happened since the frame before.
enum class SceneChange : std::uint8_t {
    nothing,
    motion, ///< of the camera or of triangles
    light   ///< of lights, materials or the environment
};

struct TemporalCounts {
    std::size_t surfaces = 0; ///< pixels that have one
    std::size_t started = 0;  ///< of these, without anything to reuse
    std::size_t held = 0;     ///< of these, whose L1 of before did not fit the neighbourhood
    double frames = 0;        ///< that a pixel is the mean of, on average
    int still_frames = 0;     ///< since anything moved, this one counted; 1 = something has
};

class TemporalReuse {
public:
    explicit TemporalReuse(TemporalSettings const& settings) : settings_(settings) {}

    /// Replaces L0, L1, L2, color and albedo by means over frames, and adds the layers variance_direct and
    /// variance_indirect: of the luminance of L1 and of L2 over the albedo, of these means, measured over frames;
    /// negative where there was one alone. Needs color, L0, L1, L2, albedo, normal, depth
    /// and motion (throws InputError where one is missing): x, y: pixels from here to where the surface was; z:
    /// its depth then, m; NaN where it was not. All frames have one size.
    /// @param partner, from  the reuse of a partner, to which this frame has been added already, and which of its
    ///   pixels' light to take (ReusedLight::from): their means while anything moves are those of the partner
    TemporalCounts add(Picture& frame, SceneChange change, TemporalReuse const* partner = nullptr,
                       std::span<std::uint32_t const> from = {});

private:
    struct Surface {
        vec3 normal;
        float depth; ///< m; 0 = nothing is there
    };
    struct Light {
        vec3 direct, indirect; ///< L1 and L2 over the albedo
        float frames;          ///< that they are means of
        vec2 variance;         ///< over those frames, of their luminances
        vec3 l0, albedo;
        float still_frames; ///< that these are means of
        bool still;         ///< its surface stood still in the picture
    };
    void follow(Picture const& frame, TemporalReuse const* partner, std::span<std::uint32_t const> from,
                TemporalCounts& counts);
    void rest(Picture& frame, TemporalCounts& counts);

    TemporalSettings settings_;
    int frames_ = 0, still_ = 0;
    std::vector<Surface> surfaces_, last_surfaces_;
    std::vector<Light> lights_, last_lights_;
    std::vector<std::array<vec3, 3>> mean_; ///< L0, L1, L2 since all is still
};

} // namespace gi
