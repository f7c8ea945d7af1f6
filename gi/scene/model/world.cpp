#include "gi/scene/model/world.h"

#include "gi/scene/model/world_parts.h"

namespace gi {

World build_world(std::shared_ptr<Scene const> scene, SceneTime time_s, Report& report,
                  std::optional<dvec3> origin)
{
    return build_world_parts(std::move(scene), time_s, report, origin).world;
}

WorldView view(World const& world)
{
    WorldView v;
    v.positions = world.positions;
    v.normals = world.normals;
    v.tangents = world.tangents;
    v.uv0 = world.uv0;
    v.uv1 = world.uv1;
    v.colors = world.colors;
    v.alphas = world.alphas;
    v.triangles = world.triangles;
    v.triangle_material = world.triangle_material;
    v.surfaces = world.surfaces;
    v.bsdfs = world.bsdfs;
    v.materials = world.materials;
    v.textures = view(world.scene->textures);
    v.lights = world.lights;
    v.emitters = world.emitters;
    v.emitter_pdf = world.emitter_pdf;
    v.light_select = view(world.light_select);
    v.environment_select = view(world.environment_select);
    if (auto const& map = world.environment) {
        v.environment_radiance = map->radiance;
        v.environment_width = map->width;
        v.environment_height = map->height;
        v.environment_scale = world.environment_scale;
        v.environment_cos = std::cos(world.environment_rotation_rad);
        v.environment_sin = std::sin(world.environment_rotation_rad);
    }
    v.background = world.scene->background;
    v.environment_pdf = world.environment_pdf;
    if (world.environment_select.total > 0) {
        double const half_row = 0.5 * double(kPi) / v.environment_height; // solid angle of a texel over its area
        v.environment_pdf_per_luminance = float(std::sin(half_row) / half_row / world.environment_select.total);
    }
    v.scene_radius = world.bounds.radius();
    return v;
}

} // namespace gi
