#pragma once
// Which files a `mtllib` of an OBJ file means: `mtllib one.mtl two.mtl`, or one whose name has blanks. A name is
// searched beside the OBJ file as it is written, then without its folders; in place of a missing one, a file with the
// OBJ file's own name is taken, as many programs rename one without the other. Whatever is not as written is noted.

#include "gi/scene/load/assimp_import.h"

#include <set>
#include <string>
#include <string_view>
#include <vector>

namespace Assimp {
class IOSystem;
}

namespace gi {

class ObjMaterials;

class ObjLibraries {
public:
    ObjLibraries(std::filesystem::path obj, Assimp::IOSystem& files, ObjMaterials& materials, ImportedFiles& notes)
        : obj_(std::move(obj)), files_(files), materials_(materials), notes_(notes)
    {
    }

    /// @param names  what follows `mtllib`
    void read(std::string_view names);

private:
    bool exists(std::filesystem::path const& file) const;
    void read_one(std::string const& name);

    std::filesystem::path obj_;
    Assimp::IOSystem& files_;
    ObjMaterials& materials_;
    ImportedFiles& notes_;
    std::set<std::string> asked_, read_; ///< names, files
};

/// Names separated by blanks; a name without the ending .mtl goes on behind the blank if a later one has it. Names may be
/// in quotes.
std::vector<std::string> library_names(std::string_view names);

} // namespace gi
