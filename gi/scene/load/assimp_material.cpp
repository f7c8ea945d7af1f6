#include "gi/scene/load/assimp_parts.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/core/step.h"
#include "gi/scene/load/load.h"

#include <algorithm>
#include <assimp/material.h>
#include <fmt/format.h>
#include <map>
#include <opencv2/core/mat.hpp>
#include <opencv2/imgcodecs.hpp>

namespace gi {
namespace {

class Materials {
public:
    Materials(aiScene const& source, std::filesystem::path const& folder, Scene& scene, Report& report)
        : source_(source), folder_(folder), scene_(scene), report_(report)
    {
    }

    void add(aiMaterial const& source)
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
        source.Get(kTextureStrength, aiTextureType_NORMALS, 0, m.normal_scale);
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
        count_other_maps(source);
        scene_.materials.push_back(m);
        scene_.material_names.push_back(name.C_Str());
    }

private:
    void count_other_maps(aiMaterial const& source)
    {
        constexpr aiTextureType kRead[] = {aiTextureType_DIFFUSE, aiTextureType_BASE_COLOR, aiTextureType_EMISSIVE,
                                           aiTextureType_NORMALS, aiTextureType_OPACITY};
        for (int type = aiTextureType_NONE + 1; type <= AI_TEXTURE_TYPE_MAX; ++type)
            if (std::find(std::begin(kRead), std::end(kRead), aiTextureType(type)) == std::end(kRead))
                report_.lose("texture maps other than diffuse, emissive, normal and opacity, ignored",
                             source.GetTextureCount(aiTextureType(type)), where_);
    }
    /// Illumination models of MTL for ray tracing: 5 reflects, 6 and 7 also refract.
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
            cv::imencode(".png", pixels, png); // aiTexel is BGRA, as OpenCV expects
            return png;
        }
        std::replace(path.begin(), path.end(), '\\', '/');
        std::filesystem::path file = path;
        if (file.is_absolute() || !std::filesystem::exists(folder_ / file)) file = file.filename();
        name = (folder_ / file).string();
        std::vector<unsigned char> bytes = read_bytes(folder_ / file);
        scene_.files.push_back(name);
        return bytes;
    }
    /// @return an index into the pool; -1 if the picture cannot be read
    std::int32_t picture(std::string const& path, bool srgb, Wrap u, Wrap v)
    {
        std::vector<Texture>& all = scene_.textures.textures;
        auto [it, fresh] = textures_.try_emplace({path, srgb}, -1);
        if (fresh) at_step("textures decoded", textures_.size() - 1);
        if (fresh) try {
                std::string name;
                std::vector<unsigned char> const bytes = texture_bytes(path, name);
                it->second = add_texture(scene_.textures, bytes.data(), bytes.size(), srgb, name);
                all.back().wrap_u = u;
                all.back().wrap_v = v;
            } catch (InputError const& e) {
                report_.lose("textures that could not be read", 1, e.what());
            }
        if (it->second < 0) return -1;
        Texture wanted = all[std::size_t(it->second)]; // one that repeats otherwise shares its texels
        wanted.wrap_u = u;
        wanted.wrap_v = v;
        auto const found = std::ranges::find_if(all, [&](Texture const& t) {
            return t.first == wanted.first && t.srgb == srgb && t.wrap_u == u && t.wrap_v == v;
        });
        if (found != all.end()) return std::int32_t(found - all.begin());
        all.push_back(wanted);
        return std::int32_t(all.size()) - 1;
    }

    Wrap wrap_of(aiTextureMapMode mode)
    {
        if (mode == aiTextureMapMode_Decal)
            report_.lose("textures that are to end at their edge: it goes on", 1, where_);
        return mode == aiTextureMapMode_Mirror ? Wrap::mirror
               : mode == aiTextureMapMode_Wrap ? Wrap::repeat
                                               : Wrap::clamp;
    }

    TextureRef texture(aiMaterial const& source, aiTextureType type, bool srgb)
    {
        TextureRef ref;
        aiString path;
        unsigned uv_set = 0;
        aiTextureMapping mapping = aiTextureMapping_UV;
        aiTextureMapMode modes[3]{aiTextureMapMode_Wrap, aiTextureMapMode_Wrap, aiTextureMapMode_Wrap};
        if (source.GetTexture(type, 0, &path, &mapping, &uv_set, nullptr, nullptr, modes) != AI_SUCCESS)
            return ref;
        if (source.GetTextureCount(type) > 1)
            report_.lose("texture maps after the first of their kind, ignored", source.GetTextureCount(type) - 1,
                         where_);
        if (mapping != aiTextureMapping_UV)
            report_.lose("textures without texture coordinates (on spheres, boxes, ...): by those of the mesh", 1,
                         where_);
        ref.texture = picture(path.C_Str(), srgb, wrap_of(modes[0]), wrap_of(modes[1]));
        ref.uv_set = uv_set == 1 ? 1 : 0;
        if (aiUVTransform t; source.Get(AI_MATKEY_UVTRANSFORM(type, 0), t) == AI_SUCCESS) place(ref, t);
        return ref;
    }

    /// Assimp's transform for our v downwards. It has v upwards and is, as documented, scaled, then turned
    /// counter-clockwise about (0.5, 0.5), then moved (TextureTransform.cpp, aiUVTransform in material.h). Assimp's own
    /// step, which is not used here, turns about (0, 0) and multiplies in the reverse order.
    void place(TextureRef& ref, aiUVTransform const& t)
    {
        float const c = std::cos(t.mRotation), s = std::sin(t.mRotation);
        vec2 const row_u{c * t.mScaling.x, -s * t.mScaling.y}, row_v{s * t.mScaling.x, c * t.mScaling.y};
        vec2 const center{0.5f * (1 - c + s), 0.5f * (1 - s - c)}; // moves the centre of the turn back
        vec2 const offset = vec2{t.mTranslation.x, t.mTranslation.y} + center;
        if (!all_finite(vec3{row_u, offset.x}) || !all_finite(vec3{row_v, offset.y})) {
            report_.lose("textures placed by numbers that are not finite, placed as they are", 1, where_);
            return;
        }
        // With w = 1 - v: u' = row_u . (u, 1 - w) + offset.x, w' = 1 - v'.
        ref.row_u = {row_u.x, -row_u.y};
        ref.row_v = {-row_v.x, row_v.y};
        ref.offset = {offset.x + row_u.y, 1 - offset.y - row_v.y};
    }

    static unsigned char channel_of(Rgba8 c, int channel)
    {
        switch (channel) {
        case 'r':
            return c.r;
        case 'g':
            return c.g;
        case 'b':
            return c.b;
        case 'm':
            return c.a;
        default: // luminance by Rec. 709
            return static_cast<unsigned char>(0.2126f * float(c.r) + 0.7152f * float(c.g) + 0.0722f * float(c.b) +
                                              0.5f);
        }
    }

    /// Stores the brightness of an opacity map in the alpha of the base colour.
    void add_mask(aiMaterial const& source, Material& m)
    {
        TextureRef const mask = texture(source, aiTextureType_OPACITY, false);
        if (mask.texture < 0) return;
        TexturePool& pool = scene_.textures;
        Texture combined = pool.textures[std::size_t(mask.texture)];
        Texture const from = combined;
        bool const has_color = m.base_color_map.texture >= 0;
        Texture const color = has_color ? pool.textures[std::size_t(m.base_color_map.texture)] : Texture{};
        int channel = 0;
        source.Get(kTextureChannel, aiTextureType_OPACITY, 0, channel);
        if (has_color && is_same_picture(source) && (channel == 'm' || (channel == 0 && has_alpha(from)))) return;
        TextureRef placed = mask;
        placed.texture = m.base_color_map.texture;
        if (has_color &&
            (placed != m.base_color_map || color.wrap_u != from.wrap_u || color.wrap_v != from.wrap_v))
            report_.lose("opacity maps placed otherwise than their colour maps: placed as these", 1, where_);
        if (has_color) {
            placed = m.base_color_map;
            combined.wrap_u = color.wrap_u;
            combined.wrap_v = color.wrap_v;
        }
        combined.first = pool.texels.size();
        combined.srgb = true;
        for (std::uint32_t y = 0; y < from.height; ++y)
            for (std::uint32_t x = 0; x < from.width; ++x) {
                Rgba8 const m_texel = pool.texels[from.first + std::uint64_t(y) * from.width + x];
                Rgba8 texel{255, 255, 255, channel_of(m_texel, channel)};
                if (has_color) {
                    std::uint64_t const cx = std::uint64_t(x) * color.width / from.width,
                                        cy = std::uint64_t(y) * color.height / from.height;
                    Rgba8 const c = pool.texels[color.first + cy * color.width + cx];
                    texel = {c.r, c.g, c.b, texel.a};
                }
                pool.texels.push_back(texel);
            }
        pool.textures.push_back(combined);
        m.base_color_map = placed;
        m.base_color_map.texture = std::int32_t(pool.textures.size()) - 1;
    }

    bool has_alpha(Texture const& t) const
    {
        Rgba8 const* const first = scene_.textures.texels.data() + t.first;
        return std::any_of(first, first + std::uint64_t(t.width) * t.height, [](Rgba8 c) { return c.a != 255; });
    }
    /// True if the colour map is the opacity map too, so that it has its alpha.
    static bool is_same_picture(aiMaterial const& source)
    {
        aiString mask, color;
        source.GetTexture(aiTextureType_OPACITY, 0, &mask);
        if (source.GetTexture(aiTextureType_DIFFUSE, 0, &color) != AI_SUCCESS)
            source.GetTexture(aiTextureType_BASE_COLOR, 0, &color);
        return mask == color;
    }

    aiScene const& source_;
    std::filesystem::path const& folder_;
    Scene& scene_;
    Report& report_;
    std::string where_;
    std::map<std::pair<std::string, bool>, std::int32_t> textures_;
};

} // namespace

void convert_materials(aiScene const& source, std::filesystem::path const& folder, Scene& scene, Report& report)
{
    Materials materials(source, folder, scene, report);
    for (unsigned i = 0; i < source.mNumMaterials; ++i) materials.add(*source.mMaterials[i]);
}

} // namespace gi
