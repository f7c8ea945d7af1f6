#pragma once
// An HTML page of tables, curves and pictures.

#include "viewer/report/folder.h"

namespace viewer {

enum class PagePictures : std::uint8_t {
    embedded, ///< the page is self-contained
    linked    ///< as separate files; the page must be in their folder
};

struct Page {
    std::string title = "Lightwell bench";
    std::string lead;                               ///< paragraph below the title; empty = none
    std::vector<BenchFolder> folders;               ///< with the pictures that they name
    PagePictures pictures = PagePictures::embedded; ///< for tables with pictures per scene, budget and method
    std::vector<std::string> next;                  ///< commands to try, shown at the end
};
std::string make_page(Page const& page);

/// Pictures, stereo pairs and videos of a folder with their times; empty if it has no renders.
std::string render_figures(BenchFolder const& folder);

/// Curves of error over time and strips of pictures, per scene; empty unless the table has the columns scene,
/// method, budget_s, frame_s and relmse.
std::string sweep_figures(BenchTable const& table, std::filesystem::path const& folder);

/// Curves of the tables of `bench thesis` in all folders: time, error, and how they grow; empty if there are none.
std::string thesis_figures(std::vector<BenchFolder> const& folders);

/// Strips of figures, each with its heading, beside a reference picture.
std::string picture_strips(std::string const& reference_html,
                           std::vector<std::pair<std::string, std::string>> const& strips);
/// Explanation of the strips of pictures, shown below them.
std::string picture_note();

/// For each scene and budget the pictures of all methods and filters beside the reference, worst first; empty
/// unless the table is from `bench pictures`.
std::string picture_grids(BenchTable const& table, std::filesystem::path const& folder, PagePictures pictures);

} // namespace viewer
