#pragma once
// `lightwell bench pictures`: compares the pictures of methods over scenes, budgets and filters.

#include "viewer/offline/render_options.h"
#include "viewer/report/table.h"

namespace viewer {

inline constexpr char const* kPeer = "reference"; ///< the method that others are compared with

struct PicturesOptions {
    RenderOptions render; ///< common to all renders: size, bounces, first seed, threads, quality
    std::string list = "data/pictures.yaml";
    std::vector<std::string> scenes; ///< names from the list; empty = all
    std::vector<std::string> budgets{"1path", "100ms", "300ms", "1s", "4s"};
    std::vector<std::string> filters{"none", "atrous"};
    std::vector<std::string> methods{kPeer, "paths", "slhb", "vpl_slhb"};
    std::uint32_t reference_paths = 4096;
    std::string references; ///< folder; empty = "references" within `out`
    int repeats = 3;
    bool interactive = false; ///< call run_interactive_pictures
    int frames = 60;          ///< of each sequence
    int reuse = 16;           ///< largest number of frames averaged per pixel
    double fps = 30;          ///< of the animation
    std::string frame_budget = "100ms";
    std::vector<int> scored_frames{1, 4, 16, 30, 45, 60}; ///< counted from 1
    bool resume = false;                                  ///< keep rows that exist in the folder
    std::string out;
};

struct PicturesResult {
    BenchTable pictures, summary; ///< for interactive frames without times at equal error
    bool interrupted = false;     ///< the tables hold what was finished before
};

/// Writes tables, pictures and the page to the folder as they are finished.
/// Throws InputError before rendering if the call is invalid; scenes and filters that are not available are
/// skipped, which is reported on stderr and in the tables.
PicturesResult run_pictures(PicturesOptions const& options);

/// Renders consecutive frames of every sequence, with the same temporal reuse for all methods. Rows are the scored
/// frames and their mean.
PicturesResult run_interactive_pictures(PicturesOptions const& options);

/// Comparisons of all methods with kPeer, from the rows of `pictures`, worst first.
BenchTable summary_of(BenchTable const& pictures);

} // namespace viewer
