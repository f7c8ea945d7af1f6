#pragma once
// Assimp's importer as this program uses it. It may crash or never return on damaged files: see assimp_trial.h.

#include "gi/scene/load/assimp_import.h"

#include <assimp/Importer.hpp>

namespace gi {

/// True if AssimpReader lets Assimp join equal vertices (AssimpFaces::merged). It does so for all meshes or none, and
/// version 5.2 joins vertices of different colours, or second texture coordinates (JoinVerticesProcess compares neither).
bool can_be_joined(aiScene const& scene);

class AssimpReader {
public:
    AssimpReader();
    /// Imports a file; the scene of an earlier one is gone. @returns why it cannot be imported; empty = it can
    std::string read(std::filesystem::path const& file, AssimpFaces faces);
    aiScene const& scene() const { return *importer_.GetScene(); }
    /// Files that the last import opened, and what it lost.
    ImportedFiles const& files() const { return files_; }

private:
    ImportedFiles files_; // before the importer, which owns a user of it
    Assimp::Importer importer_;
};

} // namespace gi
