// Reads OBJ, PLY, STL, FBX, COLLADA, ... with Assimp. Some damaged files make Assimp itself crash or hang, so
// every file is first imported in a child process with resource limits; this process reads it only if that
// succeeds.

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "gi/scene/load/assimp_convert.h"
#include "gi/scene/load/assimp_import.h"
#include "gi/scene/load/child_process.h"
#include "gi/scene/load/load.h"

#include <assimp/DefaultIOSystem.h>
#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <csignal>
#include <fcntl.h>
#include <fmt/format.h>
#include <fstream>
#include <new>
#include <optional>
#include <strings.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gi {
namespace {

constexpr rlim_t kProbeSeconds = 60;
constexpr int kAttempts = 2; ///< because the first may stall on a lock, see run_child
constexpr rlim_t kProbeBytes = rlim_t(1) << 30,
                 kProbeBytesPerByte = 64; ///< memory limit: a constant plus a multiple of the file size

/// Records which files an import opens or fails to open.
class NotingFiles : public Assimp::DefaultIOSystem {
public:
    explicit NotingFiles(ImportedFiles& files) : files_(files) {}

    Assimp::IOStream* Open(char const* file, char const* mode) override
    {
        Assimp::IOStream* const stream = DefaultIOSystem::Open(file, mode);
        (stream != nullptr ? files_.opened : files_.missing).insert(file);
        return stream;
    }

private:
    ImportedFiles& files_;
};

unsigned steps(AssimpFaces faces)
{
    if (faces == AssimpFaces::polygons) return 0;
    unsigned const cut = aiProcess_Triangulate | aiProcess_SortByPType;
    return faces == AssimpFaces::merged ? cut | aiProcess_JoinIdenticalVertices : cut;
}

aiScene const* import(Assimp::Importer& importer, std::filesystem::path const& file, AssimpFaces faces)
{
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    importer.SetPropertyInteger(AI_CONFIG_PP_LBW_MAX_WEIGHTS, 4);
    return importer.ReadFile(file.string(), steps(faces));
}

/// Size of this process's address space, bytes.
rlim_t used_memory()
{
    rlim_t pages = 0;
    std::ifstream("/proc/self/statm") >> pages;
    return pages * rlim_t(sysconf(_SC_PAGESIZE));
}

/// Returns why the file cannot be imported; empty = it can.
std::string try_import(Assimp::Importer& importer, std::filesystem::path const& file, AssimpFaces faces)
{
    try {
        if (import(importer, file, faces) != nullptr) return {};
        std::string const reason = importer.GetErrorString();
        return reason.empty() ? "Assimp reports no reason" : reason;
    } catch (std::exception const& e) {
        return e.what();
    }
}

[[noreturn]] void import_with_limits(std::filesystem::path const& file, AssimpFaces faces, rlim_t most_memory,
                                     int reason_pipe)
{
    rlimit const time{kProbeSeconds, kProbeSeconds}, none{0, 0};
    setrlimit(RLIMIT_CPU, &time);
    setrlimit(RLIMIT_CORE, &none);
#if !defined(__SANITIZE_ADDRESS__)
    rlimit const memory{most_memory, most_memory};
    setrlimit(RLIMIT_AS, &memory);
#else
    static_cast<void>(most_memory);
#endif
    if (int const null = open("/dev/null", O_WRONLY); null >= 0) dup2(null, STDERR_FILENO);
    for (int const s : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGINT, SIGTERM, SIGHUP}) signal(s, SIG_DFL);
    Assimp::Importer importer;
    std::string const reason = try_import(importer, file, faces).substr(0, 4096);
    bool const told = write(reason_pipe, reason.data(), reason.size()) == ssize_t(reason.size());
    _exit(reason.empty() && told ? 0 : 1);
}

/// Throws InputError if the file cannot be read within the limits, or if reading it crashes or stalls the reader.
void probe(std::filesystem::path const& file, AssimpFaces faces, std::size_t file_bytes)
{
    auto const bad = [&](std::string const& why) {
        bool const known = Assimp::Importer().IsExtensionSupported(file.extension().string());
        return InputError("'" + file.string() + "' cannot be read", why,
                          known ? "export it again"
                                : "give glTF, YAML, OBJ, PLY, FBX or another format that Assimp supports");
    };
    rlim_t const most_memory = used_memory() + kProbeBytes + kProbeBytesPerByte * file_bytes;
    std::string reason;
    std::optional<int> ended;
    for (int attempt = 0; attempt < kAttempts && !ended; ++attempt) {
        reason.clear();
        ended = run_child([&](int pipe) { import_with_limits(file, faces, most_memory, pipe); }, reason);
    }
    if (!ended) throw bad("its reader (Assimp) waits for something, perhaps for a file that it refers to");
    int const status = *ended;
    if (WIFSIGNALED(status))
        throw bad(WTERMSIG(status) == SIGXCPU ? "its reader (Assimp) did not finish in time"
                                              : "its reader (Assimp) crashed on it");
    if (reason == std::bad_alloc().what()) reason = "its header asks for more memory than is available";
    if (WEXITSTATUS(status) != 0) throw bad(reason);
}

} // namespace

ImportedFiles import_assimp(std::filesystem::path const& file, AssimpFaces faces,
                            std::function<void(aiScene const&)> const& use)
{
    std::size_t const file_bytes = read_bytes(file).size();
    if (file_bytes == 0)
        throw InputError("'" + file.string() + "' is empty", "there is nothing to load", "export it again");
    probe(file, faces, file_bytes);
    ImportedFiles files;
    Assimp::Importer importer;
    importer.SetIOHandler(new NotingFiles(files)); // the importer takes ownership
    std::string const reason = try_import(importer, file, faces);
    if (!reason.empty()) throw InputError("'" + file.string() + "' cannot be read", reason, "export it again");
    use(*importer.GetScene());
    return files;
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
