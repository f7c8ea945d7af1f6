#include "viewer/study/scene_content.h"

#include "gi/core/file.h"
#include "gi/core/sha256.h"

#include <filesystem>
#include <map>
#include <set>

namespace viewer {

std::string scene_sha256(gi::Scene const& scene)
{
    std::set<std::filesystem::path> files;
    std::error_code none;
    for (std::string const& file : scene.files)
        if (std::filesystem::is_regular_file(file, none))
            files.insert(std::filesystem::weakly_canonical(file, none));
    if (files.empty()) return {};
    std::multimap<std::string, std::string> contents; // by name
    for (std::filesystem::path const& file : files) {
        auto const bytes = gi::read_bytes(file);
        contents.emplace(file.filename().string(),
                         gi::sha256({reinterpret_cast<char const*>(bytes.data()), bytes.size()}));
    }
    std::string all;
    for (auto const& [name, digits] : contents) all += name + "\n" + digits + "\n";
    return gi::sha256(all);
}

} // namespace viewer
