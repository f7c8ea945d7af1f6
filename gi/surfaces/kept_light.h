#pragma once
// The light of a finished picture, kept by the surfaces that receive it, so that another picture can show it: one
// of another size or camera, or a later one. Light is that of L1 and L2 over the albedo; where a surface of the
// other picture lies in this one, the nearest pixels that show a similar surface are averaged (joint bilateral
// upsampling, Kopf et al. 2007).
//
// Irradiance is nearly linear in the normal (its spherical harmonics of order 0 and 1: Ramamoorthi and Hanrahan
// 2001). So where the picture has the layer light_normal, means of normals made with the same weights as means
// over frames of light (gi/filter/temporal.h), light is fitted as a linear function of them around each pixel,
// and folds and reliefs that are finer than its pixels, or were blurred over frames,
// are shaded by the normals of the other picture.

#include "gi/image_io/picture.h"
#include "gi/scene/model/projection.h"
#include "gi/surfaces/light_picture.h"

#include <optional>

namespace gi {

struct FoundLight {
    vec3 direct{0}, indirect{0}; ///< L1 and L2 over the albedo
    /// Of the most similar surface used, 0..1; below kUnlike the light is that of some surface around.
    float likeness = 0;
};

class KeptLight {
public:
    static constexpr float kUnlike = 0.01f;

    /// Needs the layers L1, L2, albedo, normal and position (throws InputError if
    /// one is missing); uses light_normal.
    /// @param origin  of the world, from which camera and later positions are measured
    KeptLight(Picture const& picture, CameraRays const& camera, dvec3 origin);

    /// Light of a surface, at most two pixels of this picture away from where it lies in it; none outside of it.
    /// @param position  m, from the world's origin   @param normal  unit
    std::optional<FoundLight> find(vec3 position, vec3 normal) const;
    /// The same, for a place in this picture, in its pixels from the top left corner.
    FoundLight find(vec3 position, vec3 normal, vec2 place) const;

    /// The same light for shaders; without its camera.
    LightPicture picture() const;

    int width() const { return width_; }
    int height() const { return height_; }

private:
    struct Texel {
        vec3 position;
        float reach; ///< 1 / distance from its plane at which another surface begins, 1/m; 0 = no surface
        vec3 normal;
        std::uint32_t dark; ///< bits of the channels in which the albedo is too dark
        vec3 direct, indirect;
        vec3 mean_normal; ///< of the surfaces whose light this is
        vec3 slope{0};    ///< relative change of light with the normal
    };
    struct Sum;
    void find_slopes();
    static float likeness(Texel const& texel, vec3 position, vec3 normal);

    CameraRays camera_;
    Projection project_;
    int width_, height_;
    std::vector<Texel> texels_;
    FoundLight mean_; ///< of the picture
};

} // namespace gi
