#include "gi/scene/load/gltf/gltf_parts.h"

#include "gi/core/step.h"
#include "gi/scene/load/load.h"
#include "gi/scene/shading/bsdf.h"

#include <algorithm>
#include <cstring>
#include <fmt/format.h>
#include <tuple>

namespace gi {
namespace {

/// Reads values of a JSON object with defaults; a value of the wrong type counts as missing.
class Properties {
public:
    explicit Properties(tinygltf::Value const* object)
        : object_(object != nullptr && object->IsObject() ? object : nullptr)
    {
    }
    bool exist() const { return object_ != nullptr; }
    tinygltf::Value const* find(char const* key) const
    {
        return object_ != nullptr && object_->Has(key) ? &object_->Get(key) : nullptr;
    }
    double number(char const* key, double otherwise) const
    {
        tinygltf::Value const* const v = find(key);
        return v != nullptr && v->IsNumber() ? v->GetNumberAsDouble() : otherwise;
    }
    std::vector<double> numbers(char const* key, std::vector<double> otherwise) const
    {
        tinygltf::Value const* const v = find(key);
        if (v == nullptr || !v->IsArray() || v->ArrayLen() != otherwise.size()) return otherwise;
        for (std::size_t i = 0; i < otherwise.size(); ++i)
            if (v->Get(int(i)).IsNumber()) otherwise[i] = v->Get(int(i)).GetNumberAsDouble();
        return otherwise;
    }

private:
    tinygltf::Value const* object_;
};

tinygltf::Value const* find_extension(tinygltf::ExtensionMap const& map, char const* name)
{
    auto const it = map.find(name);
    return it == map.end() ? nullptr : &it->second;
}

/// True for the image formats allowed in glTF; OpenCV would read others, too.
bool is_image_of_gltf(Bytes b)
{
    auto const has = [&](std::size_t at, std::string_view magic) {
        return b.size() >= at + magic.size() && std::memcmp(b.data() + at, magic.data(), magic.size()) == 0;
    };
    return has(0, "\x89PNG") || has(0, "\xff\xd8\xff") || (has(0, "RIFF") && has(8, "WEBP"));
}

Wrap to_wrap(int mode)
{
    return mode == TINYGLTF_TEXTURE_WRAP_CLAMP_TO_EDGE     ? Wrap::clamp
           : mode == TINYGLTF_TEXTURE_WRAP_MIRRORED_REPEAT ? Wrap::mirror
                                                           : Wrap::repeat;
}

class MaterialReader {
public:
    MaterialReader(GltfDocument& d, Scene& scene, Report& report) : d_(d), scene_(scene), report_(report) {}

    Material read(tinygltf::Material const& source)
    {
        where_ = "material '" + source.name + "'";
        Material m;
        auto const& pbr = source.pbrMetallicRoughness;
        m.base_color = color(pbr.baseColorFactor, "baseColorFactor");
        m.alpha = pbr.baseColorFactor.size() == 4 ? within(pbr.baseColorFactor[3], 0, 1, "alpha") : 1;
        m.double_sided = source.doubleSided;
        m.alpha_mode = alpha_mode(source);
        if (m.alpha_mode == AlphaMode::mask) m.alpha_cutoff = within(source.alphaCutoff, 0, 1e6, "alphaCutoff");
        m.base_color_map = texture(pbr.baseColorTexture, true);
        if (find_extension(source.extensions, "KHR_materials_unlit") != nullptr) {
            make_unlit(m);
            return m;
        }
        m.metallic = within(pbr.metallicFactor, 0, 1, "metallicFactor");
        m.roughness = within(pbr.roughnessFactor, 0, 1, "roughnessFactor");
        m.metallic_roughness_map = texture(pbr.metallicRoughnessTexture, false);
        m.normal_map = texture(source.normalTexture, false);
        m.normal_scale = within(source.normalTexture.scale, -1e3, 1e3, "normal scale");
        m.emissive_map = texture(source.emissiveTexture, true);

        Properties const strength(find_extension(source.extensions, "KHR_materials_emissive_strength"));
        float const times = within(strength.number("emissiveStrength", 1), 0, 1e18, "emissiveStrength");
        for (int c = 0; c < 3 && source.emissiveFactor.size() == 3; ++c)
            m.emission[c] = times * within(source.emissiveFactor[std::size_t(c)], 0, 1e18, "emissiveFactor");

        Properties const ior(find_extension(source.extensions, "KHR_materials_ior"));
        double const index = ior.number("ior", 1.5);
        m.ior = index == 0 ? 1e6f : within(index, 1, 100, "ior"); // 0 means a reflectance of 1 (its README)
        Properties const specular(find_extension(source.extensions, "KHR_materials_specular"));
        m.specular = within(specular.number("specularFactor", 1), 0, 1, "specularFactor");
        auto const tint = specular.numbers("specularColorFactor", {1, 1, 1});
        for (int c = 0; c < 3; ++c)
            m.specular_color[c] = within(tint[std::size_t(c)], 0, 1e3, "specularColorFactor");
        m.specular_map = texture(specular.find("specularTexture"), false);
        m.specular_color_map = texture(specular.find("specularColorTexture"), true);
        Properties const transmission(find_extension(source.extensions, "KHR_materials_transmission"));
        m.transmission = within(transmission.number("transmissionFactor", 0), 0, 1, "transmissionFactor");
        m.transmission_map = texture(transmission.find("transmissionTexture"), false);
        Properties const volume(find_extension(source.extensions, "KHR_materials_volume"));
        m.thin = !(volume.number("thicknessFactor", 0) > 0);
        if (volume.find("attenuationDistance") != nullptr) {
            vec3 left;
            auto const given = volume.numbers("attenuationColor", {1, 1, 1});
            for (int c = 0; c < 3; ++c) left[c] = within(given[std::size_t(c)], 0, 1, "attenuationColor");
            m.absorption = absorption(
                left, within(volume.number("attenuationDistance", 0), 1e-9, 1e38, "attenuationDistance"));
        }
        if (m.transmission > 0 && m.roughness * m.roughness >= kSmoothAlpha)
            report_.lose("roughness of glass ignored", 1, where_);

        read_specular_glossiness(
            m, Properties(find_extension(source.extensions, "KHR_materials_pbrSpecularGlossiness")));
        read_phong(m, source.extras);
        return m;
    }

private:
    float within(double v, double low, double high, char const* what)
    {
        if (v >= low && v <= high) return float(v);
        report_.lose("material values clamped", 1, fmt::format("{} {}", where_, what));
        return v > high ? float(high) : float(low); // NaN becomes low
    }
    vec3 color(std::vector<double> const& v, char const* what)
    {
        if (v.size() < 3) return vec3{1};
        return {within(v[0], 0, 1, what), within(v[1], 0, 1, what), within(v[2], 0, 1, what)};
    }

    /// Only the base colour counts (KHR_materials_unlit): all else, emission too, is to be ignored.
    void make_unlit(Material& m)
    {
        m.unlit = true;
        m.specular = 0;
        report_.lose("unlit materials taken as diffuse", 1, where_);
    }

    /// KHR_materials_pbrSpecularGlossiness gives f0 directly, so it is converted to a specular colour.
    void read_specular_glossiness(Material& m, Properties const& p)
    {
        if (!p.exist()) return;
        report_.lose("specular-glossiness materials converted", 1, where_);
        m.base_color = color(p.numbers("diffuseFactor", {1, 1, 1, 1}), "diffuseFactor");
        m.alpha = within(p.numbers("diffuseFactor", {1, 1, 1, 1})[3], 0, 1, "alpha");
        m.base_color_map = texture(p.find("diffuseTexture"), true);
        m.metallic = 0;
        m.roughness = 1 - within(p.number("glossinessFactor", 1), 0, 1, "glossinessFactor");
        m.specular_color = color(p.numbers("specularFactor", {1, 1, 1}), "specularFactor") / 0.04f;
        m.specular_color_map = texture(p.find("specularGlossinessTexture"), true);
        if (m.specular_color_map.texture >= 0) report_.lose("glossiness of textures ignored", 1, where_);
        m.metallic_roughness_map = {};
    }

    /// Reads the Phong parameters that write_glb stores in extras, because glTF has no Phong model.
    static void read_phong(Material& m, tinygltf::Value const& extras)
    {
        if (!extras.IsObject() || !extras.Has("lightwell_phong")) return;
        Properties const phong(&extras.Get("lightwell_phong"));
        auto const specular = phong.numbers("specular", {0, 0, 0});
        m.model = MaterialModel::phong;
        for (int c = 0; c < 3; ++c) m.phong_specular[c] = float(std::clamp(specular[std::size_t(c)], 0.0, 1.0));
        m.phong_exponent = float(std::clamp(phong.number("exponent", 1), 0.0, 1e6));
    }

    template <class Info>
    TextureRef texture(Info const& info, bool srgb)
    {
        if (info.index < 0) return {};
        return make_ref(info.index, info.texCoord,
                        Properties(find_extension(info.extensions, "KHR_texture_transform")), srgb);
    }
    /// Same for a texture in an extension, which tinygltf leaves as JSON.
    TextureRef texture(tinygltf::Value const* info, bool srgb)
    {
        Properties const p(info);
        int const index = int(std::clamp(p.number("index", -1), -1.0, 1e9));
        if (index < 0) return {};
        Properties const extensions(p.find("extensions"));
        return make_ref(index, int(std::clamp(p.number("texCoord", 0), 0.0, 100.0)),
                        Properties(extensions.find("KHR_texture_transform")), srgb);
    }
    TextureRef make_ref(int index, int uv_set, Properties const& transform, bool srgb)
    {
        TextureRef ref;
        ref.texture = find_texture(index, srgb);
        if (ref.texture < 0) return ref;
        uv_set = int(std::clamp(transform.number("texCoord", uv_set), -1.0, 100.0));
        if (uv_set < 0 || uv_set > 1) {
            report_.lose("textures on a third set of coordinates use the first", 1, where_);
            uv_set = 0;
        }
        ref.uv_set = std::uint8_t(uv_set);
        auto const offset = transform.numbers("offset", {0, 0}), scale = transform.numbers("scale", {1, 1});
        double const angle = transform.number("rotation", 0), c = std::cos(angle), s = std::sin(angle);
        ref.row_u = {float(c * scale[0]), float(s * scale[1])};
        ref.row_v = {float(-s * scale[0]), float(c * scale[1])};
        ref.offset = {float(offset[0]), float(offset[1])};
        for (float const v : {ref.row_u.x, ref.row_u.y, ref.row_v.x, ref.row_v.y, ref.offset.x, ref.offset.y})
            if (!(std::abs(v) < 1e6f)) {
                report_.lose("texture transforms out of range ignored", 1, where_);
                return {ref.texture, ref.uv_set};
            }
        return ref;
    }

    /// Returns the texture's index in the pool; -1 = missing (counted).
    std::int32_t find_texture(int index, bool srgb)
    {
        if (std::size_t(index) >= d_.model.textures.size())
            throw d_.error(fmt::format("texture {} does not exist", index), where_ + " uses it");
        tinygltf::Texture const& t = d_.model.textures[std::size_t(index)];
        int source = t.source;
        if (source < 0)
            source = int(std::clamp(
                Properties(find_extension(t.extensions, "EXT_texture_webp")).number("source", -1), -1.0, 1e9));
        Texture sampling;
        if (t.sampler >= 0 && std::size_t(t.sampler) < d_.model.samplers.size()) {
            tinygltf::Sampler const& s = d_.model.samplers[std::size_t(t.sampler)];
            sampling.wrap_u = to_wrap(s.wrapS);
            sampling.wrap_v = to_wrap(s.wrapT);
            sampling.nearest = s.magFilter == TINYGLTF_TEXTURE_FILTER_NEAREST;
        }
        auto const key = std::tuple(source, sampling.wrap_u, sampling.wrap_v, sampling.nearest, srgb);
        if (auto const it = known_.find(key); it != known_.end()) return it->second;
        return known_[key] = load_texture(source, sampling, srgb);
    }
    std::int32_t load_texture(int source, Texture const& sampling, bool srgb)
    {
        if (source < 0 || std::size_t(source) >= d_.images.size()) {
            report_.lose("textures without an image", 1, where_);
            return -1;
        }
        GltfImage const& image = d_.images[std::size_t(source)];
        if (image.bytes.empty()) return -1; // already counted when the file was opened
        if (!is_image_of_gltf(image.bytes)) {
            report_.lose("textures that could not be read", 1, image.name + " is neither PNG, JPEG nor WebP");
            return -1;
        }
        // All textures of an image share its texels.
        if (auto const it = texels_of_.find(image.bytes.data()); it != texels_of_.end()) {
            Texture t = scene_.textures.textures[std::size_t(it->second)];
            t.wrap_u = sampling.wrap_u;
            t.wrap_v = sampling.wrap_v;
            t.nearest = sampling.nearest;
            t.srgb = srgb;
            scene_.textures.textures.push_back(t);
            return std::int32_t(scene_.textures.textures.size()) - 1;
        }
        at_step("textures decoded", texels_of_.size(), d_.images.size());
        try {
            std::int32_t const index =
                add_texture(scene_.textures, image.bytes.data(), image.bytes.size(), srgb, image.name);
            Texture& t = scene_.textures.textures[std::size_t(index)];
            t.wrap_u = sampling.wrap_u;
            t.wrap_v = sampling.wrap_v;
            t.nearest = sampling.nearest;
            texels_of_[image.bytes.data()] = index;
            return index;
        } catch (InputError const& e) {
            report_.lose("textures that could not be read", 1, e.what());
            return -1;
        }
    }

    GltfDocument& d_;
    Scene& scene_;
    Report& report_;
    std::string where_;
    std::map<std::tuple<int, Wrap, Wrap, bool, bool>, std::int32_t> known_;
    std::map<unsigned char const*, std::int32_t> texels_of_;
};

} // namespace

AlphaMode alpha_mode(tinygltf::Material const& material)
{
    return material.alphaMode == "MASK"    ? AlphaMode::mask
           : material.alphaMode == "BLEND" ? AlphaMode::blend
                                           : AlphaMode::opaque;
}

void read_materials(GltfDocument& document, Scene& scene, Report& report)
{
    MaterialReader reader(document, scene, report);
    for (std::size_t i = 0; i < document.model.materials.size(); ++i) {
        tinygltf::Material const& m = document.model.materials[i];
        scene.materials.push_back(reader.read(m));
        scene.material_names.push_back(m.name.empty() ? fmt::format("material {}", i) : m.name);
    }
}

} // namespace gi
