#pragma once
// The frames of a mesh sequence as they are read, before they become a scene.

#include "gi/core/math.h"

#include <filesystem>
#include <string>
#include <vector>

namespace gi {

/// One mesh of one frame.
struct MeshFrame {
    std::vector<vec3> positions; ///< m, finite
    std::vector<vec3> normals;   ///< unit or 0; empty = the file has none
};

/// One file: its meshes, and how its polygons hang together.
struct SequenceFrame {
    std::vector<MeshFrame> meshes;
    std::vector<std::vector<std::uint32_t>> polygons; ///< per mesh: size and corners of each face
    std::vector<std::string> files;                   ///< that were opened for it
};

/// Throws InputError where the file cannot be read or has vertices that are not finite.
SequenceFrame read_sequence_frame(std::filesystem::path const& file);

/// Throws InputError, naming the file, where its meshes, vertices or faces are not those of the first.
void check_topology(SequenceFrame const& first, std::filesystem::path const& first_file,
                    SequenceFrame const& frame, std::filesystem::path const& file);

/// A vertex attribute as bytes that vertices are compared by.
struct VertexBytes {
    unsigned char const* data;
    std::size_t size; ///< per vertex
};

/// For every vertex the first one that is equal in all attributes.
std::vector<std::uint32_t> first_equal_vertices(std::size_t count, std::vector<VertexBytes> const& attributes);

} // namespace gi
