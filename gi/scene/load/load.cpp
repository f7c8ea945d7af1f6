#include "gi/scene/load/load.h"

#include "gi/core/edit_distance.h"
#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/scene/generate/generate.h"
#include "gi/scene/load/assimp_import.h"

#include <algorithm>

namespace gi {

namespace {

struct BuiltIn {
    char const* name;
    Scene (*make)();
};
enum class Reader : std::uint8_t { gltf, scene_file, mesh_sequence, assimp };

Reader reader_of(std::filesystem::path const& file)
{
    std::error_code error;
    if (std::filesystem::is_directory(file, error) || file.filename() == "sequence.json")
        return Reader::mesh_sequence;
    std::string const extension = lower_extension(file);
    if (extension == ".gltf" || extension == ".glb") return Reader::gltf;
    return extension == ".yaml" || extension == ".yml" ? Reader::scene_file : Reader::assimp;
}

constexpr BuiltIn kBuiltIn[]{{"atrium", [] { return generate_atrium({}); }},
                             {"cornell", [] { return generate_cornell(); }},
                             {"mirror", [] { return generate_mirror(); }},
                             {"ring", [] { return generate_ring(); }},
                             {"avatar", [] { return generate_avatar(); }}};

} // namespace

std::vector<std::string> built_in_scenes()
{
    std::vector<std::string> names;
    for (BuiltIn const& b : kBuiltIn) names.emplace_back(b.name);
    return names;
}

std::vector<std::string> scene_extensions()
{
    std::vector<std::string> all{".gltf", ".glb", ".yaml", ".yml"};
    for (std::string const& e : assimp_extensions())
        if (std::ranges::find(all, e) == all.end()) all.push_back(e);
    return all;
}

namespace {

/// Meshes whose material has a texture for which they have no coordinates.
void report_missing_coordinates(Scene const& scene, Report& report)
{
    for (Mesh const& mesh : scene.meshes) {
        if (mesh.material < 0 || mesh.triangles.empty()) continue;
        Material const& m = scene.materials[std::size_t(mesh.material)];
        for (TextureRef const* const map :
             {&m.base_color_map, &m.metallic_roughness_map, &m.normal_map, &m.emissive_map, &m.specular_map,
              &m.specular_color_map, &m.transmission_map})
            if (map->texture >= 0 && (map->uv_set == 0 ? mesh.uv0 : mesh.uv1).empty()) {
                report.lose("meshes with textures but without coordinates for them: one colour is shown", 1,
                            mesh.name);
                break;
            }
    }
}

Scene read_scene(std::string const& file_or_name, Report& report)
{
    std::filesystem::path const file = file_or_name;
    std::error_code error;
    if (!std::filesystem::exists(file, error)) {
        for (BuiltIn const& b : kBuiltIn)
            if (file_or_name == b.name) return b.make();
        bool const is_word = file_or_name.find_first_of("./") == file_or_name.npos;
        std::string names;
        for (BuiltIn const& b : kBuiltIn) names += (names.empty() ? "" : ", ") + std::string(b.name);
        throw InputError(
            "there is no scene '" + file_or_name + "'", "no such file, and no built-in scene of that name",
            suggest(is_word ? file_or_name : "", built_in_scenes(),
                    "give a glTF, YAML, OBJ, PLY, FBX, ... file, a folder of frames, or one of: " + names));
    }
    switch (reader_of(file)) {
    case Reader::gltf:
        return load_gltf(file, report);
    case Reader::scene_file:
        return load_scene_file(file, report);
    case Reader::mesh_sequence:
        if (std::filesystem::is_directory(file, error)) return load_mesh_sequence(file, report);
        return load_mesh_sequence(file.has_parent_path() ? file.parent_path() : ".", report);
    case Reader::assimp:
        break;
    }
    return load_assimp(file, report);
}

} // namespace

Scene load_scene(std::string const& file_or_name, Report& report)
{
    Scene scene = read_scene(file_or_name, report);
    report_missing_coordinates(scene, report);
    return scene;
}

bool is_read_by_assimp(std::filesystem::path const& file) { return reader_of(file) == Reader::assimp; }

} // namespace gi
