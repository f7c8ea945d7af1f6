#pragma once
// Reads PLY in the place of Assimp's own importer, which loses data without a word: all but the first strip of a list
// of strips, texture coordinates of faces, texture files; it refuses faces before vertices and lists of vertices
// (docs/decisions/ply-reader.md).

#include "gi/scene/load/assimp_import.h"

#include <assimp/BaseImporter.h>

namespace Assimp {
class Importer;
}

namespace gi {

class PlyImporter : public Assimp::BaseImporter {
public:
    /// From now on PLY files are read by this class. @param notes  outlives the importer
    static void replace_in(Assimp::Importer& importer, ImportedFiles& notes);

    explicit PlyImporter(ImportedFiles& notes) : notes_(notes) {}
    bool CanRead(std::string const& file, Assimp::IOSystem* files, bool) const override;
    aiImporterDesc const* GetInfo() const override;

protected:
    void InternReadFile(std::string const& file, aiScene* scene, Assimp::IOSystem* files) override;

private:
    ImportedFiles& notes_;
};

} // namespace gi
