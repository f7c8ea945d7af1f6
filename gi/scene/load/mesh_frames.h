#pragma once
// Frames of a mesh sequence as read from files, before they are converted to a scene.

#include "gi/scene/model/scene.h"

#include <filesystem>
#include <string>
#include <vector>

namespace gi {

/// One mesh of one frame.
struct MeshFrame {
    std::vector<vec3> positions; ///< m, finite
    std::vector<vec3> normals;   ///< unit or 0; empty = the file has none
};

/// Contents of one file: its meshes and their polygons.
struct SequenceFrame {
    std::vector<MeshFrame> meshes;
    std::vector<std::vector<std::uint32_t>> polygons; ///< per mesh: size and corners of each face
    std::vector<std::string> files;                   ///< opened for this frame
};

/// Throws InputError if the file cannot be read or has non-finite vertices.
SequenceFrame read_sequence_frame(std::filesystem::path const& file);

/// Throws InputError, naming the file, if its number of meshes or vertices or
/// its faces differ from the first file.
void check_topology(SequenceFrame const& first, std::filesystem::path const& first_file,
                    SequenceFrame const& frame, std::filesystem::path const& file);

/// A vertex attribute as raw bytes, for comparing vertices.
struct VertexBytes {
    unsigned char const* data;
    std::size_t size; ///< per vertex
};

/// Returns for every vertex the first vertex that is equal in all attributes.
std::vector<std::uint32_t> first_equal_vertices(std::size_t count, std::vector<VertexBytes> const& attributes);

/// Joins vertices of a mesh without morph targets whose attributes are equal, byte by byte.
void join_equal_vertices(Mesh& mesh);

} // namespace gi
