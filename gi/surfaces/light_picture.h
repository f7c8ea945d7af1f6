#pragma once
// The light that falls on the surfaces of one picture, to be looked up by the surfaces of pictures of other cameras:
// where a surface lies in this picture, the nearest texels that show a similar one are averaged, by the rule of
// KeptLight (kept_light.h). Plain data, for a shader.

#include "gi/image_io/picture.h"
#include "gi/scene/model/camera.h"

#include <bit>

namespace gi {

/// What one pixel shows, packed as shaders unpack it.
struct LightTexel {
    std::uint32_t normal = 0; ///< of shading: octahedral, 16 bits each (unpackSnorm2x16)
    float plane_m = 0;        ///< distance of its plane from the camera along the normal
    std::uint32_t light = 0;  ///< radiance over albedo: nine bits each and an exponent (GL_RGB9_E5)
    /// A float: depth along the camera's axis, m, 0 = no surface. In its last three bits: the channels in which the
    /// albedo is too dark to know the light. In the two before: the number of the flat mirror in which it is seen, 0 =
    /// none. Its normal is then that of the surface where it is; distance and depth are those of its image.
    std::uint32_t depth_dark = 0;
};
inline constexpr std::uint32_t kDarkBits = 7, kMirrorShift = 3, kPictureMirrors = 3;

inline bool has_surface(LightTexel const& t)
{
    return t.depth_dark > (kDarkBits | kPictureMirrors << kMirrorShift);
}
inline float depth_of(LightTexel const& t) ///< m; 0 = no surface
{
    return std::bit_cast<float>(t.depth_dark & ~(kDarkBits | kPictureMirrors << kMirrorShift));
}
inline std::uint32_t mirror_of(LightTexel const& t) { return t.depth_dark >> kMirrorShift & kPictureMirrors; }

/// How its light changes with the normal, see KeptLight: by the factor 1 + dot(slope, normal - mean normal).
struct LightSlope {
    std::uint32_t mean_normal = 0; ///< of the surfaces whose light this is, as LightTexel::normal
    std::uint32_t slope = 0;       ///< ten bits each, 512 = 0, in steps of kSlopeStep; all 0: not known
};
inline constexpr float kSlopeStep = 1.0f / 64;

/// @param position  relative to the camera, m  @param normal  unit  @param light  >= 0  @param dark  bits of channels
LightTexel light_texel(vec3 position, vec3 normal, vec3 light, unsigned dark, float depth);
std::uint32_t packed_light(vec3 light); ///< LightTexel::light
LightSlope light_slope(vec3 mean_normal, vec3 slope);
vec3 unpacked_normal(std::uint32_t bits); ///< of LightTexel::normal; unit

/// Of a flat mirror in which a picture shows surfaces.
struct MirrorPlane {
    vec3 normal{0};       ///< unit
    float distance_m = 0; ///< dot(normal, place) of its places, which count from the world's origin
};
inline mat3 reflection(MirrorPlane const& m) { return mat3(1) - 2.0f * glm::outerProduct(m.normal, m.normal); }
inline vec3 reflected(MirrorPlane const& m, vec3 place)
{
    return place - 2 * (glm::dot(m.normal, place) - m.distance_m) * m.normal;
}

struct LightPicture {
    int width = 0, height = 0;
    Camera camera;                           ///< of the picture
    int camera_width = 0, camera_height = 0; ///< pixels that it is for
    float texels_per_pixel = 1;
    vec2 at{0.5f};                  ///< where rays pass texels, 0..1 from their top left corners
    vec3 mean{0};                   ///< of the light of its surfaces
    std::uint64_t lamps = 0;        ///< counts changes of the scene's light: pictures of other lamps are not mixed
    bool without_punctual = false;  ///< light of punctual lights is not part of it
    std::vector<LightTexel> texels; ///< rows from the top
    std::vector<LightSlope> slopes; ///< of the same; empty = not known
    std::vector<MirrorPlane> mirrors; ///< those that texels name by their number, from 1; at most kPictureMirrors
};

/// Distance from the plane of a surface at which another one begins, relative to the depth.
inline constexpr float kOfDepth = 0.005f;

/// The light of a picture with layers L1, L2, albedo, normal and position; empty if one is missing. At most
/// `most_texels` texels: every second (third...) pixel of a larger picture.
LightPicture light_picture(Picture const& picture, Camera const& camera, std::size_t most_texels);
/// What a texel and its slope show is the image in that mirror of the picture, @param mirror  from 1
void make_image(LightPicture& light, std::size_t texel, std::uint32_t mirror);
/// Sets LightPicture::mean, of some of its texels.
void find_mean(LightPicture& light);

} // namespace gi
