#include "gi/scene/load/obj/obj_importer.h"

#include "gi/scene/load/import_text.h"
#include "gi/scene/load/obj/obj_libraries.h"
#include "gi/scene/load/obj/obj_materials.h"
#include "gi/scene/load/obj/obj_model.h"

#include <algorithm>
#include <assimp/IOSystem.hpp>
#include <assimp/Importer.hpp>
#include <assimp/importerdesc.h>
#include <assimp/scene.h>
#include <filesystem>
#include <stdexcept>

namespace gi {
namespace {

namespace fs = std::filesystem;

aiVector3D vector_of(vec3 v) { return {v.x, v.y, v.z}; }
aiColor4D color_of(vec3 v) { return {v.x, v.y, v.z, 1}; }

/// Faces of one mesh: Assimp wants vertices that no two faces share.
class MeshBuilder {
public:
    MeshBuilder(ObjModel const& model, std::size_t mesh) : m_(model), mesh_(model.meshes[mesh])
    {
        bool const is_last = mesh + 1 == model.meshes.size();
        faces_ = {mesh_.first_face, is_last ? model.faces.size() : model.meshes[mesh + 1].first_face};
    }

    bool has_faces() const { return faces_.first < faces_.end; }

    std::unique_ptr<aiMesh> build()
    {
        auto out = std::make_unique<aiMesh>();
        out->mName.Set(mesh_.name);
        out->mMaterialIndex = mesh_.material;
        count(*out);
        out->mFaces = new aiFace[out->mNumFaces];
        out->mVertices = new aiVector3D[out->mNumVertices];
        if (has_.normals) out->mNormals = new aiVector3D[out->mNumVertices];
        if (has_.uvs) out->mTextureCoords[0] = new aiVector3D[out->mNumVertices];
        if (has_.uvs) out->mNumUVComponents[0] = m_.uv_size;
        if (!m_.colors.empty()) out->mColors[0] = new aiColor4D[out->mNumVertices];
        for_parts([&](std::size_t first, std::size_t size) { add(*out, first, size); });
        return out;
    }

private:
    struct Range {
        std::size_t first = 0, end = 0;
    };
    struct Channels {
        bool normals = false, uvs = false;
    };

    /// Calls use(first corner, number of corners) for each polygon, part of a line, and point.
    template <class Use>
    void for_parts(Use const& use) const
    {
        for (std::size_t f = faces_.first; f < faces_.end; ++f) {
            ObjFace const& face = m_.faces[f];
            std::size_t const first = f == 0 ? 0 : m_.faces[f - 1].corners_end, n = face.corners_end - first;
            if (face.kind == ObjFace::Kind::polygon)
                use(first, n);
            else if (face.kind == ObjFace::Kind::line)
                for (std::size_t k = 0; k + 1 < n; ++k) use(first + k, std::size_t(2));
            else
                for (std::size_t k = 0; k < n; ++k) use(first + k, std::size_t(1));
        }
    }

    /// Counts faces and vertices, and finds the channels that are valid in all corners that have them.
    void count(aiMesh& out)
    {
        std::size_t faces = 0, vertices = 0;
        bool are_normals_right = true, are_uvs_right = true;
        for_parts([&](std::size_t first, std::size_t size) {
            ++faces;
            vertices += size;
            constexpr aiPrimitiveType kTypes[]{aiPrimitiveType_POINT, aiPrimitiveType_LINE,
                                               aiPrimitiveType_TRIANGLE, aiPrimitiveType_POLYGON};
            out.mPrimitiveTypes |= kTypes[std::min<std::size_t>(size, 4) - 1];
            for (std::size_t c = first; c < first + size; ++c) {
                ObjCorner const& corner = m_.corners[c];
                if (!is_index(corner.vertex, m_.positions.size()))
                    throw std::runtime_error("a face has a vertex that the file has not");
                note(corner.normal, m_.normals.size(), has_.normals, are_normals_right);
                note(corner.uv, m_.uvs.size(), has_.uvs, are_uvs_right);
            }
        });
        if (vertices > AI_MAX_VERTICES || faces > AI_MAX_FACES) throw std::runtime_error("too many faces");
        out.mNumFaces = unsigned(faces);
        out.mNumVertices = unsigned(vertices);
        has_.normals &= are_normals_right;
        has_.uvs &= are_uvs_right;
    }

    static bool is_index(std::int64_t index, std::size_t count)
    {
        return index >= 0 && std::size_t(index) < count;
    }
    static void note(std::int64_t index, std::size_t count, bool& has, bool& is_right)
    {
        if (index == ObjCorner::kNone) return;
        has = true;
        is_right &= is_index(index, count);
    }

    void add(aiMesh& out, std::size_t first, std::size_t size)
    {
        aiFace& face = out.mFaces[next_face_++];
        face.mNumIndices = unsigned(size);
        face.mIndices = new unsigned[size];
        for (std::size_t k = 0; k < size; ++k, ++next_vertex_) {
            ObjCorner const& corner = m_.corners[first + k];
            face.mIndices[k] = next_vertex_;
            out.mVertices[next_vertex_] = vector_of(m_.positions[std::size_t(corner.vertex)]);
            if (has_.normals && corner.normal >= 0)
                out.mNormals[next_vertex_] = vector_of(m_.normals[std::size_t(corner.normal)]);
            if (has_.uvs && corner.uv >= 0)
                out.mTextureCoords[0][next_vertex_] = vector_of(m_.uvs[std::size_t(corner.uv)]);
            if (!m_.colors.empty()) out.mColors[0][next_vertex_] = color_of(m_.colors[std::size_t(corner.vertex)]);
        }
    }

    ObjModel const& m_;
    ObjMesh const& mesh_;
    Range faces_;
    Channels has_;
    unsigned next_face_ = 0, next_vertex_ = 0;
};

/// A node for each object, with its meshes.
void convert(ObjModel const& model, std::string const& name, aiScene& scene)
{
    std::vector<std::unique_ptr<aiMesh>> meshes;
    std::vector<std::vector<unsigned>> of_object(model.objects.size());
    for (std::size_t m = 0; m < model.meshes.size(); ++m) {
        MeshBuilder builder(model, m);
        if (!builder.has_faces()) continue;
        of_object[model.meshes[m].object].push_back(unsigned(meshes.size()));
        meshes.push_back(builder.build());
    }
    scene.mRootNode = new aiNode(name);
    std::vector<aiNode*> children;
    for (std::size_t o = 0; o < model.objects.size(); ++o) {
        auto* const node = new aiNode(model.objects[o]);
        node->mNumMeshes = unsigned(of_object[o].size());
        if (node->mNumMeshes > 0) node->mMeshes = new unsigned[node->mNumMeshes];
        std::copy(of_object[o].begin(), of_object[o].end(), node->mMeshes);
        children.push_back(node);
    }
    scene.mRootNode->addChildren(unsigned(children.size()), children.data());
    scene.mNumMeshes = unsigned(meshes.size());
    if (!meshes.empty()) scene.mMeshes = new aiMesh*[meshes.size()];
    for (std::size_t m = 0; m < meshes.size(); ++m) scene.mMeshes[m] = meshes[m].release();
}

} // namespace

void ObjImporter::replace_in(Assimp::Importer& importer, ImportedFiles& notes)
{
    if (Assimp::BaseImporter* const old = importer.GetImporter("obj")) {
        importer.UnregisterLoader(old);
        delete old;
    }
    importer.RegisterLoader(new ObjImporter(notes)); // the importer takes ownership
}

bool ObjImporter::CanRead(std::string const& file, Assimp::IOSystem* files, bool) const
{
    char const* words[]{"mtllib", "usemtl", "v ", "vt ", "vn ", "o ", "g ", "s ", "f "};
    return SearchFileHeaderForToken(files, file, words, std::size(words), 200, false, true);
}

aiImporterDesc const* ObjImporter::GetInfo() const
{
    static aiImporterDesc const kInfo{
        "Wavefront OBJ", "", "", "", aiImporterFlags_SupportTextFlavour, 0, 0, 0, 0, "obj"};
    return &kInfo;
}

void ObjImporter::InternReadFile(std::string const& file, aiScene* scene, Assimp::IOSystem* files)
{
    auto const text = import_text(file, *files);
    if (!text) throw std::runtime_error("it cannot be opened");
    ObjMaterials materials(notes_);
    ObjLibraries libraries(file, *files, materials, notes_);
    ObjModel const model = read_obj(*text, {[&](std::string const& name) { return materials.index_of(name); },
                                            [&](std::string const& names) { libraries.read(names); }});
    if (model.faces.empty()) throw std::runtime_error("it has no faces");
    notes_.origin_m = model.origin_m;
    notes_.lose("points and lines skipped",
                std::size_t(std::ranges::count_if(
                    model.faces, [](ObjFace const& f) { return f.kind != ObjFace::Kind::polygon; })),
                file);
    for (auto const& [word, count] : model.skipped)
        notes_.lose("statements of OBJ that are not read (curves, surfaces, ...)", count, file + ": " + word);
    notes_.lose("faces of smoothing groups without normals, flat", model.flat_faces, file);
    notes_.lose("vertices with an alpha of their own, taken as opaque", model.alphas, file);
    convert(model, fs::path(file).filename().string(), *scene);
    auto all = materials.take();
    scene->mMaterials = new aiMaterial*[all.size()];
    for (auto& material : all) scene->mMaterials[scene->mNumMaterials++] = material.release();
}

} // namespace gi
