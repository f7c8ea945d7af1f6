#include "gi/filter/oidn_library.h"

#include "gi/core/error.h"

#include <cstdlib>
#include <dlfcn.h>
#include <filesystem>
#include <string>
#include <vector>

namespace gi {
namespace {

namespace fs = std::filesystem;

constexpr char const *kLibrary = "libOpenImageDenoise.so.2", *kVariable = "LIGHTWELL_OIDN";

/// Folders of the program and of the shared object that contains this function.
std::vector<fs::path> own_folders()
{
    std::vector<fs::path> folders;
    std::error_code none;
    if (fs::path const program = fs::read_symlink("/proc/self/exe", none); !program.empty())
        folders.push_back(program.parent_path());
    Dl_info about{};
    if (dladdr(reinterpret_cast<void const*>(&oidn_library), &about) != 0 && about.dli_fname != nullptr)
        if (fs::path const object = fs::canonical(about.dli_fname, none); !object.empty())
            folders.push_back(object.parent_path());
    return folders;
}

void add_existing(fs::path const& file, std::vector<fs::path>& found)
{
    std::error_code none;
    if (fs::exists(file, none)) found.push_back(file);
}

/// Libraries that pip installed into a Python environment.
void add_of_environment(fs::path const& environment, std::vector<fs::path>& found)
{
    std::error_code none;
    for (auto const& version : fs::directory_iterator(environment / "lib", none))
        add_existing(version.path() / "site-packages/pyoidn/oidn/lib" / kLibrary, found);
}

std::vector<fs::path> candidates()
{
    if (char const* const stated = std::getenv(kVariable); stated != nullptr && *stated != 0) {
        std::error_code none;
        return {fs::is_directory(stated, none) ? fs::path(stated) / kLibrary : fs::path(stated)};
    }
    std::vector<fs::path> found;
    for (fs::path folder : own_folders()) {
        add_existing(folder / kLibrary, found);
        for (int up = 0; up < 6 && folder.has_relative_path(); ++up, folder = folder.parent_path()) {
            add_of_environment(folder / "python", found);
            add_existing(folder / "pyoidn/oidn/lib" / kLibrary, found);
        }
    }
    found.emplace_back(kLibrary);
    return found;
}

struct Loaded {
    OidnLibrary library{};
    std::string why; ///< why the library cannot be used; empty = it can
};

template <class Function>
void bind(void* module, char const* name, Function*& function, std::string& why)
{
    function = reinterpret_cast<Function*>(dlsym(module, name));
    if (function == nullptr && why.empty()) why = std::string("it has no function ") + name;
}

Loaded load()
{
    void* module = nullptr;
    std::string first_error;
    for (fs::path const& file : candidates()) {
        module = dlopen(file.c_str(), RTLD_NOW | RTLD_LOCAL);
        if (module != nullptr) break;
        char const* const error = dlerror();
        if (first_error.empty() && error != nullptr) first_error = error;
    }
    if (module == nullptr) return {{}, first_error};
    Loaded l;
    OidnLibrary& f = l.library;
    bind(module, "oidnNewDevice", f.new_device, l.why);
    bind(module, "oidnSetDeviceInt", f.set_device_int, l.why);
    bind(module, "oidnSetDeviceBool", f.set_device_bool, l.why);
    bind(module, "oidnCommitDevice", f.commit_device, l.why);
    bind(module, "oidnGetDeviceError", f.device_error, l.why);
    bind(module, "oidnReleaseDevice", f.release_device, l.why);
    bind(module, "oidnNewFilter", f.new_filter, l.why);
    bind(module, "oidnSetSharedFilterImage", f.set_filter_image, l.why);
    bind(module, "oidnSetFilterBool", f.set_filter_bool, l.why);
    bind(module, "oidnSetFilterInt", f.set_filter_int, l.why);
    bind(module, "oidnSetFilterProgressMonitorFunction", f.set_filter_progress_monitor, l.why);
    bind(module, "oidnCommitFilter", f.commit_filter, l.why);
    bind(module, "oidnExecuteFilter", f.execute_filter, l.why);
    bind(module, "oidnReleaseFilter", f.release_filter, l.why);
    return l;
}

} // namespace

OidnLibrary const& oidn_library()
{
    static Loaded const loaded = load();
    if (loaded.why.empty()) return loaded.library;
    bool const stated = std::getenv(kVariable) != nullptr;
    throw InputError("the filter oidn cannot be used", "Open Image Denoise 2 was not loaded: " + loaded.why,
                     stated ? std::string("let ") + kVariable +
                                  " name the library, or unset it and run scripts/setup --oidn"
                            : "install it with scripts/setup --oidn, or choose another filter");
}

} // namespace gi
