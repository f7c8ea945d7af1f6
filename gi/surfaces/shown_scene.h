#pragma once
// What is needed to draw the surfaces of a world by another thread than the one that moves it: shared arrays of what
// never moves, copies of what does.

#include "gi/scene/motion/moving_world.h"

namespace gi {

struct ShownScene {
    /// Only these parts may be read while the world moves: its scene, origin, and the arrays of vertices and triangles
    /// (not Surfaces) below static_vertices and static_triangles; and triangle_material, placed, uv0, uv1, colors and alphas of all.
    std::shared_ptr<World const> world;
    struct Moved {
        std::vector<vec3> positions, normals;
        std::vector<vec4> tangents; ///< normals, tangents: empty if the world has none
    };
    std::shared_ptr<Moved const> moved; ///< of vertices that can move
    struct Moving {
        std::size_t node, first_vertex;
        Mesh const* mesh;
        vec3 center;
    };
    struct MovingParts {
        std::vector<Moving> instances;
        std::vector<uvec3> triangles; ///< of the world, with their winding when the world was new
    };
    std::shared_ptr<MovingParts const> moving; ///< the same as long as the world is
    std::shared_ptr<std::vector<Material> const> materials;
    std::shared_ptr<EnvironmentMap const> environment; ///< null = none
    float environment_cos = 1, environment_sin = 0;    ///< of its rotation about +Y
    vec3 environment_scale{1};
    std::vector<Light> lights; ///< punctual ones; empty: there are more than SeenSurfaces::kMostLights
    std::vector<vec3> authored_intensities; ///< that the scene gives the lights, whatever was set
    Background background;
    float radius_m = 0; ///< of the scene's bounds
};

/// The next state of a scene that is shown. @param last  the one before `changes`; null = all is new
std::shared_ptr<ShownScene const> shown_scene(std::shared_ptr<MovingWorld const> const& world,
                                              Changes const& changes, ShownScene const* last);
/// Its moving vertices at another pose.
std::shared_ptr<ShownScene::Moved const> moved_to(ShownScene const& scene, Pose const& pose);

} // namespace gi
