#pragma once
// Materials of an OBJ file and its libraries (MTL, Wavefront), as far as convert_materials() uses them: colours
// Kd, Ks, Ke, Tf; numbers Ns, Ni, d, Tr, Pr, Pm, illum; maps, whose options are skipped.

#include <map>
#include <memory>
#include <string>
#include <string_view>
#include <vector>

struct aiMaterial;

namespace gi {

class ObjMaterials {
public:
    ObjMaterials(); ///< with one of Assimp's default name, for faces that name none
    ~ObjMaterials();
    ObjMaterials(ObjMaterials const&) = delete;
    ObjMaterials& operator=(ObjMaterials const&) = delete;

    /// The material of that name; a new one if there is none.
    unsigned index_of(std::string const& name);
    /// Reads a library. Values that are no numbers are skipped.
    void read(std::string_view mtl);
    std::vector<std::unique_ptr<aiMaterial>> take() { return std::move(all_); }

private:
    std::vector<std::unique_ptr<aiMaterial>> all_;
    std::map<std::string, unsigned, std::less<>> by_name_;
};

} // namespace gi
