#pragma once
// Rooms in which the kernels of paths are compared with the CPU.

#include "tests/support/scenes.h"

namespace gi::test {

/// A room with a block and a ball in it; what lights it is added by the test.
inline Scene room()
{
    Scene scene;
    int const grey = add_material(scene, lambert(vec3{0.6f}));
    add_box(scene, {-1, -1, -1}, {1, 1, 1}, grey, true);
    add_box(scene, {-0.4f, -1, -0.4f}, {0.3f, 0, 0.2f}, add_material(scene, lambert(vec3{0.3f, 0.6f, 0.2f})),
            false);
    add_sphere(scene, {0.5f, -0.6f, 0.4f}, 0.3f, 3, add_material(scene, lambert(vec3{0.7f, 0.2f, 0.2f})), true);
    return scene;
}

inline Camera room_camera() { return look_at({0.8, 0.5, 0.9}, {-0.2, -0.5, -0.3}, 70); }

inline Material rough_metal(float roughness)
{
    Material m;
    m.metallic = 1;
    m.roughness = roughness;
    m.base_color = {0.9f, 0.7f, 0.4f};
    return m;
}

/// A room with a mirror, a ball of glass and one of metal whose lobe is narrow.
inline Scene shiny_room()
{
    Scene scene = room();
    add_quad(scene, {-0.95f, -0.8f, -0.6f}, {0, 1.2f, 0}, {0, 0, 1.2f}, add_material(scene, mirror(vec3{0.9f})));
    add_sphere(scene, {-0.1f, 0.3f, 0}, 0.25f, 3, add_material(scene, glass(1.5f, false)), true);
    add_sphere(scene, {0.5f, 0, -0.4f}, 0.25f, 3, add_material(scene, rough_metal(0.3f)), true);
    return scene;
}

} // namespace gi::test
