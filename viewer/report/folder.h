#pragma once
// Reads the results of benchmarks from a folder.

#include "viewer/report/render_stats.h"
#include "viewer/report/table.h"

#include <filesystem>

namespace viewer {

/// Tables of bench commands and statistics of `render --stats` in a folder.
struct BenchFolder {
    std::filesystem::path path;
    std::vector<BenchTable> tables;
    std::vector<RenderStats> renders;
};

/// Reads every *.json of the folder, sorted by name. Throws InputError if there is none,
/// or if one is damaged or of another kind.
BenchFolder read_bench_folder(std::filesystem::path const& folder);

} // namespace viewer
