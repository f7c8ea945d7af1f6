#include "gi/scene/load/assimp_convert.h"

#include "gi/core/error.h"
#include "gi/core/srgb.h"
#include "gi/scene/load/assimp_parts.h"

#include <algorithm>
#include <assimp/material.h>
#include <fmt/format.h>
#include <glm/gtc/matrix_transform.hpp>

namespace gi {
namespace {

dmat4 to_matrix(aiMatrix4x4 const& m)
{
    dmat4 out;
    for (unsigned r = 0; r < 4; ++r)
        for (unsigned c = 0; c < 4; ++c) out[int(c)][int(r)] = double(m[r][c]);
    return out;
}

class Converter {
public:
    Converter(aiScene const& source, std::filesystem::path const& file, Report& report)
        : source_(source), folder_(file.parent_path()), report_(report)
    {
        scene_.name = file.string();
    }

    Scene convert()
    {
        convert_materials(source_, folder_, scene_, report_);
        if (source_.mRootNode != nullptr) add_nodes();
        for (unsigned i = 0; i < source_.mNumMeshes; ++i) add_mesh(*source_.mMeshes[i]);
        drop_empty_meshes();
        add_cameras();
        add_lights();
        convert_animations(source_, node_of_, scene_, report_);
        if (std::all_of(scene_.meshes.begin(), scene_.meshes.end(),
                        [](Mesh const& m) { return m.triangles.empty(); }))
            throw InputError("'" + scene_.name + "' has no triangles", "points and lines cannot be seen",
                             "export its surfaces");
        return std::move(scene_);
    }

private:
    /// FBX states its axes and its unit (in centimetres) and does not convert its numbers, so all nodes are placed
    /// below one that does. Axes of the other hand mirror, which world.h follows by the winding of triangles.
    void add_fbx_node()
    {
        if (!is_fbx()) return;
        Node node;
        node.name = "axes and unit";
        node.matrix = axes_of_fbx() * glm::scale(dmat4(1), dvec3(unit_of_fbx_m()));
        scene_.nodes.push_back(std::move(node));
    }

    bool is_fbx() const { return source_.mMetaData != nullptr && source_.mMetaData->HasKey("UnitScaleFactor"); }

    double unit_of_fbx_m() const
    {
        float centimetres = 100;
        if (double other = 0; source_.mMetaData->Get("UnitScaleFactor", other)) centimetres = float(other);
        source_.mMetaData->Get("UnitScaleFactor", centimetres);
        return centimetres > 1e-6f && centimetres < 1e9f ? 0.01 * double(centimetres) : 1;
    }

    /// CoordAxis is to the right, UpAxis up, FrontAxis towards the viewer: our x, y, z.
    dmat4 axes_of_fbx()
    {
        auto const number = [&](char const* key, std::int32_t otherwise) {
            source_.mMetaData->Get(key, otherwise);
            return otherwise;
        };
        std::int32_t const axes[]{number("CoordAxis", 0), number("UpAxis", 1), number("FrontAxis", 2)};
        std::int32_t const signs[]{number("CoordAxisSign", 1), number("UpAxisSign", 1),
                                   number("FrontAxisSign", 1)};
        dmat4 ours(0);
        ours[3][3] = 1;
        for (int row = 0; row < 3; ++row)
            if (axes[row] >= 0 && axes[row] < 3) ours[axes[row]][row] = signs[row] < 0 ? -1 : 1;
        if (std::abs(glm::determinant(ours)) == 1) return ours;
        report_.lose(
            "axes of FBX that are no three directions, taken as y up", 1,
            fmt::format("{}: CoordAxis {}, UpAxis {}, FrontAxis {}", scene_.name, axes[0], axes[1], axes[2]));
        return dmat4(1);
    }

    void add_nodes()
    {
        add_fbx_node();
        struct Visit {
            aiNode const* node;
            std::int32_t parent;
        };
        std::vector<Visit> stack{{source_.mRootNode, std::int32_t(scene_.nodes.size()) - 1}};
        while (!stack.empty()) {
            Visit const v = stack.back();
            stack.pop_back();
            auto const index = std::int32_t(scene_.nodes.size());
            Node node;
            node.name = v.node->mName.C_Str();
            node.parent = v.parent;
            // The root of FBX has no transform of its own, but Assimp 5.4 and later turn it by the axes.
            bool const is_turned = v.node == source_.mRootNode && is_fbx();
            node.matrix = is_turned ? dmat4(1) : to_matrix(v.node->mTransformation);
            for (unsigned i = 0; i < v.node->mNumMeshes; ++i)
                node.meshes.push_back(std::int32_t(v.node->mMeshes[i]));
            node_of_.try_emplace(node.name, index);
            scene_.nodes.push_back(std::move(node));
            for (unsigned i = v.node->mNumChildren; i > 0; --i) stack.push_back({v.node->mChildren[i - 1], index});
        }
    }

    /// True if a material is from the file: for formats without materials,
    /// Assimp adds one with a default or empty name.
    bool of_the_file(unsigned material) const
    {
        if (material >= scene_.material_names.size()) return false;
        std::string const& name = scene_.material_names[material];
        return name != AI_DEFAULT_MATERIAL_NAME && !(name.empty() && source_.mNumMaterials == 1);
    }

    void add_mesh(aiMesh const& source)
    {
        Mesh mesh;
        mesh.name = source.mName.C_Str();
        where_ = "mesh '" + mesh.name + "'";
        unsigned const n = source.mNumVertices;
        mesh.material = of_the_file(source.mMaterialIndex) ? std::int32_t(source.mMaterialIndex) : -1;
        if (!source.HasPositions() || !source.HasFaces()) {
            scene_.meshes.push_back(std::move(mesh));
            return;
        }
        for (unsigned i = 0; i < n; ++i) mesh.positions.push_back(to_vec3(source.mVertices[i]));
        if (source.HasNormals())
            for (unsigned i = 0; i < n; ++i) {
                vec3 const v = to_vec3(source.mNormals[i]);
                float const length = glm::length(v);
                mesh.normals.push_back(length > 1e-12f && length < kInf ? v / length : vec3{0});
            }
        for (unsigned set = 0; set < 2; ++set)
            if (source.HasTextureCoords(set))
                for (unsigned i = 0; i < n; ++i) {
                    aiVector3D const uv = source.mTextureCoords[set][i];
                    (set == 0 ? mesh.uv0 : mesh.uv1)
                        .push_back({uv.x, 1 - uv.y}); // (0, 0) is the lower left corner
                }
        if (source.HasVertexColors(0))
            for (unsigned i = 0; i < n; ++i) {
                aiColor4D const c = source.mColors[0][i];
                vec3 const rgb{c.r, c.g, c.b};
                vec3 const clamped = all_finite(rgb) ? glm::clamp(rgb, vec3{0}, vec3{1}) : vec3{1};
                if (clamped != rgb) report_.lose("vertex colours not within 0..1, clamped", 1, where_);
                if (c.a < 1) report_.lose("vertices with an alpha of their own, taken as opaque", 1, where_);
                // as monitors show them: three.js and Blender read these formats so too
                mesh.colors.push_back({decode_srgb(clamped.x), decode_srgb(clamped.y), decode_srgb(clamped.z)});
            }
        if (!mesh.colors.empty() && mesh.material < 0) mesh.material = white();
        for (unsigned f = 0; f < source.mNumFaces; ++f) {
            aiFace const& face = source.mFaces[f];
            if (face.mNumIndices != 3) {
                report_.lose("points and lines skipped", 1, where_);
                continue;
            }
            uvec3 const t{face.mIndices[0], face.mIndices[1], face.mIndices[2]};
            if (std::max({t.x, t.y, t.z}) >= n)
                report_.lose("triangles with indices out of range, skipped", 1, where_);
            else
                mesh.triangles.push_back(t);
        }
        auto const index = std::int32_t(scene_.meshes.size());
        if (source.HasBones()) add_bones(source, mesh, index);
        scene_.meshes.push_back(std::move(mesh));
    }

    /// The material of meshes that have colours and no material: their colours are the albedo.
    std::int32_t white()
    {
        if (white_ < 0) {
            Material m;
            m.base_color = vec3{1};
            m.specular = 0;
            white_ = std::int32_t(scene_.materials.size());
            scene_.materials.push_back(m);
            scene_.material_names.push_back("default");
        }
        return white_;
    }

    void add_bones(aiMesh const& source, Mesh& mesh, std::int32_t index)
    {
        Skin skin;
        mesh.joints.resize(mesh.positions.size());
        mesh.weights.resize(mesh.positions.size(), vec4{0});
        for (unsigned b = 0; b < source.mNumBones; ++b) {
            aiBone const& bone = *source.mBones[b];
            auto const node = node_of_.find(bone.mName.C_Str());
            if (node == node_of_.end() || skin.joints.size() > 65535) {
                report_.lose("bones without a node, ignored", 1, where_);
                continue;
            }
            auto const joint = std::uint16_t(skin.joints.size());
            skin.joints.push_back(node->second);
            skin.inverse_bind.push_back(mat4(to_matrix(bone.mOffsetMatrix)));
            for (unsigned w = 0; w < bone.mNumWeights; ++w) {
                unsigned const vertex = bone.mWeights[w].mVertexId;
                if (vertex >= mesh.weights.size() || !(bone.mWeights[w].mWeight > 0)) continue;
                int least = 0;
                for (int k = 1; k < 4; ++k)
                    if (mesh.weights[vertex][k] < mesh.weights[vertex][least]) least = k;
                float& weight = mesh.weights[vertex][least];
                if (weight > 0)
                    report_.lose("bone weights beyond the largest four of a vertex, dropped", 1, where_);
                if (bone.mWeights[w].mWeight <= weight) continue;
                weight = bone.mWeights[w].mWeight;
                mesh.joints[vertex][std::size_t(least)] = joint;
            }
        }
        if (skin.joints.empty()) {
            mesh.joints.clear();
            mesh.weights.clear();
            return;
        }
        auto const skin_index = std::int32_t(scene_.skins.size());
        scene_.skins.push_back(std::move(skin));
        // Our nodes have one skin, Assimp's have one per mesh. Further skinned meshes get a node of their own.
        std::size_t const nodes = scene_.nodes.size();
        for (std::size_t n = 0; n < nodes; ++n) {
            auto& meshes = scene_.nodes[n].meshes;
            auto const at = std::find(meshes.begin(), meshes.end(), index);
            if (at == meshes.end()) continue;
            if (scene_.nodes[n].skin < 0 && meshes.size() == 1) {
                scene_.nodes[n].skin = skin_index;
            } else {
                meshes.erase(at);
                Node extra;
                extra.name = scene_.nodes[n].name;
                extra.parent = std::int32_t(n);
                extra.meshes = {index};
                extra.skin = skin_index;
                scene_.nodes.push_back(std::move(extra));
            }
        }
    }

    void drop_empty_meshes()
    {
        for (Node& node : scene_.nodes)
            std::erase_if(node.meshes, [&](std::int32_t m) {
                return std::size_t(m) >= scene_.meshes.size() || scene_.meshes[std::size_t(m)].triangles.empty();
            });
    }

    /// Adds a child node for a camera or light, which Assimp links to its node by name.
    Node& child_of(aiString const& name)
    {
        Node node;
        node.name = name.C_Str();
        if (auto const it = node_of_.find(node.name); it != node_of_.end()) node.parent = it->second;
        scene_.nodes.push_back(std::move(node));
        return scene_.nodes.back();
    }
    static dmat4 placed(aiVector3D position, aiVector3D forward, aiVector3D up)
    {
        dvec3 const z = -glm::normalize(dvec3(to_vec3(forward)));
        dvec3 x = glm::cross(dvec3(to_vec3(up)), z);
        x = glm::length(x) > 1e-9 ? glm::normalize(x) : dvec3(Frame::about(vec3(z)).tangent);
        return dmat4(glm::dvec4(x, 0), glm::dvec4(glm::cross(z, x), 0), glm::dvec4(z, 0),
                     glm::dvec4(dvec3(to_vec3(position)), 1));
    }
    void add_cameras()
    {
        for (unsigned i = 0; i < source_.mNumCameras; ++i) {
            aiCamera const& c = *source_.mCameras[i];
            Camera camera;
            camera.name = c.mName.C_Str();
            double const aspect = c.mAspect > 0 ? double(c.mAspect) : 1;
            camera.aspect = c.mAspect > 0 ? aspect : 0;
            double const half_width = std::tan(0.5 * double(c.mHorizontalFOV));
            if (!(half_width > 0) || !(c.mLookAt.Length() > 0)) {
                report_.lose("cameras without a view skipped", 1, camera.name);
                continue;
            }
            camera.yfov_rad = 2 * std::atan(half_width / aspect);
            Node& node = child_of(c.mName);
            node.matrix = placed(c.mPosition, c.mLookAt, c.mUp);
            node.camera = std::int32_t(scene_.cameras.size());
            scene_.cameras.push_back(camera);
        }
    }
    void add_lights()
    {
        for (unsigned i = 0; i < source_.mNumLights; ++i) {
            aiLight const& l = *source_.mLights[i];
            Light light;
            if (l.mType == aiLightSource_POINT)
                light.type = LightType::point;
            else if (l.mType == aiLightSource_SPOT)
                light.type = LightType::spot;
            else if (l.mType == aiLightSource_DIRECTIONAL)
                light.type = LightType::directional;
            else {
                report_.lose("lights of other types skipped", 1, l.mName.C_Str());
                continue;
            }
            light.intensity = positive(to_vec3(l.mColorDiffuse));
            light.cos_inner = std::cos(0.5f * l.mAngleInnerCone);
            light.cos_outer = std::cos(0.5f * l.mAngleOuterCone);
            Node& node = child_of(l.mName);
            aiVector3D const forward = l.mDirection.Length() > 0 ? l.mDirection : aiVector3D(0, 0, -1);
            node.matrix = placed(l.mPosition, forward, aiVector3D(0, 1, 0));
            node.light = std::int32_t(scene_.lights.size());
            scene_.lights.push_back(light);
        }
    }

    aiScene const& source_;
    std::filesystem::path folder_;
    Report& report_;
    Scene scene_;
    std::string where_;
    NodeOfName node_of_;
    std::int32_t white_ = -1;
};

} // namespace

Scene convert_assimp(aiScene const& source, std::filesystem::path const& file, Report& report)
{
    return Converter(source, file, report).convert();
}

} // namespace gi
