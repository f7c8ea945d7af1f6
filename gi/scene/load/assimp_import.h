#pragma once
#include <filesystem>
#include <functional>
#include <string>
#include <vector>

struct aiScene;

namespace gi {

/// What becomes of the faces and vertices of a file.
enum class AssimpFaces : unsigned char {
    merged,    ///< triangles, equal vertices joined: for a model that stands alone
    triangles, ///< triangles, vertices one by one as the file has them: its frames may differ in which are equal
    polygons,  ///< as `triangles` but uncut: where a polygon is cut depends on its shape
};

/// Import a file and show it to `use`. Returns the files that were opened: this one and those it names, such as
/// material libraries. Throws InputError where it cannot be read within limits of time and memory.
std::vector<std::string> import_assimp(std::filesystem::path const& file, AssimpFaces faces,
                                       std::function<void(aiScene const&)> const& use);

} // namespace gi
