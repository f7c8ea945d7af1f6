#pragma once
// A scene as authored: a node graph with meshes, materials, skins, clips, cameras and lights.
// world.h evaluates it to triangles and lights at one moment in time for the renderers.

#include "gi/core/math.h"
#include "gi/scene/model/camera.h"
#include "gi/scene/model/light.h"
#include "gi/scene/model/material.h"

#include <array>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace gi {

/// Displacements of one morph target; each array is empty or as long as the mesh's positions.
struct MorphTarget {
    std::vector<vec3> positions, normals, tangents;
};

/// A triangle mesh of one material. Attribute arrays are empty or as long as `positions`.
struct Mesh {
    std::string name;
    std::int32_t material = -1; ///< -1 = the default material
    std::vector<vec3> positions;
    std::vector<vec3> normals;  ///< unit; empty = flat shaded
    std::vector<vec4> tangents; ///< xyz unit, w = +-1 handedness
    std::vector<vec2> uv0, uv1;
    std::vector<vec3> colors;     ///< linear, multiply base_color
    std::vector<float> alphas;    ///< 0..1, multiply alpha, for materials that are masks or blend; empty = all 1
    std::vector<uvec3> triangles; ///< indices < positions.size(), counter-clockwise seen from the front
    std::vector<std::array<std::uint16_t, 4>> joints; ///< indices into Skin::joints
    std::vector<vec4> weights;                        ///< sum 1
    std::vector<MorphTarget> morph_targets;
};

struct Node {
    std::string name;
    std::int32_t parent = -1; ///< always smaller than the node's own index, -1 = root
    dvec3 translation{0};
    dquat rotation{1, 0, 0, 0}; ///< unit; glm order w, x, y, z
    dvec3 scale{1};
    std::optional<dmat4> matrix;                     ///< replaces the three above
    std::vector<std::int32_t> meshes;                ///< several nodes may share a mesh (instances)
    std::int32_t skin = -1, camera = -1, light = -1; ///< indices into Scene
    std::vector<float> morph_weights;
    bool driven = false; ///< may be moved by something other than clips (a tracker, an editor)
};

/// Blending of joints (deform_kernels.h): linear skinning is what scene files assume; dual quaternion skinning
/// preserves the volume of twisted limbs.
enum class SkinningMethod : std::uint8_t { linear, dual_quaternion };

struct Skin {
    std::vector<std::int32_t> joints; ///< node indices
    std::vector<mat4> inverse_bind;   ///< same length
    SkinningMethod method = SkinningMethod::linear;
};

/// `morph_frame` has one number f per key: f = 0 is the mesh itself and f >= 1 is morph target f - 1 alone;
/// fractional values interpolate between the two neighbours, and one beyond the last target is the mesh again. It
/// stores one number per frame where morph_weights would store one per pair of frames.
enum class ChannelPath : std::uint8_t { translation, rotation, scale, morph_weights, morph_frame };
enum class Interpolation : std::uint8_t { step, linear, cubic_spline };

/// Key k of a channel with n components has value values[k*n ..]; cubic spline stores in-tangent, value,
/// out-tangent for each key (glTF). Rotations are x, y, z, w as in glTF.
struct AnimationChannel {
    std::int32_t node = -1;
    ChannelPath path = ChannelPath::translation;
    Interpolation interpolation = Interpolation::linear;
    std::vector<float> times_s; ///< strictly increasing
    std::vector<float> values;
};

struct Animation {
    std::string name;
    std::vector<AnimationChannel> channels;
    double duration_s = 0; ///< period of a looping clip
    double closing_s = 0;  ///< length of the last part, from the last key back to the first; only loops play it
};

/// A playing clip: local time = offset + speed * t, wrapped into the clip if it loops, else clamped to its ends.
/// If several clips move the same part of a node, the result is their weighted mean: weights are normalised over
/// the clips that move the part, whatever their sum, and the rest pose is not mixed in. A clip of weight 0 (or
/// less) does not play.
struct Playback {
    std::int32_t animation = -1;
    double offset_s = 0, speed = 1;
    bool loop = true;
    double weight = 1;
};

/// A lat-long map: +Y up, u = 0.5 + atan2(x, -z) / 2 pi, v = acos(y) / pi, v = 0 in the top row.
struct EnvironmentMap {
    std::uint32_t width = 0, height = 0;
    std::vector<vec3> radiance; ///< linear, row-major from the top; finite, >= 0
    float rotation_rad = 0;     ///< turns the map about +Y, counter-clockwise seen from above
    vec3 scale{1};
};

/// Background that the camera sees where its ray hits no surface. Lighting, mirrors and glass use only the map.
enum class BackgroundKind : std::uint8_t { map, color, transparent };
struct Background {
    BackgroundKind kind = BackgroundKind::map;
    vec3 color{0}; ///< radiance, for kind `color`
};

struct Scene {
    std::string name;
    std::vector<Node> nodes;
    std::vector<Mesh> meshes;
    std::vector<Material> materials;
    std::vector<std::string> material_names; ///< same length as materials
    TexturePool textures;
    std::vector<Skin> skins;
    std::vector<Animation> animations;
    std::vector<Playback> playbacks; ///< clips that play when a time is given; loaders choose the first clip
    std::vector<Camera> cameras;     ///< world_from_camera is taken from the node that holds it
    std::vector<Light> lights;       ///< position/direction are taken from the node that holds it
    std::optional<EnvironmentMap> environment;
    Background background;          ///< not changed by append()
    std::vector<std::string> files; ///< all files read: the scene's own and those it refers to
};

/// Appends everything in `part` below a new root node with the given name and transform.
void append(Scene& scene, Scene part, std::string const& name, dmat4 const& transform);

} // namespace gi
