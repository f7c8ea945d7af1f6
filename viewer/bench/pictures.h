#pragma once
// `lightwell bench pictures`: methods judged by their pictures, over scenes, budgets and filters.

#include "viewer/offline/render_options.h"
#include "viewer/report/table.h"

namespace viewer {

inline constexpr char const* kPeer = "reference"; ///< the method that others are measured against

struct PicturesOptions {
    RenderOptions render; ///< what all renders have in common: size, bounces, first seed, threads, quality
    std::string list = "data/pictures.yaml";
    std::vector<std::string> scenes; ///< names in the list; empty = all
    std::vector<std::string> budgets{"1path", "100ms", "300ms", "1s", "4s"};
    std::vector<std::string> filters{"none", "atrous"};
    std::vector<std::string> methods{kPeer, "slhb", "vpl_slhb"};
    std::uint32_t reference_paths = 4096;
    std::string references; ///< folder; empty = "references" within `out`
    int repeats = 3;
    bool interactive = false; ///< run_interactive_pictures
    int frames = 60;          ///< of each sequence
    int reuse = 16;           ///< frames
    double fps = 30;          ///< of the animation
    std::string frame_budget = "100ms";
    std::vector<int> scored_frames{1, 4, 16, 30, 45, 60}; ///< counted from 1
    bool resume = false;                                  ///< rows that the folder has already are kept
    std::string out;
};

struct PicturesResult {
    BenchTable pictures, summary; ///< of interactive frames: without times at equal error
    bool interrupted = false;     ///< the tables hold what was done before
};

/// Writes tables, pictures and the page to the folder as they come. What is wrong with the call is found before
/// anything is rendered (InputError); scenes and filters that are not available are skipped, said on stderr and
/// noted in the tables.
PicturesResult run_pictures(PicturesOptions const& options);

/// Frames that follow each other, of every sequence, with temporal reuse: the same for all methods. Rows are
/// frames that are scored, and their mean.
PicturesResult run_interactive_pictures(PicturesOptions const& options);

/// Of the rows in `pictures`: the contests of all methods with the peer, worst first.
BenchTable summary_of(BenchTable const& pictures);

} // namespace viewer
