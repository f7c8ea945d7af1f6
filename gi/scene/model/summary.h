#pragma once
// What is in a scene, in numbers and as lines of text.

#include "gi/scene/model/world.h"

#include <optional>
#include <string>
#include <vector>

namespace gi {

struct MaterialKinds {
    std::size_t all = 0;
    std::size_t matt = 0, coated = 0, phong = 0, metal = 0, mirror = 0,
                glass = 0; ///< each material is one of these
    std::size_t emitting = 0;
};

/// Unshadowed irradiance from the environment, W/m2 (red, green, blue), integrated numerically.
struct EnvironmentSummary {
    std::uint32_t width = 0, height = 0; ///< texels
    dvec3 up{0}, down{0}, brightest{0};  ///< of surfaces that face up, down and to the most light
    dvec3 brightest_normal{0};
    double smooth_share = 0; ///< of the squared radiance that spherical harmonics to degree 2 hold
};

struct CameraSummary {
    std::string name;
    double aperture_radius_m = 0, focus_distance_m = 0; ///< radius 0 = a pinhole
};
struct MeshSequenceSummary {
    std::string name;
    std::size_t frames = 0;
};
struct ClipSummary {
    std::string name;
    double duration_s = 0;
};
struct PlayingClip {
    std::string name;
    double weight = 1;
};

/// Of a light without extent.
struct LightSummary {
    LightType type = LightType::point;
    dvec3 position_m{0},
        direction{0, 0, -1}; ///< of the scene; directional lights have no position, points no direction
};

struct SceneSummary {
    std::size_t nodes = 0, meshes = 0, placed_meshes = 0, triangles = 0, vertices = 0;
    std::optional<std::pair<dvec3, dvec3>> bounds_m; ///< low and high corner; nothing without geometry
    MaterialKinds materials;
    std::vector<std::string> material_names;     ///< by number; may be empty or alike
    std::vector<std::size_t> emitting_materials; ///< numbers
    std::vector<LightSummary> lights;            ///< by number
    std::size_t textures = 0, texture_bytes = 0;
    std::size_t punctual_lights = 0, emissive_triangles = 0;
    double emissive_area_m2 = 0;
    std::optional<EnvironmentSummary> environment;
    std::vector<CameraSummary> cameras;
    std::vector<std::size_t> skin_joints; ///< one number for each skin
    std::size_t morph_targets = 0;
    std::vector<MeshSequenceSummary> mesh_sequences;
    std::vector<ClipSummary> clips;
    std::vector<PlayingClip> playing;
};
SceneSummary summarise(World const& world);

struct SummaryLine {
    std::string what;  ///< "triangles", "cameras", ...
    std::string value; ///< "52140", "gallery, arches, courtyard"
};
std::vector<SummaryLine> text_lines(SceneSummary const& summary);

} // namespace gi
