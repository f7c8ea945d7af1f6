// Includes run one way: what cmake/layers.txt says of each folder is what its files do.

#include "tests/viewer/run_program.h"

#include <algorithm>
#include <iterator>
#include <map>
#include <set>

namespace viewer::test {
namespace {

namespace fs = std::filesystem;

/// Where a folder stands in cmake/layers.txt.
struct Place {
    int line;
    std::vector<std::string> allowed; ///< tops that it may include
};
using Layers = std::map<std::string, Place>;

struct Include {
    std::string where;    ///< file:line: #include "..."
    std::string from, to; ///< folders
};

Layers read_layers()
{
    Layers layers;
    std::vector<std::string> allowed;
    int number = 0;
    std::istringstream in(file_text(LIGHTWELL_SOURCE_DIR "/cmake/layers.txt"));
    for (std::string line; std::getline(in, line); ++number) {
        std::istringstream words(line);
        std::string first;
        if (!(words >> first) || first.starts_with('#')) continue;
        if (first.ends_with(':')) {
            allowed.assign(std::istream_iterator<std::string>(words), {});
            continue;
        }
        EXPECT_TRUE(layers.emplace(first, Place{number, allowed}).second) << first << " stands there twice";
    }
    return layers;
}

bool may_include(Layers const& layers, std::string const& from, std::string const& to)
{
    if (from == to || from == "tests") return true;
    Place const& place = layers.at(from);
    return layers.at(to).line < place.line && std::ranges::any_of(place.allowed, [&](std::string const& top) {
               return to == top || to.starts_with(top + "/");
           });
}

/// The longest folder of the layers that holds the path; empty = none.
std::string folder_of(std::string const& path, Layers const& layers)
{
    std::string best;
    for (auto const& [folder, unused] : layers)
        if (path.starts_with(folder + "/") && folder.size() > best.size()) best = folder;
    return best;
}

std::vector<Include> all_includes(fs::path const& root, Layers const& layers)
{
    static std::set<std::string> const kGenerated{"git_hash.h"};
    std::vector<Include> found;
    for (char const* top : {"gi", "ar", "study", "viewer", "python", "tests"}) {
        if (!fs::is_directory(root / top)) continue;
        for (auto const& entry : fs::recursive_directory_iterator(root / top)) {
            static std::set<std::string> const kCode{".h", ".cpp", ".cu", ".cuh"};
            if (!kCode.contains(entry.path().extension().string())) continue;
            std::string const file = fs::relative(entry.path(), root).string();
            std::ifstream in(entry.path());
            int number = 0;
            for (std::string line; std::getline(in, line);) {
                ++number;
                if (!line.starts_with("#include \"")) continue;
                std::string const target = line.substr(10, line.find('"', 10) - 10);
                std::string const where = file + ":" + std::to_string(number) + ": " + line;
                if (kGenerated.contains(target)) continue;
                EXPECT_TRUE(fs::exists(root / target))
                    << where << "\n  is no path from the root of the repository";
                found.push_back({where, folder_of(file, layers), folder_of(target, layers)});
            }
        }
    }
    return found;
}

TEST(IncludeGraph, FollowsTheLayers)
{
    Layers const layers = read_layers();
    for (char const* folder : {"gi/core", "gi/scene", "ar/camera", "study/stats", "viewer/cli", "tests"})
        ASSERT_TRUE(layers.contains(folder)) << folder << " has no line in cmake/layers.txt";
    ASSERT_FALSE(may_include(layers, "gi/core", "gi/scene"));
    ASSERT_FALSE(may_include(layers, "study/report", "gi/render"));
    ASSERT_TRUE(may_include(layers, "study/report", "gi/core"));
    std::vector<Include> const includes = all_includes(LIGHTWELL_SOURCE_DIR, layers);
    EXPECT_GT(includes.size(), 100u);
    for (Include const& i : includes) {
        EXPECT_FALSE(i.from.empty()) << i.where << "\n  lies in a folder without a line in cmake/layers.txt";
        if (i.from.empty() || i.to.empty()) continue;
        EXPECT_TRUE(may_include(layers, i.from, i.to))
            << i.where << "\n  '" << i.from << "' may not include '" << i.to << "'";
    }
}

} // namespace
} // namespace viewer::test
