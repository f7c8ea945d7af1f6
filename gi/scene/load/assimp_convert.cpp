#include "gi/scene/load/assimp_convert.h"

#include "gi/base/error.h"
#include "gi/base/file.h"
#include "gi/scene/load.h"

#include <algorithm>
#include <assimp/material.h>
#include <assimp/scene.h>
#include <cctype>
#include <fmt/format.h>
#include <map>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>

namespace gi {
namespace {

vec3 to_vec3(aiVector3D v) { return {v.x, v.y, v.z}; }
vec3 to_vec3(aiColor3D v) { return {v.r, v.g, v.b}; }

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
        for (unsigned i = 0; i < source_.mNumMaterials; ++i) add_material(*source_.mMaterials[i]);
        if (source_.mRootNode != nullptr) add_nodes();
        for (unsigned i = 0; i < source_.mNumMeshes; ++i) add_mesh(*source_.mMeshes[i]);
        drop_empty_meshes();
        add_cameras();
        add_lights();
        add_animations();
        if (std::all_of(scene_.meshes.begin(), scene_.meshes.end(),
                        [](Mesh const& m) { return m.triangles.empty(); }))
            throw InputError("'" + scene_.name + "' has no triangles", "points and lines cannot be seen",
                             "export its surfaces");
        return std::move(scene_);
    }

private:
    void add_material(aiMaterial const& source)
    {
        aiString name;
        source.Get(AI_MATKEY_NAME, name);
        where_ = fmt::format("material '{}'", name.C_Str());
        aiColor3D diffuse(0.8f, 0.8f, 0.8f), specular(0, 0, 0), emissive(0, 0, 0);
        float shininess = 0, opacity = 1, ior = 1.5f;
        int illumination = 2;
        source.Get(AI_MATKEY_COLOR_DIFFUSE, diffuse);
        source.Get(AI_MATKEY_COLOR_SPECULAR, specular);
        source.Get(AI_MATKEY_COLOR_EMISSIVE, emissive);
        source.Get(AI_MATKEY_SHININESS, shininess);
        source.Get(AI_MATKEY_OPACITY, opacity);
        source.Get(AI_MATKEY_REFRACTI, ior);
        source.Get("$mat.illum", 0, 0, illumination);

        Material m;
        m.specular = 0;
        m.base_color = unit_color(to_vec3(diffuse));
        m.emission = positive(to_vec3(emissive));
        vec3 const shine = unit_color(to_vec3(specular));
        float metallic = -1, roughness = -1;
        source.Get(AI_MATKEY_METALLIC_FACTOR, metallic);
        source.Get(AI_MATKEY_ROUGHNESS_FACTOR, roughness);
        if (metallic >= 0 && roughness >= 0) {
            m.metallic = std::min(metallic, 1.0f);
            m.roughness = std::min(roughness, 1.0f);
            m.specular = 1;
        } else if (max_component(shine) > 0 && shininess > 0) {
            m.model = MaterialModel::phong;
            m.phong_specular = shine;
            m.phong_exponent = std::clamp(shininess, 0.0f, 1e6f);
            float const most = max_component(m.base_color + m.phong_specular);
            if (most > 1) {
                m.base_color /= most;
                m.phong_specular /= most;
                report_.lose("materials that reflect more than they receive, scaled down", 1, where_);
            }
        }
        m.base_color_map = texture(source, aiTextureType_DIFFUSE, true);
        if (m.base_color_map.texture < 0) m.base_color_map = texture(source, aiTextureType_BASE_COLOR, true);
        // With a map, black means "not set" in many exporters.
        if (m.base_color_map.texture >= 0 && m.base_color == vec3{0}) m.base_color = vec3{1};
        m.emissive_map = texture(source, aiTextureType_EMISSIVE, true);
        m.normal_map = texture(source, aiTextureType_NORMALS, false);
        bool const mask = source.GetTextureCount(aiTextureType_OPACITY) > 0;
        if (mask) {
            m.alpha_mode = AlphaMode::mask;
            add_mask(source, m);
        } else if (opacity < 1 && opacity >= 0) {
            m.alpha_mode = AlphaMode::blend;
            m.alpha = opacity;
        }
        if (ior >= 1 && ior <= 100) m.ior = ior;
        if (illumination == 5) make_mirror(m, shine);
        if (illumination == 6 || illumination == 7) make_glass(m, source);
        scene_.materials.push_back(m);
        scene_.material_names.push_back(name.C_Str());
    }
    /// The ray-traced illumination models of MTL: 5 reflects, 6 and 7 refract as well.
    static void make_mirror(Material& m, vec3 reflectance)
    {
        m.model = MaterialModel::metal_rough;
        m.base_color = reflectance;
        m.base_color_map = {};
        m.metallic = 1;
        m.roughness = 0;
    }
    void make_glass(Material& m, aiMaterial const& source)
    {
        aiColor3D filter(1, 1, 1);
        source.Get(AI_MATKEY_COLOR_TRANSPARENT, filter);
        m.model = MaterialModel::metal_rough;
        m.alpha_mode = AlphaMode::opaque;
        m.alpha = 1;
        m.base_color = unit_color(to_vec3(filter));
        m.base_color_map = {};
        m.metallic = 0;
        m.roughness = 0;
        m.specular = 1;
        m.transmission = 1;
        m.thin = false;
    }

    vec3 unit_color(vec3 v)
    {
        if (!all_finite(v)) v = vec3{0};
        vec3 const clamped = glm::clamp(v, vec3{0}, vec3{1});
        if (clamped != v) report_.lose("material values clamped", 1, where_);
        return clamped;
    }
    static vec3 positive(vec3 v) { return all_finite(v) ? glm::max(v, vec3{0}) : vec3{0}; }

    std::vector<unsigned char> texture_bytes(std::string path, std::string& name)
    {
        if (aiTexture const* embedded = source_.GetEmbeddedTexture(path.c_str())) {
            name = fmt::format("embedded {}", path);
            if (embedded->mHeight == 0) {
                auto const* p = reinterpret_cast<unsigned char const*>(embedded->pcData);
                return {p, p + embedded->mWidth};
            }
            cv::Mat const pixels(int(embedded->mHeight), int(embedded->mWidth), CV_8UC4, embedded->pcData);
            std::vector<unsigned char> png;
            cv::imencode(".png", pixels, png); // aiTexel is BGRA, as OpenCV wants it
            return png;
        }
        std::replace(path.begin(), path.end(), '\\', '/');
        std::filesystem::path file = path;
        if (file.is_absolute() || !std::filesystem::exists(folder_ / file)) file = file.filename();
        name = (folder_ / file).string();
        return read_bytes(folder_ / file);
    }
    TextureRef texture(aiMaterial const& source, aiTextureType type, bool srgb)
    {
        TextureRef ref;
        aiString path;
        unsigned uv_set = 0;
        if (source.GetTexture(type, 0, &path, nullptr, &uv_set) != AI_SUCCESS) return ref;
        auto const key = std::pair(std::string(path.C_Str()), srgb);
        auto [it, fresh] = textures_.try_emplace(key, -1);
        if (fresh) try {
                std::string name;
                std::vector<unsigned char> const bytes = texture_bytes(path.C_Str(), name);
                it->second = add_texture(scene_.textures, bytes.data(), bytes.size(), srgb, name);
            } catch (InputError const& e) {
                report_.lose("textures that could not be read", 1, e.what());
            }
        ref.texture = it->second;
        ref.uv_set = uv_set == 1 ? 1 : 0;
        return ref;
    }
    /// Puts the brightness of an opacity map into the alpha of the base colour.
    void add_mask(aiMaterial const& source, Material& m)
    {
        TextureRef const mask = texture(source, aiTextureType_OPACITY, false);
        if (mask.texture < 0) return;
        TexturePool& pool = scene_.textures;
        Texture combined = pool.textures[std::size_t(mask.texture)];
        Texture const from = combined;
        Texture const* color =
            m.base_color_map.texture >= 0 ? &pool.textures[std::size_t(m.base_color_map.texture)] : nullptr;
        if (color != nullptr && color->first == from.first) return; // one picture with its own alpha
        combined.first = pool.texels.size();
        combined.srgb = true;
        for (std::uint32_t y = 0; y < from.height; ++y)
            for (std::uint32_t x = 0; x < from.width; ++x) {
                Rgba8 texel{255, 255, 255, pool.texels[from.first + std::uint64_t(y) * from.width + x].r};
                if (color != nullptr) {
                    std::uint64_t const cx = std::uint64_t(x) * color->width / from.width,
                                        cy = std::uint64_t(y) * color->height / from.height;
                    Rgba8 const c = pool.texels[color->first + cy * color->width + cx];
                    texel = {c.r, c.g, c.b, texel.a};
                }
                pool.texels.push_back(texel);
            }
        pool.textures.push_back(combined);
        m.base_color_map = mask;
        m.base_color_map.texture = std::int32_t(pool.textures.size()) - 1;
    }

    /// FBX states its unit in centimetres and leaves the numbers as they are: everything hangs below a node that
    /// scales.
    void add_unit_node()
    {
        float centimetres = 100;
        if (source_.mMetaData == nullptr || !source_.mMetaData->Get("UnitScaleFactor", centimetres)) return;
        if (!(centimetres > 1e-6f) || !(centimetres < 1e9f)) return;
        Node node;
        node.name = "unit";
        node.scale = dvec3(0.01 * double(centimetres));
        scene_.nodes.push_back(std::move(node));
    }

    void add_nodes()
    {
        add_unit_node();
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
            node.matrix = to_matrix(v.node->mTransformation);
            for (unsigned i = 0; i < v.node->mNumMeshes; ++i)
                node.meshes.push_back(std::int32_t(v.node->mMeshes[i]));
            node_of_.try_emplace(node.name, index);
            scene_.nodes.push_back(std::move(node));
            for (unsigned i = v.node->mNumChildren; i > 0; --i) stack.push_back({v.node->mChildren[i - 1], index});
        }
    }

    /// Assimp gives formats without materials one of its own, of a certain name or none.
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
                mesh.colors.push_back(all_finite(rgb) ? glm::clamp(rgb, vec3{0}, vec3{1}) : vec3{1});
            }
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
                for (int k = 0; k < 4; ++k)
                    if (mesh.weights[vertex][k] == 0) {
                        mesh.weights[vertex][k] = bone.mWeights[w].mWeight;
                        mesh.joints[vertex][std::size_t(k)] = joint;
                        break;
                    }
            }
        }
        if (skin.joints.empty()) {
            mesh.joints.clear();
            mesh.weights.clear();
            return;
        }
        auto const skin_index = std::int32_t(scene_.skins.size());
        scene_.skins.push_back(std::move(skin));
        // A node of ours has one skin; Assimp has one per mesh. Further skinned meshes get a node of their own.
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

    /// A node that carries what Assimp keeps beside its node of the same name.
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

    template <class Key, class Store>
    static void add_channel(Animation& clip, std::int32_t node, ChannelPath path, Key const* keys, unsigned count,
                            double ticks_per_s, Store const& store)
    {
        AnimationChannel channel;
        channel.node = node;
        channel.path = path;
        for (unsigned k = 0; k < count; ++k) {
            float const t = float(keys[k].mTime / ticks_per_s);
            if (!std::isfinite(t) || (!channel.times_s.empty() && !(t > channel.times_s.back()))) continue;
            channel.times_s.push_back(t);
            store(channel.values, keys[k].mValue);
        }
        if (channel.times_s.empty()) return;
        clip.duration_s = std::max(clip.duration_s, double(channel.times_s.back()));
        clip.channels.push_back(std::move(channel));
    }
    void add_animations()
    {
        for (unsigned a = 0; a < source_.mNumAnimations; ++a) {
            aiAnimation const& source = *source_.mAnimations[a];
            Animation clip;
            clip.name = source.mName.length > 0 ? source.mName.C_Str() : fmt::format("clip {}", a);
            double const ticks = source.mTicksPerSecond > 0 ? source.mTicksPerSecond : 25;
            for (unsigned c = 0; c < source.mNumChannels; ++c) {
                aiNodeAnim const& channel = *source.mChannels[c];
                auto const node = node_of_.find(channel.mNodeName.C_Str());
                if (node == node_of_.end()) {
                    report_.lose("animation channels ignored", 1, clip.name);
                    continue;
                }
                split_matrix(scene_.nodes[std::size_t(node->second)]);
                auto const put_vector = [](std::vector<float>& to, aiVector3D v) {
                    to.insert(to.end(), {v.x, v.y, v.z});
                };
                auto const put_rotation = [](std::vector<float>& to, aiQuaternion q) {
                    to.insert(to.end(), {q.x, q.y, q.z, q.w});
                };
                add_channel(clip, node->second, ChannelPath::translation, channel.mPositionKeys,
                            channel.mNumPositionKeys, ticks, put_vector);
                add_channel(clip, node->second, ChannelPath::rotation, channel.mRotationKeys,
                            channel.mNumRotationKeys, ticks, put_rotation);
                add_channel(clip, node->second, ChannelPath::scale, channel.mScalingKeys, channel.mNumScalingKeys,
                            ticks, put_vector);
            }
            scene_.animations.push_back(std::move(clip));
        }
        if (!scene_.animations.empty()) scene_.playbacks = {{0, 0, 1, true}};
    }
    /// A node that moves needs its parts: channels replace some of them.
    static void split_matrix(Node& node)
    {
        if (!node.matrix) return;
        aiMatrix4x4 m;
        for (unsigned r = 0; r < 4; ++r)
            for (unsigned c = 0; c < 4; ++c) m[r][c] = float((*node.matrix)[int(c)][int(r)]);
        aiVector3D scale, position;
        aiQuaternion rotation;
        m.Decompose(scale, rotation, position);
        node.translation = dvec3(to_vec3(position));
        node.scale = dvec3(to_vec3(scale));
        node.rotation =
            glm::normalize(dquat{double(rotation.w), double(rotation.x), double(rotation.y), double(rotation.z)});
        node.matrix.reset();
    }

    aiScene const& source_;
    std::filesystem::path folder_;
    Report& report_;
    Scene scene_;
    std::string where_;
    std::map<std::string, std::int32_t> node_of_;
    std::map<std::pair<std::string, bool>, std::int32_t> textures_;
};

} // namespace

Scene convert_assimp(aiScene const& source, std::filesystem::path const& file, Report& report)
{
    return Converter(source, file, report).convert();
}

} // namespace gi
