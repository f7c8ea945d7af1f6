#pragma once
// Scene files that the user opened, the newest first, kept in $XDG_STATE_HOME/lightwell/recent_scenes (by default
// below ~/.local/state), one absolute path a line.

#include <filesystem>
#include <string>
#include <vector>

namespace viewer {

class RecentScenes {
public:
    static constexpr std::size_t kMost = 16;

    /// @param file  empty = nothing is kept
    explicit RecentScenes(std::filesystem::path file = default_file()) : file_(std::move(file)) {}
    /// Empty where the user has no home.
    static std::filesystem::path default_file();

    /// Those that still exist. A file that cannot be read counts as empty.
    std::vector<std::string> read() const;
    /// Puts a scene first in the list. Names of generated scenes are left out.
    /// @return why it could not be kept; empty = it was
    std::string add(std::string const& scene) const;

private:
    std::filesystem::path file_;
};

} // namespace viewer
