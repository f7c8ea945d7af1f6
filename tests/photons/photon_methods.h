#pragma once
// All methods of gi/methods/photons, for tests that hold for each of them, and small scenes.

#include "gi/light_paths/settings.h"
#include "gi/methods/photons/methods.h"
#include "tests/support/scenes.h"

namespace gi::test {

struct PhotonMethod {
    char const* name;
    RenderResult (*render)(World const&, Camera const&, RenderSettings const&, StopRequest const&,
                           RenderProgress const&, Report&);
    std::unique_ptr<FrameRenderer> (*start)(MovingWorld const&, Camera const&, RenderSettings const&, Report&);
};

inline constexpr PhotonMethod kPhotonMethods[] = {{"ispm", render_ispm, start_ispm_frames},
                                                  {"lpv", render_lpv, start_lpv_frames},
                                                  {"isllpm", render_isllpm, start_isllpm_frames},
                                                  {"multi_image", render_multi_image, start_multi_image_frames}};

/// A small picture with coarse lattices and few impostors.
inline RenderSettings small_photon_picture(int size, int paths)
{
    RenderSettings s;
    s.width = s.height = size;
    s.paths = 1;
    s.of<PhotonSettings>().paths = paths;
    s.of<PhotonSettings>().caustic_paths = paths / 4;
    s.of<PhotonSettings>().propagation_cells = 12;
    s.of<PhotonSettings>().low_cells = s.of<PhotonSettings>().middle_cells = s.of<PhotonSettings>().high_cells = s.of<PhotonSettings>().volume_cells = 16;
    s.of<PhotonSettings>().impostors = 8;
    s.of<PhotonSettings>().impostor_texels = 64;
    return s;
}

/// A closed room, about 2 m wide, with a point light, a mirror that throws a caustic and a block in it.
/// @param scale  of all lengths; radiance stays the same
inline Scene room_with_mirror(float scale = 1)
{
    Scene scene;
    // No wall lies between two cells of a lattice, where rounding would decide.
    add_box(scene, scale * vec3{-1.1f, -1, -1.15f}, scale * vec3{0.95f, 0.9f, 1},
            add_material(scene, lambert({0.7f, 0.6f, 0.5f})), true);
    add_box(scene, scale * vec3{-0.7f, -0.999f, -0.6f}, scale * vec3{-0.2f, -0.3f, -0.1f},
            add_material(scene, lambert({0.2f, 0.5f, 0.7f})), false);
    add_quad(scene, scale * vec3{0.4f, -0.9f, -0.4f}, scale * vec3{0.3f, 0.1f, 0.5f}, scale * vec3{-0.1f, 0.8f, 0},
             add_material(scene, mirror(vec3{0.9f})));
    Light lamp;
    lamp.type = LightType::point;
    lamp.position = scale * vec3{0.1f, 0.7f, 0.2f};
    lamp.intensity = vec3{scale * scale};
    add_light(scene, lamp);
    return scene;
}

inline Camera in_the_room(double scale = 1)
{
    return look_at(scale * dvec3{0.2, 0.1, 0.9}, scale * dvec3{0, -0.5, -0.4}, 80);
}

inline double indirect(Picture const& p) { return mean_of(p, "L2").mean; }

} // namespace gi::test
