#pragma once
#include "gi/core/report.h"

#include <filesystem>
#include <functional>
#include <set>
#include <string>

struct aiScene;

namespace gi {

/// What becomes of the faces and vertices of a file.
enum class AssimpFaces : unsigned char {
    merged,    ///< triangles, equal vertices joined: for a model that stands alone
    triangles, ///< triangles, vertices one by one as the file has them: its frames may differ in which are equal
    polygons,  ///< as `triangles` but uncut: where a polygon is cut depends on its shape
};

/// This file and those it names, such as material libraries.
struct ImportedFiles {
    std::set<std::string> opened, missing;
};

/// Import a file and show it to `use`. Throws InputError where it cannot be read within limits of time and memory.
ImportedFiles import_assimp(std::filesystem::path const& file, AssimpFaces faces,
                            std::function<void(aiScene const&)> const& use);

/// Counts the material libraries that an OBJ file names and that are missing.
void lose_material_libraries(std::filesystem::path const& file, ImportedFiles const& files, Report& report);

} // namespace gi
