#pragma once
// Imports model files by the Assimp library, with limits of time and memory.

#include "gi/core/report.h"

#include <filesystem>
#include <functional>
#include <set>
#include <string>
#include <vector>

struct aiScene;

namespace gi {

/// Processing of the faces and vertices of a file.
enum class AssimpFaces : unsigned char {
    merged,    ///< triangles, equal vertices joined: for single models
    triangles, ///< triangles, vertices not joined: which of them are equal may differ between frames
    polygons,  ///< as `triangles` but not triangulated: the triangulation of a polygon depends on its shape
};

/// Files opened or missing during an import: the file itself and those it refers to, such as material libraries.
struct ImportedFiles {
    std::set<std::string> opened, missing;
};

/// Imports a file and passes it to `use`. Throws InputError if it cannot be read within limits of time and memory.
ImportedFiles import_assimp(std::filesystem::path const& file, AssimpFaces faces,
                            std::function<void(aiScene const&)> const& use);

/// Endings of the files that Assimp reads, lower case with the dot.
std::vector<std::string> assimp_extensions();

/// Counts the missing material libraries of an OBJ file.
void lose_material_libraries(std::filesystem::path const& file, ImportedFiles const& files, Report& report);

} // namespace gi
