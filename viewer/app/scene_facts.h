#pragma once
// What the panel and the remote control show of the loaded scene.

#include "viewer/engine/render_session.h"

namespace viewer {

/// Copy of the scene's data for the panel and the remote control, because the session
/// belongs to the rendering thread.
struct SceneFacts {
    struct Named {
        std::string name;
        gi::Material material;
    };
    std::string scene;
    std::vector<Named> materials;
    std::vector<gi::Light> lights;
    std::vector<gi::Camera> cameras;
    gi::dvec3 origin{0}, center{0};
    double radius_m = 1;
    std::uint32_t triangles = 0;
    bool moves = false, has_environment = false;
    float environment_rotation_rad = 0, environment_scale = 1;
};

inline SceneFacts facts_of(RenderSession const& s)
{
    SceneFacts f;
    if (!s.has_scene()) return f;
    gi::World const& w = s.world();
    f.scene = s.scene_name();
    for (std::size_t i = 0; i < w.scene->materials.size(); ++i)
        f.materials.push_back({w.scene->material_names[i], w.materials[i]});
    f.lights = w.lights;
    f.cameras = w.cameras;
    f.origin = w.origin;
    if (!w.bounds.empty()) {
        f.center = w.origin + gi::dvec3(w.bounds.center());
        f.radius_m = double(w.bounds.radius());
    }
    f.triangles = std::uint32_t(w.triangles.size());
    f.moves = s.moves();
    f.has_environment = w.environment != nullptr;
    f.environment_rotation_rad = w.environment_rotation_rad;
    f.environment_scale = w.environment_scale.x;
    return f;
}

} // namespace viewer
