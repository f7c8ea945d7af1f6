#pragma once
// A folder for the files of a check, removed at its end.

#include "gi/core/error.h"

#include <cstdlib>
#include <filesystem>
#include <string>

namespace ar {

class ScratchFolder {
public:
    /// @throws gi::InputError it cannot be made
    ScratchFolder()
    {
        namespace fs = std::filesystem;
        std::string name = (fs::temp_directory_path() / "lightwell_XXXXXX").string();
        if (mkdtemp(name.data()) == nullptr)
            throw gi::InputError("no folder can be made in " + fs::temp_directory_path().string(),
                                 "the check writes a session", "set TMPDIR");
        path_ = name;
    }
    ~ScratchFolder()
    {
        std::error_code ignored;
        std::filesystem::remove_all(path_, ignored);
    }
    ScratchFolder(ScratchFolder const&) = delete;
    ScratchFolder& operator=(ScratchFolder const&) = delete;
    std::filesystem::path const& path() const { return path_; }
    std::filesystem::path operator/(char const* file) const { return path_ / file; }

private:
    std::filesystem::path path_;
};

} // namespace ar
