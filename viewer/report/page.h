#pragma once
// One HTML page of tables, that needs nothing beside itself: no scripts, drawings inline, pictures as data.

#include "viewer/report/folder.h"

namespace viewer {

enum class PagePictures : std::uint8_t {
    embedded, ///< the page needs nothing beside itself
    linked    ///< they stay files; the page belongs in their folder
};

struct Page {
    std::string title = "Lightwell bench";
    std::string lead;                               ///< a paragraph below it; empty = none
    std::vector<BenchFolder> folders;               ///< pictures that they name are looked for in them
    PagePictures pictures = PagePictures::embedded; ///< of tables that have them per scene, budget and method
    std::vector<std::string> next;                  ///< commands to try, at the end
};
std::string make_page(Page const& page);

/// Pictures, pairs and videos of a folder with what they cost; empty where nothing was rendered.
std::string render_figures(BenchFolder const& folder);

/// Curves of error over time and strips of pictures, per scene; empty unless the table has the columns scene,
/// method, budget_s, frame_s and relmse.
std::string sweep_figures(BenchTable const& table, std::filesystem::path const& folder);

/// Per scene and budget the pictures of all methods and filters beside the reference, the worst first; empty
/// unless it is a table of `bench pictures`.
std::string picture_grids(BenchTable const& table, std::filesystem::path const& folder, PagePictures pictures);

std::string_view page_style();

} // namespace viewer
