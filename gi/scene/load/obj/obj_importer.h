#pragma once
// Reads OBJ in the place of Assimp's own importer, which clears a buffer of 16 MiB twice for each file, drops
// vertices such as ".5 .5 .5", and gives faces before the first `usemtl` the material of later ones. tinyobjloader
// loses data without a word: docs/decisions/obj-reader.md.

#include "gi/scene/load/assimp_import.h"

#include <assimp/BaseImporter.h>

namespace Assimp {
class Importer;
}

namespace gi {

class ObjImporter : public Assimp::BaseImporter {
public:
    /// From now on OBJ files are read by this class.
    /// @param notes  outlives the importer
    static void replace_in(Assimp::Importer& importer, ImportedFiles& notes);

    explicit ObjImporter(ImportedFiles& notes) : notes_(notes) {}
    bool CanRead(std::string const& file, Assimp::IOSystem* files, bool) const override;
    aiImporterDesc const* GetInfo() const override;

protected:
    void InternReadFile(std::string const& file, aiScene* scene, Assimp::IOSystem* files) override;

private:
    ImportedFiles& notes_;
};

} // namespace gi
