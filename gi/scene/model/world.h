#pragma once
// The world at one moment in time: every instance, skin and morph target evaluated to world-space triangles, with
// the tables for light sampling. Plain arrays in one index space; WorldView borrows them for kernels.
//
// Coordinates are float metres relative to `origin`. The origin is the centre of the scene's bounds if these are
// so far from zero that floats would be imprecise there, else 0. Transforms are multiplied in double and the
// origin is subtracted before rounding to float (see deform_kernels.h for the error).
//
// Instances that can move (motion.h) come last in the arrays of vertices and triangles; otherwise nodes and their
// meshes keep their order. MovingWorld (moving_world.h) advances a World in time and writes only behind
// static_triangles and static_vertices.

#include "gi/core/alias_table.h"
#include "gi/core/report.h"
#include "gi/scene/model/scene.h"
#include "gi/scene/shading/bsdf.h"

#include <memory>

namespace gi {

struct Bounds {
    vec3 low{kInf}, high{-kInf};
    GI_FN bool empty() const { return !(low.x <= high.x); }
    GI_FN vec3 center() const { return 0.5f * (low + high); }
    GI_FN float radius() const { return empty() ? 0.0f : 0.5f * glm::length(high - low); }
};

inline Bounds joined(Bounds const& a, Bounds const& b)
{
    return {glm::min(a.low, b.low), glm::max(a.high, b.high)};
}

/// Data of one triangle for shading, packed into one cache line. Derived from the arrays of World.
struct alignas(64) Surface {
    static constexpr std::uint32_t kSmooth = 1; ///< vertex normals differ from the triangle's normal
    static constexpr std::uint32_t kVaries = 2; ///< textures or vertex colours change the material across it
    static constexpr std::uint32_t kEmits = 4;
    static constexpr std::uint32_t kDoubleSided = 8;
    static constexpr std::uint32_t kBlended =
        16; ///< blended: whether it is in a texel or stops a ray is drawn by lot

    vec3 corner, edge1, edge2; ///< vertex 0 and the vectors from it to vertices 1 and 2, m
    float normal_scale;        ///< 1 / |edge1 x edge2|; 0 if too large or too small for a float
    float clearance;           ///< m; exceeds the rounding error of positions interpolated on the triangle
    std::uint32_t material, flags;
    uvec3 vertex;

    GI_FN bool is(std::uint32_t flag) const { return (flags & flag) != 0; }
};

struct World {
    std::shared_ptr<Scene const> scene; ///< owns the textures; its lights, materials etc. may be outdated
    dvec3 origin{0};
    Bounds bounds;

    // Vertices: an array is empty if no mesh of the scene has that attribute.
    std::vector<vec3> positions;
    std::vector<vec3> normals;  ///< zero vector = this vertex is flat shaded
    std::vector<vec4> tangents; ///< zero = none
    std::vector<vec2> uv0, uv1;
    std::vector<vec3> colors;  ///< 1 where a mesh has none
    std::vector<float> alphas; ///< the same
    // Triangles
    std::vector<uvec3> triangles;
    std::vector<std::uint32_t> triangle_material; ///< index into materials
    struct Placed {
        std::uint32_t node, first_triangle;
    };
    std::vector<Placed> placed; ///< per instance: scene node and first triangle; ends at the next one's
    std::uint32_t instances = 0, static_instances = 0;
    std::uint32_t static_triangles = 0, static_vertices = 0; ///< number that never change; they come first
    std::vector<Surface> surfaces;                           ///< per triangle

    std::vector<Material> materials; ///< the scene's, and the default material last
    std::vector<Bsdf> bsdfs;         ///< per material, without its textures
    std::vector<Light> lights;       ///< in this frame
    std::vector<Camera> cameras;     ///< world_from_camera without origin removed (absolute, double)
    /// Null = none; its rotation and scale are replaced by the next two.
    std::shared_ptr<EnvironmentMap const> environment;
    float environment_rotation_rad = 0; ///< as EnvironmentMap::rotation_rad
    vec3 environment_scale{1};

    // Light selection, see light_sampling.h
    std::vector<std::uint32_t> emitters; ///< triangles that emit
    /// Per triangle of the world: probability that select picks it; empty = no emitters.
    std::vector<float> emitter_pdf;
    AliasTable light_select;       ///< over lights, then emitters, then (last, if any) the environment
    AliasTable environment_select; ///< over texels of the environment map
    float environment_pdf = 0;     ///< probability that select picks the environment
};

/// Time at which a scene is evaluated; without one, nodes are in the rest pose of the file.
using SceneTime = std::optional<double>;

/// Evaluates the scene. Triangles with a non-finite vertex or without area are skipped and counted; in instances
/// that can move they are kept as triangles without area, so that indices stay valid at all times.
/// @param origin  of the World, m; without one it is chosen as described at the top of this file
/// Throws InputError if a count overflows 32 bits.
World build_world(std::shared_ptr<Scene const> scene, SceneTime time_s, Report& report,
                  std::optional<dvec3> origin = std::nullopt);

/// Borrowed arrays of a World for kernels.
struct WorldView {
    View<vec3 const> positions, normals;
    View<vec4 const> tangents;
    View<vec2 const> uv0, uv1;
    View<vec3 const> colors;
    View<float const> alphas;
    View<uvec3 const> triangles;
    View<std::uint32_t const> triangle_material;
    View<Surface const> surfaces;
    View<Material const> materials;
    View<Bsdf const> bsdfs;
    TexturePoolView textures;
    View<Light const> lights;
    View<std::uint32_t const> emitters;
    View<float const> emitter_pdf;
    AliasTableView light_select, environment_select;
    View<vec3 const> environment_radiance; ///< empty = no environment
    std::uint32_t environment_width = 0, environment_height = 0;
    vec3 environment_scale{1};
    float environment_pdf_per_luminance = 0; ///< for a direction at the centre of its texel, see light_sampling.h
    float environment_cos = 1, environment_sin = 0; ///< of the map's rotation about +Y
    float environment_pdf = 0;
    Background background;
    float scene_radius = 0; ///< m
};

WorldView view(World const& world);

} // namespace gi
