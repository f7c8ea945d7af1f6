#pragma once
// Surfaces drawn by OpenGL beside those of the CPU form: the same scene, camera and picture of light.

#include "viewer/devices/gl/surface_renderer.h"

#include "gi/filter/tone_map.h"
#include "gi/surfaces/lit_picture.h"

#include <epoxy/gl.h>
#include <functional>

namespace viewer::test {

/// Radiance over albedo of a surface. @param place  over the scene's radius, from the world's origin
using LightField = std::function<gi::vec3(gi::vec3 place, gi::vec3 normal)>;

/// Light that changes softly from place to place and with the normal.
inline gi::vec3 soft_light(gi::vec3 p, gi::vec3 n)
{
    return (0.7f + 0.25f * glm::dot(n, gi::vec3{0.5f, 0.7f, 0.5f})) *
           gi::vec3{0.6f + 0.3f * std::sin(3 * p.x), 0.6f + 0.3f * std::cos(4 * p.y),
                    0.6f + 0.2f * std::sin(3 * p.z + p.x)};
}
inline gi::vec3 even_light(gi::vec3, gi::vec3) { return gi::vec3{0.8f, 0.6f, 0.5f}; }

struct SurfaceView {
    char const* name;
    gi::Camera camera;
    glm::ivec2 size_px;
};

/// From here on, textures are what their largest level is, as the CPU has no others.
inline void leave_out_mip_maps()
{
    constexpr unsigned kMostNames = 10000;
    for (unsigned id = 1; id < kMostNames; ++id) {
        if (!glIsTexture(id)) continue;
        GLint target = 0;
        glGetTextureParameteriv(id, GL_TEXTURE_TARGET, &target);
        if (target == GL_TEXTURE_2D) glTextureParameteri(id, GL_TEXTURE_MAX_LEVEL, 0);
    }
}

/// The CPU form of a view.
struct CpuForm {
    gi::Picture picture;    ///< color, depth
    gi::LightPicture light; ///< that it is lit by
};

inline CpuForm cpu_form(gi::World const& w, SurfaceView const& v, LightField const& field, float light_scale = 1)
{
    float const radius = w.bounds.radius();
    glm::ivec2 const size = glm::max(glm::ivec2(glm::round(light_scale * glm::vec2(v.size_px))), glm::ivec2(1));
    gi::SeenSurfaces seen(w, 0);
    gi::CameraRays const of_light = gi::camera_rays(v.camera, size.x, size.y, w.origin);
    seen.look(of_light, size.x, size.y);
    gi::Picture small{size.x, size.y, {}, {}};
    for (char const* name : {"L1", "L2", "albedo", "normal", "position", "light_normal"}) small.add(name, 3);
    std::vector<std::size_t> images;
    std::vector<gi::SeenSurface> row(std::size_t(size.x));
    for (int y = 0; y < size.y; ++y) {
        seen.row(y, row);
        for (int x = 0; x < size.x; ++x) {
            gi::SeenSurface const& s = row[std::size_t(x)];
            auto const i = std::size_t(y * size.x + x);
            if (!(s.depth > 0)) continue;
            if (s.is_image) images.push_back(i);
            auto const put = [&](char const* layer, gi::vec3 value) {
                for (int c = 0; c < 3; ++c) small.find(layer)->data[3 * i + std::size_t(c)] = value[c];
            };
            put("L1", s.albedo * field(s.position / radius, s.normal));
            put("albedo", s.albedo);
            put("normal", s.normal);
            put("light_normal", s.normal);
            put("position", gi::vec3(gi::dvec3(s.position) + w.origin));
        }
    }
    gi::KeptLight const kept(small, of_light, w.origin);
    CpuForm out;
    out.light = kept.picture();
    for (std::size_t const i : images) out.light.texels[i] = {};
    out.light.camera = v.camera;
    out.light.camera_width = size.x;
    out.light.camera_height = size.y;
    out.light.without_punctual = gi::SeenSurfaces::has_few_lights(w);
    gi::find_mean(out.light);
    if (out.light.mean == gi::vec3{0}) out.light.mean = field(gi::vec3{0}, gi::vec3{0, 1, 0}); // an image alone
    gi::CameraRays const rays = gi::camera_rays(v.camera, v.size_px.x, v.size_px.y, w.origin);
    seen.look(rays, v.size_px.x, v.size_px.y,
              out.light.without_punctual ? gi::SeenSurfaces::Lights::few : gi::SeenSurfaces::Lights::none);
    gi::LitCounts counts;
    out.picture = gi::lit_picture(seen, v.size_px.x, v.size_px.y, kept, {}, counts);
    return out;
}

/// Linear radiance that OpenGL draws. @param last  picture of the same camera, for what is taken from it
inline std::vector<float> gl_form(SurfaceRenderer& renderer, SurfaceView const& v, gi::Picture const& last)
{
    PictureTexture picture;
    picture.upload(v.size_px, last.find("color")->data, last.find("depth")->data);
    ShownPicture const out = renderer.draw(0, 0, v.camera, v.size_px, picture, v.camera);
    std::vector<float> rgb(std::size_t(3 * v.size_px.x * v.size_px.y));
    glPixelStorei(GL_PACK_ALIGNMENT, 4);
    glGetTextureImage(out.texture, 0, GL_RGB, GL_FLOAT, GLsizei(rgb.size() * sizeof(float)), rgb.data());
    return rgb;
}

/// Share of pixels that differ by more than 2/255 as shown.
inline double share_differing(std::vector<float> const& a, std::vector<float> const& b, float exposure_ev = 0)
{
    auto const shown = [&](float v) {
        return 255 * gi::encode_srgb(std::clamp(std::exp2(exposure_ev) * v, 0.0f, 1.0f));
    };
    std::size_t n = 0;
    for (std::size_t i = 0; i < a.size(); i += 3) {
        float most = 0;
        for (std::size_t c = 0; c < 3; ++c) {
            float const d = std::abs(shown(a[i + c]) - shown(b[i + c]));
            most = d <= most ? most : d; // NaN differs
        }
        n += !(most <= 2);
    }
    return 3 * double(n) / double(a.size());
}

} // namespace viewer::test
