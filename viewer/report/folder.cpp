#include "viewer/report/folder.h"

#include "gi/core/error.h"
#include "gi/core/file.h"
#include "viewer/report/table_file.h"

#include <algorithm>

namespace viewer {
namespace fs = std::filesystem;

BenchFolder read_bench_folder(fs::path const& folder)
{
    constexpr std::size_t kMostBytes = std::size_t(1) << 28; // largest file of rows
    auto const cannot = [&](std::string const& why, std::string const& suggestion) {
        return gi::InputError("cannot read tables from '" + folder.string() + "'", why, suggestion);
    };
    std::error_code error;
    if (!fs::exists(folder, error)) throw cannot("there is no such folder", "make one with lightwell bench sweep");
    if (!fs::is_directory(folder, error)) throw cannot("it is not a folder", "name the folder that --out named");
    std::vector<fs::path> files;
    for (auto const& entry : fs::directory_iterator(folder, error))
        if (entry.path().extension() == ".json" && !entry.path().filename().string().starts_with('.'))
            files.push_back(entry.path());
    if (error) throw cannot(error.message(), "check its permissions");
    if (files.empty()) throw cannot("it holds no *.json", "make one with lightwell bench sweep");
    std::sort(files.begin(), files.end());
    BenchFolder found{folder, {}, {}};
    for (fs::path const& file : files) {
        std::vector<unsigned char> const bytes = gi::read_bytes(file, kMostBytes);
        std::string const json(bytes.begin(), bytes.end());
        if (is_render_stats(json))
            found.renders.push_back(parse_render_stats(json, file.string()));
        else
            found.tables.push_back(parse_table(json, file.string()));
    }
    return found;
}

} // namespace viewer
