// Reads OBJ, PLY, STL, FBX, COLLADA, ... with Assimp. Every file is first imported in a child process with limits
// (assimp_trial.h); this process reads it only if that succeeds.

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/scene/load/assimp_convert.h"
#include "gi/scene/load/assimp_import.h"
#include "gi/scene/load/assimp_reader.h"
#include "gi/scene/load/assimp_trial.h"
#include "gi/scene/load/load.h"

#include <strings.h>

namespace gi {

ImportedFiles import_assimp(std::filesystem::path const& file, AssimpFaces faces,
                            std::function<void(aiScene const&)> const& use)
{
    if (regular_file_bytes(file) == 0)
        throw InputError("'" + file.string() + "' is empty", "there is nothing to load", "export it again");
    std::optional<std::string> tried = AssimpTrials::known_outcome(file, faces);
    if (!tried) tried = AssimpTrials({file}, faces).outcome(file, faces);
    AssimpReader reader;
    std::string const why = !tried->empty() ? *tried : reader.read(file, faces);
    if (!why.empty())
        throw InputError("'" + file.string() + "' cannot be read", why,
                         Assimp::Importer().IsExtensionSupported(file.extension().string())
                             ? "export it again"
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

void lose_material_libraries(std::filesystem::path const& file, ImportedFiles const& files, Report& report)
{
    if (files.missing.empty() || strcasecmp(file.extension().c_str(), ".obj") != 0) return;
    // For each missing library, Assimp also tries one with the OBJ file's own name.
    std::set<std::string> named = files.missing;
    if (named.size() > 1) named.erase(std::filesystem::path(file).replace_extension("mtl").string());
    report.lose("material libraries that could not be read", named.size(), *named.begin());
}

Scene load_assimp(std::filesystem::path const& file, Report& report)
{
    Scene scene;
    ImportedFiles const files = import_assimp(
        file, AssimpFaces::merged, [&](aiScene const& source) { scene = convert_assimp(source, file, report); });
    scene.files.insert(scene.files.end(), files.opened.begin(), files.opened.end());
    lose_material_libraries(file, files, report);
    return scene;
}

} // namespace gi
