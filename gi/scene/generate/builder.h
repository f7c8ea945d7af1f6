#pragma once
// Builds a scene from shapes: one mesh per material, in world coordinates, with one node each.

#include "gi/scene/model/scene.h"

#include <functional>

namespace gi {

/// Vertex of a grid with two triangles per cell; cells face (d/du) x (d/dv).
struct GridVertex {
    vec3 position, normal;
    vec2 uv;
};

/// Returns a Lambertian material without a specular lobe.
Material matt(vec3 albedo);

class SceneBuilder {
public:
    int add_material(std::string const& name, Material const& material);
    /// Adds nu x nv cells over [0, 1]^2. @param point called with u, v
    void grid(int material, int nu, int nv, std::function<GridVertex(float u, float v)> const& point);
    /// Adds a quad that faces cross(u, v); texture coordinates are metres * uv_per_m.
    void quad(int material, vec3 corner, vec3 u, vec3 v, float uv_per_m = 1, int nu = 1, int nv = 1);
    /// Adds an axis-aligned box whose front faces point outwards.
    void box(int material, vec3 low, vec3 high, float uv_per_m = 1);
    /// Adds a surface of revolution: a profile of (radius, height) from bottom to top,
    /// about the vertical axis through `foot`.
    void lathe(int material, vec3 foot, std::vector<vec2> const& profile, int segments);
    void sphere(int material, vec3 center, float radius, int segments);
    void add_camera(std::string const& name, dvec3 from, dvec3 at, double yfov_deg);
    /// Adds a light that shines along `direction` (must not be zero).
    void add_light(std::string const& name, Light light, dvec3 position, dvec3 direction);

    Scene& scene() { return scene_; }
    /// Converts all shapes to nodes; call once, at the end.
    Scene finish(std::string const& name);

private:
    Mesh& mesh_of(int material);
    Scene scene_;
    std::vector<Mesh> meshes_; ///< one per material
};

} // namespace gi
