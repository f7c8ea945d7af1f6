#pragma once
// Imports model files by the Assimp library, with limits of time and memory.

#include "gi/core/math.h"
#include "gi/core/report.h"

#include <filesystem>
#include <functional>
#include <map>
#include <set>
#include <string>
#include <vector>

struct aiScene;

namespace gi {

/// Processing of the faces and vertices of a file.
enum class AssimpFaces : unsigned char {
    merged,    ///< triangles, equal vertices joined unless the file has colours or second texture coordinates
    triangles, ///< triangles, vertices not joined: which of them are equal may differ between frames
    polygons,  ///< as `triangles` but not triangulated: the triangulation of a polygon depends on its shape
};

/// Files opened during an import (the file itself and those it refers to, such as material libraries), and what our
/// own readers could not take from them.
struct ImportedFiles {
    std::set<std::string> opened;
    dvec3 origin_m{0};                          ///< in the file, of what was read: far from 0 floats are coarse
    std::map<std::string, Report::Loss> losses; ///< by what was lost

    /// As Report::lose.
    void lose(std::string const& what, std::uint64_t count, std::string const& where);
    void pass_on_losses(Report& report) const;
};

/// What positions of a file are counted from: 0, or whole metres near the first one if floats would round that by more
/// than 1 mm (beyond 2^14 m, as maps and surveys have it).
dvec3 near_origin(dvec3 first_m);

/// Imports a file and passes it to `use`. Throws InputError if it cannot be read within limits of time and memory.
ImportedFiles import_assimp(std::filesystem::path const& file, AssimpFaces faces,
                            std::function<void(aiScene const&)> const& use);

/// Endings of the files that Assimp reads, lower case with the dot.
std::vector<std::string> assimp_extensions();

} // namespace gi
