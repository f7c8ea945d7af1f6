#pragma once
// Materials of an OBJ file and its libraries (MTL, Wavefront), as far as convert_materials() uses them: colours
// Kd, Ks, Ke, Tf; numbers Ns, Ni, d, Tr, Pr, Pm, illum; maps with their options (mtl_map.h). What is skipped is
// noted.

#include "gi/scene/load/assimp_import.h"

#include <map>
#include <memory>
#include <set>
#include <string>
#include <string_view>
#include <vector>

struct aiMaterial;

namespace gi {

class ObjMaterials {
public:
    ObjMaterials(ImportedFiles& notes); ///< with one of Assimp's default name, for faces that name none
    ~ObjMaterials();
    ObjMaterials(ObjMaterials const&) = delete;
    ObjMaterials& operator=(ObjMaterials const&) = delete;

    /// The material of that name; a new one if there is none.
    unsigned index_of(std::string const& name);
    /// Reads a library. Materials of an earlier one stay as they are: libraries are searched in their order.
    /// @param file  for notes
    void read(std::string_view mtl, std::string const& file);
    /// All of them; notes those that no library has.
    std::vector<std::unique_ptr<aiMaterial>> take();

private:
    void read_line(aiMaterial& m, std::string_view word, std::string_view values, std::string const& where);

    ImportedFiles& notes_;
    std::vector<std::unique_ptr<aiMaterial>> all_;
    std::map<std::string, unsigned, std::less<>> by_name_;
    std::set<std::string> defined_; ///< in a library that has been read
};

} // namespace gi
