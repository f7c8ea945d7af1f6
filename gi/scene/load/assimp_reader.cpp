#include "gi/scene/load/assimp_reader.h"

#include "gi/scene/load/obj/obj_importer.h"
#include "gi/scene/load/ply/ply_importer.h"

#include <algorithm>
#include <assimp/DefaultIOSystem.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

namespace gi {
namespace {

namespace fs = std::filesystem;

/// Opens regular files only (a pipe would be waited for), and notes what is opened.
class NotingFiles : public Assimp::DefaultIOSystem {
public:
    explicit NotingFiles(ImportedFiles& files) : files_(files) {}

    bool Exists(char const* file) const override
    {
        std::error_code error;
        return fs::is_regular_file(file, error);
    }
    Assimp::IOStream* Open(char const* file, char const* mode) override
    {
        Assimp::IOStream* stream = Exists(file) ? DefaultIOSystem::Open(file, mode) : nullptr;
        if (stream != nullptr) files_.opened.insert(file);
        return stream;
    }

private:
    ImportedFiles& files_;
};

unsigned steps(AssimpFaces faces)
{
    if (faces == AssimpFaces::polygons) return 0;
    return aiProcess_Triangulate | aiProcess_SortByPType;
}

} // namespace

bool can_be_joined(aiScene const& scene)
{
    return std::none_of(scene.mMeshes, scene.mMeshes + scene.mNumMeshes,
                        [](aiMesh const* mesh) { return mesh->HasVertexColors(0) || mesh->HasTextureCoords(1); });
}

AssimpReader::AssimpReader()
{
    ObjImporter::replace_in(importer_, files_);
    PlyImporter::replace_in(importer_, files_);
    importer_.SetIOHandler(new NotingFiles(files_)); // the importer takes ownership
    importer_.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    importer_.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    importer_.SetPropertyInteger(AI_CONFIG_PP_LBW_MAX_WEIGHTS, 4);
}

std::string AssimpReader::read(fs::path const& file, AssimpFaces faces)
{
    files_ = {};
    try {
        aiScene const* scene = importer_.ReadFile(file.string(), steps(faces));
        if (scene != nullptr && faces == AssimpFaces::merged && can_be_joined(*scene))
            scene = importer_.ApplyPostProcessing(aiProcess_JoinIdenticalVertices);
        if (scene != nullptr) return {};
        std::string const reason = importer_.GetErrorString();
        return reason.empty() ? "Assimp reports no reason" : reason;
    } catch (std::exception const& e) {
        return e.what();
    }
}

} // namespace gi
