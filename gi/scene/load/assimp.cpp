// Reads OBJ, PLY, STL, FBX, COLLADA, ... with Assimp. Every file is first imported in a child process with limits
// (assimp_trial.h); this process reads it only if that succeeds.

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/scene/load/assimp_convert.h"
#include "gi/scene/load/assimp_import.h"
#include "gi/scene/load/assimp_reader.h"
#include "gi/scene/load/assimp_trial.h"
#include "gi/scene/load/load.h"
#include "gi/scene/load/mesh_frames.h"

namespace gi {

ImportedFiles import_assimp(std::filesystem::path const& file, AssimpFaces faces,
                            std::function<void(aiScene const&)> const& use)
{
    if (regular_file_bytes(file) == 0)
        throw InputError("'" + file.string() + "' is empty", "there is nothing to load",
                         "was it copied or exported to its end? take it from where it came from");
    std::optional<std::string> tried = AssimpTrials::known_outcome(file, faces);
    if (!tried) tried = AssimpTrials({file}, faces).outcome(file, faces);
    AssimpReader reader;
    std::string const why = !tried->empty() ? *tried : reader.read(file, faces);
    if (!why.empty())
        throw InputError(
            "'" + file.string() + "' cannot be read", why,
            Assimp::Importer().IsExtensionSupported(file.extension().string())
                ? "correct that place, or open it in Blender and export glTF (.glb), which is checked best"
                : "give glTF, YAML, OBJ, PLY, FBX or another format that Assimp supports");
    use(reader.scene());
    return reader.files();
}

std::vector<std::string> assimp_extensions()
{
    std::string list; // "*.3d;*.3ds;..."
    Assimp::Importer().GetExtensionList(list);
    std::vector<std::string> all;
    for (std::size_t at = 0; at < list.size();) {
        std::size_t const end = std::min(list.find(';', at), list.size());
        if (end > at + 1) all.push_back(list.substr(at + 1, end - at - 1));
        at = end + 1;
    }
    return all;
}

dvec3 near_origin(dvec3 first_m)
{
    constexpr double kFar_m = 1 << 14, kFarthest_m = 1e15;
    dvec3 origin_m{0};
    bool is_far = false;
    for (int i = 0; i < 3; ++i) {
        if (!(std::abs(first_m[i]) < kFarthest_m)) return dvec3(0);
        origin_m[i] = std::floor(first_m[i]);
        is_far |= std::abs(first_m[i]) > kFar_m;
    }
    return is_far ? origin_m : dvec3(0);
}

void ImportedFiles::lose(std::string const& what, std::uint64_t count, std::string const& where)
{
    if (count == 0) return;
    Report::Loss& loss = losses[what];
    if (loss.count == 0) loss.first = where;
    loss.count += count;
}

void ImportedFiles::pass_on_losses(Report& report) const
{
    for (auto const& [what, loss] : losses) report.lose(what, loss.count, loss.first);
}

Scene load_assimp(std::filesystem::path const& file, Report& report)
{
    Scene scene;
    bool is_joined = false;
    ImportedFiles const files = import_assimp(file, AssimpFaces::merged, [&](aiScene const& source) {
        scene = convert_assimp(source, file, report);
        is_joined = can_be_joined(source);
    });
    scene.files.insert(scene.files.end(), files.opened.begin(), files.opened.end());
    files.pass_on_losses(report);
    if (files.origin_m != dvec3(0))
        for (Node& node : scene.nodes)
            if (node.parent < 0)
                node.matrix = glm::translate(dmat4(1), files.origin_m) * node.matrix.value_or(dmat4(1));
    if (!is_joined)
        for (Mesh& mesh : scene.meshes) join_equal_vertices(mesh);
    return scene;
}

} // namespace gi
