#pragma once
// One HTML page of tables, that needs nothing beside itself: no scripts, drawings inline, pictures as data.

#include "viewer/bench/table.h"

#include <filesystem>

namespace viewer {

/// @param folder where the pictures are that the tables name
std::string make_page(std::vector<BenchTable> const& tables, std::filesystem::path const& folder);

/// Curves of error over time and strips of pictures, per scene; empty unless the table has the columns scene,
/// method, budget_s, frame_s and relmse.
std::string sweep_figures(BenchTable const& table, std::filesystem::path const& folder);

std::string_view page_style();

} // namespace viewer
