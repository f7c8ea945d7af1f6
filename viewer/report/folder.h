#pragma once
#include "viewer/report/render_stats.h"
#include "viewer/report/table.h"

#include <filesystem>

namespace viewer {

/// What commands of bench, and `render --stats`, have left in a folder.
struct BenchFolder {
    std::filesystem::path path;
    std::vector<BenchTable> tables;
    std::vector<RenderStats> renders;
};

/// Every *.json of the folder, by name. Throws InputError where there is none, or one is damaged or neither.
BenchFolder read_bench_folder(std::filesystem::path const& folder);

} // namespace viewer
