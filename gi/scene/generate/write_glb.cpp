#include "gi/scene/generate/write_glb.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/image_io/picture_file.h"
#include "gi/scene/motion/animation.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <fmt/format.h>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <opencv2/imgcodecs.hpp>
#include <opencv2/imgproc.hpp>
#include <set>

namespace gi {
namespace {

using json = nlohmann::json; // not ordered_json, because references into this one stay valid

constexpr int kFloat = 5126, kUint32 = 5125, kUint16 = 5123;

json to_json(vec3 v) { return {v.x, v.y, v.z}; }

class GlbWriter {
public:
    GlbWriter(Scene const& scene, Report& report) : scene_(scene), report_(report) {}

    void write(std::filesystem::path const& file)
    {
        root_["asset"] = {{"version", "2.0"}, {"generator", "lightwell"}};
        add_textures();
        add_materials();
        add_meshes();
        add_nodes();
        add_skins();
        add_animations();
        if (!used_.empty()) root_["extensionsUsed"] = used_;
        while (binary_.size() % 4 != 0) binary_.push_back(0);
        if (!binary_.empty()) root_["buffers"] = {{{"byteLength", binary_.size()}}};
        std::string text = root_.dump(-1, ' ', false, json::error_handler_t::replace);
        while (text.size() % 4 != 0) text += ' ';
        std::uint64_t const total = 12 + 8 + text.size() + (binary_.empty() ? 0 : 8 + binary_.size());
        if (total > 0xffffffffu)
            throw InputError("'" + file.string() + "' would have " + std::to_string(total) + " bytes",
                             "a GLB holds at most 4 GiB", "make the scene smaller");
        write_by_rename(file, [&](std::filesystem::path const& temporary) {
            std::ofstream out(temporary, std::ios::binary);
            out.exceptions(std::ios::failbit | std::ios::badbit);
            auto const word = [&](std::uint32_t v) { out.write(reinterpret_cast<char const*>(&v), 4); };
            word(0x46546c67);
            word(2);
            word(std::uint32_t(total));
            word(std::uint32_t(text.size()));
            word(0x4e4f534a);
            out.write(text.data(), std::streamsize(text.size()));
            if (!binary_.empty()) {
                word(std::uint32_t(binary_.size()));
                word(0x004e4942);
                out.write(reinterpret_cast<char const*>(binary_.data()), std::streamsize(binary_.size()));
            }
            out.flush();
        });
    }

private:
    int add_view(void const* data, std::size_t bytes)
    {
        while (binary_.size() % 4 != 0) binary_.push_back(0);
        root_["bufferViews"].push_back({{"buffer", 0}, {"byteOffset", binary_.size()}, {"byteLength", bytes}});
        auto const* p = static_cast<unsigned char const*>(data);
        binary_.insert(binary_.end(), p, p + bytes);
        return int(root_["bufferViews"].size()) - 1;
    }
    int add_accessor(void const* data, std::size_t count, std::size_t bytes, int component, char const* type)
    {
        root_["accessors"].push_back({{"bufferView", add_view(data, bytes)},
                                      {"componentType", component},
                                      {"count", count},
                                      {"type", type}});
        return int(root_["accessors"].size()) - 1;
    }
    template <class T>
    int add_floats(std::vector<T> const& v, char const* type)
    {
        return add_accessor(v.data(), v.size(), v.size() * sizeof(T), kFloat, type);
    }
    int add_positions(std::vector<vec3> const& v)
    {
        int const accessor = add_floats(v, "VEC3");
        vec3 low{kInf}, high{-kInf};
        for (vec3 const p : v) {
            low = glm::min(low, p);
            high = glm::max(high, p);
        }
        root_["accessors"].back()["min"] = to_json(low);
        root_["accessors"].back()["max"] = to_json(high);
        return accessor;
    }

    void add_textures()
    {
        std::map<std::uint64_t, int> image_of;
        for (Texture const& t : scene_.textures.textures) {
            auto const [it, fresh] = image_of.try_emplace(t.first, int(image_of.size()));
            if (fresh) {
                cv::Mat const rgba(int(t.height), int(t.width), CV_8UC4,
                                   const_cast<Rgba8*>(scene_.textures.texels.data() + t.first));
                cv::Mat bgra;
                cv::cvtColor(rgba, bgra, cv::COLOR_RGBA2BGRA);
                std::vector<unsigned char> png;
                cv::imencode(".png", bgra, png);
                root_["images"].push_back(
                    {{"bufferView", add_view(png.data(), png.size())}, {"mimeType", "image/png"}});
            }
            auto const wrap = [](Wrap w) { return w == Wrap::repeat ? 10497 : w == Wrap::clamp ? 33071 : 33648; };
            int const filter = t.nearest ? 9728 : 9729;
            root_["samplers"].push_back({{"magFilter", filter},
                                         {"minFilter", filter},
                                         {"wrapS", wrap(t.wrap_u)},
                                         {"wrapT", wrap(t.wrap_v)}});
            root_["textures"].push_back({{"source", it->second}, {"sampler", root_["samplers"].size() - 1}});
        }
    }

    /// Computes KHR_texture_transform from the matrix: the scale from the columns' lengths,
    /// the rotation from their directions.
    json texture_info(TextureRef const& t)
    {
        json j{{"index", t.texture}};
        if (t.uv_set != 0) j["texCoord"] = t.uv_set;
        if (t.row_u == vec2{1, 0} && t.row_v == vec2{0, 1} && t.offset == vec2{0}) return j;
        use("KHR_texture_transform");
        float const sx = std::hypot(t.row_u.x, t.row_v.x), sy = std::hypot(t.row_u.y, t.row_v.y);
        if (std::abs(t.row_u.x * t.row_u.y + t.row_v.x * t.row_v.y) > 1e-4f * sx * sy)
            report_.lose("shears of texture transforms that GLB cannot hold");
        bool const flipped = t.row_u.x * t.row_v.y - t.row_u.y * t.row_v.x < 0;
        j["extensions"]["KHR_texture_transform"] = {{"offset", {t.offset.x, t.offset.y}},
                                                    {"rotation", std::atan2(-t.row_v.x, t.row_u.x)},
                                                    {"scale", {sx, flipped ? -sy : sy}}};
        return j;
    }
    void use(std::string const& extension) { used_.insert(extension); }

    void add_materials()
    {
        for (std::size_t i = 0; i < scene_.materials.size(); ++i)
            add_material(scene_.materials[i], scene_.material_names[i]);
        // The default of glTF is another one.
        if (std::ranges::any_of(scene_.meshes, [](Mesh const& m) { return m.material < 0; }))
            add_material({}, "default");
    }
    void add_material(Material const& m, std::string const& name)
    {
        json j{{"name", name}};
        json& pbr = j["pbrMetallicRoughness"];
        pbr["baseColorFactor"] = {m.base_color.x, m.base_color.y, m.base_color.z, m.alpha};
        pbr["metallicFactor"] = m.metallic;
        bool const phong = m.model == MaterialModel::phong;
        // For other viewers, approximate the Phong lobe by the corresponding GGX width (Walter et al. 2007).
        pbr["roughnessFactor"] = phong ? std::pow(2 / (m.phong_exponent + 2), 0.25f) : m.roughness;
        if (m.base_color_map.texture >= 0) pbr["baseColorTexture"] = texture_info(m.base_color_map);
        if (m.metallic_roughness_map.texture >= 0)
            pbr["metallicRoughnessTexture"] = texture_info(m.metallic_roughness_map);
        if (m.normal_map.texture >= 0) {
            j["normalTexture"] = texture_info(m.normal_map);
            j["normalTexture"]["scale"] = m.normal_scale;
        }
        if (m.emissive_map.texture >= 0) j["emissiveTexture"] = texture_info(m.emissive_map);
        j["doubleSided"] = m.double_sided;
        if (m.alpha_mode == AlphaMode::mask) {
            j["alphaMode"] = "MASK";
            j["alphaCutoff"] = m.alpha_cutoff;
        } else if (m.alpha_mode == AlphaMode::blend) {
            j["alphaMode"] = "BLEND";
        }
        add_material_extensions(m, j);
        root_["materials"].push_back(std::move(j));
    }
    void add_material_extensions(Material const& m, json& j)
    {
        auto const extend = [&](char const* name, json value) {
            use(name);
            j["extensions"][name] = std::move(value);
        };
        if (float const strength = max_component(m.emission); strength > 0) {
            j["emissiveFactor"] = to_json(strength > 1 ? m.emission / strength : m.emission);
            if (strength > 1) extend("KHR_materials_emissive_strength", {{"emissiveStrength", strength}});
        }
        if (m.unlit) extend("KHR_materials_unlit", json::object());
        if (m.specular != 1 || m.specular_color != vec3{1} || m.specular_map.texture >= 0 ||
            m.specular_color_map.texture >= 0) {
            json s{{"specularFactor", m.specular}, {"specularColorFactor", to_json(m.specular_color)}};
            if (m.specular_map.texture >= 0) s["specularTexture"] = texture_info(m.specular_map);
            if (m.specular_color_map.texture >= 0) s["specularColorTexture"] = texture_info(m.specular_color_map);
            extend("KHR_materials_specular", std::move(s));
        }
        if (m.ior != 1.5f) extend("KHR_materials_ior", {{"ior", m.ior}});
        if (m.transmission > 0) {
            json t{{"transmissionFactor", m.transmission}};
            if (m.transmission_map.texture >= 0) t["transmissionTexture"] = texture_info(m.transmission_map);
            extend("KHR_materials_transmission", std::move(t));
        }
        if (!m.thin) {
            json v{{"thicknessFactor", 1.0}};
            if (m.absorption != vec3{0}) {
                float const distance_m = 1 / max_component(m.absorption);
                v["attenuationDistance"] = distance_m;
                v["attenuationColor"] = to_json(glm::exp(-distance_m * m.absorption));
            }
            extend("KHR_materials_volume", std::move(v));
        }
        if (m.model == MaterialModel::phong)
            j["extras"]["lightwell_phong"] = {{"specular", to_json(m.phong_specular)},
                                              {"exponent", m.phong_exponent}};
    }

    json primitive(Mesh const& m)
    {
        json p;
        json& a = p["attributes"];
        a["POSITION"] = add_positions(m.positions);
        if (!m.normals.empty()) a["NORMAL"] = add_floats(m.normals, "VEC3");
        if (!m.tangents.empty()) a["TANGENT"] = add_floats(m.tangents, "VEC4");
        if (!m.uv0.empty()) a["TEXCOORD_0"] = add_floats(m.uv0, "VEC2");
        if (!m.uv1.empty()) a["TEXCOORD_1"] = add_floats(m.uv1, "VEC2");
        if (!m.alphas.empty()) {
            std::vector<vec4> colors;
            for (std::size_t i = 0; i < m.alphas.size(); ++i)
                colors.emplace_back(m.colors.empty() ? vec3{1} : m.colors[i], m.alphas[i]);
            a["COLOR_0"] = add_floats(colors, "VEC4");
        } else if (!m.colors.empty()) {
            a["COLOR_0"] = add_floats(m.colors, "VEC3");
        }
        if (!m.joints.empty()) {
            a["JOINTS_0"] = add_accessor(m.joints.data(), m.joints.size(), m.joints.size() * 8, kUint16, "VEC4");
            a["WEIGHTS_0"] = add_floats(m.weights, "VEC4");
        }
        p["indices"] = add_accessor(m.triangles.data(), 3 * m.triangles.size(), m.triangles.size() * sizeof(uvec3),
                                    kUint32, "SCALAR");
        p["material"] = m.material >= 0 ? std::size_t(m.material) : scene_.materials.size();
        for (MorphTarget const& t : m.morph_targets) {
            json target = json::object();
            if (!t.positions.empty()) target["POSITION"] = add_positions(t.positions);
            if (!t.normals.empty()) target["NORMAL"] = add_floats(t.normals, "VEC3");
            if (!t.tangents.empty()) target["TANGENT"] = add_floats(t.tangents, "VEC3");
            p["targets"].push_back(std::move(target));
        }
        return p;
    }
    /// A glTF mesh contains all meshes of a node; nodes with the same meshes share it.
    void add_meshes()
    {
        std::vector<json> primitives(scene_.meshes.size());
        for (Node const& node : scene_.nodes) {
            std::vector<std::int32_t> shown;
            for (std::int32_t const m : node.meshes)
                if (scene_.meshes[std::size_t(m)].triangles.empty())
                    report_.lose("meshes without triangles not written", 1, scene_.meshes[std::size_t(m)].name);
                else
                    shown.push_back(m);
            if (shown.empty() || mesh_of_.contains(node.meshes)) continue;
            json mesh{{"name", scene_.meshes[std::size_t(shown.front())].name}};
            for (std::int32_t const m : shown) {
                if (primitives[std::size_t(m)].is_null())
                    primitives[std::size_t(m)] = primitive(scene_.meshes[std::size_t(m)]);
                mesh["primitives"].push_back(primitives[std::size_t(m)]);
            }
            mesh_of_[node.meshes] = int(root_["meshes"].size());
            root_["meshes"].push_back(std::move(mesh));
        }
    }

    void add_nodes()
    {
        json roots = json::array();
        for (std::size_t i = 0; i < scene_.nodes.size(); ++i) {
            Node const& n = scene_.nodes[i];
            json j{{"name", n.name}};
            if (n.matrix) {
                for (int c = 0; c < 4; ++c)
                    for (int r = 0; r < 4; ++r) j["matrix"].push_back((*n.matrix)[c][r]);
            } else {
                if (n.translation != dvec3{0})
                    j["translation"] = {n.translation.x, n.translation.y, n.translation.z};
                if (n.rotation != dquat(1, 0, 0, 0))
                    j["rotation"] = {n.rotation.x, n.rotation.y, n.rotation.z, n.rotation.w};
                if (n.scale != dvec3{1}) j["scale"] = {n.scale.x, n.scale.y, n.scale.z};
            }
            if (auto const it = mesh_of_.find(n.meshes); it != mesh_of_.end()) j["mesh"] = it->second;
            if (n.skin >= 0 && j.contains("mesh")) j["skin"] = n.skin;
            if (n.camera >= 0) j["camera"] = add_camera(scene_.cameras[std::size_t(n.camera)]);
            if (n.light >= 0)
                j["extensions"]["KHR_lights_punctual"]["light"] = add_light(scene_.lights[std::size_t(n.light)]);
            if (!n.morph_weights.empty() && j.contains("mesh")) j["weights"] = n.morph_weights;
            root_["nodes"].push_back(std::move(j));
            if (n.parent >= 0)
                root_["nodes"][std::size_t(n.parent)]["children"].push_back(i);
            else
                roots.push_back(i);
        }
        root_["scenes"] = {{{"nodes", roots}}};
        root_["scene"] = 0;
    }
    int add_camera(Camera const& c)
    {
        json j;
        if (c.orthographic) {
            j = {{"type", "orthographic"},
                 {"orthographic",
                  {{"xmag", c.ymag_m * (c.aspect > 0 ? c.aspect : 1)},
                   {"ymag", c.ymag_m},
                   {"znear", 0.0},
                   {"zfar", 1e4}}}};
        } else {
            j = {{"type", "perspective"}, {"perspective", {{"yfov", c.yfov_rad}, {"znear", 0.01}}}};
            if (c.aspect > 0) j["perspective"]["aspectRatio"] = c.aspect;
        }
        root_["cameras"].push_back(std::move(j));
        return int(root_["cameras"].size()) - 1;
    }
    int add_light(Light const& l)
    {
        use("KHR_lights_punctual");
        static constexpr std::array kTypes{"point", "spot", "directional"};
        float const intensity = max_component(l.intensity);
        json j{{"type", kTypes[std::size_t(l.type)]},
               {"intensity", intensity},
               {"color", to_json(intensity > 0 ? l.intensity / intensity : vec3{1})}};
        if (l.range > 0 && l.type != LightType::directional) j["range"] = l.range;
        if (l.type == LightType::spot)
            j["spot"] = {{"innerConeAngle", std::acos(l.cos_inner)}, {"outerConeAngle", std::acos(l.cos_outer)}};
        json& lights = root_["extensions"]["KHR_lights_punctual"]["lights"];
        lights.push_back(std::move(j));
        return int(lights.size()) - 1;
    }

    void add_skins()
    {
        for (Skin const& s : scene_.skins)
            root_["skins"].push_back(
                {{"joints", s.joints}, {"inverseBindMatrices", add_floats(s.inverse_bind, "MAT4")}});
    }
    void add_animations()
    {
        static constexpr std::array kPaths{"translation", "rotation", "scale", "weights"};
        static constexpr std::array kInterpolations{"STEP", "LINEAR", "CUBICSPLINE"};
        // The playing clip comes first, because readers play the first one.
        std::vector<std::size_t> order(scene_.animations.size());
        for (std::size_t i = 0; i < order.size(); ++i) order[i] = i;
        if (!scene_.playbacks.empty())
            std::stable_partition(order.begin(), order.end(), [&](std::size_t i) {
                return std::int32_t(i) == scene_.playbacks.front().animation;
            });
        for (std::size_t const i : order) {
            Animation const& a = scene_.animations[i];
            json j{{"name", a.name}};
            for (AnimationChannel const& channel : a.channels) {
                AnimationChannel const c = as_gltf(channel);
                int const input = add_floats(c.times_s, "SCALAR");
                root_["accessors"].back()["min"] = {c.times_s.front()};
                root_["accessors"].back()["max"] = {c.times_s.back()};
                std::size_t const components = c.path == ChannelPath::rotation        ? 4
                                               : c.path == ChannelPath::morph_weights ? 1
                                                                                      : 3;
                char const* const type = components == 4 ? "VEC4" : components == 3 ? "VEC3" : "SCALAR";
                int const output = add_accessor(c.values.data(), c.values.size() / components,
                                                c.values.size() * sizeof(float), kFloat, type);
                j["samplers"].push_back({{"input", input},
                                         {"output", output},
                                         {"interpolation", kInterpolations[std::size_t(c.interpolation)]}});
                j["channels"].push_back({{"sampler", j["samplers"].size() - 1},
                                         {"target", {{"node", c.node}, {"path", kPaths[std::size_t(c.path)]}}}});
            }
            if (j.contains("channels")) root_["animations"].push_back(std::move(j));
        }
    }

    /// Converts frame numbers to weights of every morph target, because glTF has only weights.
    AnimationChannel as_gltf(AnimationChannel const& channel) const
    {
        if (channel.path != ChannelPath::morph_frame) return channel;
        AnimationChannel out = channel;
        out.path = ChannelPath::morph_weights;
        out.values.clear();
        for (float const frame : channel.values) {
            std::vector<double> weights(scene_.nodes[std::size_t(channel.node)].morph_weights.size());
            add_frame(double(frame), 1, weights);
            for (double const w : weights) out.values.push_back(float(w));
        }
        return out;
    }

    Scene const& scene_;
    Report& report_;
    json root_;
    std::vector<unsigned char> binary_;
    std::set<std::string> used_;
    std::map<std::vector<std::int32_t>, int> mesh_of_;
};

std::string sky_yaml(EnvironmentMap const& map, std::string const& glb, std::string const& sky)
{
    return fmt::format(
        "{}\nmodels:\n  - file: \"{}\"\nenvironment:\n  file: \"{}\"\n  rotate: {}\n  scale: [{}, {}, {}]\n",
        kBundleMark, glb, sky, glm::degrees(map.rotation_rad), map.scale.x, map.scale.y, map.scale.z);
}

} // namespace

void write_glb(std::filesystem::path const& file, Scene const& scene, Report& report)
{
    if (scene.environment) report.lose("environment maps that GLB cannot hold", 1, file.string());
    GlbWriter(scene, report).write(file);
}

std::vector<std::filesystem::path> scene_bundle_files(std::filesystem::path const& glb, Scene const& scene)
{
    if (!scene.environment) return {glb};
    std::string const stem = (glb.parent_path() / glb.stem()).string();
    return {glb, stem + "_sky.exr", stem + ".yaml"};
}

std::vector<std::filesystem::path> write_scene_bundle(std::filesystem::path const& glb, Scene const& scene,
                                                      Report& report)
{
    auto const files = scene_bundle_files(glb, scene);
    GlbWriter(scene, report).write(glb);
    if (!scene.environment) return files;
    EnvironmentMap const& map = *scene.environment;
    Picture picture;
    picture.width = int(map.width);
    picture.height = int(map.height);
    Layer& layer = picture.add("color", 3);
    for (std::size_t i = 0; i < map.radiance.size(); ++i)
        for (int c = 0; c < 3; ++c) layer.data[3 * i + std::size_t(c)] = map.radiance[i][c];
    write_exr(files[1], picture, PixelType::single, report);
    write_text(files[2], sky_yaml(map, glb.filename().string(), files[1].filename().string()));
    return files;
}

} // namespace gi
