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

#include <algorithm>

namespace gi {

namespace {

/// Formats of other programs that people ask for, in lower case.
struct ForeignFormat {
    char const *extension, *why, *suggestion;
};
constexpr char const* kSaveAsGltf = "save it as glTF (.glb), in Blender for example";
constexpr char const* kModelled = "save it as glTF (.glb) in the program in which it was modelled";
constexpr ForeignFormat kForeign[]{
    {".blend", "only Blender reads all of its own format", "save it as glTF in Blender: File, Export, glTF 2.0"},
    {".usd", "USD is not supported", kSaveAsGltf},
    {".usda", "USD is not supported", kSaveAsGltf},
    {".usdc", "USD is not supported", kSaveAsGltf},
    {".usdz", "USD is not supported", kSaveAsGltf},
    {".pbrt", "scenes of PBRT are not supported", kModelled}};

std::string what_else(std::string const& extension)
{
    if (extension == ".xml") return std::string("if it is a scene of Mitsuba or another renderer: ") + kModelled;
    return Assimp::Importer().IsExtensionSupported(extension)
               ? "correct that place, or open it in Blender and export glTF (.glb), which is checked best"
               : "give glTF, YAML, OBJ, PLY, FBX or another format that Assimp supports";
}

} // namespace

ImportedFiles import_assimp(std::filesystem::path const& file, AssimpFaces faces,
                            std::function<void(aiScene const&)> const& use)
{
    std::string const extension = lower_extension(file);
    auto const foreign = std::ranges::find(kForeign, extension, &ForeignFormat::extension);
    if (foreign != std::end(kForeign))
        throw InputError("'" + file.string() + "' cannot be read", foreign->why, foreign->suggestion);
    if (regular_file_bytes(file) == 0)
        throw InputError("'" + file.string() + "' is empty", "there is nothing to load",
                         "was it copied or exported to its end? take it from where it came from");
    std::optional<std::string> tried = AssimpTrials::known_outcome(file, faces);
    if (!tried) tried = AssimpTrials({file}, faces).outcome(file, faces);
    AssimpReader reader;
    std::string const why = !tried->empty() ? *tried : reader.read(file, faces);
    if (!why.empty()) throw InputError("'" + file.string() + "' cannot be read", why, what_else(extension));
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
        std::string const extension = end > at + 1 ? list.substr(at + 1, end - at - 1) : "";
        if (!extension.empty() &&
            std::ranges::find(kForeign, extension, &ForeignFormat::extension) == std::end(kForeign))
            all.push_back(extension);
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
