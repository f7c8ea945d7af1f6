#include "gi/scene/load/load.h"

#include "gi/core/error.h"
#include "gi/scene/generate/generate.h"

#include <algorithm>

namespace gi {

Scene load_scene(std::string const& file_or_name, Report& report)
{
    std::filesystem::path const file = file_or_name;
    std::error_code error;
    if (!std::filesystem::exists(file, error)) {
        if (file_or_name == "atrium") return generate_atrium({});
        if (file_or_name == "cornell") return generate_cornell();
        if (file_or_name == "mirror") return generate_mirror();
        if (file_or_name == "ring") return generate_ring();
        if (file_or_name == "avatar") return generate_avatar();
        throw InputError("there is no scene '" + file_or_name + "'",
                         "no such file, and no built-in scene of that name",
                         "give a glTF, YAML, OBJ, PLY, FBX, ... file, a folder of frames, or one of: atrium, "
                         "cornell, mirror, ring, avatar");
    }
    if (std::filesystem::is_directory(file, error)) return load_mesh_sequence(file, report);
    if (file.filename() == "sequence.json")
        return load_mesh_sequence(file.has_parent_path() ? file.parent_path() : ".", report);
    std::string extension = file.extension().string();
    std::transform(extension.begin(), extension.end(), extension.begin(),
                   [](unsigned char c) { return char(std::tolower(c)); });
    if (extension == ".gltf" || extension == ".glb") return load_gltf(file, report);
    if (extension == ".yaml" || extension == ".yml") return load_scene_file(file, report);
    return load_assimp(file, report);
}

} // namespace gi
