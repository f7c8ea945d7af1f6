#include "gi/scene/load/obj/obj_materials.h"

#include "gi/core/text.h"
#include "gi/scene/load/assimp_parts.h"
#include "gi/scene/load/obj/mtl_map.h"
#include "gi/scene/load/obj/obj_text.h"
#include "gi/scene/model/spectrum.h"

#include <array>
#include <assimp/ObjMaterial.h>
#include <assimp/material.h>

namespace gi {
namespace {

constexpr int kDiffuseIllumination = 1;

/// A property of Assimp's materials.
struct Key {
    std::string_view word;
    char const* key;
    unsigned type, index;
};
constexpr Key kColors[]{{"kd", AI_MATKEY_COLOR_DIFFUSE},
                        {"ks", AI_MATKEY_COLOR_SPECULAR},
                        {"ke", AI_MATKEY_COLOR_EMISSIVE},
                        {"tf", AI_MATKEY_COLOR_TRANSPARENT}};
constexpr Key kNumbers[]{{"ns", AI_MATKEY_SHININESS},        {"ni", AI_MATKEY_REFRACTI},
                         {"d", AI_MATKEY_OPACITY},           {"tr", AI_MATKEY_OPACITY},
                         {"pr", AI_MATKEY_ROUGHNESS_FACTOR}, {"pm", AI_MATKEY_METALLIC_FACTOR}};

struct Map {
    std::string_view word;
    aiTextureType type;
};
constexpr Map kMaps[]{{"map_kd", aiTextureType_DIFFUSE},        {"map_ka", aiTextureType_AMBIENT},
                      {"map_ks", aiTextureType_SPECULAR},       {"map_ke", aiTextureType_EMISSIVE},
                      {"map_emissive", aiTextureType_EMISSIVE}, {"map_d", aiTextureType_OPACITY},
                      {"map_bump", aiTextureType_HEIGHT},       {"bump", aiTextureType_HEIGHT},
                      {"map_kn", aiTextureType_NORMALS},        {"norm", aiTextureType_NORMALS},
                      {"refl", aiTextureType_REFLECTION},       {"map_refl", aiTextureType_REFLECTION},
                      {"map_disp", aiTextureType_DISPLACEMENT}, {"disp", aiTextureType_DISPLACEMENT},
                      {"map_ns", aiTextureType_SHININESS},      {"map_pr", aiTextureType_DIFFUSE_ROUGHNESS},
                      {"map_pm", aiTextureType_METALNESS},      {"map_ps", aiTextureType_SHEEN}};

constexpr Map kColorMaps[]{{"map_kd", aiTextureType_DIFFUSE},
                           {"map_ke", aiTextureType_EMISSIVE},
                           {"map_emissive", aiTextureType_EMISSIVE}};

/// Statements that change no picture of traced light.
struct Idle {
    std::string_view word;
};
constexpr Idle kWithoutEffect[]{{"ka"}, {"sharpness"}, {"map_aat"}};

template <class Entry, std::size_t n>
Entry const* find(Entry const (&table)[n], std::string_view word)
{
    for (Entry const& entry : table)
        if (equals_caseless(word, entry.word)) return &entry;
    return nullptr;
}

void set(aiMaterial& m, Key const& key, aiColor3D color)
{
    m.AddProperty(&color, 1, key.key, key.type, key.index);
}
void set(aiMaterial& m, Key const& key, float number) { m.AddProperty(&number, 1, key.key, key.type, key.index); }

std::unique_ptr<aiMaterial> new_material(std::string const& name)
{
    auto m = std::make_unique<aiMaterial>();
    aiString const text(name);
    m->AddProperty(&text, AI_MATKEY_NAME);
    set(*m, {"", AI_MATKEY_COLOR_DIFFUSE}, aiColor3D(0.6f, 0.6f, 0.6f));
    set(*m, {"", AI_MATKEY_COLOR_TRANSPARENT}, aiColor3D(1, 1, 1));
    set(*m, {"", AI_MATKEY_REFRACTI}, 1.0f);
    m->AddProperty(&kDiffuseIllumination, 1, AI_MATKEY_OBJ_ILLUM);
    return m;
}

/// Red, green and blue, or X, Y and Z behind "xyz"; one number alone is all three.
/// @return false if there are none, as of spectra
bool read_color(aiMaterial& m, Key const& key, std::string_view values)
{
    std::string_view behind = values;
    bool const is_xyz = equals_caseless(take_word(behind), "xyz");
    std::array<float, 3> c{};
    std::size_t const n = leading_numbers(is_xyz ? behind : values, c);
    if (n == 1) c[1] = c[2] = c[0];
    if (n != 1 && n != 3) return false;
    vec3 const read{c[0], c[1], c[2]}, rgb = is_xyz ? vec3(xyz_to_rec709(dvec3(read))) : read;
    set(m, key, aiColor3D(rgb.x, rgb.y, rgb.z));
    return true;
}

void read_number(aiMaterial& m, Key const& key, std::string_view values)
{
    std::string_view rest = values;
    if (take_word(rest) == "-halo") values = rest;
    std::array<float, 1> n{};
    if (leading_numbers(values, n) == 1) set(m, key, key.word == "tr" ? 1 - n[0] : n[0]);
}

/// Places a map as its options say. A map that was set before is replaced.
void read_map(aiMaterial& m, aiTextureType type, MtlMap const& map)
{
    aiString const file(map.file);
    m.AddProperty(&file, AI_MATKEY_TEXTURE(type, 0));
    for (char const* const key : {_AI_MATKEY_UVTRANSFORM_BASE, _AI_MATKEY_MAPPINGMODE_U_BASE,
                                  _AI_MATKEY_MAPPINGMODE_V_BASE, kTextureStrength, kTextureChannel})
        m.RemoveProperty(key, type, 0);
    aiUVTransform placed;
    placed.mScaling = {map.scale_u, map.scale_v};
    placed.mTranslation = {map.offset_u, map.offset_v};
    if (placed.mScaling != aiVector2D(1, 1) || placed.mTranslation != aiVector2D(0, 0))
        m.AddProperty(&placed, 1, AI_MATKEY_UVTRANSFORM(type, 0));
    if (int const mode = aiTextureMapMode_Clamp; map.clamped) {
        m.AddProperty(&mode, 1, AI_MATKEY_MAPPINGMODE_U(type, 0));
        m.AddProperty(&mode, 1, AI_MATKEY_MAPPINGMODE_V(type, 0));
    }
    if (type == aiTextureType_NORMALS && map.bump != 1) m.AddProperty(&map.bump, 1, kTextureStrength, type, 0);
    if (int const channel = map.channel; type == aiTextureType_OPACITY && channel != 0)
        m.AddProperty(&channel, 1, kTextureChannel, type, 0);
}

bool is_zero(std::string_view values)
{
    while (true) {
        std::string_view const word = take_word(values);
        if (word.empty() || word.starts_with('#')) return true;
        if (number_word(word).value_or(1) != 0) return false;
    }
}

} // namespace

ObjMaterials::ObjMaterials(ImportedFiles& notes) : notes_(notes)
{
    index_of(AI_DEFAULT_MATERIAL_NAME);
    defined_.insert(AI_DEFAULT_MATERIAL_NAME);
}
ObjMaterials::~ObjMaterials() = default;

unsigned ObjMaterials::index_of(std::string const& name)
{
    auto const [at, is_new] = by_name_.try_emplace(name, unsigned(all_.size()));
    if (is_new) all_.push_back(new_material(name));
    return at->second;
}

void ObjMaterials::read_line(aiMaterial& m, std::string_view word, std::string_view values,
                             std::string const& where)
{
    if (Key const* const color = find(kColors, word)) {
        if (!read_color(m, *color, values))
            notes_.lose("colours of MTL that are not three numbers, skipped", 1, where);
    } else if (Key const* const number = find(kNumbers, word)) {
        read_number(m, *number, values);
    } else if (equals_caseless(word, "illum")) {
        if (auto const model = parse_number<int>(take_word(values)))
            m.AddProperty(&*model, 1, AI_MATKEY_OBJ_ILLUM);
    } else if (Map const* const map = find(kMaps, word)) {
        MtlMap const read = read_mtl_map(values);
        if (read.file.empty()) return notes_.lose("texture maps without a file, skipped", 1, where);
        read_map(m, map->type, read);
        bool const is_scalar = map->type == aiTextureType_OPACITY;
        std::vector<std::string> dropped = read.dropped;
        if (read.bump != 1 && (find(kColorMaps, word) != nullptr || is_scalar)) dropped.push_back("-bm");
        if (read.channel != 0 && !(is_scalar && read.channel != 'z'))
            dropped.push_back(std::string("-imfchan ") + read.channel);
        for (std::string const& option : dropped)
            notes_.lose("options of texture maps without an equivalent, dropped", 1,
                        where + " " + shortened(option, 60));
    } else if (!find(kWithoutEffect, word) && !is_zero(values)) {
        notes_.lose("statements of MTL without an equivalent, skipped", 1, where);
    }
}

void ObjMaterials::read(std::string_view mtl, std::string const& file)
{
    aiMaterial* current = nullptr;
    bool is_before_first = true;
    std::set<std::string> here;
    for (ObjLines lines(mtl); lines.next();) {
        std::string_view rest = lines.line();
        std::string_view const word = take_word(rest);
        if (word.empty() || word.starts_with('#')) continue;
        std::string const where =
            file + ":" + std::to_string(lines.number()) + ": " + shortened(std::string(word), 60);
        if (equals_caseless(word, "newmtl")) {
            is_before_first = false;
            std::string name{trimmed(rest)};
            if (name.empty()) name = AI_DEFAULT_MATERIAL_NAME;
            bool const is_known = defined_.contains(name) && name != AI_DEFAULT_MATERIAL_NAME;
            current = is_known ? nullptr : all_[index_of(name)].get();
            here.insert(name);
            if (is_known)
                notes_.lose("materials of a library that an earlier one has: the first is taken", 1,
                            where + " " + shortened(name, 60));
        } else if (current != nullptr) {
            read_line(*current, word, rest, where);
        } else if (is_before_first) {
            notes_.lose("statements of MTL before the first material, skipped", 1, where);
        }
    }
    defined_.merge(here);
}

std::vector<std::unique_ptr<aiMaterial>> ObjMaterials::take()
{
    for (auto const& [name, index] : by_name_)
        if (!defined_.contains(name))
            notes_.lose("materials that no library has, taken as grey", 1, shortened(name, 60));
    return std::move(all_);
}

} // namespace gi
