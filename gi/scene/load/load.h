#pragma once
// Loads scenes of all formats. The extension selects the reader: .gltf/.glb tinygltf, .yaml/.yml scene files,
// everything else Assimp; a folder of OBJ or PLY files (or its sequence.json) is a mesh sequence. A name without a
// file ("atrium", "cornell", "mirror", "ring", "avatar") selects a generated scene.

#include "gi/core/report.h"
#include "gi/scene/model/camera_path.h"
#include "gi/scene/model/scene.h"

#include <filesystem>
#include <string>

namespace gi {

/// Loads or generates a scene. Throws InputError for invalid input;
/// repairs and omissions are counted in the report.
Scene load_scene(std::string const& file_or_name, Report& report);

/// Names of the generated scenes that load_scene knows.
std::vector<std::string> built_in_scenes();
/// Endings of files that load_scene reads, lower case with the dot: ".glb", ".yaml", ".obj", ...
std::vector<std::string> scene_extensions();

/// True if load_scene would pass an existing file to Assimp.
bool is_read_by_assimp(std::filesystem::path const& file);

Scene load_gltf(std::filesystem::path const& file, Report& report);
/// Parses glTF JSON or GLB from memory; external files are searched in `folder`, empty = none allowed.
Scene parse_gltf(unsigned char const* bytes, std::size_t size, std::filesystem::path const& folder,
                 std::string const& name, Report& report);
Scene load_assimp(std::filesystem::path const& file, Report& report);
/// Loads OBJ or PLY files of equal topology, one per frame, in the order of their names; see sequence_timing.h for
/// their times. Positions and normals are interpolated linearly between frames; missing normals are computed.
Scene load_mesh_sequence(std::filesystem::path const& folder, Report& report);
Scene load_scene_file(std::filesystem::path const& yaml, Report& report);
/// `name` is used in messages; relative paths are searched in `folder`.
Scene parse_scene_file(std::string const& text, std::filesystem::path const& folder, std::string const& name,
                       Report& report);
/// Loads the keys of a camera path; messages give the line and column in the text.
CameraPath load_camera_path(std::filesystem::path const& yaml);
CameraPath parse_camera_path(std::string const& text, std::string const& name);
/// Decodes an image and appends it to the pool; the caller avoids duplicates.
/// Throws InputError if it cannot be decoded.
std::int32_t add_texture(TexturePool& pool, unsigned char const* bytes, std::size_t size, bool srgb,
                         std::string const& name);
/// Loads a lat-long map from HDR or EXR; negative and non-finite pixels are set to 0 and counted.
EnvironmentMap load_environment(std::filesystem::path const& file, Report& report);

} // namespace gi
