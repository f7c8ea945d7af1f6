#pragma once
// Materials as plain data. One struct holds both models; bsdf.h and docs/methods/scene.md define them.

#include "gi/scene/model/texture.h"

#include <algorithm>
#include <cmath>

namespace gi {

enum class MaterialModel : std::uint8_t {
    /// glTF 2: Lambert + GGX, metal, KHR specular / ior / transmission. Mirror: metallic 1, roughness 0.
    metal_rough,
    phong, ///< Lambert base_color + normalised Phong lobe (Chang et al., sec. 4.3)
};

enum class AlphaMode : std::uint8_t { opaque, mask, blend };

struct Material {
    MaterialModel model = MaterialModel::metal_rough;
    AlphaMode alpha_mode = AlphaMode::opaque;
    /// Emission leaves both faces; otherwise only the front (counter-clockwise) face emits.
    /// Reflection always works on both faces: there is no back-face culling.
    bool double_sided = false;
    /// Meant to show its base colour whatever the light (KHR_materials_unlit); rendered as matt.
    bool unlit = false;
    bool thin = true; ///< transmission through an infinitely thin sheet (no KHR_materials_volume): no refraction

    vec3 base_color{0.8f}; ///< linear; phong: diffuse albedo k_d
    float alpha = 1;       ///< base colour alpha
    float alpha_cutoff = 0.5f;
    float metallic = 0;       ///< 0..1
    float roughness = 1;      ///< perceptual, GGX alpha = roughness^2; below kSmoothAlpha it is a perfect mirror
    float specular = 1;       ///< KHR_materials_specular.specularFactor; 0 = pure Lambert
    vec3 specular_color{1};   ///< KHR_materials_specular.specularColorFactor
    float ior = 1.5f;         ///< >= 1
    float transmission = 0;   ///< 0..1, fraction of a dielectric's non-reflected light that is transmitted
    vec3 absorption{0};       ///< inside of closed glass (not thin), 1/m
    vec3 phong_specular{0};   ///< k_s of f = k_s (n+1)/(2 pi) (r . w)^n
    float phong_exponent = 1; ///< n >= 0
    vec3 emission{0};         ///< radiance, W/(m2 sr) = emissiveFactor * emissive_strength
    float normal_scale = 1;

    TextureRef base_color_map;         ///< sRGB, multiplies base_color and alpha
    TextureRef metallic_roughness_map; ///< G roughness, B metallic
    TextureRef normal_map;             ///< tangent space, +Y up
    TextureRef emissive_map;           ///< sRGB, multiplies emission
    TextureRef specular_map;           ///< A multiplies specular
    TextureRef specular_color_map;     ///< sRGB, multiplies specular_color
    TextureRef transmission_map;       ///< R multiplies transmission

    bool operator==(Material const&) const = default;
};

GI_FN inline bool has_textures(Material const& m)
{
    return m.base_color_map.texture >= 0 || m.metallic_roughness_map.texture >= 0 || m.normal_map.texture >= 0 ||
           m.emissive_map.texture >= 0 || m.specular_map.texture >= 0 || m.specular_color_map.texture >= 0 ||
           m.transmission_map.texture >= 0;
}

/// Thin glass: light goes on in its direction.
GI_FN inline bool is_pane(Material const& m)
{
    return m.model == MaterialModel::metal_rough && m.thin && m.transmission > 0;
}

/// Absorption coefficient (1/m) of glass in which this share of light is left after a distance (m). At most 1e9.
inline vec3 absorption(vec3 left, double distance_m)
{
    vec3 a{0};
    for (int c = 0; c < 3; ++c) a[c] = float(std::clamp(-std::log(double(left[c])) / distance_m, 0.0, 1e9));
    return a;
}

GI_FN inline bool emits(Material const& m) { return max_component(m.emission) > 0; }

} // namespace gi
