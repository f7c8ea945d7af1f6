#include "gi/scene/load/obj/obj_materials.h"

#include "gi/core/text.h"
#include "gi/scene/load/obj/obj_text.h"

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

/// Red, green and blue; one number alone is all three. Spectra are skipped.
void read_color(aiMaterial& m, Key const& key, std::string_view values)
{
    std::array<float, 3> c{};
    std::size_t const n = leading_numbers(values, c);
    if (n == 1) c[1] = c[2] = c[0];
    if (n == 1 || n == 3) set(m, key, aiColor3D(c[0], c[1], c[2]));
}

void read_number(aiMaterial& m, Key const& key, std::string_view values)
{
    std::string_view rest = values;
    if (take_word(rest) == "-halo") values = rest;
    std::array<float, 1> n{};
    if (leading_numbers(values, n) == 1) set(m, key, key.word == "tr" ? 1 - n[0] : n[0]);
}

/// What is left behind options such as `-o 1 1 1 -clamp on`.
std::string_view without_options(std::string_view values)
{
    constexpr std::string_view kWords[]{"-blendu", "-blendv",  "-boost",  "-bm",  "-cc",
                                        "-clamp",  "-imfchan", "-texres", "-type"};
    constexpr std::string_view kUpToThreeNumbers[]{"-o", "-s", "-t", "-mm"};
    while (true) {
        std::string_view rest = values;
        std::string_view const word = take_word(rest);
        if (std::ranges::any_of(kWords, [&](auto option) { return equals_caseless(word, option); }))
            take_word(rest);
        else if (std::ranges::any_of(kUpToThreeNumbers,
                                     [&](auto option) { return equals_caseless(word, option); }))
            for (int k = 0; k < 3; ++k) {
                std::string_view after = rest;
                if (!parse_number<float>(take_word(after))) break;
                rest = after;
            }
        else
            return trimmed(values);
        values = rest;
    }
}

void read_line(aiMaterial& m, std::string_view word, std::string_view values)
{
    if (Key const* const color = find(kColors, word)) return read_color(m, *color, values);
    if (Key const* const number = find(kNumbers, word)) return read_number(m, *number, values);
    if (equals_caseless(word, "illum")) {
        if (auto const model = parse_number<int>(take_word(values)))
            m.AddProperty(&*model, 1, AI_MATKEY_OBJ_ILLUM);
    } else if (Map const* const map = find(kMaps, word)) {
        aiString const file{std::string(without_options(values))};
        if (file.length > 0) m.AddProperty(&file, AI_MATKEY_TEXTURE(map->type, 0));
    }
}

} // namespace

ObjMaterials::ObjMaterials() { index_of(AI_DEFAULT_MATERIAL_NAME); }
ObjMaterials::~ObjMaterials() = default;

unsigned ObjMaterials::index_of(std::string const& name)
{
    auto const [at, is_new] = by_name_.try_emplace(name, unsigned(all_.size()));
    if (is_new) all_.push_back(new_material(name));
    return at->second;
}

void ObjMaterials::read(std::string_view mtl)
{
    aiMaterial* current = nullptr;
    for (ObjLines lines(mtl); lines.next();) {
        std::string_view rest = lines.line();
        std::string_view const word = take_word(rest);
        if (equals_caseless(word, "newmtl")) {
            std::string const name{trimmed(rest)};
            current = all_[index_of(name.empty() ? AI_DEFAULT_MATERIAL_NAME : name)].get();
        } else if (current != nullptr) {
            read_line(*current, word, rest);
        }
    }
}

} // namespace gi
