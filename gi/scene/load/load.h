#pragma once
// One door to every scene format. The extension chooses the reader: .gltf/.glb tinygltf, .yaml/.yml scene files,
// everything else Assimp; a folder of OBJ or PLY files (or its sequence.json) is a mesh sequence. A name without a
// file ("atrium", "cornell", "mirror", "avatar") is a scene that the project generates.

#include "gi/core/report.h"
#include "gi/scene/model/camera_path.h"
#include "gi/scene/model/scene.h"

#include <filesystem>
#include <string>

namespace gi {

/// Throws InputError for anything that cannot be a scene. What is repaired or ignored is counted in the report.
Scene load_scene(std::string const& file_or_name, Report& report);

Scene load_gltf(std::filesystem::path const& file, Report& report);
/// glTF JSON or GLB from memory; external files are looked up in `folder`, empty = none allowed.
Scene parse_gltf(unsigned char const* bytes, std::size_t size, std::filesystem::path const& folder,
                 std::string const& name, Report& report);
Scene load_assimp(std::filesystem::path const& file, Report& report);
/// OBJ or PLY files of equal topology, one per frame, in the order of their names; sequence_timing.h says when
/// each is seen. Between frames positions and normals are interpolated linearly; normals that files do not have
/// are made.
Scene load_mesh_sequence(std::filesystem::path const& folder, Report& report);
Scene load_scene_file(std::filesystem::path const& yaml, Report& report);
/// `name` is used in messages, relative paths are looked up in `folder`.
Scene parse_scene_file(std::string const& text, std::filesystem::path const& folder, std::string const& name,
                       Report& report);
/// Keys of a moving camera; messages name the place in the text.
CameraPath load_camera_path(std::filesystem::path const& yaml);
CameraPath parse_camera_path(std::string const& text, std::string const& name);
/// Append an image to the pool, de-duplicated by the caller. Throws InputError if it cannot be decoded.
std::int32_t add_texture(TexturePool& pool, unsigned char const* bytes, std::size_t size, bool srgb,
                         std::string const& name);
/// A lat-long map from HDR or EXR; pixels that are not finite or negative are set to 0 and counted.
EnvironmentMap load_environment(std::filesystem::path const& file, Report& report);

} // namespace gi
