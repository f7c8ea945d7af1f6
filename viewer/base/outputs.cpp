#include "viewer/base/outputs.h"

#include "gi/core/error.h"
#include "gi/core/file.h"

#include <algorithm>
#include <filesystem>
#include <optional>
#include <set>
#include <sys/stat.h>
#include <unistd.h>

namespace viewer {
namespace fs = std::filesystem;
namespace {

/// Device and inode: equal for all names of one file.
using Identity = std::pair<dev_t, ino_t>;

std::optional<Identity> identity(std::string const& file)
{
    struct stat s {};
    if (file.empty() || stat(file.c_str(), &s) != 0) return std::nullopt;
    return Identity{s.st_dev, s.st_ino};
}

} // namespace

void check_outputs(std::vector<std::string> const& files, std::vector<std::string> const& inputs)
{
    std::set<Identity> read;
    for (std::string const& input : inputs)
        if (auto const found = identity(input)) read.insert(*found);
    std::set<fs::path> seen;
    for (std::string const& file : files) {
        if (file.empty()) continue;
        auto const cannot = [&](std::string const& why, std::string const& suggestion) {
            return gi::InputError("cannot write '" + file + "'", why, suggestion);
        };
        fs::path const path = file, folder = path.has_parent_path() ? path.parent_path() : ".";
        std::error_code error;
        if (!fs::is_directory(folder, error))
            throw cannot("there is no folder '" + folder.string() + "'", "create it first");
        if (access(folder.c_str(), W_OK) != 0)
            throw cannot("the folder '" + folder.string() + "' is read-only", "choose another");
        if (fs::is_directory(path, error)) throw cannot("it is a folder", "name a file");
        if (fs::exists(path, error) && !fs::is_regular_file(path, error))
            throw cannot("it is a device or a pipe, which a file would replace", "name a file");
        if (!seen.insert(fs::weakly_canonical(fs::absolute(path), error)).second)
            throw cannot("two outputs have this name", "give each its own");
        if (auto const found = identity(file); found && read.contains(*found))
            throw cannot("it is also an input", "choose another name");
    }
}

void check_ending(std::string const& file, std::string const& ending, std::string const& what,
                  std::string const& suggestion)
{
    std::string const given = gi::lower_extension(file);
    if (!given.empty() && given != ending)
        throw gi::InputError("'" + file + "' cannot be " + what, "its ending is not " + ending, suggestion);
}

} // namespace viewer
