#include "gi/scene/load/ply/ply_importer.h"

#include "gi/scene/load/import_text.h"
#include "gi/scene/load/ply/ply_model.h"

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/importerdesc.h>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <filesystem>
#include <stdexcept>

namespace gi {
namespace {

/// Makes a mesh of the faces of one texture.
class PlyMeshBuilder {
public:
    /// @param faces  of that texture
    PlyMeshBuilder(PlyModel const& model, std::int32_t texture, std::vector<std::size_t> faces)
        : m_(model), texture_(texture), faces_(std::move(faces))
    {
        // Vertices that the file shares stay shared, unless corners have something of their own, or there are others.
        shared_ = m_.corner_uvs.empty() && m_.face_colors.empty() && faces_.size() == m_.faces.size();
    }

    bool has_faces() const { return !faces_.empty(); }
    bool drops_colors() const { return texture_ >= 0 && (!m_.colors.empty() || !m_.face_colors.empty()); }

    std::unique_ptr<aiMesh> build(unsigned material)
    {
        std::size_t corners = 0;
        for (std::size_t const f : faces_) corners += m_.faces[f].corners_end - first_corner(f);
        std::size_t const vertices = shared_ ? m_.positions.size() : corners;
        if (vertices > AI_MAX_VERTICES || faces_.size() > AI_MAX_FACES) throw std::runtime_error("too many faces");
        auto out = std::make_unique<aiMesh>();
        out->mMaterialIndex = material;
        out->mNumVertices = unsigned(vertices);
        out->mNumFaces = unsigned(faces_.size());
        out->mFaces = new aiFace[faces_.size()];
        out->mVertices = new aiVector3D[vertices];
        bool const has_uvs = !m_.uvs.empty() || !m_.corner_uvs.empty();
        bool const has_colors = !drops_colors() && (!m_.colors.empty() || !m_.face_colors.empty());
        if (!m_.normals.empty()) out->mNormals = new aiVector3D[vertices];
        if (has_uvs) out->mTextureCoords[0] = new aiVector3D[vertices];
        if (has_uvs) out->mNumUVComponents[0] = 2;
        if (has_colors) out->mColors[0] = new aiColor4D[vertices];
        if (shared_)
            for (std::size_t v = 0; v < vertices; ++v) add_vertex(*out, v, v, 0, 0);
        std::size_t next = 0;
        for (std::size_t i = 0; i < faces_.size(); ++i) {
            std::size_t const f = faces_[i], first = first_corner(f), size = m_.faces[f].corners_end - first;
            constexpr aiPrimitiveType kKinds[]{aiPrimitiveType_POINT, aiPrimitiveType_LINE,
                                               aiPrimitiveType_TRIANGLE, aiPrimitiveType_POLYGON};
            out->mPrimitiveTypes |= kKinds[std::min<std::size_t>(size, 4) - 1];
            aiFace& face = out->mFaces[i];
            face.mNumIndices = unsigned(size);
            face.mIndices = new unsigned[size];
            for (std::size_t k = 0; k < size; ++k, ++next) {
                face.mIndices[k] = shared_ ? m_.corners[first + k] : unsigned(next);
                if (!shared_) add_vertex(*out, next, m_.corners[first + k], first + k, f);
            }
        }
        return out;
    }

private:
    std::size_t first_corner(std::size_t face) const { return face == 0 ? 0 : m_.faces[face - 1].corners_end; }

    void add_vertex(aiMesh& out, std::size_t to, std::size_t vertex, std::size_t corner, std::size_t face) const
    {
        auto const vector = [](vec3 v) { return aiVector3D(v.x, v.y, v.z); };
        out.mVertices[to] = vector(m_.positions[vertex]);
        if (out.mNormals != nullptr) out.mNormals[to] = vector(m_.normals[vertex]);
        if (out.mTextureCoords[0] != nullptr)
            out.mTextureCoords[0][to] =
                vector(vec3(m_.corner_uvs.empty() ? m_.uvs[vertex] : m_.corner_uvs[corner], 0));
        if (out.mColors[0] == nullptr) return;
        vec4 const c = m_.colors.empty() ? m_.face_colors[face] : m_.colors[vertex];
        out.mColors[0][to] = aiColor4D(c.x, c.y, c.z, c.w);
    }

    PlyModel const& m_;
    std::int32_t texture_;
    std::vector<std::size_t> faces_;
    bool shared_ = true;
};

std::unique_ptr<aiMaterial> textured(std::string const& file)
{
    auto m = std::make_unique<aiMaterial>();
    aiString const name(file);
    aiColor3D const white(1, 1, 1);
    m->AddProperty(&name, AI_MATKEY_NAME);
    m->AddProperty(&white, 1, AI_MATKEY_COLOR_DIFFUSE);
    m->AddProperty(&name, AI_MATKEY_TEXTURE(aiTextureType_DIFFUSE, 0));
    return m;
}

std::unique_ptr<aiMaterial> untextured()
{
    auto m = std::make_unique<aiMaterial>();
    aiString const name(AI_DEFAULT_MATERIAL_NAME);
    m->AddProperty(&name, AI_MATKEY_NAME);
    return m;
}

} // namespace

void PlyImporter::replace_in(Assimp::Importer& importer, ImportedFiles& notes)
{
    if (Assimp::BaseImporter* const old = importer.GetImporter("ply")) {
        importer.UnregisterLoader(old);
        delete old;
    }
    importer.RegisterLoader(new PlyImporter(notes)); // the importer takes ownership
}

bool PlyImporter::CanRead(std::string const& file, Assimp::IOSystem* files, bool) const
{
    char const* words[]{"ply"};
    return SearchFileHeaderForToken(files, file, words, std::size(words));
}

aiImporterDesc const* PlyImporter::GetInfo() const
{
    static aiImporterDesc const info{
        "PLY", "", "", "", aiImporterFlags_SupportTextFlavour | aiImporterFlags_SupportBinaryFlavour,
        0,     0,  0,  0,  "ply"};
    return &info;
}

void PlyImporter::InternReadFile(std::string const& file, aiScene* scene, Assimp::IOSystem* files)
{
    auto const text = import_text(file, *files);
    if (!text) throw std::runtime_error("it cannot be opened");
    PlyModel const model = read_ply(*text, notes_, file);
    notes_.origin_m = model.origin_m;
    std::vector<std::unique_ptr<aiMesh>> meshes;
    std::vector<std::unique_ptr<aiMaterial>> materials;
    std::vector<std::vector<std::size_t>> faces_of(model.textures.size() + 1); // those of [0] have none
    for (std::size_t f = 0; f < model.faces.size(); ++f)
        faces_of[std::size_t(model.faces[f].texture + 1)].push_back(f);
    for (std::int32_t texture = -1; texture < std::int32_t(model.textures.size()); ++texture) {
        PlyMeshBuilder builder(model, texture, std::move(faces_of[std::size_t(texture + 1)]));
        if (!builder.has_faces()) continue;
        if (builder.drops_colors())
            notes_.lose("vertex colours of PLY where there is a texture, skipped", 1,
                        file + ": " + model.textures[std::size_t(texture)]);
        meshes.push_back(builder.build(unsigned(materials.size())));
        materials.push_back(texture < 0 ? untextured() : textured(model.textures[std::size_t(texture)]));
    }
    scene->mRootNode = new aiNode(std::filesystem::path(file).filename().string());
    scene->mNumMeshes = scene->mRootNode->mNumMeshes = unsigned(meshes.size());
    scene->mMeshes = new aiMesh*[meshes.size()];
    scene->mRootNode->mMeshes = new unsigned[meshes.size()];
    scene->mMaterials = new aiMaterial*[materials.size()];
    for (std::size_t m = 0; m < meshes.size(); ++m) {
        scene->mMeshes[m] = meshes[m].release();
        scene->mRootNode->mMeshes[m] = unsigned(m);
        scene->mMaterials[scene->mNumMaterials++] = materials[m].release();
    }
}

} // namespace gi
