#pragma once
// Small scenes for tests, written in code, and the one way to judge a rendered mean against a closed form.

#include "gi/core/report.h"
#include "gi/image_io/picture.h"
#include "gi/scene/model/world.h"

#include <string>

namespace gi::test {

Material lambert(vec3 albedo);
Material emitter(vec3 radiance, bool double_sided = false);
Material mirror(vec3 f0);
Material glass(float ior, bool thin);

/// Adds a material and returns its index.
int add_material(Scene& scene, Material const& material);
/// corner, corner + u, corner + u + v, corner + v; the front faces cross(u, v).
void add_quad(Scene& scene, vec3 corner, vec3 u, vec3 v, int material);
/// Axis-aligned box with its front faces inwards (a room) or outwards.
void add_box(Scene& scene, vec3 low, vec3 high, int material, bool inwards);
/// Icosphere with vertices on the sphere; smooth normals or flat.
void add_sphere(Scene& scene, vec3 center, float radius, int subdivisions, int material, bool smooth);
void add_light(Scene& scene, Light const& light);
void set_environment(Scene& scene, vec3 radiance);

World world_of(Scene scene);
/// Looks from `from` along -Y/-Z/... at `at`; a view of height_m.
Camera orthographic(dvec3 from, dvec3 at, double height_m);

/// Mean of a layer over channels and pixels, and the standard error of "color" from the layer "variance".
struct Estimate {
    double mean, sigma;
};
Estimate mean_of(Picture const& picture, std::string const& layer = "color");
/// The rule of the house: within 0.5 % and within 3 sigma.
void expect_estimate(Estimate const& estimate, double truth, std::string const& what);

} // namespace gi::test
