#pragma once
// One HTML page of tables, that needs nothing beside itself: no scripts, drawings inline, pictures as data.

#include "viewer/bench/folder.h"

namespace viewer {

struct Page {
    std::string title = "Lightwell bench";
    std::string lead;                 ///< a paragraph below it; empty = none
    std::vector<BenchFolder> folders; ///< pictures that they name are looked for in them
    std::vector<std::string> next;    ///< commands to try, at the end
};
std::string make_page(Page const& page);

/// Pictures, pairs and videos of a folder with what they cost; empty where nothing was rendered.
std::string render_figures(BenchFolder const& folder);

/// Curves of error over time and strips of pictures, per scene; empty unless the table has the columns scene,
/// method, budget_s, frame_s and relmse.
std::string sweep_figures(BenchTable const& table, std::filesystem::path const& folder);

std::string_view page_style();

} // namespace viewer
