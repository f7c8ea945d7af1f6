// OBJ, PLY, STL, FBX, COLLADA, ... through Assimp. Some damaged files make Assimp itself crash or hang, so every
// file is first imported by a child process with limits; only if that ends well does this process read it.

#include "gi/base/error.h"
#include "gi/base/file.h"
#include "gi/scene/load.h"
#include "gi/scene/load/assimp_convert.h"

#include <assimp/Importer.hpp>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>
#include <csignal>
#include <fcntl.h>
#include <fmt/format.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

namespace gi {
namespace {

constexpr rlim_t kProbeSeconds = 60;
constexpr rlim_t kProbeBytes = rlim_t(16) << 30;

aiScene const* import(Assimp::Importer& importer, std::filesystem::path const& file)
{
    importer.SetPropertyInteger(AI_CONFIG_PP_SBP_REMOVE, aiPrimitiveType_POINT | aiPrimitiveType_LINE);
    importer.SetPropertyBool(AI_CONFIG_IMPORT_FBX_PRESERVE_PIVOTS, false);
    importer.SetPropertyInteger(AI_CONFIG_PP_LBW_MAX_WEIGHTS, 4);
    return importer.ReadFile(file.string(), aiProcess_Triangulate | aiProcess_JoinIdenticalVertices |
                                                aiProcess_LimitBoneWeights | aiProcess_SortByPType);
}

/// Throws InputError where reading the file kills or stalls the reader.
void probe(std::filesystem::path const& file)
{
    pid_t const child = fork();
    if (child < 0) return; // no child to be had: read it without a net
    if (child == 0) {
        rlimit const time{kProbeSeconds, kProbeSeconds}, memory{kProbeBytes, kProbeBytes}, none{0, 0};
        setrlimit(RLIMIT_CPU, &time);
#if !defined(__SANITIZE_ADDRESS__)
        setrlimit(RLIMIT_AS, &memory);
#endif
        setrlimit(RLIMIT_CORE, &none);
        if (int const null = open("/dev/null", O_WRONLY); null >= 0) dup2(null, STDERR_FILENO);
        for (int const s : {SIGSEGV, SIGABRT, SIGBUS, SIGFPE, SIGILL, SIGINT, SIGTERM}) signal(s, SIG_DFL);
        try {
            Assimp::Importer importer;
            import(importer, file);
        } catch (...) { // the parent will meet the exception itself
        }
        _exit(0);
    }
    int status = 0;
    while (waitpid(child, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFEXITED(status) && WEXITSTATUS(status) == 0) return;
    throw InputError("'" + file.string() + "' cannot be read",
                     WIFSIGNALED(status) && WTERMSIG(status) == SIGXCPU
                         ? "its reader (Assimp) did not come to an end"
                         : "its reader (Assimp) crashed on it",
                     "convert it to glTF with another program");
}

} // namespace

Scene load_assimp(std::filesystem::path const& file, Report& report)
{
    if (read_bytes(file).empty())
        throw InputError("'" + file.string() + "' is empty", "there is nothing to load", "export it again");
    probe(file);
    Assimp::Importer importer;
    aiScene const* source = nullptr;
    std::string reason;
    try {
        source = import(importer, file);
        if (source == nullptr) reason = importer.GetErrorString();
    } catch (std::exception const& e) {
        reason = e.what();
    }
    if (source == nullptr)
        throw InputError("'" + file.string() + "' cannot be read",
                         reason.empty() ? "Assimp gives no reason" : reason,
                         "give glTF, YAML, OBJ, PLY, FBX or another format that Assimp knows");
    return convert_assimp(*source, file, report);
}

} // namespace gi
