#include "viewer/app/recent_scenes.h"

#include "gi/core/error.h"
#include "gi/core/file.h"

#include <algorithm>
#include <cstdlib>
#include <fmt/format.h>
#include <fstream>

namespace viewer {
namespace {

namespace fs = std::filesystem;

std::string variable(char const* name)
{
    char const* const value = std::getenv(name);
    return value == nullptr ? "" : value;
}

} // namespace

fs::path RecentScenes::default_file()
{
    fs::path state = variable("XDG_STATE_HOME");
    if (!state.is_absolute()) { // as its specification says
        fs::path const home = variable("HOME");
        if (!home.is_absolute()) return {};
        state = home / ".local/state";
    }
    return state / "lightwell/recent_scenes";
}

std::vector<std::string> RecentScenes::read() const
{
    std::vector<std::string> scenes;
    std::ifstream in(file_);
    std::error_code ignored;
    for (std::string line; scenes.size() < kMost && std::getline(in, line);)
        if (line.starts_with('/') && fs::exists(line, ignored) && std::ranges::find(scenes, line) == scenes.end())
            scenes.push_back(line);
    return scenes;
}

std::string RecentScenes::add(std::string const& scene) const
{
    std::error_code failure;
    if (file_.empty() || !fs::exists(scene, failure)) return {};
    std::string const path = fs::absolute(scene, failure).lexically_normal().string();
    if (failure || path.find('\n') != std::string::npos) return {};
    std::vector<std::string> scenes = read();
    std::erase(scenes, path);
    std::string text = path + "\n";
    for (std::size_t i = 0; i + 1 < kMost && i < scenes.size(); ++i) text += scenes[i] + "\n";
    fs::create_directories(file_.parent_path(), failure);
    if (failure) return fmt::format("'{}' cannot be made ({})", file_.parent_path().string(), failure.message());
    try {
        gi::write_text(file_, text);
    } catch (gi::InputError const& e) {
        return e.what();
    }
    return {};
}

} // namespace viewer
