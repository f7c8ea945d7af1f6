#pragma once
// Warp meshes in files of other programs: P. Bourke's (.data: a type, columns and rows, then x, y, u, v, intensity
// per node, rows from below; x from -aspect to aspect, y from -1 to 1), Wavefront .obj of a grid (x, y like
// that, one vt per v), and those of domeprojection (.csv: x; y; u; v; column; row, from the upper left, 0 to 1; after
// SGCT's reader).

#include "viewer/displays/warp_mesh.h"

#include <filesystem>

namespace viewer {

/// True if its extension is that of a mesh that is read.
bool is_mesh_file(std::filesystem::path const& file);
/// @param aspect  width / height of the viewport
/// Throws InputError, with the line, on other formats, on an .obj or .csv that is not a grid,
/// and on meshes that cannot be drawn.
WallMesh load_mesh_file(std::filesystem::path const& file, double aspect);
/// @param name  its extension is the format
WallMesh parse_mesh_file(std::string const& text, std::string const& name, double aspect);

} // namespace viewer
